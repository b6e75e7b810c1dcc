"""Vertical motion of a level body over stationary feet, with changes of footholds in between."""

from __future__ import annotations

import contextlib
import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.startup.builder import SequenceBuilder
from tarsus.control.startup.foothold_change import change_footholds
from tarsus.control.startup.foothold_stations import FootholdStation, foothold_stations
from tarsus.errors import UnreachableError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_stance, foothold_distances, footholds_straight_out
from tarsus.kinematics.underside import belly_depth

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["lower_body", "raise_body"]


# Spacing of the body heights that are tried for the advice of an error message [m].
_BODY_HEIGHT_STEP = 0.005
# Tolerance of the joint angles of the final stance, which are computed in two ways [rad].
_ANGLE_TOLERANCE = 1e-6


def raise_body(
    builder: SequenceBuilder, feet: Float[np.ndarray, "legs 3"], stance: Float[np.ndarray, "legs 3"]
) -> None:
    """Move a level body, lying or standing, vertically to a stance.

    Parameters
    ----------
    builder : SequenceBuilder
        The robot, with folded legs if it lies; stages are added to it.
    feet : array, shape (legs, 3)
        Footholds of the stance in B [m].
    stance : array, shape (legs, 3)
        Joint angles of the stance [rad].

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
        spots = spots - [0, 0, builder.height]
        exact = last and builder.height == height
        angles = stance if exact else inverse_kinematics(builder.robot, spots).require().angles
        if builder.belly:
            builder.move_legs("place feet", (builder.angles != angles).any(-1), angles, landed=True)
        else:
            change_footholds(builder, angles)
        if next_height != builder.height:
            name = "raise body" if next_height > builder.height else "lower body"
            builder.move_body(name, _at_height(builder.body, next_height))
    error = float(np.abs(builder.angles - stance).max())
    if error > _ANGLE_TOLERANCE:
        raise UnreachableError(
            f"the final joint angles differ from those of the stance by {math.degrees(error):.3f} deg"
        )
    builder.set_end_angles(stance)


def _stations(
    builder: SequenceBuilder, feet: Float[np.ndarray, "legs 3"], height: float
) -> tuple[FootholdStation, ...]:
    """Return the stations up to a height; if there are none, say which body heights would work."""
    robot, start, swing_height = builder.robot, builder.height, builder.swing_height
    try:
        return foothold_stations(robot, start, height, feet, swing_height=swing_height)
    except UnreachableError as error:
        feasible = []
        for body_height in np.arange(start, height, _BODY_HEIGHT_STEP).tolist():
            with contextlib.suppress(UnreachableError):
                other = default_stance(robot, body_height, swing_height=swing_height)
                foothold_stations(robot, start, body_height, other, swing_height=swing_height)
                feasible.append(body_height)
        advice = "no lower body height works either"
        if feasible:
            advice = f"a body height of {max(feasible) * 1000:.1f} mm works"
        raise UnreachableError(f"raising the body to {height * 1000:.1f} mm: {error}; {advice}") from None


def lower_body(builder: SequenceBuilder) -> None:
    """Lower a level, standing body until it lies on the ground.

    Parameters
    ----------
    builder : SequenceBuilder
        The robot; stages are added to it.

    Raises
    ------
    TarsusError
        If the body cannot be lowered: which leg, at what height, and by how much.
    """
    robot, lowest = builder.robot, belly_depth(builder.robot)
    distances = foothold_distances(robot, builder.body.inverse() @ builder.feet)
    feet = footholds_straight_out(robot, distances, -builder.height)
    stations = foothold_stations(robot, lowest, builder.height, feet, swing_height=builder.swing_height)
    for station in stations[::-1]:
        spots = footholds_straight_out(robot, station.distances, -builder.height)
        angles = inverse_kinematics(robot, spots).require().angles
        change_footholds(builder, angles)
        builder.move_body("lower body", _at_height(builder.body, station.height))
    builder.set_lying()


def _at_height(body: Pose, height: float) -> Pose:
    return Pose(body.rotation, np.array([body.position[0], body.position[1], height]))
