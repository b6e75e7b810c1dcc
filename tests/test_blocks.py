"""Batches cut into blocks: all of it, once, no block too large, and columns that are the block transposed."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tarsus import blocks

shapes = st.lists(st.integers(0, 7), max_size=4).map(tuple)


@given(shape=shapes, size=st.integers(1, 30))
def test_blocks_cover_every_item_once_and_are_small(shape, size):
    count = np.zeros(shape, dtype=int)
    for index in blocks.batch_blocks(shape, size):
        block = blocks.block_shape(shape, index)
        assert count[index].shape == block
        assert math.prod(block) <= size
        count[index] += 1
    assert (count == 1).all()


@given(shape=st.lists(st.integers(1, 5), min_size=1, max_size=3).map(tuple), size=st.integers(1, 10), data=st.data())
def test_columns_are_the_block_transposed(shape, size, data):
    own = tuple(data.draw(st.sampled_from([1, n])) for n in shape)[data.draw(st.integers(0, len(shape))) :]
    array = np.arange(math.prod(own) * 6.0).reshape(*own, 2, 3)
    whole = np.broadcast_to(array, (*shape, 2, 3))
    for index in blocks.batch_blocks(shape, size):
        block = blocks.block_shape(shape, index)
        found = blocks.columns(array, index, block, tail=2)
        expected = whole[index].reshape(-1, 2, 3).T
        assert found.shape in (expected.shape, (3, 2, 1))
        assert np.array_equal(np.broadcast_to(found, expected.shape), expected)
        assert found.flags.c_contiguous
