"""Change of footholds in groups of legs, with the body stationary."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.startup.builder import SequenceBuilder
from tarsus.errors import TarsusError
from tarsus.gait.branch import branches

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["change_footholds"]


# Smaller differences of joint angles are ignored [rad]: less than a nanometre at the foot.
_TOLERANCE = 1e-9
_MIN_STANCE_FEET = 3


def change_footholds(builder: SequenceBuilder, angles: Float[np.ndarray, "legs 3"]) -> SequenceBuilder:
    """Move all legs to a new stance with the body stationary.

    Feet in the air are placed first. Then the tripods are moved, every second leg of the ring, and single legs where a
    tripod cannot be lifted.

    Parameters
    ----------
    builder : SequenceBuilder
        The robot in its current state.
    angles : array, shape (legs, 3)
        Joint angles of the new stance, all feet on the ground [rad].

    Returns
    -------
    SequenceBuilder
        The robot in the new stance.

    Raises
    ------
    TarsusError
        If a foot cannot be moved.
    """
    remaining = np.abs(angles - builder.angles).max(-1) > _TOLERANCE
    if (remaining & ~builder.contacts).any():
        # These legs bear no load, so the support of the body does not change.
        builder = _move(builder, remaining & ~builder.contacts, angles, margin=0.0)
        remaining &= np.abs(angles - builder.angles).max(-1) > _TOLERANCE
    while remaining.any():
        builder, group = _move_first_group(builder, remaining, angles)
        remaining = remaining & ~group
    return builder


def _move_first_group(
    builder: SequenceBuilder, remaining: Bool[np.ndarray, "legs"], angles: Float[np.ndarray, "legs 3"]
) -> tuple[SequenceBuilder, Bool[np.ndarray, "legs"]]:
    """Move the first group of legs that can be lifted, and return it too."""
    failure = TarsusError(
        f"only {int(builder.contacts.sum())} feet are on the ground; lifting one of them requires at least "
        f"{_MIN_STANCE_FEET + 1}"
    )
    for group in _groups(builder, remaining):
        try:
            return _move(builder, group, angles, margin=builder.margin), group
        except TarsusError as error:
            failure = error
    raise failure


def _groups(builder: SequenceBuilder, remaining: Bool[np.ndarray, "legs"]) -> Iterator[Bool[np.ndarray, "..."]]:
    """Yield the groups to try, tripods before single legs, that leave three feet on the ground."""
    legs = np.arange(remaining.size)
    groups = [remaining & (legs % 2 == parity) for parity in (0, 1)]
    groups += [legs == leg for leg in np.flatnonzero(remaining)]
    return (group for group in groups if group.any() and (builder.contacts & ~group).sum() >= _MIN_STANCE_FEET)


def _move(
    builder: SequenceBuilder, legs: Bool[np.ndarray, "legs"], angles: Float[np.ndarray, "legs 3"], *, margin: float
) -> SequenceBuilder:
    """Move legs by a swing of their feet if possible, else along paths in joint space."""
    codes = [builder.robot.leg_codes[leg] for leg in np.flatnonzero(legs)]
    name = f"place {' '.join(codes)}"
    # A swing keeps the way in which the knee bends.
    if (branches(builder.robot, angles) == branches(builder.robot, builder.angles))[legs].all():
        with suppress(TarsusError):
            return builder.swing(name, legs, replace(builder, angles=angles).feet, margin=margin)
    return builder.move_legs(name, np.where(legs[:, None], angles, builder.angles), landed=True, margin=margin)
