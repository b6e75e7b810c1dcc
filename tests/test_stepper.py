"""How a moment of the walk goes on: against the steady cycle, half steps, and what a swing promises."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from gait_robots import HEXAPOD_GAITS, PRESETS
from sample_gait_states import EARTH, FACING, begun, moment_of, rest_of, step_inputs_of
from sample_stances import setup_of
from tarsus.control.filters import CriticallyDamped
from tarsus.control.pose.posture_feedback import PostureRates
from tarsus.control.walk.felt_feet import FeltFoot, FeltInputs, GroundUnder
from tarsus.control.walk.foothold import final_footholds
from tarsus.control.walk.state import POSITION_TOLERANCE, integrate_twist
from tarsus.control.walk.stepper import TARGET_FREEZE, advance
from tarsus.control.walk.vertical_motion import moved_vertically
from tarsus.gait.cycle import cycle_feet
from tarsus.gait.stance.stance_geometry import with_sway
from tarsus.kinematics.pose import Pose

TWISTS = [(0.08, 0.0, 0.0), (0.0, -0.06, 0.0), (0.05, 0.02, 0.3), (0.0, 0.0, -0.5)]
every_walk = pytest.mark.parametrize(
    ("name", "gait"), [(n, "tripod") for n in PRESETS] + [("strider", g) for g in HEXAPOD_GAITS]
)


def walked(now, inputs, seconds, dt):
    for _ in range(round(seconds / dt)):
        now = advance(now, inputs, dt)
    return now


def seen(now, swing_height):
    feet = (now.foot - now.origin) * np.exp(-1j * now.yaw)
    return np.stack([feet.real, feet.imag, now.heights(swing_height)], axis=-1)


@every_walk
def test_a_constant_twist_comes_to_the_steady_cycle(name, gait):
    setup = setup_of(name, gait)
    rest = rest_of(name)
    for twist in TWISTS[-2:] if name != "strider" else TWISTS:
        inputs = step_inputs_of(setup, rest, twist)
        now = walked(begun(setup, rest), inputs, 9.0, 0.03)
        for _ in range(12):
            now = advance(now, inputs, 0.093)
            stride = np.array(twist) * setup.gait.duty_factor
            phase = np.array([now.clock])
            expected, down = cycle_feet(
                setup.gait, setup.rest, stride, swing_height=np.asarray(setup.swing_height), phases=phase
            )
            np.testing.assert_allclose(seen(now, setup.swing_height), expected[0], atol=1e-9)
            np.testing.assert_array_equal(now.down, down[0])


@pytest.mark.parametrize("twist", TWISTS)
def test_a_step_is_two_half_steps_where_nothing_begins_or_ends(twist):
    setup, rest = setup_of("strider", "ripple"), rest_of("strider")
    inputs = step_inputs_of(setup, rest, twist)
    now, compared = walked(begun(setup, rest), inputs, 6.0, 0.01), 0
    for _ in range(100):
        whole, halves = advance(now, inputs, 0.01), walked(now, inputs, 0.01, 0.005)
        if (whole.down == now.down).all():
            compared += 1
            for one, other in zip(whole[:13], halves[:13], strict=True):
                np.testing.assert_allclose(one, other, atol=1e-9)
            np.testing.assert_allclose(whole.origin, halves.origin, atol=1e-9)
        now = whole
    assert compared > 80


def test_the_body_goes_where_its_twist_takes_it_half_step_by_half_step():
    setup, rest = setup_of("strider"), rest_of("strider")
    inputs = step_inputs_of(setup, rest, (0.1, 0.05, 0.0))
    now = begun(setup, rest)
    whole, halves = advance(now, inputs, 0.02), walked(now, inputs, 0.02, 0.01)
    assert whole.origin == pytest.approx(halves.origin, abs=1e-14)
    np.testing.assert_allclose(whole.twist.value, halves.twist.value, atol=1e-14)
    np.testing.assert_allclose(whole.posture.value, halves.posture.value, atol=1e-14)


@settings(max_examples=15)
@given(st.integers(0, 10**6), st.floats(0.003, 0.05))
def test_a_swing_lands_exactly_on_its_target_and_gently(seed, dt):
    rng = np.random.default_rng(seed)
    setup, rest = setup_of("strider"), rest_of("strider")
    now = begun(setup, rest)
    landings = 0
    for tick in range(round(1.5 / dt)):
        if tick % 7 == 0:
            inputs = step_inputs_of(setup, rest, rng.uniform(-1, 1, 3) * [0.1, 0.1, 0.4])
        after = advance(now, inputs, dt)
        landed = after.down & ~now.down
        landings += landed.sum()
        np.testing.assert_array_equal(after.foot[landed], after.foothold[landed])
        assert not after.swing_velocity[landed].any()
        assert not after.swing_acceleration[landed].any()
        np.testing.assert_array_equal(np.array(after.heights(setup.swing_height))[after.down], 0.0)
        # Standing feet stand, and what is bound for somewhere late in its swing stays bound for it.
        still = now.down & after.down
        np.testing.assert_array_equal(after.foot[still], now.foot[still])
        late = ~now.down & (now.swing_phase > TARGET_FREEZE)
        np.testing.assert_array_equal(after.foothold[late], now.foothold[late])
        assert np.isfinite(after.foot).all()
        now = after
    assert landings >= 6


def test_a_foot_comes_down_ever_slower():
    setup, rest = setup_of("strider"), rest_of("strider")
    inputs = step_inputs_of(setup, rest, (0.1, 0.0, 0.2))
    now = walked(begun(setup, rest), inputs, 2.0, 0.01)
    fine, speeds = 1e-4, []
    while not (~now.down & (now.swing_phase > 0.98)).any():
        now = advance(now, inputs, fine * 10)
    leg = int(np.flatnonzero(~now.down)[0])
    while not now.down[leg]:
        after = advance(now, inputs, fine)
        speeds.append(abs(after.foot[leg] - now.foot[leg]) / fine)
        now = after
    assert all(later <= earlier + 1e-9 for earlier, later in itertools.pairwise(speeds))
    assert speeds[-1] < 1e-3


def test_ticks_longer_than_a_swing_land_the_foot_where_shorter_ones_do():
    setup, rest = setup_of("strider", "wave"), rest_of("strider")
    inputs = step_inputs_of(setup, rest, (0.04, 0.0, 0.0), frequency=4.0)
    now = walked(begun(setup, rest), inputs, 6.0, 0.005)
    swing = (1 - setup.gait.duty_factor) / 4.0
    at_once, slowly = advance(now, inputs, 1.2 * swing), walked(now, inputs, 1.2 * swing, 0.02 * swing)
    both = at_once.down & slowly.down & (at_once.step_number == slowly.step_number)
    assert both.any()
    np.testing.assert_allclose(at_once.foot[both], slowly.foot[both], atol=1e-9)


def arrays_of(value):
    if isinstance(value, np.ndarray):
        return [value]
    return [a for part in value for a in arrays_of(part)] if isinstance(value, tuple) else []


@pytest.mark.parametrize("twist", [(0.1, 0.0, 0.3), (0.0, 0.0, 0.0)])
def test_the_given_state_is_not_changed(twist):
    setup, rest = setup_of("strider"), rest_of("strider")
    now = walked(begun(setup, rest), step_inputs_of(setup, rest, (0.1, 0.0, 0.3)), 0.7, 0.01)
    inputs = step_inputs_of(setup, rest, twist)
    for _ in range(150):
        for array in arrays_of(now) + [a for a in inputs if isinstance(a, np.ndarray)]:
            array.setflags(write=False)
        before = [array.copy() for array in arrays_of(now)]
        after = advance(now, inputs, 0.01)
        for old, new in zip(before, arrays_of(now), strict=True):
            np.testing.assert_array_equal(old, new)
        now = after


@pytest.mark.parametrize("gait", HEXAPOD_GAITS)
def test_stopping_ends_at_rest_with_every_foot_at_its_rest_foothold(gait):
    setup, rest = setup_of("strider", gait), rest_of("strider")
    now = walked(begun(setup, rest), step_inputs_of(setup, rest, (0.05, 0.02, 0.2)), 3.13, 0.01)
    stop = step_inputs_of(setup, rest, (0.0, 0.0, 0.0))
    assert final_footholds(now, rest=stop.rest, bandwidth=stop.bandwidth) is None
    now = walked(now, stop, 8.0, 0.01)
    assert now.down.all()
    assert not now.twist.value.any()
    expected = now.origin + np.exp(1j * now.yaw) * rest
    assert np.abs(now.foot - expected).max() <= POSITION_TOLERANCE
    np.testing.assert_allclose(final_footholds(now, rest=stop.rest, bandwidth=stop.bandwidth), expected)
    # And there it stays: no foot is lifted that is there already.
    later = walked(now, stop, 2.0, 0.01)
    np.testing.assert_array_equal(later.foot, now.foot)
    assert later.down.all()


def test_legs_that_may_not_lift_miss_their_steps_and_go_on_in_order():
    setup, rest = setup_of("strider"), rest_of("strider")
    begin = begun(setup, rest)
    now = walked(begin, step_inputs_of(setup, rest, (0.02, 0.0, 0.0), excluded=(1,)), 2.25, 0.01)
    assert now.foot[1] == begin.foot[1]
    assert now.step_number[1] > begin.step_number[1]
    assert abs(now.foot[3] - begin.foot[3]) > 0.01
    again = walked(now, step_inputs_of(setup, rest, (0.02, 0.0, 0.0)), 2.0, 0.01)
    assert abs(again.foot[1] - begin.foot[1]) > 0.01


def test_a_robot_whose_clock_stands_moves_its_body_only():
    setup, rest = setup_of("strider"), rest_of("strider")
    now = moment_of(setup, rest)
    posture = now.posture.value + 0.01
    after = advance(now, step_inputs_of(setup, rest, (0, 0, 0), frequency=0.0, posture=posture), 0.1)
    assert after.clock == now.clock
    np.testing.assert_array_equal(after.foot, now.foot)
    expected = now.posture.step(posture, 0.1, bandwidth=4.0)
    np.testing.assert_allclose(after.posture.value, expected.value)


@given(st.floats(-3, 3), st.floats(-1, 1), st.floats(-1, 1), st.floats(-4, 4))
def test_a_travel_is_the_exponential_of_its_displacement(yaw, x, y, angle):
    origin, facing = integrate_twist(0.4 - 0.1j, yaw, np.array([x, y, angle]))
    start = Pose.from_rpy(0, 0, yaw, (0.4, -0.1, 0.0))
    here = np.eye(3)
    here[:2, :2], here[:2, 2] = start.rotation[:2, :2], start.position[:2]
    there = here @ expm(np.array([[0, -angle, x], [angle, 0, y], [0, 0, 0]]))
    assert origin == pytest.approx(complex(*there[:2, 2]), abs=1e-12)
    assert facing == yaw + angle


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-7, 1e-5, 0.3, -2.0, np.pi, 2 * np.pi])
def test_a_travel_that_hardly_turns_is_as_exact_as_any(angle):
    origin, _ = integrate_twist(0j, 0.0, (1.0, 0.0, angle))
    assert origin == pytest.approx(np.exp(0.5j * angle) * np.sinc(angle / (2 * np.pi)), abs=1e-15)


def test_final_rest_is_where_the_lag_leaves_the_body():
    setup, rest = setup_of("strider"), rest_of("strider")
    now = moment_of(
        setup, rest, twist=CriticallyDamped(np.array([0.005, -0.003, 0.008]), np.array([0.02, 0.01, -0.03]))
    )
    stop = step_inputs_of(setup, rest, (0, 0, 0), frequency=0.0)
    expected = final_footholds(now, rest=stop.rest, bandwidth=stop.bandwidth)
    end = walked(now, stop, 6.0, 0.05)
    np.testing.assert_allclose(end.origin + np.exp(1j * end.yaw) * rest, expected, atol=1e-5)
    assert now.origin == EARTH
    assert now.yaw == FACING


def test_a_sway_is_within_its_amplitudes_and_takes_each_of_them():
    amplitude = np.array([0.01, 0.02, 0.0, 0.05, 0.06, 0.0])
    row = np.array([0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.03, *amplitude])
    seen = np.array([with_sway(row, clock, 2 * clock) for clock in np.linspace(0, 1, 401)]) - row[:7]
    np.testing.assert_allclose(np.abs(seen[:, :6]).max(axis=0), amplitude, atol=1e-9)
    assert not seen[:, 6].any()
    np.testing.assert_array_equal(with_sway(np.array([*row[:7], *np.zeros(6)]), 0.3, 0.6), row[:7])


def test_what_a_foot_has_given_way_is_part_of_its_swing():
    setup, rest = setup_of("strider"), rest_of("strider")
    given = np.linspace(-0.004, 0.006, len(rest))
    now = begun(setup, rest)
    now = now._replace(admittance_offset=CriticallyDamped(given, np.zeros(len(rest))))
    inputs = step_inputs_of(setup, rest, (0.05, 0.0, 0.0), admittance_offset=given)
    after = advance(now, inputs, 1e-6)
    assert not after.down.all()
    before, later = (np.array(m.heights(setup.swing_height)) + m.admittance_offset.value for m in (now, after))
    np.testing.assert_allclose(later, before, atol=1e-9)
    assert not after.admittance_offset.value[~after.down].any()


def test_a_foot_that_was_put_down_in_the_air_and_has_not_stood_rises_as_it_lifts_off_again():
    setup, rest = setup_of("strider"), rest_of("strider")
    now = begun(setup, rest)
    now = now._replace(felt=[FeltFoot(speed=-0.1, top=0.05)] * len(rest), ground_height=np.full(len(rest), 0.02))
    under = [GroundUnder(0.0, lowest=-0.05, highest=0.1)] * len(rest)
    stands, steps = [False] * len(rest), [True] * len(rest)
    felt = FeltInputs(under, stands, steps, 0.0, PostureRates(), 0j, 0.0, 0j, 0.8, 1.0, 0.03, 0.4, 0.0, {})
    inputs = step_inputs_of(setup, rest, (0.05, 0.0, 0.0), felt=felt)
    for _ in range(18):
        now = moved_vertically(advance(now, inputs, 0.01), inputs, 0.01)
    assert 0 < now.down.sum() < len(rest)
    assert (now.ground_height[~now.down] > 0.035).all()
    assert (now.ground_height[now.down] < 0.01).all()
