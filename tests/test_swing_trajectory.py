"""Swing trajectories: boundary conditions, continuity when the target moves, and the stop after early contact."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tarsus.gait.swing import swing_position
from tarsus.gait.swing_trajectory import quintic, swinging_height

number = st.floats(-1, 1)
state = st.tuples(number, number, number)


@given(state, number, st.floats(0.05, 1))
def test_a_quintic_keeps_its_state_at_first_and_ends_at_the_target_at_rest(start, target, remaining):
    assert quintic(start, target, remaining, 0.0) == pytest.approx(start)
    assert quintic(start, target, remaining, 1.0) == pytest.approx((target, 0.0, 0.0), abs=1e-10)


@given(state, number, st.floats(0.2, 1), st.floats(0.1, 0.9))
def test_advancing_in_two_steps_equals_one(start, target, remaining, fraction):
    half = quintic(start, target, remaining, fraction / 2)
    # The second step covers the same part of a remainder that has become smaller.
    rest = remaining * (1 - fraction / 2)
    twice = quintic(half, target, rest, (fraction / 2) / (1 - fraction / 2))
    assert twice == pytest.approx(quintic(start, target, remaining, fraction), abs=1e-9)


def test_from_rest_it_is_the_planned_swing():
    fractions = np.linspace(0, 1, 11)
    planned = swing_position(np.array([0.1, -0.2, 0.01]), np.array([0.25, -0.1, 0.03]), fractions, 0.04)
    found = quintic((complex(0.1, -0.2), 0j, 0j), complex(0.25, -0.1), 1.0, fractions)[0]
    np.testing.assert_allclose(found, planned[:, 0] + 1j * planned[:, 1], atol=1e-15)
    heights = [swinging_height(x, start=0.01, ground=0.03, swing_height=0.04) for x in fractions.tolist()]
    np.testing.assert_allclose(heights, planned[:, 2], atol=1e-15)
