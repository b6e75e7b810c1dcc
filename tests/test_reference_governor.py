"""The governor against brute force: the lag integrated, the feet seen from the body at every moment."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from sample_gait_states import EARTH, FACING, moment_of
from sample_stances import polygon_radii, setup_of, velocity_limits_of
from tarsus.control.filters import CriticallyDamped, integral_factors
from tarsus.control.walk.reference_governor import FootPrediction
from tarsus.control.walk.state import integrate_twist
from tarsus.gait.foot_polygons import NORMALS

STANCE = 0.5
BANDWIDTH = 4 / STANCE
seeds = st.integers(0, 10**6)


def situation(seed, name="strider"):
    """Feet anywhere about their rest footholds, moving anyhow; a current target and a command."""
    rng = np.random.default_rng(seed)
    setup, limits = setup_of(name), velocity_limits_of(name)
    rest = limits.rest
    foot = rest * np.exp(1j * rng.uniform(-0.15, 0.15, 6)) + rng.uniform(-0.02, 0.02, (2, 6)).T @ [1, 1j]
    twist = CriticallyDamped(rng.uniform(-1, 1, 3) * [0.1, 0.1, 0.6], rng.uniform(-1, 1, 3) * [0.2, 0.2, 1.0])
    now = moment_of(setup, rest, foothold=EARTH + np.exp(1j * FACING) * foot, twist=twist)
    ends = np.tile([STANCE, STANCE / 2], 3) * rng.uniform(0.1, 1)
    given_as = {"begins": np.zeros(6), "ends": ends, "bounds": limits.bounds, "bandwidth": BANDWIDTH}
    return now, twist.value * rng.uniform(0, 1), rng.uniform(-1, 1, 3) * [0.4, 0.4, 2.0], given_as


def polygon_excess(now, targets, *, begins, ends, bounds, bandwidth):
    return FootPrediction.of(now, begins, ends, bandwidth).excess(targets, bounds)


def governed(now, current, command, *, begins, ends, bounds, bandwidth):
    return FootPrediction.of(now, begins, ends, bandwidth).governed_twist(current, command, bounds)


def worst(now, target, given_as):
    return polygon_excess(now, target[None], **given_as).max()


def settled(now, current, command, given_as):
    """The target after many ticks at this moment."""
    for _ in range(60):
        current = governed(now, current, command, **given_as)
        assert worst(now, current, given_as) <= 1e-9
    return current


def driven(now, target, times):
    """Origin and yaw at times by an integrator that takes the twist as it is, instead of a mean: ``(n,)`` each."""
    w = BANDWIDTH

    def change(_, state):
        v, a = state[:3], state[3:6]
        moved = np.exp(1j * state[8]) * (v[0] + 1j * v[1])
        return [*a, *(w * w * (target - v) - 2 * w * a), moved.real, moved.imag, v[2]]

    start = [*now.twist.value, *now.twist.rate, now.origin.real, now.origin.imag, now.yaw]
    found = solve_ivp(change, (0, times[-1]), start, t_eval=times, rtol=1e-9, atol=1e-11).y
    return found[6] + 1j * found[7], found[8]


@pytest.mark.parametrize("seed", range(12))
def test_feet_stay_within_their_polygons_under_what_is_allowed(seed):
    now, current, command, given_as = situation(seed)
    target = governed(now, current, command, **given_as)
    assert worst(now, np.zeros(3), given_as) < 0
    times = np.linspace(0, given_as["ends"].max(), 101)
    origin, yaw = driven(now, target, times)
    seen = (now.foothold - origin[:, None]) * np.exp(-1j * yaw)[:, None]
    over = (seen[..., None] * NORMALS.conj()).real - given_as["bounds"]
    down = times[:, None] <= given_as["ends"]
    # The walk that is reckoned with turns by the mean of its twist: that is less than a millimetre away.
    assert over[down].max() <= 1e-3


def test_without_turning_what_is_reckoned_is_what_happens():
    now, _, _, given_as = situation(3)
    now = now._replace(twist=CriticallyDamped(np.array([0.05, -0.04, 0.0]), np.array([0.1, 0.2, 0.0])))
    target = np.array([0.2, 0.1, 0.0])
    times = np.array([0.0, 0.5, 1.0]) * given_as["ends"][0]
    origin, yaw = driven(now, target, times)
    seen = (now.foothold[0] - origin) * np.exp(-1j * yaw)
    over = (seen[:, None] * NORMALS.conj()).real - given_as["bounds"][0]
    np.testing.assert_allclose(polygon_excess(now, target[None], **given_as)[0, :, 0], over, atol=1e-8)


@given(seeds, st.sampled_from(["strider", "phantomx", "freenove"]))
def test_what_is_allowed_works_and_two_percent_more_would_not(seed, name):
    now, current, command, given_as = situation(seed, name)
    if worst(now, current, given_as) > 1e-9:
        current = governed(now, current, command, **given_as)
    if worst(now, current, given_as) > 1e-9:
        assert worst(now, np.zeros(3), given_as) > 1e-9
        return
    target = settled(now, current, command, given_as)
    if (current == command).all():
        return
    way = command - current
    share = float((target - current) @ way / (way @ way))
    np.testing.assert_allclose(target, current + share * way, atol=1e-12)
    assert 0 <= share <= 1
    more = current + (share + 0.02) * way
    assert share == 1 or share + 0.02 > 1 or worst(now, more, given_as) > 0


@given(seeds, st.floats(0.001, 0.05))
def test_what_was_allowed_stays_allowed(seed, dt):
    now, current, command, given_as = situation(seed)
    target = governed(now, current, command, **given_as)
    if worst(now, target, given_as) > 1e-9:
        return
    twist, travel = now.twist.step_with_integral(target, dt, bandwidth=BANDWIDTH)
    origin, yaw = integrate_twist(now.origin, now.yaw, travel)
    later = now._replace(twist=twist, origin=origin, yaw=yaw)
    given_as = {**given_as, "ends": np.maximum(given_as["ends"] - dt, 0.0)}
    # What is left of a walk that turns differs a little from the walk as it was seen from its beginning.
    assert worst(later, target, given_as) <= 2e-4
    if not target[2] and not now.twist.value[2]:
        assert worst(later, target, given_as) <= 1e-9


def test_a_feasible_command_is_met_in_full():
    now, current, _, given_as = situation(1)
    command = np.array([0.01, 0.0, 0.0])
    assert governed(now, current, command, **given_as) is command


@pytest.mark.parametrize("heading", np.arange(8) * np.pi / 4)
def test_a_foot_at_its_edge_allows_no_step_further_out(heading):
    setup, limits = setup_of("strider"), velocity_limits_of("strider")
    # Leg 1 is as far back, seen along the heading, as it may be: the body stands still.
    way = np.exp(1j * heading)
    foot = limits.rest.copy()
    foot[1] -= way * polygon_radii(limits.bounds, limits.rest, np.array([-way]))[1, 0]
    now = moment_of(setup, limits.rest, foothold=EARTH + np.exp(1j * FACING) * foot)
    given_as = {"begins": np.zeros(6), "ends": np.full(6, STANCE), "bounds": limits.bounds, "bandwidth": BANDWIDTH}
    command = 0.1 * np.array([way.real, way.imag, 0.0])
    np.testing.assert_allclose(governed(now, np.zeros(3), command, **given_as), 0, atol=1e-6)
    assert governed(now, np.zeros(3), -command / 4, **given_as) @ -command > 0


def test_a_foot_that_is_outside_allows_what_takes_it_no_farther_out():
    setup, limits = setup_of("strider"), velocity_limits_of("strider")
    foot = limits.rest.copy()
    foot[0] -= 0.15
    now = moment_of(setup, limits.rest, foothold=EARTH + np.exp(1j * FACING) * foot)
    given_as = {"begins": np.zeros(6), "ends": np.full(6, STANCE), "bounds": limits.bounds, "bandwidth": BANDWIDTH}
    assert worst(now, np.zeros(3), given_as) > 0.01
    ahead, back = np.array([0.1, 0.0, 0.0]), np.array([-0.1, 0.0, 0.0])
    np.testing.assert_array_equal(governed(now, np.zeros(3), ahead, **given_as), 0)
    np.testing.assert_array_equal(governed(now, np.zeros(3), back, **given_as), back)


def test_a_foot_that_is_a_little_outside_before_it_lifts_off_does_not_stop_the_walk():
    setup, limits = setup_of("strider"), velocity_limits_of("strider")
    current, foot = np.array([0.1, 0.0, 0.0]), limits.rest.copy()
    foot[1] -= polygon_radii(limits.bounds, limits.rest, np.array([-1.0 + 0j]))[1, 0] - 0.001
    twist = CriticallyDamped.still(current)
    now = moment_of(setup, limits.rest, foothold=EARTH + np.exp(1j * FACING) * foot, twist=twist)
    given_as = {"begins": np.zeros(6), "bounds": limits.bounds, "bandwidth": BANDWIDTH}
    assert worst(now, np.zeros(3), {**given_as, "ends": np.full(6, 0.04)}) > 0.001
    kept = governed(now, current, current, ends=np.full(6, 0.04), **given_as)
    np.testing.assert_array_equal(kept, current)
    # One that stands for long stops it.
    assert governed(now, current, current, ends=np.full(6, STANCE), **given_as)[0] < 0.03


def test_where_the_current_target_does_not_work_any_more_as_much_less_as_does():
    setup, limits = setup_of("strider"), velocity_limits_of("strider")
    now = moment_of(setup, limits.rest, twist=CriticallyDamped.still(np.array([0.3, 0.0, 0.0])))
    given_as = {"begins": np.zeros(6), "ends": np.full(6, STANCE), "bounds": limits.bounds, "bandwidth": BANDWIDTH}
    current = np.array([0.5, 0.0, 0.0])
    assert worst(now, current, given_as) > 0.01
    found = governed(now, current, np.array([0.6, 0.1, 0.0]), **given_as)
    assert worst(now, found, given_as) <= 1e-9
    np.testing.assert_allclose(found, found[0] / current[0] * current)
    found = settled(now, found, 1.2 * current, given_as)
    assert worst(now, 1.02 * found, given_as) > 0
    assert 0 < found[0] < 0.5


@pytest.mark.parametrize("current", [(0.5, 0.0, 0.0), (0.0, 0.0, 0.0), (-0.2, 0.0, 0.0)])
def test_where_not_even_stopping_keeps_the_feet_inside_it_does_not_go_on_as_it_was(current):
    setup, limits = setup_of("strider"), velocity_limits_of("strider")
    now = moment_of(setup, limits.rest, twist=CriticallyDamped.still(np.array([3.0, 0.0, 0.0])))
    given_as = {"begins": np.zeros(6), "ends": np.full(6, STANCE), "bounds": limits.bounds, "bandwidth": BANDWIDTH}
    assert worst(now, np.zeros(3), given_as) > 0.1
    current = np.array(current)
    found = governed(now, current, np.array([0.6, 0.0, 0.0]), **given_as)
    assert worst(now, found, given_as) <= worst(now, current, given_as)
    assert (np.abs(found) <= np.abs(current)).all()


def test_each_foot_is_looked_at_from_when_to_when_it_is_down():
    now, _, _, given_as = situation(2)
    target = np.array([0.1, 0.0, 0.2])
    begins = np.stack([np.zeros(6), given_as["ends"] / 2])
    ends = np.stack([given_as["ends"], given_as["ends"]])
    both = polygon_excess(now, target[None], **{**given_as, "begins": begins, "ends": ends})
    assert both.shape == (2, 1, 3, 6, 16)
    whole = polygon_excess(now, target[None], **given_as)
    np.testing.assert_allclose(both[0], whole)
    np.testing.assert_allclose(both[1].reshape(3, 6, 16)[0], whole.reshape(3, 6, 16)[1])


def test_a_turn_that_cancels_the_smallest_angle_is_no_division_by_zero():
    now, _, _, given_as = situation(1)
    now = now._replace(twist=CriticallyDamped.still(np.zeros(3)))
    straight = np.array([0.1, 0.0, 0.0])
    expected = polygon_excess(now, straight[None], **given_as)
    # Half the angle of the whole stance is then exactly -1e-30 rad.
    moments = given_as["ends"] - given_as["begins"]
    for time in moments:
        of_target = integral_factors(np.array(time), bandwidth=BANDWIDTH)[0]
        turning = np.array([0.1, 0.0, -2e-30 / float(of_target)])
        np.testing.assert_allclose(polygon_excess(now, turning[None], **given_as), expected, atol=1e-12)
