"""Range of heights in which legs reach the places of their strokes, and the share of a slope that it covers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.stance.stance_geometry import SWING_HEIGHT, StanceGeometry, joint_margin, rotation_rows
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["STROKE_PLACES", "reachable_heights", "reachable_share"]

# Places of a stroke that are examined, from its rear end to its front end, as fractions of its length.
STROKE_PLACES = (-0.5, 0.0, 0.5)

# Heights tried, relative to level ground, over the length of femur and tibia; index of level ground.
_TRIED = np.linspace(-0.8, 0.8, 121)
_LEVEL = len(_TRIED) // 2


def reachable_heights(
    robot: Robot,
    posture: Float[np.ndarray, "_"],
    rest: Complex[np.ndarray, "*batch legs"],
    strokes: Complex[np.ndarray, "legs"],
) -> tuple[Float[np.ndarray, "*batch 3 legs"], Float[np.ndarray, "*batch 3 legs"]]:
    """Return the least and greatest reachable height of each foot at the places of its stroke, in the heading frame.

    Both are 0 at a place that the leg does not reach on level ground.

    Parameters
    ----------
    robot : Robot
        A single robot.
    posture : array, shape (7,) or more
        Posture of the body.
    rest : complex array, shape (..., legs)
        Rest footholds in the heading frame [m].
    strokes : complex array, shape (legs,)
        Stroke of each foot about its rest foothold [m].

    Returns
    -------
    lowest, highest : array, shape (..., 3, legs)
        Heights at the places of `STROKE_PLACES` [m].
    """
    g = robot.geometry
    levels = _TRIED * float(np.max(g.femur + g.tibia))
    stance = StanceGeometry(rest, np.array(rotation_rows(*posture[3:SWING_HEIGHT].tolist())), posture[:3], 0.0)
    places = rest[..., None, None, :] + np.array(STROKE_PLACES)[:, None, None] * strokes
    solution = stance.solve(robot.geometry, places.real, places.imag, levels[:, None])
    beyond = np.asarray(~(joint_margin(g, solution) >= 0))
    ends = []
    for sign, way in ((-1, beyond[..., _LEVEL::-1, :]), (1, beyond[..., _LEVEL:, :])):
        # The last level before the first one that is out of reach.
        steps = np.where(way.any(axis=-2), way.argmax(axis=-2) - 1, _LEVEL)
        ends.append(levels[_LEVEL + sign * np.maximum(steps, 0)])
    return ends[0], ends[1]


def reachable_share(rises: Sequence[float], lowest: Sequence[float], highest: Sequence[float]) -> float:
    """Return the share of a slope that the legs reach, 0 to 1; the body has to follow the rest.

    Parameters
    ----------
    rises : sequence of float
        Height of the slope at each foot, or other part of the robot, over that at the body [m].
    lowest, highest : sequence of float
        Least and greatest height that each foot, or other part, can have [m].
    """
    if max(rises) - min(rises) <= min(highest) - max(lowest):
        return 1.0
    uphill, downhill = zip(rises, highest, strict=True), list(zip(rises, lowest, strict=True))
    pairs = ((up - down, max(high - low, 0.0)) for up, high in uphill for down, low in downhill)
    return min([1.0, *(room / rise for rise, room in pairs if rise > room)])
