"""Ground grid that fills the view and stays fixed while the view follows the robot."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.report.view import View

if TYPE_CHECKING:
    from jaxtyping import Float
    from matplotlib.axes import Axes

__all__ = ["Ground"]

_GRID_MM = 100.0
_MAX_LINES = 80
_COLOUR = "#e3e3e3"
# Points along a line of the grid on ground that is not flat.
_POINTS = 160


class Ground:
    """Grid on the ground.

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
        from matplotlib.collections import LineCollection

        self._axes, self._view, self._height = axes, view, height
        self._lines = LineCollection([], colors=_COLOUR, linewidths=0.8, zorder=0)
        axes.add_collection(self._lines, autolim=False)

    def update(self) -> None:
        """Draw the grid lines within the current limits of the axes."""
        (left, right), (low, high) = self._axes.get_xlim(), self._axes.get_ylim()
        visible = self._view.ground_under(np.array([[left, low], [right, low], [right, high], [left, high]]))[:, :2]
        lines = _grid(visible.min(0), visible.max(0))
        if self._height is not None:
            lines = [self._raised(line) for line in lines]
        self._lines.set_segments([self._view.project(line) for line in lines])

    def _raised(self, line: Float[np.ndarray, "2 3"]) -> Float[np.ndarray, "k 3"]:
        """Return points along a line of the grid, at the height of the ground."""
        assert self._height is not None
        points: np.ndarray = line[0] + (line[1] - line[0]) * np.linspace(0, 1, _POINTS)[:, None]
        points[:, 2] = 1000 * self._height(points[:, 0] / 1000, points[:, 1] / 1000)
        return points


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
