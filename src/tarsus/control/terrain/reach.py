"""How low and how high each foot may stand: the heights at which the leg reaches the whole of its stroke."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.workspace.stance_geometry import SWING_HEIGHT, StanceGeometry, joint_margin, rotation_rows
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["reachable_heights"]

# Heights that are tried about the level ground, over the length of femur and tibia.
_TRIED = np.linspace(-0.8, 0.8, 41)
_LEVEL = len(_TRIED) // 2


def reachable_heights(
    robot: Robot,
    posture: Float[np.ndarray, "_"],
    rest: Complex[np.ndarray, "legs"],
    strokes: Complex[np.ndarray, "legs"],
) -> tuple[list[float], list[float]]:
    """Return the least and the greatest height of each foot in the heading frame [m].

    Parameters
    ----------
    robot : Robot
        A single robot.
    posture : array, shape (7,) or more
        Posture of the body.
    rest : complex array, shape (legs,)
        Rest footholds in the heading frame [m].
    strokes : complex array, shape (legs,)
        Stroke of each foot about its rest foothold [m].
    """
    g = robot.geometry
    levels = _TRIED * float(np.max(g.femur + g.tibia))
    stance = StanceGeometry(rest, np.array(rotation_rows(*posture[3:SWING_HEIGHT].tolist())), posture[:3], 0.0)
    places = rest + np.array([-0.5, 0.0, 0.5])[:, None, None] * strokes
    x, y = np.broadcast_to(places.real, (3, len(levels), len(rest))), places.imag
    solution = stance.solve(robot, x, np.broadcast_to(y, x.shape), np.broadcast_to(levels[:, None], x.shape))
    works = np.asarray((joint_margin(g, solution) >= 0).all(axis=0))
    lowest, highest = [], []
    for leg in range(len(rest)):
        below, above = ~works[: _LEVEL + 1, leg][::-1], ~works[_LEVEL:, leg]
        # The last level before the first one that is out of reach.
        low = int(below.argmax()) if below.any() else _LEVEL + 1
        high = int(above.argmax()) if above.any() else _LEVEL + 1
        lowest.append(float(levels[_LEVEL - max(low - 1, 0)]))
        highest.append(float(levels[_LEVEL + max(high - 1, 0)]))
    return lowest, highest
