"""Heights of the ground on a grid around the body, and the choice of better footholds on it."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tarsus.arrays import require_float
from tarsus.errors import InputError
from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Shaped

__all__ = ["GroundHeights", "Heights", "better_foothold", "is_steep", "lowest_near", "on_way"]

Heights: TypeAlias = "Callable[[Shaped[np.ndarray, '...']], Shaped[np.ndarray, '...']]"
"""A function that returns the heights of the ground at places x + iy [m]."""

# Rings of footholds tried around the planned one: radius [m], and rotation in eighths of a turn.
_RINGS = [(0.02, 0.0), (0.04, 0.5), (0.06, 0.0)]
# Offsets of these footholds, the planned one first, and offsets at which the ground around each is sampled [m].
TRIED = np.array([0j, *(cmath.rect(far, (k + turned) * math.pi / 4) for far, turned in _RINGS for k in range(8))])
_AROUND = 0.02 * np.array([0j, 1.0, -1.0, 1j, -1j])
# Distance that feet keep from ground too low to stand on [m]; unit offsets at which ground is sampled around a place.
_CLEAR, _RING = 0.04, np.append(0j, np.exp(0.25j * np.pi * np.arange(8)))
# Costs of a foothold per metre: height out of reach, depth of ground nearby that is too low, height off the plane of
# the feet, difference in height to the ground around it (an edge), distance from the planned foothold.
_OUT_OF_REACH, _NEAR_HOLE, _OFF_PLANE, _EDGE, _AWAY = 3.0, 1.0, 0.3, 0.5, 0.15
# Margin kept to the least height at which a foot can stand, and between foot and ground at its greatest height [m].
_ROOM = 0.01
# Fractions of a path at which the ground is sampled.
_ALONG = np.linspace(0.0, 1.0, 9)
# A path is steep where the ground rises by more than `_STEEP` within `_NEAR` of its start [m].
_NEAR, _STEEP = 0.04, 0.015


@represented("heights.shape", "cell")
@dataclass(frozen=True, kw_only=True, eq=False)
class GroundHeights:
    """Heights of the ground on a grid around the body, as obtained from a camera.

    The grid is level, its middle is at the origin of B, and its x axis has the body's yaw.

    Attributes
    ----------
    heights : array, shape (rows, columns)
        Heights, rows along x, columns along y, both ascending [m]; only their differences are used. NaN where unknown.
    cell : float
        Spacing of the grid points [m].

    Raises
    ------
    InputError
        If the heights are no array of numbers with two axes and some points, one is infinite, or `cell` is not a
        positive number.
    """

    heights: Float[np.ndarray, "rows columns"]
    cell: float = 0.02

    def __post_init__(self) -> None:
        try:
            heights = np.array(self.heights, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise InputError(f"ground heights: expected an array of numbers: {error}") from None
        if heights.ndim != 2 or not heights.size or np.isinf(heights).any():
            raise InputError(
                f"ground heights of shape {heights.shape} must have two axes, some points and no infinite value"
            )
        cell = require_float("ground heights: cell", self.cell)
        if not 0 < cell < np.inf:
            raise InputError(f"ground heights: cell is {cell:g} m; it must be a positive number")
        heights.setflags(write=False)
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "cell", cell)

    def at(self, places: Shaped[np.ndarray, "..."]) -> Shaped[np.ndarray, "..."]:
        """Return the heights at the grid points nearest to places x + iy from the middle; NaN where unknown [m].

        Parameters
        ----------
        places : complex array, shape (...)
            The places [m].
        """
        rows, columns = self.heights.shape
        cells = places / self.cell + complex(rows - 1, columns - 1) / 2
        row, column = np.rint(cells.real).astype(int), np.rint(cells.imag).astype(int)
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        return np.where(inside, self.heights[row.clip(0, rows - 1), column.clip(0, columns - 1)], np.nan)


def better_foothold(
    heights: Heights,
    level: Heights,
    start: complex,
    foothold: complex,
    *,
    allowed: Bool[np.ndarray, "tried"],
    reach: tuple[float, float, float],
) -> complex:
    """Return the offset from its planned foothold at which a foot stands best, one of `TRIED` [m].

    Parameters
    ----------
    heights, level : callable
        Heights of the ground, and of the plane through the other feet.
    start, foothold : complex
        Where the foot is, and its planned foothold [m].
    allowed : array of bool, shape (tried,)
        Which of `TRIED` may be chosen.
    reach : (float, float, float)
        Least and greatest height at which the foot can stand, and greatest height to which it can be lifted [m].
    """
    lowest, highest, over = reach
    tried = TRIED[allowed]
    places = foothold + tried[:, None]
    around = heights(places + _AROUND)
    under = around[:, 0]
    cost = _EDGE * np.abs(around - under[:, None]).max(axis=1) + _AWAY * np.abs(tried)
    cost += _OFF_PLANE * np.abs(under - level(places[:, 0]))
    cost += _OUT_OF_REACH * np.maximum(np.maximum(lowest + _ROOM - under, under - highest), 0.0)
    cost += _NEAR_HOLE * np.maximum(lowest + _ROOM - lowest_near(heights, places[:, 0], within=_CLEAR), 0.0)
    way = heights(start + (places - start) * _ALONG).max(axis=1)
    cost += _OUT_OF_REACH * np.maximum(way + _ROOM - over, 0.0)
    return complex(tried[int(cost.argmin())])


def lowest_near(heights: Heights, places: Shaped[np.ndarray, "..."], *, within: float) -> Shaped[np.ndarray, "..."]:
    """Return the least height of the ground at each of some places and on a circle around it [m].

    Parameters
    ----------
    heights : callable
        Heights of the ground.
    places : complex array, shape (...)
        The places [m].
    within : float
        Radius of the circle [m].
    """
    return np.asarray(heights(places[..., None] + within * _RING).min(axis=-1))


def on_way(heights: Heights, start: complex, end: complex) -> Float[np.ndarray, "n"]:
    """Return the heights of the ground along the straight line between two places [m].

    Parameters
    ----------
    heights : callable
        Heights of the ground.
    start, end : complex
        The two places [m].
    """
    return heights(start + (end - start) * _ALONG)


def is_steep(heights: Heights, start: complex, end: complex) -> bool:
    """Return whether the ground rises so soon along a path that a foot has to rise before it moves ahead.

    Parameters
    ----------
    heights : callable
        Heights of the ground.
    start, end : complex
        Start and end of the path [m].
    """
    near = (end - start) * min(_NEAR / max(abs(end - start), 1e-9), 1.0)
    found = heights(start + near * _ALONG)
    return bool(found.max() > found[0] + _STEEP)
