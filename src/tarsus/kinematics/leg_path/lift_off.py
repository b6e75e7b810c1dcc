"""Lift-off of a foot: whether it leaves the ground without dragging."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["DEPTH_TOLERANCE", "lifts_off"]

DEPTH_TOLERANCE = 1e-7
"""Tolerance of a depth below the ground [m]."""

# Heights up to which a foot is on the ground, and from which it is clear of it [m]; in between it must rise by this
# fraction of its horizontal distance.
_ON_GROUND = 1e-6
_CLEAR_HEIGHT = 0.003
_MIN_SLOPE = 0.5


def lifts_off(foot: Float[np.ndarray, "n 3"], heights: Float[np.ndarray, "n"]) -> bool:
    """Return whether a foot that starts on the ground leaves it steeply; a foot that does not is dragged.

    Parameters
    ----------
    foot : array, shape (n, 3)
        Positions of the foot along its path [m].
    heights : array, shape (n,)
        Heights over the ground [m].
    """
    if heights[0] > _ON_GROUND:
        return True
    low = heights < _CLEAR_HEIGHT
    low = low[: int(np.argmin(low)) or None]
    distance2 = ((foot[: low.size] - foot[0]) ** 2).sum(-1)
    rise = heights[: low.size] - heights[0]
    horizontal = np.sqrt(np.maximum(distance2 - rise * rise, 0.0))
    return bool((rise >= _MIN_SLOPE * horizontal - DEPTH_TOLERANCE).all())
