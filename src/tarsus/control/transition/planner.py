"""Planning of stance transitions, in stages of less than a tick each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tarsus.arrays import require_float
from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.transition.feasible_fraction import balanced_fraction, destination, first_increment
from tarsus.control.transition.stance_transition import StanceTarget, StanceTransition, WalkParameters, target_stance
from tarsus.control.workspace.cycle_time import CycleTiming, cycle_timing
from tarsus.control.workspace.foot_workspace import reach_cause
from tarsus.control.workspace.stance_limits import shifted_limits, velocity_limits
from tarsus.errors import UnreachableError
from tarsus.gait.stance.stability import StabilityCheck, support_sets
from tarsus.gait.stance.stance_geometry import sway_extremes
from tarsus.gait.stance.supporting_feet import supporting_turns
from tarsus.gait.stance.velocity_limits import VelocityLimits, with_stroke_limits
from tarsus.gait.walk_setup import WalkSetup, require_number
from tarsus.incremental import Incremental, complete
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.underside import FLOOR_TOLERANCE, floor_depth, too_low_text
from tarsus.robot.joint_limits import JointLimits
from tarsus.robot.robot import Robot

__all__ = ["TIPPING", "TransitionPlanner"]

TIPPING = Cause("the robot would tip over")
_UNREACHABLE = Cause("no leg reaches the ground at this height")
_LEAST_FRACTION = 0.02
# Least motion of the body for a transition without steps [m, rad], so that each brings the commanded posture closer.
_LEAST_MOVE = 1e-3
# Differences below this are rounding.
_SAME = 1e-9


class TransitionPlanner:
    """Plans stance transitions of one robot.

    Parameters
    ----------
    robot, joint_limits, foot_distance : Robot, JointLimits, float
        A single robot; greatest speed and acceleration of each joint; least distance between two feet [m].

    Attributes
    ----------
    robot, joint_limits : Robot, JointLimits
        As given.
    """

    def __init__(self, robot: Robot, joint_limits: JointLimits, *, foot_distance: float) -> None:
        self.robot, self.joint_limits, self._foot_distance = robot, joint_limits, foot_distance
        # Legs that bear no load, and by how much the others turn then: the same for all increments of a transition.
        self._unloaded, self._turns = tuple[int, ...](), np.ones(robot.legs, dtype=complex)

    def initial_stance(self, setup: WalkSetup, *, stance_width: float, cycle_time: float | None) -> StanceTransition:
        """Return the stance that the setup of a walk asks for.

        Parameters
        ----------
        setup, stance_width : WalkSetup, float
            Gait and heights; distance by which the feet rest farther out than by default [m].
        cycle_time : float or None
            Duration of a cycle [s]; None for the one with the highest top speed.

        Raises
        ------
        InputError
            If stance width or cycle time are not finite, or out of their range.
        UnreachableError
            If the robot can't stand and step in this stance, or its body is below the ground.
        """
        depth = float(floor_depth(self.robot, Pose(position=(0.0, 0.0, setup.body_height))))
        if depth > FLOOR_TOLERANCE:
            low = too_low_text(depth, setup.body_height)
            raise UnreachableError(f"the robot can't stand in this stance: the underside of its body is {low}")
        stance_width = require_float("stance_width", stance_width, finite=True)
        if cycle_time is not None:
            cycle_time = require_number("cycle_time", cycle_time, zero=False)
        parameters = WalkParameters(
            gait=setup.gait,
            body_height=setup.body_height,
            swing_height=setup.swing_height,
            stance_width=stance_width,
            cycle_time=cycle_time,
        )
        stance = StanceTarget.of(self.robot, parameters, setup.rest)
        found = complete(self.plan(parameters, stance, stay=True))
        if isinstance(found, Cause):
            raise UnreachableError(f"the robot can't stand and step in this stance: {found.text()}")
        return found

    def plan(
        self, parameters: WalkParameters, present: StanceTarget, *, stay: bool = False
    ) -> Incremental[StanceTransition | Cause]:
        """Plan the transition to commanded parameters.

        Parameters
        ----------
        parameters, present : WalkParameters, StanceTarget
            What is commanded; the present stance.
        stay : bool
            Whether the robot keeps its present posture, and changes only how it steps.

        Returns
        -------
        StanceTransition or Cause
            The transition; or why nothing of it is feasible.
        """
        robot = self.robot
        if not stay and parameters.unloaded != self._unloaded:
            turns = yield from supporting_turns(robot, parameters.unloaded)
            self._unloaded, self._turns = parameters.unloaded, turns
        end = present if stay else target_stance(robot, parameters, present, self._turns)
        if end is None:
            return _UNREACHABLE
        yield
        asked, reachable, cause = end, 1.0, None
        if present is not end:
            end, reachable, cause = yield from destination(robot, present, asked, parameters)
            if cause is not None and reachable == 0:
                return cause
            yield
        leads_there = end is asked or cause is not None
        fraction = first_increment(robot, present, end, reachable)
        if np.abs(end.rest - present.rest).max() > _SAME:
            yield
        goal = present.towards(end, fraction)
        limits = yield from self._limits(parameters, goal)
        if not (limits.feasible or limits.balanced or present is end or parameters.gait.body_shift):
            sets = support_sets(parameters.gait, parameters.excluded)
            check = StabilityCheck(robot, sets, parameters.excluded)
            reachable = fraction = yield from balanced_fraction(check, present, end, fraction)
            if fraction == 0:
                return TIPPING
            cause, goal = TIPPING, present.towards(end, fraction)
            limits = yield from self._limits(parameters, goal)
        first: Cause | None = None
        while isinstance(found := (yield from self._increment(parameters, present, goal, limits)), Cause):
            fraction, first = fraction / 2, first or found
            if fraction < _LEAST_FRACTION or present is end:
                return first
            yield
            goal = present.towards(end, fraction)
            limits = yield from self._limits(parameters, goal)
        reached = present.towards(end, reachable)
        ends = leads_there and end is not present
        shortfalls = self._shortfalls(parameters, asked, reached, cause or _UNREACHABLE) if ends else []
        return replace(
            found,
            complete=leads_there and fraction == reachable and bool((found.rest == goal.rest).all()),
            keeps_posture=end is present,
            limitations=(*shortfalls, *_timing_limitations(parameters, found.cycle_timing)),
        )

    def _increment(
        self, parameters: WalkParameters, start: StanceTarget, goal: StanceTarget, limits: VelocityLimits
    ) -> Incremental[StanceTransition | Cause]:
        """Find a way to a stance, whose limits are `limits`; failing that, one on which only the body moves."""
        if not limits.balanced:
            return TIPPING
        if not limits.feasible and any(parameters.sway):
            return Cause("end of the leg's reach as the body sways", self.robot.leg_names[limits.limiting_leg])
        if not limits.feasible:
            return reach_cause(self.robot, goal.stand)
        found = yield from self._way(parameters, start, goal, limits)
        moves = np.abs(goal.posture - start.posture).max() > _LEAST_MOVE
        if isinstance(found, Cause) and moves and np.abs(goal.rest - start.rest).max() > _SAME:
            # At the end of their reach, feet can step only once the body is back over them.
            goal = goal._replace(rest=start.rest)
            yield
            limits = yield from self._limits(parameters, goal)
            if limits.feasible:
                found = yield from self._way(parameters, start, goal, limits)
        return found

    def _way(
        self, parameters: WalkParameters, start: StanceTarget, goal: StanceTarget, limits: VelocityLimits
    ) -> Incremental[StanceTransition | Cause]:
        """Find cycle time and limits on the way to a stance; `limits` are those in that stance."""
        gait = parameters.gait
        timing = yield from cycle_timing(
            self.robot, gait, goal.stand, limits, self.joint_limits, cycle_time=parameters.cycle_time
        )
        final = with_stroke_limits(limits, timing.stroke, timing.turning, duty_factor=gait.duty_factor)
        yield
        stepping, on_path = yield from self._path_limits(parameters, start, goal, final)
        if on_path.feasible:
            return StanceTransition(
                parameters=parameters,
                posture=goal.posture,
                rest=goal.rest,
                cycle_timing=timing,
                stepping_limits=stepping,
                path_limits=on_path,
                final_limits=final,
            )
        if not on_path.balanced:
            return TIPPING._replace(reason=f"{TIPPING.reason} on the way")
        return Cause("could not stand and step on the way", self.robot.leg_names[on_path.limiting_leg])

    def _limits(self, parameters: WalkParameters, stance: StanceTarget) -> Incremental[VelocityLimits]:
        """Find the limits in a stance, with its sway or the body shift of its gait."""
        gait, excluded, distance = parameters.gait, parameters.excluded, self._foot_distance
        if gait.body_shift:
            return shifted_limits(self.robot, gait, stance.stand, foot_distance=distance)
        stands = [stance._replace(posture=row).stand for row in sway_extremes(stance.posture, parameters.sway)]
        return velocity_limits(self.robot, gait, stands, foot_distance=distance, excluded=excluded)

    def _path_limits(
        self, parameters: WalkParameters, start: StanceTarget, goal: StanceTarget, final: VelocityLimits
    ) -> Incremental[tuple[VelocityLimits, VelocityLimits]]:
        """Find the limits while the feet step, and while the body moves to its goal."""
        if np.abs(goal.posture - start.posture).max() <= _SAME:
            return final, final
        halfway, begin = (goal._replace(posture=start.towards(goal, part).posture) for part in (0.5, 0.0))
        on_path = final.intersection((yield from self._limits(parameters, halfway)))
        stepping = yield from self._limits(parameters, begin)
        stepping = with_stroke_limits(stepping, final.stroke, final.turning, duty_factor=parameters.gait.duty_factor)
        return stepping, on_path.intersection(stepping)

    def _shortfalls(
        self, parameters: WalkParameters, end: StanceTarget, reached: StanceTarget, cause: Cause
    ) -> list[Limitation]:
        """Return what is not feasible of the commanded stance, `end`."""
        mount = self.robot.geometry.mount_x + 1j * self.robot.geometry.mount_y
        missing = float((np.abs(end.rest - mount) - np.abs(reached.rest - mount)).mean())
        return parameters.shortfalls(reached.posture, cause, stance_width=parameters.stance_width - missing)


def _timing_limitations(parameters: WalkParameters, timing: CycleTiming) -> tuple[Limitation, ...]:
    asked, granted = parameters.cycle_time, timing.cycle_time
    if asked is None or granted <= asked:
        return ()
    cause = "too short for the joints' speed and acceleration at this swing height"
    return (Limitation(kind=LimitationKind.CYCLE_TIME, cause=cause, asked=asked, granted=granted),)
