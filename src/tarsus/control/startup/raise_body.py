"""Pushing a level body straight up and letting it down, feet still, and changing footholds in between."""

from __future__ import annotations

import contextlib
import math
from typing import Any

import numpy as np

from tarsus.control.startup.builder import SequenceBuilder
from tarsus.control.startup.folded_pose import belly_depth
from tarsus.control.startup.foothold_change import change_footholds
from tarsus.control.startup.foothold_stations import FootholdStation, foothold_distances, footholds, stations
from tarsus.errors import UnreachableError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_stance

__all__ = ["lower_body", "raise_body"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Spacing of the body heights that are tried for advice [m].
_BODY_HEIGHT_STEP = 0.005
# How far the angles of a stance may be off where its feet stand by other arithmetic [rad].
_SAME = 1e-6


def raise_body(draft: SequenceBuilder, feet: Floats, stance: Floats, *, swing_height: float, least: float) -> None:
    """Bring a level body, lying or standing, straight up (or down) to a stance.

    Parameters
    ----------
    draft : Draft
        The robot, its legs folded where it lies; takes the stages.
    feet, stance : array, shape (legs, 3)
        Footholds of the stance in B [m], and its joint angles [rad].
    swing_height : float
        How high feet are lifted that change their footholds [m].
    least : float
        The least stability margin meanwhile [m].

    Raises
    ------
    TarsusError
        If it can't be done: which leg, at what height, by how much, and what would work.
    """
    height = -float(feet[0, 2])
    way = _way_up(draft, feet, height, swing_height)
    for station, after in zip(way, [*(s.height for s in way[1:]), height], strict=True):
        last = station is way[-1]
        spots = feet * [1, 1, 0] if last else footholds(draft.robot, station.out, 0.0)
        spots = spots - [0, 0, draft.height]
        exact = last and draft.height == height
        angles = stance if exact else inverse_kinematics(draft.robot, spots).require().angles
        if draft.belly:
            draft.fly("put the feet down", (draft.angles != angles).any(-1), angles, landed=True)
        else:
            change_footholds(draft, angles, swing_height=swing_height, least=least)
        if after != draft.height:
            draft.move_body("push up" if after > draft.height else "let down", _at_height(draft.body, after))
    off = float(np.abs(draft.angles - stance).max())
    if off > _SAME:
        raise UnreachableError(f"the stance is reached by other angles, {math.degrees(off):.3f} deg off")
    draft.end_in(stance)


def _way_up(draft: SequenceBuilder, feet: Floats, height: float, swing_height: float) -> tuple[FootholdStation, ...]:
    """Return the stations up to a height; where there are none, say which body heights would work."""
    try:
        return stations(draft.robot, draft.height, height, feet, swing_height=swing_height)
    except UnreachableError as error:
        works = []
        for body_height in np.arange(draft.height, height, _BODY_HEIGHT_STEP):
            with contextlib.suppress(UnreachableError):
                other = default_stance(draft.robot, float(body_height), swing_height=swing_height)
                stations(draft.robot, draft.height, float(body_height), other, swing_height=swing_height)
                works.append(float(body_height))
        advice = f"a body height of {max(works) * 1000:.1f} mm works" if works else "no lower body height works either"
        raise UnreachableError(f"pushing the body up to {height * 1000:.1f} mm: {error}; {advice}") from None


def lower_body(draft: SequenceBuilder, *, swing_height: float, least: float) -> None:
    """Let a level body that stands on its feet down until its belly lies on the ground.

    Parameters
    ----------
    draft : Draft
        The robot; takes the stages.
    swing_height : float
        How high feet are lifted that change their footholds [m].
    least : float
        The least stability margin meanwhile [m].

    Raises
    ------
    TarsusError
        If it can't be done: which leg, at what height, and by how much.
    """
    lying = belly_depth(draft.robot)
    up = foothold_distances(draft.robot, draft.body.inverse() @ draft.feet)
    way = stations(
        draft.robot, lying, draft.height, footholds(draft.robot, up, draft.height), swing_height=swing_height
    )
    for station in way[::-1]:
        spots = footholds(draft.robot, station.out, draft.height)
        angles = inverse_kinematics(draft.robot, spots).require().angles
        change_footholds(draft, angles, swing_height=swing_height, least=least)
        draft.move_body("let down", _at_height(draft.body, station.height))
    draft.lie()


def _at_height(body: Pose, height: float) -> Pose:
    return Pose(body.rotation, np.array([body.position[0], body.position[1], height]))
