"""Changes that take thought: another gait, posture or pace, worked out in parts before it is gone over to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.control.incremental import Incremental
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.transition.feasible_fraction import (
    StanceTarget,
    balanced_fraction,
    first_increment,
    largest_fraction,
    limiting_cause,
)
from tarsus.control.transition.parameters import WalkParameters
from tarsus.control.transition.target_stance import sway_extremes, target_stance
from tarsus.control.workspace.cycle_time import CycleTiming, cycle_timing
from tarsus.control.workspace.stability import StabilityCheck, support_sets
from tarsus.control.workspace.stance_geometry import TerrainEstimate
from tarsus.control.workspace.velocity_limits import VelocityLimits, velocity_limits, with_stroke_limits
from tarsus.robot.robot import Robot

__all__ = ["StanceTransition", "plan_transition"]

Floats = np.ndarray[Any, Any]

_LEAST_PART = 0.02
# What is no change.
_SAME = 1e-9
_TIPS_OVER = "the robot would tip over"


@dataclass(frozen=True, eq=False, kw_only=True)
class StanceTransition:
    """What going over to a manner comes to, or to a part of it.

    First the feet step to new rest footholds, then the body moves over them.

    Attributes
    ----------
    parameters : WalkParameters
        What was asked for.
    whole : bool
        Whether this is all of it that works; if not, the rest comes with a further change.
    posture : array, shape (7,)
        The posture to go to.
    rest : complex array, shape (legs,)
        The rest footholds to step to, in the heading frame [m].
    cycle_timing : CycleTiming
        How fast the legs step there.
    stepping, way, there : VelocityLimits
        What is possible while the feet step, while the body moves, and there.
    limitations : tuple of Limitation
        Why it isn't all that was asked for.
    terrain : Terrain
        How the ground was taken to lie.
    """

    parameters: WalkParameters
    whole: bool
    posture: Floats
    rest: Floats
    cycle_timing: CycleTiming
    stepping: VelocityLimits
    way: VelocityLimits
    there: VelocityLimits
    limitations: tuple[Limitation, ...]
    terrain: TerrainEstimate


def plan_transition(
    robot: Robot,
    parameters: WalkParameters,
    now: Floats | None,
    rest: Floats | None,
    *,
    stay: bool = False,
    speed: Floats,
    acceleration: Floats,
    foot_distance: float,
) -> Incremental[StanceTransition | str]:
    """Work out how to go over to a manner, in parts.

    Parameters
    ----------
    robot : Robot
        A single robot.
    parameters : WalkParameters
        What is asked for.
    now : array, shape (7,), or None
        The present posture; None to be there at once.
    rest : complex array, shape (legs,), or None
        The present rest footholds [m].
    stay : bool
        Whether the robot keeps its present posture, and changes only how it steps.
    speed, acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s], [rad/s^2].
    foot_distance : float
        Least distance between two feet [m].

    Returns
    -------
    Change or str
        The change; or why nothing of it works.
    """
    present = StanceTarget(now, rest, parameters.terrain) if now is not None and rest is not None else None
    wished = present if present is not None and stay else target_stance(robot, parameters, now)
    sets = support_sets(parameters.gait, parameters.excluded)
    yield
    here, share, why = present or wished, 1.0, ""
    if here is not wished:
        share, why = yield from largest_fraction(robot, here, wished)
        if share == 0:
            return f"body: {why}"
        yield
    works, share = share, first_increment(robot, here, wished, share)
    if np.abs(wished.rest - here.rest).max() > _SAME:
        yield
    there = yield from _envelope_of(robot, parameters, here.towards(wished, share), sets, foot_distance)
    if not (there.feasible or there.balanced or here is wished):
        works = share = yield from balanced_fraction(
            StabilityCheck(robot, sets, parameters.excluded), here, wished, share
        )
        why = _TIPS_OVER
        if share == 0:
            return f"body: {why}"
        there = yield from _envelope_of(robot, parameters, here.towards(wished, share), sets, foot_distance)
    while not there.feasible:
        why = _why_not(robot, parameters, here.towards(wished, share), there)
        share /= 2
        if share < _LEAST_PART or here is wished:
            return f"body: {why}"
        yield
        there = yield from _envelope_of(robot, parameters, here.towards(wished, share), sets, foot_distance)
    goal = here.towards(wished, share)
    pace = yield from cycle_timing(
        robot,
        parameters.gait,
        goal.stand,
        there,
        speed=speed,
        acceleration=acceleration,
        cycle_time=parameters.cycle_time,
    )
    yield
    there = with_stroke_limits(there, pace.stroke, pace.turning, duty_factor=parameters.gait.duty_factor)
    stepping = way = there
    if np.abs(goal.posture - here.posture).max() > _SAME:
        between = [goal._replace(posture=here.towards(goal, part).posture) for part in (0.5, 0.0)]
        way = there.intersection((yield from _envelope_of(robot, parameters, between[0], sets, foot_distance)))
        stepping = yield from _envelope_of(robot, parameters, between[1], sets, foot_distance)
        stepping = with_stroke_limits(stepping, pace.stroke, pace.turning, duty_factor=parameters.gait.duty_factor)
        way = way.intersection(stepping)
    if not way.feasible:
        who = f"{robot.leg_names[way.limiting_leg]} could not stand and step" if way.balanced else _TIPS_OVER
        return f"body: on the way there {who}"
    whole = share == works
    return StanceTransition(
        parameters=parameters,
        whole=whole,
        posture=goal.posture,
        rest=goal.rest,
        cycle_timing=pace,
        stepping=stepping,
        way=way,
        there=there,
        limitations=_limitations(parameters, pace, why if whole else ""),
        terrain=goal.terrain,
    )


def _envelope_of(
    robot: Robot, parameters: WalkParameters, posed: StanceTarget, sets: Floats, foot_distance: float
) -> Incremental[VelocityLimits]:
    """Work out what is possible in a posture, with its sway."""
    stands = [posed._replace(posture=row).stand for row in sway_extremes(posed.posture, parameters.sway)]
    return (yield from velocity_limits(robot, stands, sets, foot_distance=foot_distance, excluded=parameters.excluded))


def _why_not(robot: Robot, parameters: WalkParameters, posed: StanceTarget, there: VelocityLimits) -> str:
    """Say why a robot can't stand and step in a posture."""
    if not there.balanced:
        return _TIPS_OVER
    if any(parameters.sway):
        return f"{robot.leg_names[there.limiting_leg]} comes to the end of its reach as the body sways"
    return limiting_cause(robot, posed.stand)


def _limitations(parameters: WalkParameters, pace: CycleTiming, why: str) -> tuple[Limitation, ...]:
    """Return what of the parameters is not met."""
    limitations: tuple[Limitation, ...] = (Limitation(kind=LimitationKind.BODY, cause=why),) if why else ()
    if parameters.cycle_time is not None and pace.cycle_time > parameters.cycle_time:
        limitations += (
            Limitation(
                kind=LimitationKind.CYCLE_TIME,
                cause="too short for the joints' speed and acceleration at this swing height",
                asked=parameters.cycle_time,
                granted=pace.cycle_time,
            ),
        )
    return limitations
