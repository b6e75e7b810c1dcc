"""The lag against SciPy's exponential, quadrature and its own promises."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp
from scipy.linalg import expm

from tarsus.control.filters import CriticallyDamped, integral_factors

# Greatest rate over bandwidth and half the range of the targets.
PEAK_RATE = 2 / math.e
small = st.floats(-2, 2)
bandwidths = st.floats(0.3, 30)


def lag(value, rate):
    return CriticallyDamped(np.array([value]), np.array([rate]))


def travelled(start, target, time, *, bandwidth):
    """The integral of the value over a time with a constant target, from the factors."""
    of_target, of_value, of_rate = integral_factors(time, bandwidth=bandwidth)
    return target * of_target + start.value * of_value + start.rate * of_rate


@given(small, small, small, st.floats(0, 3), bandwidths)
def test_a_step_and_its_travel_are_the_exponential_of_the_linear_system(value, rate, target, dt, w):
    # State: integral, value, rate, and 1.
    system = np.array([[0, 1, 0, 0], [0, 0, 1, 0], [0, -w * w, -2 * w, w * w * target], [0, 0, 0, 0]])
    integral, there, speed, _ = expm(system * dt) @ [0, value, rate, 1]
    after = lag(value, rate).step(np.array([target]), dt, bandwidth=w)
    scale = 1 + abs(rate) + w
    assert after.value[0] == pytest.approx(there, abs=1e-10 * scale)
    assert after.rate[0] == pytest.approx(speed, abs=1e-10 * scale * scale)
    travel = travelled(lag(value, rate), np.array([target]), dt, bandwidth=w)
    assert travel[0] == pytest.approx(integral, abs=1e-10 * scale)


@given(small, small, small, st.floats(1e-3, 1), bandwidths)
def test_to_go_is_to_step_and_to_travel(value, rate, target, dt, w):
    start, goal = CriticallyDamped(np.array([value, 0.3]), np.array([rate, 0.0])), np.array([target, -0.2])
    after, travel = start.step_with_integral(goal, dt, bandwidth=w)
    expected = start.step(goal, dt, bandwidth=w)
    np.testing.assert_allclose(after.value, expected.value, atol=1e-13)
    np.testing.assert_allclose(after.rate, expected.rate, atol=1e-12 * (1 + w))
    np.testing.assert_allclose(travel, travelled(start, goal, dt, bandwidth=w), atol=1e-13 * (1 + 1 / w))


def test_the_step_solves_its_differential_equation():
    w, target, start = 5.0, 0.7, [-0.3, 2.0]

    def change(_, state):
        return [state[1], w * w * (target - state[0]) - 2 * w * state[1]]

    found = solve_ivp(change, (0, 1), start, rtol=1e-10, atol=1e-12)
    after = lag(*start).step(np.array([target]), 1.0, bandwidth=w)
    np.testing.assert_allclose([after.value[0], after.rate[0]], found.y[:, -1], atol=1e-8)


def test_travel_is_the_integral_of_the_value():
    start, target = lag(0.4, -3.0), np.array([-1.0])
    for time in (1e-3, 0.1, 2.0):
        area, _ = quad(lambda t: start.step(target, t, bandwidth=4.0).value[0], 0, time, epsabs=1e-12)
        assert travelled(start, target, time, bandwidth=4.0)[0] == pytest.approx(area, abs=1e-11)


def test_factors_of_an_array_of_times_are_those_of_each():
    times = np.array([[0.0, 0.3], [1.0, 7.0]])
    together = integral_factors(times, bandwidth=3.0)
    for index, time in np.ndenumerate(times):
        np.testing.assert_allclose(
            [f[index] for f in together], integral_factors(float(time), bandwidth=3.0), atol=1e-15
        )


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(0.001, 0.5)), min_size=1, max_size=12), bandwidths)
def test_it_stays_between_its_targets_and_its_rates_below_what_is_said(targets, w):
    now = CriticallyDamped.still(np.array([0.0]))
    for target, time in targets:
        for share in np.linspace(0, 1, 9):
            here = now.step(np.array([target]), share * time, bandwidth=w)
            assert abs(here.value[0]) <= 1 + 1e-12
            assert abs(here.rate[0]) <= PEAK_RATE * w + 1e-9
            bend = w * w * (target - here.value[0]) - 2 * w * here.rate[0]
            assert abs(bend) <= 2 * (1 + math.exp(-2)) * w * w + 1e-9
        now = here


@given(st.lists(st.tuples(st.floats(0, 2 * math.pi), st.floats(0.01, 1)), min_size=1, max_size=10))
def test_a_value_of_the_plane_stays_in_the_hull_of_its_targets(targets):
    # In a half plane that holds the start and all targets, for every half plane of a bundle.
    points = np.array([[math.cos(a), math.sin(a)] for a, _ in targets] + [[0.0, 0.0]])
    normals = np.stack([np.cos(np.arange(24) * np.pi / 12), np.sin(np.arange(24) * np.pi / 12)])
    bounds = (points @ normals).max(axis=0)
    now = CriticallyDamped.still(np.zeros(2))
    for point, (_, time) in zip(points, targets, strict=False):
        now = now.step(point, time, bandwidth=6.0)
        assert (now.value @ normals <= bounds + 1e-12).all()


def test_the_peak_rate_is_reached_by_a_step_from_one_end_to_the_other():
    w = 7.0
    now = lag(-1.0, 0.0).step(np.array([1.0]), 1 / w, bandwidth=w)
    assert now.rate[0] == pytest.approx(PEAK_RATE * w, rel=1e-12)


@given(small, small, small, st.floats(0, 1), st.floats(0, 1), bandwidths)
def test_two_steps_are_one(value, rate, target, first, second, w):
    target = np.array([target])
    at_once = lag(value, rate).step(target, first + second, bandwidth=w)
    in_two = lag(value, rate).step(target, first, bandwidth=w).step(target, second, bandwidth=w)
    np.testing.assert_allclose(at_once.value, in_two.value, atol=1e-12 * (1 + w))
    np.testing.assert_allclose(at_once.rate, in_two.rate, atol=1e-11 * (1 + w) ** 2)


def test_a_lag_at_rest_on_its_target_stays_there():
    still = CriticallyDamped.still(np.array([0.3, -2.0]))
    after = still.step(still.value, 5.0, bandwidth=2.0)
    np.testing.assert_array_equal(after.value, still.value)
    np.testing.assert_array_equal(after.rate, 0.0)
