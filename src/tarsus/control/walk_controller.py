"""The live walker: commands in, joint angles out, tick by tick, without a jump."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tarsus.control.command import Command
from tarsus.control.filters import CriticallyDamped
from tarsus.control.incremental import Incremental, complete
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.pose.admittance import Admittance
from tarsus.control.pose.attitude import CommandedAttitude
from tarsus.control.pose.levelling import LevellingMode
from tarsus.control.pose.pose_controller import PoseController
from tarsus.control.readings import SensorReadings
from tarsus.control.terrain.adaptation import TerrainAdaptation
from tarsus.control.terrain.early_contact import relaxed_rate, stop_on_contact
from tarsus.control.terrain.slope_limit import SlopeLimit
from tarsus.control.transition.foothold_transfer import FootholdTransfer
from tarsus.control.transition.parameters import WalkParameters
from tarsus.control.transition.planner import StanceTransition, plan_transition
from tarsus.control.transition.scheduler import TransitionScheduler
from tarsus.control.transition.target_stance import sway_extremes
from tarsus.control.walk.foot_target_motion import best_body_shift, reachable_fraction
from tarsus.control.walk.foot_targets import FootTargets, excluded_legs
from tarsus.control.walk.foothold import final_footholds
from tarsus.control.walk.joint_solver import JointSolver
from tarsus.control.walk.reference_governor import (
    governed_twist,
    lift_delays,
    polygon_excess,
    stance_intervals,
    time_to_touchdown,
)
from tarsus.control.walk.state import PHASE_TOLERANCE, POSITION_TOLERANCE, GaitState, StepInputs
from tarsus.control.walk.stepper import advance
from tarsus.control.walk.time_scaling import TimeScaling
from tarsus.control.walk_controller_state import WalkControllerState
from tarsus.control.workspace.stability import support_sets
from tarsus.control.workspace.stance_geometry import LEVEL_TERRAIN, SWING_HEIGHT, sway_fraction
from tarsus.control.workspace.velocity_limits import VelocityLimits
from tarsus.errors import InputError, UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.setup import Setup, require_number
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.stability import stability_margin
from tarsus.robot.joint_limits import joint_limits
from tarsus.robot.robot import Robot

__all__ = ["WalkController"]

Floats = np.ndarray[Any, Any]

# The twist follows its target within about a stance: faster, and feet that are down would be left behind.
_LAGS_PER_STANCE = 4.0
# Ticks longer than this are walked as if they took no longer [s]: a late tick must not become a jump.
_LONGEST_TICK = 0.05
# In which time a change that waits for room slows the walk down by a factor of e [s].
_PATIENCE = 1.0
_NO_MOTION = (0.0,) * 6
# How far inside their support the feet left must hold the robot when a leg is taken out of the gait [m].
_LEAST_MARGIN = 0.01
# How near to its target a twist counts as steady [m/s, rad/s].
_STEADY = 1e-3


class WalkController(WalkControllerState):
    """Walks a robot live: each tick takes a wish and gives the next joint angles.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait, optional
        Order of the steps; the robot's own where left out.
    body_height, swing_height : float, optional
        Height of the body's origin, lift of the swinging feet [m]; the robot's own where left out.
    stance_width : float
        How much farther out than usual the feet rest [m].
    cycle_time : float, optional
        Duration of a cycle [s]; left out, the one that gets the robot farthest.
    joint_speed, joint_acceleration : float, optional
        Greatest of every joint [rad/s], [rad/s^2]; left out, each servo's no-load speed, reached in 0.05 s.
    foot_distance : float, optional
        Least distance between two feet [m]; two foot radii and 10 mm where left out.
    levelling : "level", "follow" or None
        Whether the body stays level on ground that is not, or follows its slope.
    admittance : Admittance, optional
        How the feet give way to the forces on them; left out, they don't.

    Raises
    ------
    InputError
        If an argument is not finite or out of its range, the robot is a batch, or the gait is for another number of
        legs.
    UnreachableError
        If the robot can't stand and step so.
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
        levelling: LevellingMode | None = None,
        admittance: Admittance | None = None,
    ) -> None:
        gait = Gait.named(robot.gait.name, legs=robot.legs) if gait is None else gait
        if not math.isfinite(stance_width):
            raise InputError(f"stance_width is {stance_width} m; it must be a finite number")
        for name, value in (
            ("cycle_time", cycle_time),
            ("joint_speed", joint_speed),
            ("joint_acceleration", joint_acceleration),
        ):
            if value is not None:
                require_number(name, value, zero=False)
        setup = Setup.of(
            robot,
            gait,
            body_height=body_height,
            swing_height=swing_height,
            body_tilt=(0.0, 0.0),
            foot_distance=foot_distance,
        )
        self.robot = setup.robot
        self.joint_speed, self.joint_acceleration = joint_limits(self.robot, joint_speed, joint_acceleration)
        self._foot_distance = setup.foot_distance
        self._solver = JointSolver(self.robot)
        parameters = WalkParameters(
            gait=gait,
            body=(0.0,) * 6,
            body_height=setup.body_height,
            swing_height=setup.swing_height,
            stance_width=stance_width,
            cycle_time=cycle_time,
        )
        change = complete(self._work_out(parameters, stay=False, at_once=True))
        if isinstance(change, str):
            raise UnreachableError(f"the robot can't walk so: {change}")
        self._begin_standing(change)
        self._terrain = TerrainAdaptation(
            self.robot,
            self.angles,
            self.feet,
            acceleration=self.joint_acceleration,
            levelling=levelling,
            admittance=admittance,
        )

    def _begin_standing(self, change: StanceTransition) -> None:
        """Stand in the rest stance, the heading frame over G's origin."""
        legs = self.robot.legs
        self._scheduler, self._footholds = TransitionScheduler(change), FootholdTransfer(change)
        self._stepping: StanceTransition | None = None
        self._settling: tuple[StanceTransition, int] | None = None
        self._pose = PoseController(change.posture)
        self._frequency = 1 / change.cycle_timing.cycle_time
        self._target = np.zeros(3)
        self._patience = 1.0
        self._steep = False
        self._share_of: tuple[Any, ...] = ()
        self._share = (1.0, 0)
        self._foot_targets = FootTargets(self.robot.leg_names)
        self._asked: Command | None = None
        self._steepness = SlopeLimit()
        self._leaning_for: tuple[int, ...] = ()
        self._lean = 0j
        self._walking = False
        self.time = 0.0
        self._set_gait(change.parameters.gait)
        self._all, self._none = np.ones(legs, dtype=bool), np.zeros(legs, dtype=bool)
        self._blind = {"admittance_offset": np.zeros(legs)}
        self._now = GaitState.standing(change.rest, self._pose.target)
        self._time_scaling = TimeScaling(self._solver.angles(self._now), self.joint_speed, self.joint_acceleration)

    def _set_gait(self, gait: Gait) -> None:
        self._offsets = np.asarray(gait.offsets)
        self._beats = len(set(gait.offsets))

    def step(self, command: Command | Sequence[float], dt: float, *, readings: SensorReadings | None = None) -> Floats:
        """Go on by one tick.

        Parameters
        ----------
        command : Command or (vx, vy, wz)
            What is asked for: a twist [m/s, m/s, rad/s] leaves everything else as it is.
        dt : float
            The time since the last tick [s]. Of a tick later than 0.05 s no more than that is walked.
        readings : SensorReadings, optional
            What is measured. Implausible readings are rejected and named in `limitations`.

        Returns
        -------
        array, shape (legs, 3)
            The next joint angles [rad].

        Raises
        ------
        InputError
            If the command or the time is not finite, or out of its range. Nothing has changed then.
        UnknownNameError
            If there is no such gait. Nothing has changed then.
        """
        command = command if isinstance(command, Command) else Command(twist=command)
        require_number("dt", dt, zero=False)
        dt = min(float(dt), _LONGEST_TICK)
        self._ask(command)
        self._sense(readings, dt)
        self._change(dt)
        if self._terrain.searches:
            self._draw_back(command)
        self._foot_targets.set_targets(command, dt, self._reachable)
        self._aim(command.twist)
        self._advance(dt)
        self.time += dt
        return self.angles

    def _ask(self, command: Command) -> None:
        """Note what is asked for besides the twist, where it isn't what was asked for before."""
        wanted = self._scheduler.wanted
        excluded = excluded_legs(command, wanted.excluded, self.robot.legs)
        correction, terrain = self._correction(excluded), self._terrain.terrain
        known = command.only_twist or command is self._asked
        if not known or (excluded, correction, terrain) != (wanted.excluded, wanted.correction, wanted.terrain):
            self._scheduler.ask(command, excluded, correction, terrain)
            self._asked = command

    def _correction(self, excluded: tuple[int, ...]) -> tuple[float, ...]:
        """Return what the ground, and legs that don't bear, ask of the body."""
        estimate = self._terrain.estimate.correction if self._terrain.estimate else _NO_MOTION
        if not excluded:
            return estimate
        if excluded != self._leaning_for:
            com = centre_of_mass(self.robot, self.angles)
            rest = self._footholds.new_rest
            sets = support_sets(self._scheduler.wanted.gait, excluded)
            self._leaning_for, self._lean = excluded, best_body_shift(rest, complex(com[0], com[1]), sets)
        return (estimate[0] + self._lean.real, estimate[1] + self._lean.imag, *estimate[2:])

    def _sense(self, readings: SensorReadings | None, dt: float) -> None:
        """Take in what is measured, and let feet come to rest that have met the ground early."""
        if readings is None and not self._terrain.has_feedback:
            return
        now, body = self._now, self._scheduler.wanted.body
        height = float(now.posture.value[2]) - self._scheduler.doing.parameters.correction[2]
        self._terrain.sense(
            readings,
            dt,
            now,
            feet=self.feet,
            contacts=self.contacts,
            angles=self.angles,
            commanded=CommandedAttitude(body[3], body[4], now.yaw + body[5], height),
        )
        met = self._terrain.early_contacts(now)
        if met.any():
            swing_rate = self._frequency / now.swings(self.gait.duty_factor)
            self._now = stop_on_contact(
                self.robot, now, met, acceleration=self.joint_acceleration, swing_rate=swing_rate
            )

    def _draw_back(self, command: Command) -> None:
        """Let feet that hang over a hole swing once more as soon as something else is asked for."""
        standing = self._time_scaling.rate == 0 or self._terrain.recovering
        if not (standing and self._terrain.searches.all_failed):
            return
        wanted = dataclasses.replace(self._scheduler.wanted, correction=_NO_MOTION, terrain=LEVEL_TERRAIN)
        again = self._terrain.recover(self._now, (tuple(command.twist), wanted), self.gait)
        if again is not None:
            # It stands still, whatever it was about to do.
            self._target, self._now = np.zeros(3), again._replace(twist=CriticallyDamped.still(np.zeros(3)))

    # Changes of how it stands and steps.

    def _work_out(
        self, parameters: WalkParameters, stay: bool, *, at_once: bool = False
    ) -> Incremental[StanceTransition | str]:
        if parameters.excluded:
            yield
            sets = support_sets(parameters.gait, parameters.excluded)
            margin = float(stability_margin(self.robot, self.angles, self.body, sets).min())
            if margin < _LEAST_MARGIN:
                names = " and ".join(self.robot.leg_names[leg] for leg in parameters.excluded)
                return (
                    f"foot_target: without {names} the {parameters.gait.name} would stand {1000 * margin:.0f} mm "
                    f"inside its support; {1000 * _LEAST_MARGIN:.0f} mm is the least. "
                    "A gait with more feet down may work"
                )
        return (yield from self._posed(parameters, stay, at_once=at_once))

    def _posed(self, parameters: WalkParameters, stay: bool, *, at_once: bool) -> Incremental[StanceTransition | str]:
        return plan_transition(
            self.robot,
            parameters,
            None if at_once else self._pose.posture,
            None if at_once else self._footholds.new_rest,
            stay=stay,
            speed=self.joint_speed,
            acceleration=self.joint_acceleration,
            foot_distance=self._foot_distance,
        )

    def _change(self, dt: float) -> None:
        """Work on the next change, and go over to it once the walk allows."""
        scheduler, stepping = self._scheduler, self._stepping
        scheduler.think(self._work_out, free=self._arrived())
        if scheduler.ready is not None:
            self._try_change(scheduler.ready)
        elif stepping is not None:
            self._try_body(stepping)
        # A change that the walk has no room for slows it down until it has.
        waits = scheduler.ready is not None or (self._stepping is not None and bool(self._footholds.stepped.all()))
        self._patience = self._patience * math.exp(-dt / _PATIENCE) if waits else 1.0

    def _arrived(self) -> bool:
        """Return whether the last change is over: posture reached, and every leg that came back on the ground."""
        if self._settling is not None or self._stepping is not None:
            return False
        return not self._foot_targets.returning and self._pose.reached(self._now.posture.value)

    def _try_change(self, change: StanceTransition) -> None:
        """Go over to a change as soon as the feet on the ground allow it."""
        old, new = self.gait, change.parameters.gait
        # It steps faster only once the change is over.
        frequency = min(self._frequency, 1 / change.cycle_timing.cycle_time)
        leaving = list(set(change.parameters.excluded) - set(self._scheduler.doing.parameters.excluded))
        share, _ = change.stepping.feasible_fraction(
            self._now.twist.value,
            stance_time=new.duty_factor / frequency,
            duty_factor=new.duty_factor,
            hold=self._terrain.hold_time,
        )
        if new.duty_factor == old.duty_factor and new.offsets == old.offsets:
            begins, ends = self._stances(frequency)
            bounds = self._foot_targets.without_bounds(self._footholds.begun(change))
            if leaving:
                bounds = np.minimum(bounds, change.there.bounds)
            if (
                share >= 1
                and self._now.down[leaving].all()
                and self._works(begins, ends, bounds, _bandwidth(new, frequency))
            ):
                self._adopt(change)
        elif not self._walking:
            self._switch(change, 0)
        elif share >= 1:
            self._try_gait(change)

    def _try_gait(self, change: StanceTransition) -> None:
        """Let all feet come down, if they may wait so long; then the new order begins with the leg that suits best."""
        frequency = 1 / change.cycle_timing.cycle_time
        delays = lift_delays(change.parameters.gait, change.cycle_timing.cycle_time)
        ends = time_to_touchdown(self._now, self.gait, self._frequency).max() + delays + self._terrain.hold_time
        bounds = np.minimum(self._foot_targets.without_bounds(self._footholds.begun(change)), change.there.bounds)
        bandwidth = _bandwidth(change.parameters.gait, frequency)
        over = self._excess(np.zeros(delays.shape), ends, bounds, bandwidth).max(axis=(1, 2, 3, 4))
        first = int(over.argmin())
        if over[first] <= POSITION_TOLERANCE:
            self._settling, self._scheduler.ready = (change, first), None
            self._footholds.tighten(change.there)

    def _try_body(self, change: StanceTransition) -> None:
        """Move the body once every foot has stepped to where it is to rest."""
        excluded = list(self._scheduler.doing.parameters.excluded)
        stepped = self._footholds.stepped.copy()
        stepped[excluded] = True
        begins, ends = self._stances(self._frequency)
        slow = self._frequency <= 1 / change.cycle_timing.cycle_time
        bounds = self._foot_targets.without_bounds(change.way.bounds)
        if slow and stepped.all() and self._works(begins, ends, bounds, self._bandwidth()):
            self._footholds.tighten(change.way)
            self._pose.set_posture(change.posture)
            self._stepping = None

    def _adopt(self, change: StanceTransition) -> None:
        """Send the feet to where they are to rest; the body follows. Legs that leave the gait become hands."""
        self._footholds.begin(change, self._now.down)
        self._scheduler.adopt(change)
        self._stepping = change
        excluded = change.parameters.excluded
        if excluded:
            self._footholds.tighten(change.there)
        self._foot_targets.set_legs(excluded, self._now)

    def _switch(self, change: StanceTransition, first: int) -> None:
        """Begin the new order of steps; every foot is down."""
        self._adopt(change)
        self._settling = None
        self._frequency = 1 / change.cycle_timing.cycle_time
        self._set_gait(change.parameters.gait)
        self._begin(first)

    def _begin(self, first: int) -> None:
        """Set the clock to the moment when a leg lifts."""
        clock = float(self._offsets[first]) + self.gait.duty_factor
        self._now = self._now._replace(
            clock=clock, step_number=np.ceil(clock - self._offsets - self.gait.duty_factor - PHASE_TOLERANCE)
        )

    def _reachable(self, leg: int, start: Floats, wished: Floats) -> float:
        # Wherever the body sways.
        postures = sway_extremes(self._now.posture.value[: SWING_HEIGHT + 1], self._scheduler.doing.parameters.sway)
        return reachable_fraction(self.robot, postures, leg, start, wished)

    # Where to.

    def _bandwidth(self) -> float:
        """Return how fast the twist follows its target; as in the order of steps to come from when it is decided."""
        if self._settling is None:
            return _bandwidth(self.gait, self._frequency)
        change, _ = self._settling
        return _bandwidth(change.parameters.gait, 1 / change.cycle_timing.cycle_time)

    def _stances(self, frequency: float) -> tuple[Floats, Floats]:
        """Return from when until when each foot is where it stands, or where it is about to [s]."""
        if self._settling is None:
            return stance_intervals(self._now, self.gait, frequency, self._terrain.hold_time)
        change, first = self._settling
        begins = time_to_touchdown(self._now, self.gait, self._frequency)
        delays = lift_delays(change.parameters.gait, change.cycle_timing.cycle_time)[first]
        return begins, begins.max() + delays + self._terrain.hold_time

    def _excess(self, begins: Floats, ends: Floats, bounds: Floats, bandwidth: float) -> Floats:
        return polygon_excess(
            self._now, self._target[None], begins=begins, ends=ends, bounds=bounds, bandwidth=bandwidth
        )

    def _bounds(self) -> Floats:
        return self._foot_targets.without_bounds(self._footholds.bounds)

    def _works(self, begins: Floats, ends: Floats, bounds: Floats, bandwidth: float) -> bool:
        return bool(self._excess(begins, ends, bounds, bandwidth).max() <= POSITION_TOLERANCE)

    def _aim(self, twist: Sequence[float]) -> None:
        """Set the target of the twist: as much of the command as the legs allow, for good and right now."""
        share, _ = self._largest_share(tuple(twist))
        self._steep = bool(self._scheduler.rejections or self._steepness) and self._too_steep(twist)
        if self._terrain.recovering:
            return
        part = 0.0 if self._steep else min(share, self._patience)
        command = [part * speed for speed in twist]
        if not self._walking:
            if not any(command) and self._at_rest():
                return
            self._begin(0)
            self._walking = True
        # In steady walking nothing changes. Before that, feet may be put down where the target leaves them no room.
        if command == self._target.tolist() and self._steady(command):
            return
        begins, ends = self._stances(self._frequency)
        self._target = governed_twist(
            self._now,
            self._target,
            np.array(command),
            begins=begins,
            ends=ends,
            bounds=self._bounds(),
            bandwidth=self._bandwidth(),
        )

    def _too_steep(self, twist: Sequence[float]) -> bool:
        """Return whether a twist leads on to ground that the robot was refused to stand on."""
        scheduler, known = self._scheduler, self._scheduler.doing.terrain
        if any(parameters.terrain != known for parameters in scheduler.rejections):
            self._steepness.record(known, self._now.twist.value.tolist())
        return self._steepness.forbids(twist, known)

    def _steady(self, twist: Sequence[float]) -> bool:
        """Return whether the robot walks at a twist, and at its pace."""
        settled = self._settling is None and self._frequency == 1 / self._scheduler.doing.cycle_timing.cycle_time
        value = self._now.twist.value.tolist()
        return settled and max(abs(a - b) for a, b in zip(value, twist, strict=True)) <= _STEADY * max(map(abs, twist))

    def _largest_share(self, twist: tuple[float, ...]) -> tuple[float, int]:
        """Return how much of a twist works for good in all that is gone over to, and which leg stops it."""
        doing, settling = self._scheduler.doing, self._settling[0] if self._settling else None
        hold = self._terrain.hold_time
        frequency = min(self._frequency, 1 / doing.cycle_timing.cycle_time)
        key = (twist, frequency, hold, self._footholds.way, self._scheduler.ready, self._stepping, settling)
        if key == self._share_of:
            return self._share
        asked: list[tuple[StanceTransition, VelocityLimits]] = [(doing, self._footholds.way)]
        for change in (self._scheduler.ready, self._stepping, settling):
            if change is not None:
                asked.append((change, change.way))
        share, leg = 1.0, 0
        for change, way in asked:
            duty_factor = change.parameters.gait.duty_factor
            stance_time = duty_factor * max(1 / frequency, change.cycle_timing.cycle_time)
            allowed, which = way.feasible_fraction(
                np.array(twist), stance_time=stance_time, duty_factor=duty_factor, hold=hold
            )
            if allowed < share:
                share, leg = allowed, which
        self._share_of, self._share = key, (share, leg)
        return share, leg

    @property
    def limitations(self) -> tuple[Limitation, ...]:
        """Why the command is not met in full."""
        names, twist = self.robot.leg_names, LimitationKind.TWIST
        fraction, leg = self._share
        found = [
            *self._scheduler.doing.limitations,
            *(Limitation(kind=LimitationKind.BODY, cause=why) for why in self._scheduler.rejections.values()),
            *self._foot_targets.limitations,
        ]
        if fraction < 1:
            cause = "workspace and joint speed at this cycle time"
            found.append(Limitation(kind=twist, cause=cause, leg=names[leg], asked=1.0, granted=fraction))
        if self._steep:
            cause = "the ground is too steep in this direction"
            found.append(Limitation(kind=twist, cause=cause, asked=1.0, granted=0.0))
        sway = self._scheduler.doing.parameters.sway
        calm = sway_fraction(np.array(sway), self._frequency, self._beats) if any(sway) else 1.0
        if calm < 1:
            cause = "joint speed and acceleration at this cycle time"
            found.append(Limitation(kind=LimitationKind.SWAY, cause=cause, asked=1.0, granted=calm))
        if self._terrain.estimate is not None:
            found += [Limitation(kind=LimitationKind.READINGS, cause=why) for why in self._terrain.estimate.rejected]
        for missing in self._terrain.searches.failed_legs:
            cause = "no ground under the foot, the robot stands still"
            found.append(Limitation(kind=LimitationKind.GROUND, cause=cause, leg=names[missing]))
        return tuple(found)

    def _at_rest(self) -> bool:
        """Return whether every foot that steps is at its rest foothold."""
        rest = final_footholds(self._now, self._step_inputs())
        assert rest is not None  # nobody asks while it is fast
        off = np.abs(self._now.foot - rest)
        off[list(self._scheduler.doing.parameters.excluded)] = 0.0
        return bool(off.max() <= POSITION_TOLERANCE)

    # The next moment.

    def _step_inputs(self, dt: float = 0.0) -> StepInputs:
        now = self._now
        steps, lands, holds = self._all, self._all, self._settling is not None
        if self._foot_targets:
            steps = steps.copy()
            steps[list(self._scheduler.doing.parameters.excluded)] = False
        estimate = self._terrain.estimate is not None
        if estimate:
            soon = now.swing_phase + dt * self._frequency / now.swings(self.gait.duty_factor) >= 1.0 - PHASE_TOLERANCE
            lands, waits = self._terrain.may_land(now, soon)
            holds = holds or waits
        return StepInputs(
            gait=self.gait,
            frequency=self._frequency if self._walking else 0.0,
            twist=self._target,
            posture=self._pose.target,
            bandwidth=self._bandwidth(),
            posture_bandwidth=self._pose.bandwidth(now.posture.value),
            may_lift=steps,
            may_land=lands,
            rest=self._footholds.rest,
            placement_bounds=self._footholds.room,
            hold_feet=holds,
            beats=self._beats,
            swaying=self._pose.is_swaying(now.posture.value),
            **(self._terrain.step_inputs(now, self._scheduler.doing.terrain) if estimate else self._blind),
        )

    def _advance(self, dt: float) -> None:
        """Go on by one tick, or less of it where the joints need longer."""
        sway = self._scheduler.doing.parameters.sway if self._walking else _NO_MOTION
        self._pose.set_sway(sway, frequency=self._frequency, beats=self._beats)
        before, inputs, terrain = self._now, self._step_inputs(dt), self._terrain
        self._now = terrain.search(
            before,
            dt,
            terrain=self._scheduler.doing.terrain,
            stance_time=self.gait.duty_factor / self._frequency,
        )
        swing_time = (1 - self.gait.duty_factor) / self._frequency

        def move(time: float) -> GaitState:
            return self._foot_targets.apply(advance(self._now, inputs, time), time, swing_time=swing_time)

        fastest = 1.0 if terrain.estimate is None else relaxed_rate(self._now, self.gait.duty_factor)
        self._now = self._time_scaling.advance(move, self._solver.angles, dt, stop=terrain.stops_walk, fastest=fastest)
        self._foot_targets.step(dt * self._time_scaling.rate, self._now.down)
        self._finish(before, dt)

    def _finish(self, before: GaitState, dt: float) -> None:
        """See what has come to its end with this tick."""
        now, doing = self._now, self._scheduler.doing
        landed = now.down & ~before.down if now.down is not before.down else self._none
        if landed.any():
            self._footholds.land(landed)
            self._terrain.feet_landed(landed)
        arrived = self._arrived()
        if self._settling is not None and now.down.all():
            self._switch(*self._settling)
        elif self._settling is None:
            self._change_pace(dt, faster=arrived)
        if arrived and self._footholds.way is not doing.there:
            self._footholds.arrive(doing.there)
        moves = any(self._target.tolist()) or any(now.twist.value.tolist())
        if self._walking and not moves and now.down.all():
            self._walking = not (self._at_rest() and self._settling is None)

    def _change_pace(self, dt: float, *, faster: bool) -> None:
        """Step a little faster or slower, until the cycle takes as long as it is to."""
        goal, now = 1 / self._scheduler.doing.cycle_timing.cycle_time, self._frequency
        goal = goal if faster else min(goal, now)
        step = dt * now * now / 2
        self._frequency = goal if abs(goal - now) <= step else now + math.copysign(step, goal - now)


def _bandwidth(gait: Gait, frequency: float) -> float:
    """Return how fast the twist may follow its target [rad/s]."""
    return _LAGS_PER_STANCE * frequency / gait.duty_factor
