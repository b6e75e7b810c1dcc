"""A single robot that stands as it is lowered, without rolling: the usual case, in a tenth of the time of `settle`."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.kinematics.convex_hull import origin_margin
from tarsus.kinematics.roll import TOUCH

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["Lowered", "stands_as_lowered"]


class Lowered(NamedTuple):
    """How a robot stands upright.

    Attributes
    ----------
    height : float
        Height of the body's origin above the ground [m].
    down : array of bool, shape (points,)
        Points in contact.
    margin : float
        Margin of the centre of mass in their hull [m].
    """

    height: float
    down: Bool[np.ndarray, "points"]
    margin: float


def stands_as_lowered(points: Float[np.ndarray, "points 3"], com: Float[np.ndarray, "3"]) -> Lowered | None:
    """Return how a robot stands as lowered; None where it may roll, or its balance is a matter of rounding.

    Parameters
    ----------
    points : array, shape (points, 3)
        Points that can touch the ground, in B [m].
    com : array, shape (3,)
        Centre of mass in B [m].
    """
    touch = max(TOUCH, 64 * float(np.finfo(com.dtype).eps))
    heights = points[:, 2]
    lowest = float(heights.min())
    down = heights - lowest < touch
    margin = origin_margin((points[down, :2] - com[:2]).tolist())[0]
    return Lowered(-lowest, down, margin) if margin > touch else None
