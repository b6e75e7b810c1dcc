"""Blocks of large NumPy batches that fit in the cache, with contiguous items."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tarsus.arrays import Array

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["BLOCK", "SMALL", "Index", "batch_blocks", "block_shape", "columns"]

Index: TypeAlias = tuple[slice, ...]

BLOCK = 32768
"""Legs per block: a dozen arrays of this many doubles fit in the cache, and the number of calls is small."""

SMALL = 1024
"""Size of an array below which blocks cost more than they save."""


def batch_blocks(shape: tuple[int, ...], size: int) -> Iterator[Index]:
    """Yield the indices of blocks of a batch of at most `size` items each.

    Parameters
    ----------
    shape : tuple of int
        The batch axes.
    size : int
        Greatest number of items in a block; at least 1.
    """
    if math.prod(shape) <= size:
        yield (slice(None),) * len(shape)
        return
    row = math.prod(shape[1:])
    if row > size:
        for i in range(shape[0]):
            for rest in batch_blocks(shape[1:], size):
                yield (slice(i, i + 1), *rest)
        return
    step = size // row
    for start in range(0, shape[0], step):
        yield (slice(start, start + step), *(slice(None),) * (len(shape) - 1))


def block_shape(shape: tuple[int, ...], index: Index) -> tuple[int, ...]:
    """Return the batch axes of a block.

    Parameters
    ----------
    shape : tuple of int
        The batch axes.
    index : tuple of slice
        The block, from `batch_blocks`.
    """
    return tuple(len(range(*part.indices(n))) for part, n in zip(index, shape, strict=True))


def columns(array: Shaped[Array, "..."], index: Index, block: tuple[int, ...], *, tail: int) -> Shaped[Array, "..."]:
    """Return the part of a NumPy array that belongs to a block, transposed so that the block is the last axis.

    An operation on ``(legs, block)`` runs over thousands of contiguous numbers; on ``(block, legs)``, with values of
    the robot ``(legs,)`` broadcast, over the legs only: a third of the speed (measured).

    Parameters
    ----------
    array : array
        Batch axes, then `tail` more.
    index : tuple of slice
        The block, from `batch_blocks`.
    block : tuple of int
        Shape of the block.
    tail : int
        Number of last axes that are not batch axes.

    Returns
    -------
    array
        The last axes in reverse order, then an axis of the length of the block, or of 1 where the array is constant.
    """
    own = array.ndim - tail
    rest = array.shape[own:]
    part = array
    if own and index:
        where = index[len(index) - own :]
        part = array[tuple(slice(None) if n == 1 else cut for n, cut in zip(array.shape, where, strict=False))]
    if math.prod(part.shape[:own]) != 1:
        part = np.broadcast_to(part, (*block, *rest))
    return np.ascontiguousarray(part.reshape(-1, *rest).T)
