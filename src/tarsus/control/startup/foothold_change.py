"""Feet change their footholds in groups: as many at once as the rest can bear."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tarsus.control.startup.builder import SequenceBuilder
from tarsus.errors import TarsusError
from tarsus.gait.branch import branches
from tarsus.kinematics.leg import forward_kinematics

__all__ = ["change_footholds"]

Floats = np.ndarray[Any, np.dtype[np.float64]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]

# Angles that differ by less than this are the same [rad]: a foot is then less than a nanometre off.
_SAME = 1e-9
_LEAST_FEET = 3


def change_footholds(draft: SequenceBuilder, angles: Floats, *, swing_height: float, least: float) -> None:
    """Bring every leg to its angles of a new stance, the body held still and the other feet with it.

    Feet in the air are put down first; then tripods are lifted, every second leg of the ring, and single legs where a
    tripod can't be.

    Parameters
    ----------
    draft : Draft
        Where the robot is; takes the stages.
    angles : array, shape (legs, 3)
        Joint angles of the new stance, all feet on the ground [rad].
    swing_height : float
        How high the feet are lifted [m].
    least : float
        The least stability margin while feet are in the air [m].

    Raises
    ------
    TarsusError
        If a foot can't be moved; the message says why.
    """
    left = np.abs(angles - draft.angles).max(-1) > _SAME
    if (left & ~draft.contacts).any():
        # They bear nothing: whatever holds the body goes on holding it.
        _move(draft, left & ~draft.contacts, angles, swing_height=swing_height, least=0.0)
        left &= np.abs(angles - draft.angles).max(-1) > _SAME
    while left.any():
        group = _next_group(draft, left, angles, swing_height=swing_height, least=least)
        left = left & ~group


def _next_group(draft: SequenceBuilder, left: Flags, angles: Floats, *, swing_height: float, least: float) -> Flags:
    """Move the first group that can be, and return it."""
    rejected: list[TarsusError] = []
    for group in _groups(draft, left):
        try:
            _move(draft, group, angles, swing_height=swing_height, least=least)
        except TarsusError as error:
            rejected.append(error)
        else:
            return group
    raise (
        rejected[-1]
        if rejected
        else TarsusError(
            f"only {int(draft.contacts.sum())} feet are on the ground; {_LEAST_FEET + 1} are needed to lift one of them"
        )
    )


def _groups(draft: SequenceBuilder, left: Flags) -> Iterator[Flags]:
    """Yield the groups to try: tripods, then single legs, as many as leave three feet on the ground."""
    legs = np.arange(left.size)
    groups = [left & (legs % 2 == parity) for parity in (0, 1)]
    groups += [legs == leg for leg in np.flatnonzero(left)]
    return (group for group in groups if group.any() and (draft.contacts & ~group).sum() >= _LEAST_FEET)


def _move(draft: SequenceBuilder, legs: Flags, angles: Floats, *, swing_height: float, least: float) -> None:
    """Move the legs, by a swing of their feet where that is possible, else through the air by their joints."""
    codes = [draft.robot.leg_codes[leg] for leg in np.flatnonzero(legs)]
    name = f"place {' '.join(codes)}"
    trial = draft.copy()
    same_way = (branches(draft.robot, angles) == branches(draft.robot, draft.angles))[legs].all()
    try:
        if not same_way:
            raise TarsusError(f"{name}: the knee has to bend the other way")
        feet = draft.body @ forward_kinematics(draft.robot, angles)[:, 3]
        trial.swing(name, legs, feet, swing_height=swing_height, least=least)
    except TarsusError:
        trial = draft.copy()
        trial.fly(name, legs, np.where(legs[:, None], angles, draft.angles), landed=True, least=least)
    draft.take(trial)
