"""Change of footholds in groups of legs, with the body stationary."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.startup.builder import SequenceBuilder
from tarsus.errors import TarsusError
from tarsus.gait.branch import branches
from tarsus.kinematics.leg import forward_kinematics

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["change_footholds"]


# Smaller differences of joint angles are ignored [rad]: less than a nanometre at the foot.
_TOLERANCE = 1e-9
_MIN_STANCE_FEET = 3


def change_footholds(builder: SequenceBuilder, angles: Float[np.ndarray, "legs 3"]) -> None:
    """Move all legs to a new stance with the body stationary.

    Feet in the air are placed first. Then the tripods are moved, every second leg of the ring, and single legs where a
    tripod cannot be lifted.

    Parameters
    ----------
    builder : SequenceBuilder
        The robot in its current state; stages are added to it.
    angles : array, shape (legs, 3)
        Joint angles of the new stance, all feet on the ground [rad].

    Raises
    ------
    TarsusError
        If a foot cannot be moved.
    """
    remaining = np.abs(angles - builder.angles).max(-1) > _TOLERANCE
    if (remaining & ~builder.contacts).any():
        # These legs bear no load, so the support of the body does not change.
        _move(builder, remaining & ~builder.contacts, angles, margin=0.0)
        remaining &= np.abs(angles - builder.angles).max(-1) > _TOLERANCE
    while remaining.any():
        group = _move_first_group(builder, remaining, angles)
        remaining = remaining & ~group


def _move_first_group(
    builder: SequenceBuilder, remaining: Bool[np.ndarray, "legs"], angles: Float[np.ndarray, "legs 3"]
) -> Bool[np.ndarray, "legs"]:
    """Move the first group of legs that can be lifted, and return it."""
    errors: list[TarsusError] = []
    for group in _groups(builder, remaining):
        try:
            _move(builder, group, angles, margin=builder.margin)
        except TarsusError as error:
            errors.append(error)
        else:
            return group
    if errors:
        raise errors[-1]
    raise TarsusError(
        f"only {int(builder.contacts.sum())} feet are on the ground; lifting one of them requires at least "
        f"{_MIN_STANCE_FEET + 1}"
    )


def _groups(builder: SequenceBuilder, remaining: Bool[np.ndarray, "legs"]) -> Iterator[Bool[np.ndarray, "..."]]:
    """Yield the groups to try, tripods before single legs, that leave three feet on the ground."""
    legs = np.arange(remaining.size)
    groups = [remaining & (legs % 2 == parity) for parity in (0, 1)]
    groups += [legs == leg for leg in np.flatnonzero(remaining)]
    return (group for group in groups if group.any() and (builder.contacts & ~group).sum() >= _MIN_STANCE_FEET)


def _move(
    builder: SequenceBuilder, legs: Bool[np.ndarray, "legs"], angles: Float[np.ndarray, "legs 3"], *, margin: float
) -> None:
    """Move legs by a swing of their feet if possible, else along paths in joint space."""
    codes = [builder.robot.leg_codes[leg] for leg in np.flatnonzero(legs)]
    name = f"place {' '.join(codes)}"
    trial = builder.copy()
    same_branch = (branches(builder.robot, angles) == branches(builder.robot, builder.angles))[legs].all()
    try:
        if not same_branch:
            raise TarsusError(f"{name}: the knee must bend the other way")
        feet = builder.body @ forward_kinematics(builder.robot, angles)[:, 3]
        trial.swing(name, legs, feet, margin=margin)
    except TarsusError:
        trial = builder.copy()
        trial.move_legs(name, legs, np.where(legs[:, None], angles, builder.angles), landed=True, margin=margin)
    builder.adopt(trial)
