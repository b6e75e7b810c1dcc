"""How much of the straight path from one stance to another is feasible, what limits it, and what comes closer."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.limitation import Cause, LimitationKind
from tarsus.control.transition.stance_transition import StanceTarget, WalkParameters
from tarsus.control.workspace.foot_workspace import reach_cause, rest_margin
from tarsus.gait.stance.stability import StabilityCheck
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT, StanceGeometry, joint_margin, rotation_rows
from tarsus.incremental import Incremental
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.underside import FLOOR_TOLERANCE, floor_depth
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["balanced_fraction", "destination", "first_increment", "reachable_fraction"]

_TOO_LOW = Cause("the body would be below the ground")
# Number of samples of the whole path; how often the interval that fails is then halved, down to 1/2048 of the path.
_SAMPLES, _HALVINGS = 16, 7
# How many stances are examined in one tick.
_PER_TICK = 2
# Farthest that the rest footholds move in one transition [m]; fractions of the feasible path that are tried for it.
_LONGEST_STEP, _SHORTER = 0.03, np.append(np.arange(16, 0, -1) / 16, (1 / 32, 1 / 64))
# Rest footholds closer than this are the same [m]; least additional fraction of a body pose to go elsewhere for.
_SAME, _MORE = 1e-9, 1e-3
# Additional stability margin, as a fraction of the greatest distance between neighbouring feet.
_STEP_MARGIN = 0.03


def reachable_fraction(robot: Robot, start: StanceTarget, end: StanceTarget) -> Incremental[tuple[float, Cause | None]]:
    """Find the fraction of a path up to which all legs have room about their rest footholds.

    Parameters
    ----------
    robot : Robot
        A single robot.
    start, end : StanceTarget
        Both ends of the path.

    Returns
    -------
    fraction : float
        To a thousandth of the path; 1 where nothing limits it.
    cause : Cause or None
        What limits it.
    """
    fractions = np.arange(1, _SAMPLES + 1) / _SAMPLES
    stances = start.towards(end, fractions[:, None])
    # A body that is too low already may rise.
    deepest = max(float(_depth(robot, start)), FLOOR_TOLERANCE)
    fails = (_depth(robot, stances) > deepest) | (_reach_margin(robot, stances) < 0).any(axis=-1)
    yield

    def works(fraction: float) -> bool:
        stance = start.towards(end, fraction)
        return bool(_depth(robot, stance) <= deepest and (rest_margin(robot, stance.stand) >= 0).all())

    if not fails.any():
        if works(1.0):
            return 1.0, None
        yield
    # Search below the first sample that fails; where all are in reach, it is the end that has no room.
    feasible, infeasible = yield from _bracket(works, float(fractions[fails.argmax()]) if fails.any() else 1.0)
    yield
    beyond = start.towards(end, infeasible)
    return feasible, _TOO_LOW if _depth(robot, beyond) > deepest else reach_cause(robot, beyond.stand)


def destination(
    robot: Robot, start: StanceTarget, end: StanceTarget, parameters: WalkParameters
) -> Incremental[tuple[StanceTarget, float, Cause | None]]:
    """Find where to go for a stance: towards it, or to where a level body could go if that meets more of the body pose.

    Parameters
    ----------
    robot, start, end, parameters : Robot, StanceTarget, StanceTarget, WalkParameters
        A single robot; the present stance; the one that is commanded, and by which parameters.

    Returns
    -------
    goal : StanceTarget
        Where to go: `end`, a stance on the path to it from a level body, or the level body, from which it goes on.
    fraction : float
        The fraction of the straight path to it that is feasible.
    cause : Cause or None
        What limits how far it goes; None for the whole way to `end`, and for the way to the level body.
    """
    fraction, cause = yield from reachable_fraction(robot, start, end)
    if cause is None or not any(parameters.body):
        return end, fraction, cause
    yield
    straight = start.towards(end, fraction).posture
    missing = parameters.shortfalls(straight, cause, stance_width=parameters.stance_width)
    met = min((each.granted for each in missing if each.kind is LimitationKind.BODY), default=1.0)
    level = end._replace(posture=end.posture - np.array([*parameters.body, 0.0]))
    part, limit = yield from reachable_fraction(robot, level, end)
    if part - met < _MORE:
        return end, fraction, cause
    yield
    goal = level.towards(end, part)
    whole, _ = yield from reachable_fraction(robot, start, goal)
    # Between two stances at the end of the legs' reach, there may be less room.
    if whole == 1 and (rest_margin(robot, start.towards(goal, 0.5).stand) >= 0).all():
        return goal, whole, limit
    yield
    back, _ = yield from reachable_fraction(robot, start, level)
    return (level, back, None) if back > 0 else (end, fraction, cause)


def balanced_fraction(
    check: StabilityCheck, start: StanceTarget, end: StanceTarget, fraction: float
) -> Incremental[float]:
    """Find the fraction of a path up to which the robot stands with stability margin to spare; 0 for none of it.

    Parameters
    ----------
    check : StabilityCheck
        The check against tipping over.
    start, end, fraction : StanceTarget, StanceTarget, float
        Both ends of the path; a fraction at which it tips over.
    """
    # Stability margin to spare leaves the feet room to step.
    margin = check.least_margin + _STEP_MARGIN * float(np.abs(start.rest - np.roll(start.rest, 1)).max())

    def works(fraction: float) -> bool:
        return check.margin_at_rest(start.towards(end, fraction).stand) >= margin

    feasible, _ = yield from _bracket(works, fraction)
    return feasible


def _depth(robot: Robot, stances: StanceTarget) -> Float[np.ndarray, "*batch"]:
    """Return the depth of the body below level ground in one stance or in each of several [m]."""
    roll, pitch, yaw = stances.posture[..., 3:SWING_HEIGHT].T
    return np.asarray(floor_depth(robot, Pose.from_rpy(roll, pitch, yaw, stances.posture[..., :3])))


def _bracket(works: Callable[[float], bool], infeasible: float) -> Incremental[tuple[float, float]]:
    """Find two fractions close to each other: one that is feasible, or 0, and a greater one that is not."""
    feasible = max(0.0, infeasible - 1 / _SAMPLES)
    while feasible > 0 and not works(feasible):
        # Go on with the interval below, of the same width.
        feasible, infeasible = max(0.0, 2 * feasible - infeasible), feasible
        yield
    yield
    for count in range(_HALVINGS):
        middle = (feasible + infeasible) / 2
        if works(middle):
            feasible = middle
        else:
            infeasible = middle
        if count % _PER_TICK:
            yield
    return feasible, infeasible


def first_increment(robot: Robot, start: StanceTarget, end: StanceTarget, fraction: float) -> float:
    """Return the fraction of a path that one transition covers: the feet must reach it in the present posture.

    Parameters
    ----------
    robot : Robot
        A single robot.
    start, end, fraction : StanceTarget, StanceTarget, float
        Both ends of the path; the fraction that is feasible.
    """
    parts = fraction * _SHORTER
    moved = np.abs(end.rest - start.rest).max()
    if moved < _SAME:
        return fraction
    stances = start.towards(end, parts[:, None])
    margin = _reach_margin(robot, stances._replace(posture=np.tile(start.posture, (len(parts), 1))))
    works = (moved * parts <= _LONGEST_STEP) & (margin >= 0).all(axis=-1)
    return float(parts[works.argmax()] if works.any() else parts[-1])


def _reach_margin(robot: Robot, stances: StanceTarget) -> Float[np.ndarray, "n legs"]:
    """Return each leg's least joint margin at its rest foothold, on the ground and lifted; negative out of reach."""
    rows, rest = stances
    rotation = np.array([rotation_rows(*row) for row in rows[:, 3:SWING_HEIGHT].tolist()])
    swing_height = rows[:, SWING_HEIGHT:]
    stand = StanceGeometry(rest, rotation[:, None], rows[:, :3].T[..., None], 0.0)
    height = np.stack([0 * swing_height, swing_height])
    margin = joint_margin(robot.geometry, stand.solve(robot.geometry, rest.real, rest.imag, height))
    return np.asarray(margin.min(axis=0))
