"""Vertical motion of a level body over stationary feet, with changes of footholds in between."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.startup.builder import BodyTarget, SequenceBuilder
from tarsus.errors import TarsusError, UnreachableError
from tarsus.gait.branch import branches
from tarsus.kinematics.foothold_stations import FootholdStation, foothold_stations
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_stance, footholds_straight_out
from tarsus.kinematics.underside import belly_depth

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["lower_body", "raise_body"]

# Spacing of the body heights that are tried to find the one that an error message advises [m].
_BODY_HEIGHT_STEP = 0.005
# Tolerance of the joint angles of the final stance, which are computed in two ways: by the plan and directly [rad].
_ANGLE_TOLERANCE = 1e-6
# Smaller differences of joint angles are ignored [rad]: less than a nanometre at the foot.
_SAME = 1e-9
# Least number of feet on the ground while others are moved.
_MIN_STANCE_FEET = 3


def raise_body(
    builder: SequenceBuilder, feet: Float[np.ndarray, "legs 3"], stance: Float[np.ndarray, "legs 3"]
) -> SequenceBuilder:
    """Move a level body, lying or standing, vertically to a stance.

    Parameters
    ----------
    builder : SequenceBuilder
        The robot, with folded legs if it lies.
    feet : array, shape (legs, 3)
        Footholds of the stance in B [m].
    stance : array, shape (legs, 3)
        Joint angles of the stance [rad].

    Returns
    -------
    SequenceBuilder
        The robot in the stance.

    Raises
    ------
    TarsusError
        If the body cannot be raised: which leg, at what height, by how much, and what would work.
    """
    height = -float(feet[0, 2])
    stations = _stations(builder, feet, height)
    for station, next_height in zip(stations, [*(s.height for s in stations[1:]), height], strict=True):
        last = station is stations[-1]
        spots = feet * [1, 1, 0] if last else footholds_straight_out(builder.robot, station.distances, 0.0)
        builder = _over_spots(builder, spots, next_height)
    error = float(np.abs(builder.angles - stance).max())
    if error > _ANGLE_TOLERANCE:
        raise UnreachableError(
            f"the final joint angles differ from those of the stance by {math.degrees(error):.3f} deg"
        )
    return builder.end_at(stance)


def _stations(
    builder: SequenceBuilder, feet: Float[np.ndarray, "legs 3"], height: float
) -> tuple[FootholdStation, ...]:
    """Return the foothold stations up to a height; if there are none, the error says which body height works."""
    robot, start, swing_height = builder.robot, builder.height, builder.swing_height
    try:
        return foothold_stations(robot, start, height, feet, swing_height=swing_height)
    except UnreachableError as error:
        advice = "no lower body height works either"
        for body_height in np.arange(start, height, _BODY_HEIGHT_STEP).tolist():
            with suppress(UnreachableError):
                other = default_stance(robot, body_height, swing_height=swing_height)
                foothold_stations(robot, start, body_height, other, swing_height=swing_height)
                advice = f"a body height of {body_height * 1000:.1f} mm works"
        raise UnreachableError(f"raising the body to {height * 1000:.1f} mm: {error}; {advice}") from None


def lower_body(builder: SequenceBuilder) -> SequenceBuilder:
    """Lower a level, standing body until it lies on the ground.

    Parameters
    ----------
    builder : SequenceBuilder
        The robot.

    Returns
    -------
    SequenceBuilder
        The robot lying on its belly.

    Raises
    ------
    TarsusError
        If the body cannot be lowered: which leg, at what height, and by how much.
    """
    robot, lowest = builder.robot, belly_depth(builder.robot)
    feet = builder.body.inverse() @ builder.feet
    stations = foothold_stations(robot, lowest, builder.height, feet, swing_height=builder.swing_height)
    for station in stations[::-1]:
        builder = _over_spots(builder, footholds_straight_out(robot, station.distances, 0.0), station.height)
    return builder.lie_down()


def _over_spots(builder: SequenceBuilder, spots: Float[np.ndarray, "legs 3"], height: float) -> SequenceBuilder:
    """Place the feet on spots of the ground, x and y in B, then move the body vertically to a height."""
    angles = inverse_kinematics(builder.robot, spots - [0, 0, builder.height]).require().angles
    if builder.belly:
        builder = builder.move_legs("place feet", angles, landed=True)
    else:
        builder = _change_footholds(builder, angles)
    if height == builder.height:
        return builder
    x, y, _ = builder.body.position
    name = "raise body" if height > builder.height else "lower body"
    target = BodyTarget(Pose(builder.body.rotation, np.array([x, y, height])), np.zeros(3), belly=False)
    return builder.move_body(name, target, builder.contacts)


def _change_footholds(builder: SequenceBuilder, angles: Float[np.ndarray, "legs 3"]) -> SequenceBuilder:
    """Move all legs to a new stance that ends with all feet on the ground, with the body stationary.

    Feet in the air are placed first. Then each tripod (the even or the odd legs) is moved as a whole, or single legs
    where a tripod cannot be lifted.
    """
    remaining = np.abs(angles - builder.angles).max(-1) > _SAME
    while remaining.any():
        group = remaining & ~builder.contacts
        if group.any():
            # These legs bear no load, so the support of the body does not change.
            builder = _move(builder, group, angles, margin=0.0)
        else:
            builder, group = _move_first_group(builder, remaining, angles)
        remaining = remaining & ~group
    return builder


def _move_first_group(
    builder: SequenceBuilder, remaining: Bool[np.ndarray, "legs"], angles: Float[np.ndarray, "legs 3"]
) -> tuple[SequenceBuilder, Bool[np.ndarray, "legs"]]:
    """Move the first group of legs, tripods before single legs, that leaves three feet on the ground, and return it."""
    failure = TarsusError(
        f"only {int(builder.contacts.sum())} feet are on the ground; lifting one of them requires at least "
        f"{_MIN_STANCE_FEET + 1}"
    )
    legs = np.arange(remaining.size)
    tripods = [remaining & (legs % 2 == parity) for parity in (0, 1)]
    for group in (*tripods, *(legs == leg for leg in np.flatnonzero(remaining))):
        if group.any() and (builder.contacts & ~group).sum() >= _MIN_STANCE_FEET:
            try:
                return _move(builder, group, angles, margin=builder.margin), group
            except TarsusError as error:
                failure = error
    raise failure


def _move(
    builder: SequenceBuilder, legs: Bool[np.ndarray, "legs"], angles: Float[np.ndarray, "legs 3"], *, margin: float
) -> SequenceBuilder:
    """Move legs by swings of their feet if possible, else along paths in joint space."""
    codes = [builder.robot.leg_codes[leg] for leg in np.flatnonzero(legs)]
    name = f"place {' '.join(codes)}"
    # A swing keeps each leg in its inverse-kinematics branch.
    if (branches(builder.robot, angles) == branches(builder.robot, builder.angles))[legs].all():
        with suppress(TarsusError):
            return builder.swing(name, legs, replace(builder, angles=angles).feet, margin=margin)
    return builder.move_legs(name, np.where(legs[:, None], angles, builder.angles), landed=True, margin=margin)
