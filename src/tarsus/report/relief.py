"""Faces of uneven ground: level or sloping cells, and walls where the height jumps."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tarsus.report.view import View

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Relief", "relief_of"]

# Distance inside the edges of a cell at which its height is sampled [m], so that no cell contains a wall.
_INSIDE = 1e-6
# Walls are drawn for differences of height above this, summed over both ends of the edge [m].
_WALL = 1e-4
# Direction towards the light in G: backward, left and up.
_LIGHT = np.array([-0.35, 0.45, 0.82])
_DARKEST, _BRIGHTEST = 0.55, 1.0


class Relief(NamedTuple):
    """Faces, sorted from the farthest to the nearest.

    Attributes
    ----------
    corners : array, shape (n, 4, 3)
        Corners of the faces in G [m].
    brightness : array, shape (n,)
        Brightness of the faces, from 0 to 1.
    """

    corners: Float[np.ndarray, "n 4 3"]
    brightness: Float[np.ndarray, "n"]


def relief_of(
    height: Callable[[Any, Any], Any],
    low: Float[np.ndarray, "2"],
    high: Float[np.ndarray, "2"],
    *,
    step: float,
    view: View,
) -> Relief:
    """Return the faces of the ground over a rectangle.

    Parameters
    ----------
    height : callable
        Height of the ground [m] at x, y [m], arrays of the same shape.
    low, high : array, shape (2,)
        Corners of the rectangle: x, y [m]; widened to whole cells.
    step : float
        Edge of a cell [m]; walls are at its multiples.
    view : View
        Direction of view, for the order of the faces.
    """
    # Edges of cells are at multiples of the step, whatever the rectangle, so that they coincide with those of terrain.
    x, y = (np.arange(np.floor(a / step), np.ceil(b / step) + 1) * step for a, b in zip(low, high, strict=True))
    left, right, near, far = x[:-1] + _INSIDE, x[1:] - _INSIDE, y[:-1] + _INSIDE, y[1:] - _INSIDE
    # Corners of the cells, counter-clockwise seen from above, (columns, rows, 4).
    xs = np.stack(np.broadcast_arrays(left[:, None], right[:, None], right[:, None], left[:, None]), axis=-1)
    ys = np.stack(np.broadcast_arrays(near, near, far, far), axis=-1)
    xs, ys = np.broadcast_arrays(xs, ys)
    cells = np.stack([xs, ys, np.broadcast_to(height(xs, ys), xs.shape)], axis=-1)
    # A wall between neighbours along x has the facing edges of both cells; the same along y.
    across = np.stack([cells[:-1, :, 1], cells[:-1, :, 2], cells[1:, :, 3], cells[1:, :, 0]], axis=-2)
    along = np.stack([cells[:, :-1, 3], cells[:, :-1, 2], cells[:, 1:, 1], cells[:, 1:, 0]], axis=-2)
    walls = np.concatenate([across.reshape(-1, 4, 3), along.reshape(-1, 4, 3)])
    jumps = np.abs(walls[:, 0, 2] - walls[:, 3, 2]) + np.abs(walls[:, 1, 2] - walls[:, 2, 2])
    faces = np.concatenate([cells.reshape(-1, 4, 3), walls[jumps > _WALL]])
    # Sorted by horizontal position alone, so that a wall is drawn over the cells behind it and under those before it.
    order = np.argsort(view.depth(faces.mean(axis=1) * [1.0, 1.0, 0.0]), kind="stable")
    corners: np.ndarray = faces[order]
    return Relief(corners, _brightness(corners))


def _brightness(corners: Float[np.ndarray, "n 4 3"]) -> Float[np.ndarray, "n"]:
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    lengths = np.linalg.norm(normals, axis=1)
    lit = np.abs(normals @ (_LIGHT / np.linalg.norm(_LIGHT))) / np.where(lengths > 0, lengths, 1.0)
    brightness: np.ndarray = _DARKEST + (_BRIGHTEST - _DARKEST) * np.clip(lit, 0.0, 1.0)
    return brightness
