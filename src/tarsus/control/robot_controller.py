"""The controller of the whole robot: from a command and sensor readings to joint angles, in every state."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.command import Command, merged, stopped
from tarsus.control.control_output import ControlOutput, Snapshot
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.pose.admittance import Admittance
from tarsus.control.pose.posture_feedback import Levelling
from tarsus.control.readings import SensorReadings
from tarsus.control.robot_state import CHANGES, RobotState, requested_state
from tarsus.control.safety import Guard, GuardBounds, GuardState, Intervention
from tarsus.control.sequence import MotionSequence
from tarsus.control.startup import fold, sit_down, stand_up
from tarsus.control.states.activity import Activity, Braking, Playing, Resting, Walking, way_back
from tarsus.control.states.reduced_walking import LegFailures
from tarsus.control.terrain.roughness import GroundAdaptation
from tarsus.control.walk_controller import WalkController
from tarsus.errors import InputError, TarsusError
from tarsus.gait.gait import Gait
from tarsus.gait.walk_setup import require_number
from tarsus.kinematics.ground import ground_frame
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.representation import represented
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["RobotController"]

# Joint speed below which the robot counts as at rest, with all of its legs and with failed ones [rad/s].
_AT_REST, _AT_REST_DAMAGED = 5e-3, 0.05


@represented("robot", "state", "output.time", "output.activity", "output.angles", "output.twist", "output.limitations")
class RobotController:
    """Controls a robot in all its states: lying, rising, standing, walking, sitting down, folding.

    Each tick takes a command, which names the wanted state, and sensor readings, and gives joint angles. A guard, which
    is independent of the rest, checks the angles of every tick before they are given out; while it holds the robot, the
    state is FAULT and nothing else advances.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait, optional
        Order of the steps; by default the robot's own gait.
    start : RobotState or str
        Initial state: standing, lying or folded.
    angles : array, shape (legs, 3), optional
        Measured joint angles of a robot that lies, in any pose of its legs [rad]; left out, those in which sitting down
        (and folding) ends.
    body_height, swing_height : float, optional
        Body height and swing height of the stance that it starts in or stands up to [m]; by default the robot's own.
    levelling : "level", "between", "follow" or None
        Attitude to keep on sloping ground where the attitude is measured; None to ignore the measured attitude.
    adaptation : GroundAdaptation, optional
        How far the walk may adapt to rough ground; by default ``GroundAdaptation()``.
    admittance : Admittance, optional
        How the feet comply with the forces on them; left out, they are stiff.
    guard : bool or GuardBounds
        Whether a guard checks the angles, with the robot's default bounds; or the bounds that it enforces.

    Raises
    ------
    InputError
        If an argument is not finite or out of its range, or the robot is a batch.
    UnreachableError
        If the robot can't stand or lie with these heights.
    """

    def __init__(  # noqa: PLR0913 - all that a robot is controlled with, all of it optional
        self,
        robot: Robot,
        gait: Gait | None = None,
        *,
        start: RobotState | str = RobotState.STANDING,
        angles: Sequence[Any] | Float[np.ndarray, "legs 3"] | None = None,
        body_height: float | None = None,
        swing_height: float | None = None,
        levelling: Levelling | None = "level",
        adaptation: GroundAdaptation | None = None,
        admittance: Admittance | None = None,
        guard: bool | GuardBounds = True,
    ) -> None:
        require_robot(robot)
        self.robot = robot
        self.body_height, self.swing_height = body_height, swing_height
        # The gait of walks on all legs, and that of the present walk, which may lack legs.
        self._gait = self._shown_gait = Gait.named(robot.gait.name, legs=robot.legs) if gait is None else gait
        self.compliant = admittance is not None
        heights: dict[str, Any] = {"body_height": body_height, "swing_height": swing_height}
        self._options = heights | {"levelling": levelling, "adaptation": adaptation, "admittance": admittance}
        self.leg_failures = LegFailures(robot, **self._options)
        # The last command as given, and merged: mostly the same object is given for many ticks, and not merged again.
        self._given = self._command = Command()
        # Pose of the activity's ground frame in G; None where they are the same.
        self._base: Pose | None = None
        self._cycle_time, self._time, self._rates = 0.0, 0.0, np.zeros((robot.legs, 3))
        walking = self._new_walk()
        self._activity: Activity = walking
        start = requested_state(start)
        if start is not RobotState.STANDING or angles is not None:
            stance = walking.controller.angles
            self._activity = (
                Resting.after_sitting(robot, stance, start) if angles is None else Resting.measured(robot, angles)
            )
            self._base = ground_frame(self._activity.snapshot.body).inverse()
        self._now = self._placed(self._activity.snapshot)
        self._goal = RobotState.STANDING if self._now.state.upright else self._now.state
        self._rejected: Limitation | None = None
        if not isinstance(guard, GuardBounds | bool | np.bool):
            raise InputError(f"guard is {guard!r}; it must be True, False or GuardBounds")
        # Where a servo's speed is unknown, walk controller and guard have to assume the same value.
        speed, acceleration = walking.controller.joint_speed, walking.controller.joint_acceleration
        default = GuardBounds.of(robot, speed=speed, acceleration=acceleration)
        bounds = guard if isinstance(guard, GuardBounds) else default
        self.guard = Guard(robot, bounds=bounds, start=self._now.angles) if guard else None
        self._present: set[str] = set()
        self.output = self._shown(self._now.angles, ())

    def _new_walk(self) -> Walking:
        return Walking(WalkController(self.robot, self._gait, **self._options))

    @property
    def state(self) -> RobotState:
        """The present state."""
        return self.output.state

    def step(
        self, command: Command | Sequence[float], dt: float, readings: SensorReadings | None = None
    ) -> ControlOutput:
        """Advance by one tick.

        Parameters
        ----------
        command : Command or (vx, vy, wz)
            The command; what is None in it stays as it is. A twist alone changes nothing else.
        dt : float
            Time since the last tick [s].
        readings : SensorReadings, optional
            The sensor readings.

        Raises
        ------
        InputError
            If the command or the time is not finite, or out of its range. Nothing has changed then.
        UnknownNameError
            If there is no such gait. Nothing has changed then.
        """
        require_number("dt", dt, zero=False)
        command = command if isinstance(command, Command) else Command(twist=command)
        full = self._command if command is self._given else merged(command, self._command, self.robot.legs)
        if self.guard is None or self.guard.state is GuardState.PASSING:
            self._advance(full, dt, readings)
        elif not isinstance(self._activity, Resting):
            self._activity.joints_held()
        self._given, self._command = command, full
        self._time += dt
        self.output = self._shown(*self._guarded(dt))
        return self.output

    def _advance(self, command: Command, dt: float, readings: SensorReadings | None) -> None:
        """Advance the activity by one tick, and begin or end changes of state."""
        self._begin_change(command)
        before, activity = self._now.angles, self._activity
        activity.step(command if self._goal.upright else stopped(command, self.robot.legs), dt, readings)
        if isinstance(activity, Walking):
            self._shown_gait, self._cycle_time = activity.gait, activity.controller.cycle_time
            self._activity = self.leg_failures.following(activity, self._now, dt)
            if self._activity is not activity:
                self._base = ground_frame(self._now.body) @ ground_frame(self._activity.snapshot.body).inverse()
        if type(activity) is Walking:
            self._gait = activity.gait
        self._now = self._placed(self._activity.snapshot)
        self._rates = (self._now.angles - before) / dt
        if isinstance(activity, Playing) and activity.done:
            self._end_change(activity)

    @property
    def _at_rest(self) -> bool:
        still = isinstance(self._activity, Resting) or (isinstance(self._activity, Walking) and self._activity.stands)
        return still and float(np.abs(self._rates).max()) < (_AT_REST_DAMAGED if self.leg_failures.failed else _AT_REST)

    def _begin_change(self, command: Command) -> None:
        """Begin the next change towards the wanted state once at rest; reverse one under way if it leads elsewhere."""
        goal = self._goal if command.state is None else requested_state(command.state)
        goal = RobotState.LYING if self.leg_failures.sits and goal is RobotState.STANDING else goal
        if goal is not self._goal:
            self._goal, self._rejected = goal, None
        if isinstance(self._activity, Playing):
            self._activity.turn(back=not self._activity.leads_to(goal))
            return
        change, now = self._next_change(), self._now
        braking = None
        if self.leg_failures.sits and isinstance(self._activity, Walking) and not self._at_rest:
            braking = Braking(self.robot, now.angles, self._rates, self._activity.controller.joint_acceleration)
        if change is None or not (self._at_rest or braking):
            return
        try:
            sequence = self._plan(change, now.angles if braking is None else braking.at(braking.duration))
        except TarsusError as error:
            self._activity = way_back(self._activity, change)
            if not isinstance(self._activity, Playing):
                self._rejected = Limitation(kind=LimitationKind.STATE, cause=f"{change} is not possible: {error}")
            return
        self._activity = Playing(sequence, change, before=self._activity, base=self._base, braking=braking)
        self._base = ground_frame(now.body) @ ground_frame(sequence.stages[0].start).inverse()

    def _next_change(self) -> RobotState | None:
        """Return the next change towards the wanted state; None where that is reached, or a change was not possible."""
        state = RobotState.STANDING if self._now.state.upright else self._now.state
        return None if self._rejected is not None else CHANGES.get((state, self._goal))

    def _plan(self, state: RobotState, angles: Float[np.ndarray, "legs 3"]) -> MotionSequence:
        if state is RobotState.RISING:
            return stand_up(self.robot, angles, body_height=self.body_height, swing_height=self.swing_height)
        if state is RobotState.FOLDING:
            return fold(self.robot, angles)
        return sit_down(self.robot, angles, loaded=self._activity.bears if type(self._activity) is Walking else None)

    def _end_change(self, playing: Playing) -> None:
        """Switch to the activity that follows a motion sequence."""
        end = playing.sequence.at(playing.sequence.duration)
        if playing.returning:
            self._activity, self._base = playing.before, playing.base
        elif playing.end is RobotState.STANDING:
            frame = ground_frame(end.body)
            self._base = frame if self._base is None else self._base @ frame
            self._activity = self._new_walk()
        else:
            self._activity = Resting(end, playing.end, after=playing)
        after = self._activity.snapshot
        self._now = self._now._replace(state=after.state, activity=after.activity, belly=after.belly)

    def _own_limitations(self) -> Iterator[Limitation]:
        """Yield why the robot sits down or can't change its state, and what of the command the state does not allow."""
        yield from self.leg_failures.limitations
        if self._rejected is not None:
            yield self._rejected
        if self._goal is RobotState.STANDING and self._now.state.upright:
            return
        command, state = self._command, self._now.state
        cause = f"the robot is {state}; it {'starts once it stands' if self._goal.upright else 'must stand'}"
        if any(command.twist):
            yield Limitation(kind=LimitationKind.TWIST, cause=cause, asked=1.0, granted=0.0)
        if command.foot_velocities or any(point is not None for point in (command.foot_targets or {}).values()):
            yield Limitation(kind=LimitationKind.FOOT_TARGET, cause=cause, asked=1.0, granted=0.0)

    def _guarded(self, dt: float) -> tuple[Float[np.ndarray, "legs 3"], tuple[Intervention, ...]]:
        """Return the angles that the guard lets through, and the interventions that begin with this tick."""
        now = self._now
        if self.guard is None:
            return now.angles, ()
        told = self.guard.check(now.angles, dt, *((None, None) if now.belly or now.felt else (now.contacts, now.body)))
        began = tuple(each for each in told.interventions if each.kind not in self._present)
        self._present = {each.kind for each in told.interventions}
        return told.angles, began

    def _placed(self, snapshot: Snapshot) -> Snapshot:
        """Return a snapshot with body and feet in G."""
        body, feet = snapshot.body, snapshot.feet
        if self._base is not None:
            body, feet = self._base @ body, None if feet is None else np.asarray(self._base @ feet)
        if feet is None:
            feet = np.asarray(body @ forward_kinematics(self.robot, snapshot.angles)[..., 3, :])
        return snapshot._replace(body=body, feet=feet)

    def _shown(self, angles: Float[np.ndarray, "legs 3"], began: tuple[Intervention, ...]) -> ControlOutput:
        now, guard = self._now, "" if self.guard is None else str(self.guard.state)
        assert now.feet is not None  # as placed
        return ControlOutput(
            time=self._time,
            angles=angles,
            state=now.state if guard in ("", "passing") else RobotState.FAULT,
            activity=now.activity,
            limitations=(*now.limitations, *self._own_limitations()),
            interventions=began,
            guard=guard,
            body=now.body,
            feet=now.feet,
            contacts=now.contacts,
            belly=now.belly,
            twist=now.twist,
            gait=self._shown_gait,
            cycle_time=self._cycle_time,
            at_rest=self._at_rest and self._next_change() is None,
        )
