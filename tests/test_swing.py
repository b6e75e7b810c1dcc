import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tarsus.gait.swing import horizontal_profile, swing_position, vertical_profile

START, END = np.array([0.1, -0.2, 0.0]), np.array([0.25, -0.1, 0.0])


@given(st.integers(0, 2**32 - 1), st.floats(0, 0.2))
def test_a_swing_starts_and_ends_at_its_footholds(seed, swing_height):
    start, end = np.random.default_rng(seed).uniform(-1, 1, (2, 6, 3))
    np.testing.assert_array_equal(swing_position(start, end, np.zeros(6), swing_height), start)
    np.testing.assert_allclose(swing_position(start, end, np.ones(6), swing_height), end, atol=1e-15)


def test_a_swing_is_highest_at_mid_swing():
    share = np.linspace(0, 1, 1001)
    path = swing_position(START, END, share, 0.03)
    assert path[500, 2] == 0.03
    assert path[:, 2].max() == 0.03
    assert (path[1:-1, 2] > 0).all()
    np.testing.assert_allclose(path[500, :2], (START + END)[:2] / 2, atol=1e-16)


def test_a_swing_is_symmetric_in_time():
    share = np.linspace(0, 1, 101)
    np.testing.assert_allclose(
        swing_position(START, END, share, 0.03), swing_position(END, START, 1 - share, 0.03), atol=1e-16
    )


def test_a_swing_is_horizontally_straight_and_monotonic():
    path = swing_position(START, END, np.linspace(0, 1, 201), 0.03)
    steps = np.diff(path[:, :2], axis=0)
    way = (END - START)[:2]
    assert (steps @ way > 0).all()
    np.testing.assert_allclose(steps[:, 0] * way[1] - steps[:, 1] * way[0], 0, atol=1e-17)


@pytest.mark.parametrize("end", [0, 1])
@pytest.mark.parametrize("profile", [horizontal_profile, vertical_profile])
def test_velocity_and_acceleration_vanish_at_both_ends(profile, end):
    """Near an end the profile grows with the cube of the time: order 3, so that two derivatives are 0 there."""
    inward = 1 - 2 * end
    steps = 0.02 / 2.0 ** np.arange(5)
    away = np.abs(profile(end + inward * steps) - profile(float(end)))
    order = np.log2(away[:-1] / away[1:])
    np.testing.assert_allclose(order, 3, atol=0.1)
    assert abs(order[-1] - 3) < abs(order[0] - 3)


def test_the_profiles_derivatives_by_automatic_differentiation():
    for profile in (horizontal_profile, vertical_profile):
        for end in (0.0, 1.0):
            assert jax.grad(profile)(end) == 0
            assert jax.grad(jax.grad(profile))(end) == pytest.approx(0, abs=1e-12)
        assert abs(jax.grad(jax.grad(jax.grad(profile)))(0.0)) > 1


@pytest.mark.parametrize("library", [jnp, array_api_strict], ids=["jax", "strict"])
def test_every_array_library_gives_the_same(library):
    share = np.linspace(0, 1, 11)
    expected = swing_position(START, END, share, 0.03)
    for i in range(4):
        args = [START, END, share, np.asarray(0.03)]
        args[i] = library.asarray(args[i])
        result = swing_position(*args)
        assert not isinstance(result, np.ndarray)
        np.testing.assert_allclose(np.asarray(result), expected, atol=1e-16)


def test_the_swing_height_may_be_traced():
    height = jax.jit(lambda swing_height: swing_position(START, END, np.array(0.25), swing_height)[2])
    assert jax.grad(height)(0.05) == pytest.approx(0.75**3)
