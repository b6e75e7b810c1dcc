"""The states of a robot, and which states may follow each state."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from types import MappingProxyType

from tarsus.errors import InputError

__all__ = ["REQUESTABLE", "TRANSITIONS", "RobotState", "next_state", "requested_state"]


class RobotState(StrEnum):
    """What the robot as a whole does."""

    LYING = "lying"
    FOLDED = "folded"
    RISING = "rising"
    STANDING = "standing"
    WALKING = "walking"
    SITTING = "sitting"
    FOLDING = "folding"
    FAULT = "fault"

    @property
    def upright(self) -> bool:
        """Whether the walk controller moves the robot: it stands or walks."""
        return self in (RobotState.STANDING, RobotState.WALKING)

    @property
    def end(self) -> RobotState:
        """The state in which rising, sitting down or folding ends; any other state is its own end."""
        return _ENDS.get(self, self)

    @property
    def on_belly(self) -> bool:
        """Whether the robot rests on its belly, and nothing moves."""
        return self in (RobotState.LYING, RobotState.FOLDED)


TRANSITIONS: Mapping[RobotState, frozenset[RobotState]] = MappingProxyType(
    {
        RobotState.LYING: frozenset({RobotState.RISING, RobotState.FOLDING, RobotState.FAULT}),
        RobotState.FOLDED: frozenset({RobotState.RISING, RobotState.FAULT}),
        RobotState.RISING: frozenset({RobotState.STANDING, RobotState.LYING, RobotState.FOLDED, RobotState.FAULT}),
        RobotState.STANDING: frozenset({RobotState.WALKING, RobotState.SITTING, RobotState.FAULT}),
        RobotState.WALKING: frozenset({RobotState.STANDING, RobotState.FAULT}),
        RobotState.SITTING: frozenset({RobotState.LYING, RobotState.STANDING, RobotState.FAULT}),
        RobotState.FOLDING: frozenset({RobotState.FOLDED, RobotState.LYING, RobotState.FAULT}),
        # A robot that the guard releases continues what it did.
        RobotState.FAULT: frozenset(RobotState) - {RobotState.FAULT},
    }
)
"""The states that may follow each state. From RISING, SITTING and FOLDING the robot may also return to where it was."""

REQUESTABLE = (RobotState.STANDING, RobotState.LYING, RobotState.FOLDED)
"""The states that a command may ask for; walking follows from a twist."""

# The change to begin with, by the present state and the wanted one.
_STEPS = {
    (RobotState.STANDING, RobotState.LYING): RobotState.SITTING,
    (RobotState.STANDING, RobotState.FOLDED): RobotState.SITTING,
    (RobotState.LYING, RobotState.STANDING): RobotState.RISING,
    (RobotState.LYING, RobotState.FOLDED): RobotState.FOLDING,
    (RobotState.FOLDED, RobotState.STANDING): RobotState.RISING,
}
# The state in which each change ends.
_ENDS = {
    RobotState.RISING: RobotState.STANDING,
    RobotState.SITTING: RobotState.LYING,
    RobotState.FOLDING: RobotState.FOLDED,
}


def requested_state(value: RobotState | str) -> RobotState:
    """Return the state that a command asks for.

    Parameters
    ----------
    value : RobotState or str
        One of `REQUESTABLE`, or its value.

    Raises
    ------
    InputError
        If it is any other value.
    """
    if value not in [*REQUESTABLE, *map(str, REQUESTABLE)]:
        known = ", ".join(f"'{state}'" for state in REQUESTABLE)
        raise InputError(f"the command's state is {value!r}; it must be one of {known}")
    return RobotState(value)


def next_state(state: RobotState, goal: RobotState) -> RobotState | None:
    """Return the next state on the way to a goal: the change to begin with; None where the goal is reached.

    A folded robot counts as lying already: its legs are unfolded only by standing up.

    Parameters
    ----------
    state, goal : RobotState, RobotState
        The present state and the wanted one, each one of `REQUESTABLE`.
    """
    return _STEPS.get((state, goal))
