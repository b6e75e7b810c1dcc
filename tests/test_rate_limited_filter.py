"""Rate-limited filter: bounds, smoothness, and an independent integration."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from tarsus.control.filters import RateLimitedFilter


def follow(goals, dts, **bounds):
    filter_ = RateLimitedFilter(**bounds)
    return np.array([filter_.step(goal, dt) for goal, dt in zip(goals, dts, strict=True)])


@given(st.integers(0, 2**32 - 1))
def test_circle_rate_and_change_of_rate_are_bounded_for_any_target(seed):
    rng = np.random.default_rng(seed)
    n = 400
    goals = rng.normal(size=(n, 2)) * 10.0 ** rng.integers(-3, 3, (n, 1))
    if seed % 2:  # bang-bang: as bad as it gets
        goals = np.repeat(rng.choice([-1.0, 1.0], (n // 20, 2)), 20, axis=0)
    goals[rng.random(n) < 0.05] = rng.choice([np.nan, np.inf, -np.inf], 2)
    dts = rng.uniform(0.001, 0.05, n)
    found = follow(goals.tolist(), dts.tolist(), radius=0.3, rate=0.2, frequency=8.0)
    assert np.hypot(*found.T).max() <= 0.3 + 1e-12
    moves = np.diff(found, axis=0, prepend=0.0)
    assert (np.hypot(*moves.T) <= 0.2 * dts + 1e-12).all()
    speeds = moves / dts[:, None]
    changes = np.abs(np.diff(speeds, axis=0)) / ((dts[1:] + dts[:-1]) / 2)[:, None]
    assert changes.max() <= 2 / math.e * 8.0 * 0.2 + 1e-9


def test_it_agrees_with_an_integration_for_any_ticks():
    goal, rate, w = (0.3, -0.1), 0.25, 6.0
    way = math.hypot(*goal)

    def motion(t, state):
        point = np.array(goal) * min(t * rate / way, 1.0)
        return [*state[2:], *(w * w * (point - state[:2]) - 2 * w * state[2:])]

    at = [0.4, 1.2, 3.0]
    want = solve_ivp(motion, (0, 3), [0] * 4, rtol=1e-10, atol=1e-12, max_step=0.01, t_eval=at).y[:2]
    for dt in (0.01, 0.05):
        found = np.array(follow([goal] * round(3 / dt), [dt] * round(3 / dt), radius=1.0, rate=rate, frequency=w))
        found = found[[round(t / dt) - 1 for t in at]].T
        # While the point runs, and long after, ticks don't matter; the tick in which it arrives spreads the arrival.
        np.testing.assert_allclose(found[:, [0, 2]], want[:, [0, 2]], rtol=0, atol=1e-6)
        np.testing.assert_allclose(found[:, 1], want[:, 1], rtol=0, atol=1e-6 if dt == 0.01 else 1e-3)
    np.testing.assert_allclose(found[:, 2], goal, rtol=0, atol=1e-4)


def test_it_decays_to_zero_and_ignores_invalid_ticks():
    filter_ = RateLimitedFilter(1.0, rate=1.0, frequency=10.0)
    assert filter_.step((0.0, 0.0), 0.01) == (0.0, 0.0)
    filter_.step((1.0, 1.0), 0.1)
    there = filter_.values
    for dt in (0.0, -1.0, math.nan, math.inf):
        assert filter_.step((0.5, 0.5), dt) == there != (0.0, 0.0)
    for _ in range(1000):
        filter_.step((0.0, 0.0), 0.01)
    assert filter_.values == (0.0, 0.0)
    far = RateLimitedFilter(0.5, rate=1.0, frequency=10.0)
    for _ in range(400):
        far.step((0.36, 0.48), 0.01)
    assert far.values == pytest.approx((0.3, 0.4))
    # One tick of a week is as good as many.
    assert filter_.step((0.6, 0.8), 1e6) == pytest.approx((0.6, 0.8), abs=1e-6)
