"""The segments between all pairs of a few points in the plane: all that is needed to measure their convex hull.

Every measure is a bound over all pairs, with neither a sorted hull nor a tolerance, so that it can be batched and
differentiated, and points that coincide or lie on a line need no case of their own.

Points or pairs lead in the arrays and the batch follows: sums over a few points then run along contiguous memory.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple, Self

import numpy as np

from tarsus.arrays import Array, Namespace, root
from tarsus.blocks import Index, block_shape, columns

__all__ = ["Pairs", "columns_of"]


class Pairs(NamedTuple):
    """The segments between all points of a set, seen from the origin.

    `x` and `y` are the points ``(n, batch)``, `start_x` and `start_y` where a segment starts ``(pairs, batch)``,
    `along_x` and `along_y` how it goes on from there, and `length` how long it is.
    """

    x: Array
    y: Array
    start_x: Array
    start_y: Array
    along_x: Array
    along_y: Array
    length: Array

    @classmethod
    def of(cls, xp: Namespace, x: Array, y: Array) -> Self:
        """Join the points ``(n, batch)`` in pairs; a single point makes a pair with itself."""
        first, second = (xp.asarray(index) for index in _pair_indices(x.shape[0]))
        start_x, start_y = xp.take(x, first, axis=0), xp.take(y, first, axis=0)
        along_x, along_y = xp.take(x, second, axis=0) - start_x, xp.take(y, second, axis=0) - start_y
        return cls(x, y, start_x, start_y, along_x, along_y, root(xp, along_x * along_x + along_y * along_y))

    def normals(self, xp: Namespace) -> tuple[Array, Array]:
        """Return unit vectors across the segments; zero where a segment has no length."""
        length = xp.where(self.length > 0, self.length, 1.0)
        return self.along_y / length, -self.along_x / length

    def depth_and_width(self, xp: Namespace) -> tuple[Array, Array]:
        """Return how deep the origin lies in the hull, and how wide the hull is where it is narrowest.

        The depth is the least height of a supporting line over the origin, taken over the directions across all
        pairs. The least of all directions is the one across the nearest edge of the hull, and the edges are among
        the pairs: so it is exact where it is positive, which it is inside and nowhere else. The width likewise.
        """
        real = self.length > 0
        across_x, across_y = self.normals(xp)
        heights = across_x[:, None, ...] * self.x + across_y[:, None, ...] * self.y
        highest, lowest = xp.max(heights, axis=1), xp.min(heights, axis=1)
        depth = xp.min(xp.where(real, xp.minimum(highest, -lowest), xp.inf), axis=0)
        width = xp.min(xp.where(real, highest - lowest, xp.inf), axis=0)
        spread = xp.any(real, axis=0)
        return xp.where(spread, depth, 0.0), xp.where(spread, width, 0.0)

    def nearest(self, xp: Namespace) -> tuple[Array, Array, Array]:
        """Return the point of each segment nearest to the origin: x, y, and the share of the way along."""
        length2 = self.along_x * self.along_x + self.along_y * self.along_y
        length2 = xp.where(length2 > 0, length2, 1.0)
        share = xp.clip(-(self.start_x * self.along_x + self.start_y * self.along_y) / length2, 0.0, 1.0)
        return self.start_x + share * self.along_x, self.start_y + share * self.along_y, share


def columns_of(xp: Namespace, array: Array, batch: tuple[int, ...], index: Index, *, tail: int) -> Array:
    """Return a block of `array` with the last `tail` axes in reverse order in front and the batch flat behind.

    Parameters
    ----------
    xp : namespace
        The array library.
    array : array
        Batch axes, then `tail` more.
    batch : tuple of int
        The batch axes it broadcasts to.
    index : tuple of slice
        The block; arrays of other libraries than NumPy are taken whole.
    tail : int
        How many of the last axes are not batch axes.
    """
    if xp is np:
        return columns(array, index, block_shape(batch, index), tail=tail)
    rest = tuple(array.shape[array.ndim - tail :])
    flat = xp.reshape(xp.broadcast_to(array, (*batch, *rest)), (math.prod(batch), *rest))
    return xp.permute_dims(flat, tuple(range(tail, -1, -1)))


@lru_cache(maxsize=64)
def _pair_indices(n: int) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    first, second = np.triu_indices(n, k=0 if n == 1 else 1)
    return first, second
