"""The states of a robot, and the changes between them."""

from __future__ import annotations

from enum import StrEnum

from tarsus.errors import InputError

__all__ = ["CHANGES", "REQUESTABLE", "RobotState", "requested_state"]


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


REQUESTABLE = (RobotState.STANDING, RobotState.LYING, RobotState.FOLDED)
"""The states that a command may ask for; walking follows from a twist."""

# A change ends in its `RobotState.end`, or where it began. A folded robot counts as lying already: its legs are
# unfolded only by standing up.
CHANGES = {
    (RobotState.STANDING, RobotState.LYING): RobotState.SITTING,
    (RobotState.STANDING, RobotState.FOLDED): RobotState.SITTING,
    (RobotState.LYING, RobotState.STANDING): RobotState.RISING,
    (RobotState.LYING, RobotState.FOLDED): RobotState.FOLDING,
    (RobotState.FOLDED, RobotState.STANDING): RobotState.RISING,
}
"""The table of transitions: the change to begin with, by the present state and the wanted one."""

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
    if value not in REQUESTABLE:
        known = ", ".join(f"'{state}'" for state in REQUESTABLE)
        raise InputError(f"the command's state is {value!r}; it must be one of {known}")
    return RobotState(value)
