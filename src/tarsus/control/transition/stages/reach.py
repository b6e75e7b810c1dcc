"""Stages of planning: each generator yields where its work continues in the next tick."""

from __future__ import annotations

from collections.abc import Callable

from tarsus.control.incremental import Incremental
from tarsus.control.limitation import Cause
from tarsus.control.transition.feasible_fraction import (
    HALVINGS,
    Bracket,
    StanceTarget,
    first_unreachable,
    is_balanced,
    is_reachable,
    reach_cause,
)
from tarsus.control.workspace.stability import StabilityCheck
from tarsus.robot.robot import Robot

__all__ = ["balanced_fraction", "reachable_fraction"]

# How many stances are examined in one tick.
_PER_TICK = 2


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
    unreachable = first_unreachable(robot, start, end)
    yield

    def works(fraction: float) -> bool:
        return is_reachable(robot, start.towards(end, fraction))

    if unreachable is None:
        if works(1.0):
            return 1.0, None
        yield
        unreachable = 1.0
    bracket = yield from _bracketed(works, unreachable)
    yield
    return bracket.feasible, reach_cause(robot, start.towards(end, bracket.infeasible).stand)


def balanced_fraction(
    check: StabilityCheck, start: StanceTarget, end: StanceTarget, fraction: float
) -> Incremental[float]:
    """Find the fraction of a path up to which the robot stands with stability margin to spare; 0 for none of it.

    Parameters
    ----------
    check : StabilityCheck
        The check against tipping over.
    start, end : StanceTarget
        Both ends of the path.
    fraction : float
        A fraction at which it tips over.
    """

    def works(fraction: float) -> bool:
        return is_balanced(check, start.towards(end, fraction), start.rest)

    return (yield from _bracketed(works, fraction)).feasible


def _bracketed(works: Callable[[float], bool], infeasible: float) -> Incremental[Bracket]:
    """Find a bracket from a fraction that is not feasible."""
    bracket = Bracket.before(infeasible)
    while bracket.feasible > 0 and not works(bracket.feasible):
        bracket = bracket.widened()
        yield
    yield
    for count in range(HALVINGS):
        bracket = bracket.halved(works)
        if count % _PER_TICK:
            yield
    return bracket
