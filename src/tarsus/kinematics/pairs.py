"""Segments between all pairs of a few points in the plane, for measures of their convex hull.

Every measure is an extremum over all pairs, without sorting and tolerances. It can be batched and differentiated, and
coincident or collinear points need no special case.

The axis of points or pairs precedes the batch, so that reductions run along contiguous memory.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from tarsus.arrays import Array, Namespace, root
from tarsus.blocks import Index, block_shape, columns

if TYPE_CHECKING:
    from jaxtyping import Float, Shaped

__all__ = ["Pairs", "columns_of"]


class Pairs(NamedTuple):
    """Segments between all pairs of points of a set.

    Attributes
    ----------
    x, y : array, shape (n, batch)
        The points [m].
    start_x, start_y : array, shape (pairs, batch)
        Start of each segment [m].
    along_x, along_y : array, shape (pairs, batch)
        Vector from the start of each segment to its end [m].
    length : array, shape (pairs, batch)
        Length of each segment [m].
    """

    x: Float[Array, "n batch"]
    y: Float[Array, "n batch"]
    start_x: Float[Array, "pairs batch"]
    start_y: Float[Array, "pairs batch"]
    along_x: Float[Array, "pairs batch"]
    along_y: Float[Array, "pairs batch"]
    length: Float[Array, "pairs batch"]

    @classmethod
    def of(cls, xp: Namespace, x: Float[Array, "n batch"], y: Float[Array, "n batch"]) -> Self:
        """Return the segments of points ``(n, batch)``; a single point is paired with itself."""
        first, second = (xp.asarray(index) for index in _pair_indices(x.shape[0]))
        start_x, start_y = xp.take(x, first, axis=0), xp.take(y, first, axis=0)
        along_x, along_y = xp.take(x, second, axis=0) - start_x, xp.take(y, second, axis=0) - start_y
        return cls(x, y, start_x, start_y, along_x, along_y, root(xp, along_x * along_x + along_y * along_y))

    def normals(self, xp: Namespace) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
        """Return unit normals of the segments ``(pairs, batch)``; zero where a segment has no length."""
        length = xp.where(self.length > 0, self.length, 1.0)
        return self.along_y / length, -self.along_x / length

    def depth_and_width(self, xp: Namespace) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
        """Return the depth of the origin in the hull ``(batch,)`` and the least width of the hull ``(batch,)`` [m].

        The depth is the least distance of a supporting line from the origin over the normals of all pairs. The minimum
        over all directions is attained at the normal of the nearest edge, and the edges are among the pairs: the depth
        is exact where it is positive, which is inside the hull only. The same holds for the width.
        """
        real = self.length > 0
        across_x, across_y = self.normals(xp)
        heights = across_x[:, None, ...] * self.x + across_y[:, None, ...] * self.y
        highest, lowest = xp.max(heights, axis=1), xp.min(heights, axis=1)
        depth = xp.min(xp.where(real, xp.minimum(highest, -lowest), xp.inf), axis=0)
        width = xp.min(xp.where(real, highest - lowest, xp.inf), axis=0)
        spread = xp.any(real, axis=0)
        return xp.where(spread, depth, 0.0), xp.where(spread, width, 0.0)

    def nearest(self, xp: Namespace) -> tuple[Float[Array, "..."], Float[Array, "..."], Float[Array, "..."]]:
        """Return the nearest point of each segment to the origin: x, y and fraction along it ``(pairs, batch)``."""
        length2 = self.along_x * self.along_x + self.along_y * self.along_y
        length2 = xp.where(length2 > 0, length2, 1.0)
        fraction = xp.clip(-(self.start_x * self.along_x + self.start_y * self.along_y) / length2, 0.0, 1.0)
        return self.start_x + fraction * self.along_x, self.start_y + fraction * self.along_y, fraction


def columns_of(
    xp: Namespace, array: Shaped[Array, "..."], batch: tuple[int, ...], index: Index, *, tail: int
) -> Shaped[Array, "..."]:
    """Return a block of `array` with its last `tail` axes first, in reverse order, and a flat batch axis last.

    Parameters
    ----------
    xp : namespace
        The array library.
    array : array
        Batch axes, then `tail` more.
    batch : tuple of int
        The batch axes to which it broadcasts.
    index : tuple of slice
        The block; ignored for arrays of libraries other than NumPy.
    tail : int
        How many of the last axes are not batch axes.
    """
    if xp is np:
        return columns(array, index, block_shape(batch, index), tail=tail)
    rest = tuple(array.shape[array.ndim - tail :])
    flat = xp.reshape(xp.broadcast_to(array, (*batch, *rest)), (math.prod(batch), *rest))
    return xp.permute_dims(flat, tuple(range(tail, -1, -1)))


@lru_cache(maxsize=64)
def _pair_indices(n: int) -> tuple[Float[np.ndarray, "..."], Float[np.ndarray, "..."]]:
    first, second = np.triu_indices(n, k=0 if n == 1 else 1)
    return first, second
