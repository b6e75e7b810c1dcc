"""Large NumPy batches are worked through in blocks that fit the cache, their items side by side."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TypeAlias

import numpy as np

from tarsus.arrays import Array

__all__ = ["BLOCK", "SMALL", "Index", "batch_blocks", "block_shape", "columns"]

Index: TypeAlias = tuple[slice, ...]

BLOCK = 32768
"""Legs worked through at a time: a dozen arrays of this many doubles stay in the cache, and calls are few."""

SMALL = 1024
"""Numbers in an array below which cutting it into blocks costs more than it saves."""


def batch_blocks(shape: tuple[int, ...], size: int) -> Iterator[Index]:
    """Cut a batch into blocks of at most `size` items, yielding the index of each.

    Parameters
    ----------
    shape : tuple of int
        The batch axes.
    size : int
        Most items in a block; at least 1.
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


def columns(array: Array, index: Index, block: tuple[int, ...], *, tail: int) -> Array:
    """Return what a block needs of a NumPy array, transposed: the block's items side by side in the last axis.

    An operation on ``(legs, block)`` runs over thousands of neighbouring numbers at a time; on ``(block, legs)``,
    with the robot's numbers ``(legs,)`` broadcast, only over the legs: measured, a third of the speed.

    Parameters
    ----------
    array : array
        Batch axes, then `tail` more.
    index : tuple of slice
        The block, from `batch_blocks`.
    block : tuple of int
        The block's shape.
    tail : int
        How many of the last axes are not batch axes.

    Returns
    -------
    array
        The last axes in reverse order, then one of the block's length, or of 1 where the array is the same
        throughout.
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
