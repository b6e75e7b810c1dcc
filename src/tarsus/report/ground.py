"""Ground that fills the view and stays fixed while the view follows the robot: a grid, or the faces of a terrain."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.report.relief import relief_of
from tarsus.report.view import View

if TYPE_CHECKING:
    from jaxtyping import Float
    from matplotlib.axes import Axes

__all__ = ["Ground"]

_GRID_MM = 100.0
_MAX_LINES = 80
_COLOUR = "#e3e3e3"
# Colour of faces in full light.
_EARTH = np.array([0.93, 0.94, 0.92])
# Uneven ground: edge of a cell [m], and margin around the view within which ground may rise into the picture [m].
_CELL, _BEYOND = 0.025, 0.3
_MOST_CELLS = 40_000


class Ground:
    """The ground: a grid where it is flat, else its faces.

    Parameters
    ----------
    axes : Axes
        Target axes, in millimetres of the projection.
    view : View
        Direction of view.
    height : callable, optional
        Height of the ground [m] at x, y [m], arrays of the same shape; flat ground where left out.
    """

    def __init__(self, axes: Axes, view: View, height: Callable[[Any, Any], Any] | None = None) -> None:
        from matplotlib.collections import LineCollection, PolyCollection

        self._axes, self._view, self._height = axes, view, height
        self._lines = LineCollection([], colors=_COLOUR, linewidths=0.8, zorder=0)
        axes.add_collection(self._lines, autolim=False)
        self._faces = PolyCollection([], zorder=0, linewidths=0.4)
        axes.add_collection(self._faces, autolim=False)

    def update(self) -> None:
        """Draw the ground within the current limits of the axes."""
        (left, right), (low, high) = self._axes.get_xlim(), self._axes.get_ylim()
        visible = self._view.ground_under(np.array([[left, low], [right, low], [right, high], [left, high]]))[:, :2]
        if self._height is None:
            self._lines.set_segments([self._view.project(line) for line in _grid(visible.min(0), visible.max(0))])
        else:
            self._draw_faces(visible.min(0) / 1000 - _BEYOND, visible.max(0) / 1000 + _BEYOND)

    def _draw_faces(self, low: Float[np.ndarray, "2"], high: Float[np.ndarray, "2"]) -> None:
        assert self._height is not None
        step = _CELL
        while float(np.prod((high - low) / step)) > _MOST_CELLS:
            step *= 2
        relief = relief_of(self._height, low, high, step=step, view=self._view)
        corners = self._view.project(relief.corners * 1000)
        # Most faces lie outside the picture, and are left out.
        (left, right), (bottom, top) = self._axes.get_xlim(), self._axes.get_ylim()
        least, most = corners.min(axis=1), corners.max(axis=1)
        seen = (most[:, 0] > left) & (least[:, 0] < right) & (most[:, 1] > bottom) & (least[:, 1] < top)
        colours = np.clip(relief.brightness[seen, None] * _EARTH, 0.0, 1.0)
        self._faces.set_verts(list(corners[seen]))
        self._faces.set_facecolor(colours)
        # Drawing the edges in the colour of their face closes the seams between faces.
        self._faces.set_edgecolor(colours)


def _grid(low: Float[np.ndarray, "n"], high: Float[np.ndarray, "m"]) -> list[Float[np.ndarray, "k 3"]]:
    """Return the grid lines over a rectangle of the ground, with a wider spacing if there are too many."""
    step = _GRID_MM
    while float((high - low).max()) / step > _MAX_LINES:
        step *= 10
    lines = []
    for axis in (0, 1):
        positions = np.arange(np.ceil(low[axis] / step), np.floor(high[axis] / step) + 1) * step
        for value in positions:
            line = np.zeros((2, 3))
            line[:, axis] = value
            line[:, 1 - axis] = low[1 - axis], high[1 - axis]
            lines.append(line)
    return lines
