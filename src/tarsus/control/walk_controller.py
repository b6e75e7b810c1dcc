"""The walk controller: from a command and sensor readings to the next joint angles, tick by tick."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.command import Command
from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.limiter.workspace import top_speed
from tarsus.control.pose.admittance import Admittance
from tarsus.control.pose.posture_feedback import Levelling
from tarsus.control.readings import SensorReadings, ValidReadings
from tarsus.control.search.missing_ground import SLOW
from tarsus.control.sensing.foot_loads import FootLoads
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.terrain.roughness import GroundAdaptation
from tarsus.control.tick.components import WalkComponents
from tarsus.control.tick.estimate import estimated
from tarsus.control.tick.integrate import integrated
from tarsus.control.tick.limit import limited, twist_limiters
from tarsus.control.tick.plan import planned
from tarsus.control.transition.planner import TransitionPlanner
from tarsus.control.walk_state import TickState, WalkState
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.gait.walk_setup import WalkSetup, require_number
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stability import stability_margin
from tarsus.representation import represented
from tarsus.robot.joint_limits import joint_limits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["WalkController"]

# Longest part of a tick that is walked [s], so that the joints don't jump after a late tick.
_LONGEST_TICK = 0.05
_JOINTS = Cause("joint speed and acceleration")
_LATE = Cause(f"of a tick longer than {1e3 * _LONGEST_TICK:.0f} ms, only {1e3 * _LONGEST_TICK:.0f} ms are walked")


@represented("robot", "gait", "walk_state", "time", "twist", "cycle_time", "margin", "angles", "limitations")
class WalkController:
    """Walks a robot live: each tick takes a command and readings, and gives the next joint angles.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait, optional
        Order of the steps; by default the robot's own gait.
    body_height, swing_height : float, optional
        Height of the body's origin over the ground, and of a swinging foot over its foothold [m]; by default the
        robot's own.
    stance_width : float
        How much farther from its coxa axis each foot rests than by default [m].
    cycle_time : float, optional
        Duration of a cycle [s]; left out, the one with the highest top speed.
    joint_speed, joint_acceleration : float, optional
        Greatest speed [rad/s] and acceleration [rad/s^2] of every joint; left out, each servo's no-load speed, reached
        in 0.05 s.
    foot_distance : float, optional
        Least distance between two feet [m]; two foot radii and 10 mm where left out.
    levelling : "level", "between", "follow" or None
        Attitude to keep on sloping ground where the attitude is measured: level, halfway between level and the slope,
        or along the slope; None to ignore the measured attitude.
    adaptation : GroundAdaptation, optional
        How far the walk may adapt to rough ground; by default ``GroundAdaptation()``.
    admittance : Admittance, optional
        How the feet comply with the forces on them; left out, they are stiff.

    Attributes
    ----------
    robot : Robot
        The robot.
    joint_speed, joint_acceleration : array, shape (legs, 3)
        Greatest speed [rad/s] and acceleration [rad/s^2] of each joint.
    time : float
        Time since the start [s].

    Raises
    ------
    InputError
        If an argument is not finite or out of its range, the robot is a batch, or the gait is for another number of
        legs.
    UnreachableError
        If the robot can't stand and step in this stance.
    """

    def __init__(  # noqa: PLR0913 - all that a walk is set up with, all of it optional
        self,
        robot: Robot,
        gait: Gait | None = None,
        *,
        body_height: float | None = None,
        swing_height: float | None = None,
        stance_width: float = 0.0,
        cycle_time: float | None = None,
        joint_speed: float | None = None,
        joint_acceleration: float | None = None,
        foot_distance: float | None = None,
        levelling: Levelling | None = "level",
        adaptation: GroundAdaptation | None = None,
        admittance: Admittance | None = None,
    ) -> None:
        setup = WalkSetup.of(
            robot, gait, body_height=body_height, swing_height=swing_height, foot_distance=foot_distance
        )
        # Share of the last tick that was walked.
        self.robot, self.time, self._walked = setup.robot, 0.0, 1.0
        limits = joint_limits(self.robot, joint_speed, joint_acceleration)
        self.joint_speed, self.joint_acceleration = limits
        planner = TransitionPlanner(self.robot, limits, foot_distance=setup.foot_distance)
        stance = planner.initial_stance(setup, stance_width=stance_width, cycle_time=cycle_time)
        adaptation = GroundAdaptation() if adaptation is None else adaptation
        for name, value, kind in (("adaptation", adaptation, GroundAdaptation), ("admittance", admittance, Admittance)):
            if value is not None and not isinstance(value, kind):
                raise InputError(f"{name} is {value!r}; it must be of class {kind.__name__}")
        body = BodyMotion(self.robot, levelling=levelling, adaptation=adaptation)
        self._walk = WalkComponents(planner, stance, body=body, loads=FootLoads(self.robot, admittance))
        self._tick = TickState(self._walk.initial, np.zeros(3))
        self._twist_limiters = twist_limiters(self._walk)

    def step(
        self, command: Command | Sequence[float], dt: float, readings: SensorReadings | None = None
    ) -> Float[np.ndarray, "legs 3"]:
        """Advance by one tick.

        Parameters
        ----------
        command : Command or (vx, vy, wz)
            The command; a twist alone [m/s, m/s, rad/s] changes nothing else.
        dt : float
            Time since the last tick [s]. Of a tick longer than 0.05 s, only 0.05 s are walked.
        readings : SensorReadings, optional
            The sensor readings. Implausible ones are rejected and named in `limitations`.

        Returns
        -------
        array, shape (legs, 3)
            The next joint angles [rad].

        Raises
        ------
        InputError
            If the command or the time is not finite, or out of its range. Nothing has changed then.
        UnknownNameError
            If no gait has the name. Nothing has changed then.
        """
        command = command if isinstance(command, Command) else Command(twist=command)
        require_number("dt", dt, zero=False)
        self._walked, dt = min(_LONGEST_TICK / dt, 1.0), min(float(dt), _LONGEST_TICK)
        self._walk.transitions.scheduler.request(command)
        tick = estimated(self._walk, self._tick, readings, dt)
        tick = planned(self._walk, tick, command, dt)
        tick = limited(self._walk, tick, command, dt, self._twist_limiters)
        self._tick = integrated(self._walk, tick, dt)
        self.time += dt
        return self.angles

    def begin_on(self, slope: complex) -> None:
        """Begin in a stance on a slope that has been felt before, with the body as it stands on level ground.

        Parameters
        ----------
        slope : complex
            Rise of the ground along x and y of the body [m/m]; of what is beyond the legs' reach, only a part counts.

        Raises
        ------
        InputError
            After the first tick, as the joints would jump.
        """
        if self.time:
            raise InputError(f"begin_on is for a walk before its first tick; this one is at {self.time:.2f} s")
        self._tick = self._tick._replace(gait=self._walk.on_slope(slope))

    def joints_held(self) -> None:
        """Note that the joints have been held in place: the walk continues from rest."""
        self._walk.time_scaling.joints_held()

    @property
    def walk_state(self) -> WalkState:
        """The present state of the walk."""
        return self._tick.walk_state

    @property
    def limitations(self) -> tuple[Limitation, ...]:
        """Why the command is not met in full."""
        walk = self._walk
        slower = (_JOINTS, walk.time_scaling.rate, SLOW), (_LATE, self._walked, 1.0)
        return (
            *walk.transitions.limitations,
            *walk.foot_targets.limitations,
            *self._tick.limitations,
            *walk.ground.limitations,
            *(
                cause.limitation(LimitationKind.TWIST, asked=1.0, granted=share)
                for cause, share, least in slower
                if share < least and self._tick.twist.any()
            ),
        )

    @property
    def gait(self) -> Gait:
        """Order of the steps."""
        return self._walk.transitions.timing.gait

    @property
    def cycle_time(self) -> float:
        """Duration of a cycle [s]."""
        return 1 / self._walk.transitions.timing.frequency

    @property
    def place(self) -> tuple[float, float, float]:
        """Position and yaw of the heading frame in G: x, y [m], yaw [rad]."""
        state = self._tick.gait
        return state.origin.real, state.origin.imag, state.yaw

    @property
    def slope(self) -> complex:
        """Rise of the plane of the feet along x and y of a level body [m/m]; 0 where no ground is felt."""
        plane, yaw = self._walk.ground.ground.plane, float(self._tick.gait.moved_posture[5])
        return complex(plane.slope_x, plane.slope_y) * cmath.exp(-1j * yaw)

    @property
    def body(self) -> Pose:
        """Pose of B in G."""
        return self._tick.gait.body

    @property
    def feet(self) -> Float[np.ndarray, "legs 3"]:
        """The feet in G, which are the centres of their balls: array, shape (legs, 3) [m]."""
        return self._walk.solver.feet(self._tick.gait, self.angles)

    @property
    def contacts(self) -> Bool[np.ndarray, "legs"]:
        """Which feet of the legs in the gait are on the ground: array of bool, shape (legs,)."""
        down = self._tick.gait.down.copy()
        down[self._walk.foot_targets.legs] = False
        return down

    @property
    def bears(self) -> Bool[np.ndarray, "legs"]:
        """Which of the feet in `contacts` bear load, as far as is felt: array of bool, shape (legs,)."""
        return self.contacts & [self._walk.ground.contacts.supports(leg) for leg in range(self.robot.legs)]

    @property
    def feels_ground(self) -> bool:
        """Whether any readings so far have told of the ground: from then on, the feet follow what is felt of it."""
        return bool(self._tick.gait.felt)

    @property
    def measured(self) -> ValidReadings:
        """The part of the last readings that passed validation."""
        return self._walk.ground.readings.valid

    @property
    def angles(self) -> Float[np.ndarray, "legs 3"]:
        """The joint angles: array, shape (legs, 3) [rad]."""
        return self._walk.time_scaling.angles

    @property
    def twist(self) -> Float[np.ndarray, "3"]:
        """The present twist: array, shape (3,): forward, left [m/s], turning [rad/s]."""
        return self._tick.gait.twist.value * self._walk.time_scaling.rate * self._walk.ground.support.pace

    @property
    def margin(self) -> float:
        """Static stability margin [m]."""
        return float(stability_margin(self.robot, self.angles, self.body, self.contacts))

    def top_speed(self, direction: Sequence[float]) -> float:
        """Return the largest multiple of a twist that the robot can sustain.

        Parameters
        ----------
        direction : (vx, vy, wz)
            The twist [m/s, m/s, rad/s].

        Raises
        ------
        InputError
            If `direction` is not three finite numbers, or all are 0.
        """
        return top_speed(self._walk.transitions, direction)
