import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import quad

from tarsus.gait.gait import Gait
from tarsus.gait.timing import BodyClock, least_step_fraction, plan_steps

rates = st.floats(1e-3, 5)
ramps = st.floats(0.05, 4)
gaits = st.builds(Gait, st.floats(0.1, 0.95), st.lists(st.floats(0, 0.999), min_size=1, max_size=8).map(tuple))


def walk(gait, *, strokes, cycle_time):
    """The steps of a walk of so many strokes."""
    clock = BodyClock.of(rate=1 / (strokes * gait.duty_factor * cycle_time), ramp=cycle_time)
    return plan_steps(gait, clock, cycle_time=cycle_time, least_step=least_step_fraction(strokes))


@given(rates, ramps)
def test_body_progress_is_monotonic_from_0_to_1(rate, ramp):
    clock = BodyClock.of(rate=rate, ramp=ramp)
    time = np.linspace(-ramp, clock.duration + ramp, 3001)
    share = clock.fraction(time)
    assert (share[time <= 0] == 0).all()
    assert (share[time >= clock.duration] == 1).all()
    assert (np.diff(share) >= -1e-14).all()
    assert clock.rate <= rate * (1 + 1e-12)
    # Nowhere faster than cruising: what keeps stances within half a stroke.
    assert (np.diff(share) <= clock.rate * np.diff(time) * (1 + 1e-9) + 1e-13).all()


@given(rates, ramps)
def test_fraction_is_the_integral_of_the_quintic_ramp(rate, ramp):
    clock = BodyClock.of(rate=rate, ramp=ramp)
    for s in (0.1, 0.5, 0.9, 1.0):
        way = quad(lambda u: clock.rate * ramp * (10 * u**3 - 15 * u**4 + 6 * u**5), 0, s, epsabs=1e-14)[0]
        assert clock.fraction(s * ramp) == pytest.approx(way, abs=1e-12)
        assert clock.fraction(clock.duration - s * ramp) == pytest.approx(1 - way, abs=1e-12)


def test_a_path_shorter_than_two_ramps_is_walked_more_slowly():
    clock = BodyClock.of(rate=2.0, ramp=1.0)
    assert (clock.rate, clock.cruise, clock.duration) == (1.0, 0.0, 2.0)
    assert clock.fraction(1.0) == 0.5


def test_speed_and_acceleration_are_continuous():
    clock = BodyClock.of(rate=0.3, ramp=0.8)
    for step in (1e-2, 5e-3):
        time = np.arange(-0.5, clock.duration + 0.5, step)
        jerk = np.diff(clock.fraction(time), n=3) / step**3
        # A jump of the acceleration would let this grow with 1 / step; the quintic's own bound is 10 rate / ramp^2.
        assert np.abs(jerk).max() < 10.1 * clock.rate / clock.ramp**2


@given(gaits, st.floats(0.01, 30), st.floats(0.1, 5))
def test_footholds_are_those_of_the_body_at_mid_stance(gait, strokes, cycle_time):
    steps = walk(gait, strokes=strokes, cycle_time=cycle_time)
    for number in range(-3, 40):
        shares = steps.foothold_fraction(np.array([number]))
        for leg, offset in enumerate(gait.offsets):
            share = float(steps.clock.fraction((number + offset + gait.duty_factor / 2) * cycle_time))
            if share < steps.least_step:
                share = 0.0
            elif share > 1 - steps.least_step:
                share = 1.0
            assert shares[..., leg] == pytest.approx(share, abs=1e-12)


@given(gaits, st.floats(0.01, 30), st.floats(0.1, 5))
def test_start_and_end_are_the_first_lift_off_and_the_last_touchdown(gait, strokes, cycle_time):
    steps = walk(gait, strokes=strokes, cycle_time=cycle_time)
    time = np.linspace(-3 * cycle_time, steps.clock.duration + 3 * cycle_time, 4001)
    last, following, swung, stance = steps.at(time)
    moving = (~stance).any(-1) | ((steps.clock.fraction(time) > 0) & (steps.clock.fraction(time) < 1))
    resolution = time[1] - time[0]
    assert steps.start >= -cycle_time
    assert not moving[(time < steps.start - 1e-6) | (time > steps.end + 1e-6)].any()
    if (1 - gait.duty_factor) * cycle_time > 2 * resolution:
        assert time[moving][0] <= steps.start + resolution + 1e-6
        assert time[moving][-1] >= steps.end - 2 * resolution  # the body's last motion is below rounding
    assert ((swung >= 0) & (swung <= 1 + 1e-9)).all()
    assert (swung[stance] == 0).all()
    assert (last[time < steps.start - 1e-6] == 0).all()
    assert (following[time > steps.end + 1e-6] == 1).all()


@given(gaits, st.floats(0.5, 30))
def test_no_stance_exceeds_half_a_stroke_on_either_side(gait, strokes):
    steps = walk(gait, strokes=strokes, cycle_time=1.0)
    time = np.linspace(steps.start, steps.end, 3001)
    last, _, _, stance = steps.at(time)
    excursion = np.abs(last - steps.clock.fraction(time)[:, None])[stance] * strokes
    assert excursion.max() <= 0.5 + 1e-9


@given(gaits)
def test_steps_shorter_than_a_twentieth_of_a_stroke_are_omitted(gait):
    strokes = 7.3
    steps = walk(gait, strokes=strokes, cycle_time=1.0)
    numbers = np.arange(-3, 30)[:, None]
    shares = steps.foothold_fraction(numbers)
    lengths = np.diff(shares, axis=0) * strokes
    assume((lengths > 0).any())
    assert lengths[lengths > 0].min() >= 0.05 - 1e-12
    assert shares.min() == 0
    assert shares.max() == 1


def test_at_most_a_quarter_of_a_short_path_is_omitted():
    assert least_step_fraction(10.0) == pytest.approx(0.005)
    assert least_step_fraction(1e-6) == 0.25
