"""Admittance control against the matrix exponential and an independent integration."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from tarsus.control.pose.admittance import Admittance, AdmittanceFilter
from tarsus.errors import InputError

PLAUSIBLE = {"mass": st.floats(0.05, 20), "damping": st.floats(0.1, 2000), "stiffness": st.floats(1, 1e5)}
admittances = st.builds(Admittance, **PLAUSIBLE)
critical = st.builds(
    lambda mass, w: Admittance(mass=mass, damping=2 * mass * w, stiffness=mass * w * w),
    st.sampled_from([0.5, 1.0, 2.0]),
    st.sampled_from([1.0, 8.0, 64.0]),
)
ticks = st.floats(1e-4, 10)


def matrix(a):
    return np.array([[0, 1], [-a.stiffness / a.mass, -a.damping / a.mass]])


@given(st.one_of(admittances, critical), ticks)
def test_transition_is_the_matrix_exponential(a, dt):
    scale = np.diag([a.frequency, 1.0])  # offset in units of speed, so that all four numbers are of a size
    want = scale @ expm(matrix(a) * dt) @ np.linalg.inv(scale)
    got = scale @ np.reshape(a.transition(dt), (2, 2)) @ np.linalg.inv(scale)
    # What expm itself loses grows with the fastest rate over the tick.
    np.testing.assert_allclose(got, want, rtol=0, atol=1e-12 * (1 + np.abs(matrix(a) * dt).max()))


def test_over_under_and_critical_damping_meet():
    w, dt = 7.0, 0.3
    exact = Admittance(mass=1.0, damping=2 * w, stiffness=w * w)
    assert exact.decay == exact.frequency
    for off in (1e-15, 1e-9, 1e-6):
        for side in (1 - off, 1 + off):
            near = Admittance(mass=1.0, damping=2 * w * side, stiffness=w * w)
            np.testing.assert_allclose(near.transition(dt), exact.transition(dt), rtol=0, atol=50 * off + 1e-14)


@given(st.one_of(admittances, critical), ticks, st.floats(-1e3, 1e3))
def test_ticks_of_any_length_give_the_same_motion(a, dt, force):
    once, often = AdmittanceFilter(a, 1), AdmittanceFilter(a, 1)
    once.step([force], dt)
    for _ in range(7):
        often.step([force], dt / 7)
    np.testing.assert_allclose(once.offsets, often.offsets, rtol=0, atol=1e-12)
    np.testing.assert_allclose(once.speeds, often.speeds, rtol=0, atol=1e-10)


@pytest.mark.parametrize("damping", [2.0, 40.0, 300.0])
def test_follows_an_independent_integration(damping):
    a = Admittance(mass=1.0, damping=damping, stiffness=400.0, travel=1.0)
    rng = np.random.default_rng(int(damping))
    feet, state = AdmittanceFilter(a, 2), np.zeros((2, 2))
    for dt in rng.uniform(0.001, 0.05, 40):
        forces = rng.normal(size=2) * 10
        got = feet.step(forces.tolist(), dt)
        for leg in range(2):
            state[leg] = solve_ivp(
                lambda _, s, f=forces[leg]: [s[1], (f - a.damping * s[1] - a.stiffness * s[0]) / a.mass],
                (0, dt),
                state[leg],
                rtol=1e-10,
                atol=1e-12,
            ).y[:, -1]
        np.testing.assert_allclose(got, state[:, 0], rtol=0, atol=1e-9)
        np.testing.assert_allclose(feet.speeds, state[:, 1], rtol=0, atol=1e-8)


def energy(a, feet):
    return 0.5 * a.mass * np.square(feet.speeds) + 0.5 * a.stiffness * np.square(feet.offsets)


@given(st.one_of(admittances, critical), st.integers(0, 2**32 - 1))
def test_passive(a, seed):
    """The filter is passive: it returns no more energy than the force puts in."""
    rng = np.random.default_rng(seed)
    feet = AdmittanceFilter(a, 3)
    for i, dt in enumerate(10.0 ** rng.uniform(-4, 0, 60)):
        forces = rng.uniform(-1, 1, 3) * a.max_force if i < 30 else np.zeros(3)
        stored, offsets = energy(a, feet), np.array(feet.offsets)
        feet.step(forces.tolist(), dt)
        given_ = forces * (np.array(feet.offsets) - offsets)
        size = stored.max() + a.stiffness * a.travel**2
        assert (energy(a, feet) - stored <= given_ + 1e-12 * size).all()


@given(st.one_of(admittances, critical), st.integers(0, 2**32 - 1))
def test_travel_is_bounded_for_any_force(a, seed):
    rng = np.random.default_rng(seed)
    feet = AdmittanceFilter(a, 2)
    square = a.frequency**2 - a.decay**2
    period = math.pi / math.sqrt(square) if square > 0 else 3 / a.frequency
    for i in range(60):
        swung = 1e9 * (-1) ** i  # foot 0 in resonance, foot 1 anyhow
        feet.step([swung, rng.normal() * 10.0 ** rng.integers(-2, 300)], period)
        assert max(map(abs, feet.offsets)) <= a.travel * (1 + 1e-9)
    if square > 0 and a.decay / math.sqrt(square) > 0.05:
        assert abs(feet.offsets[0]) == pytest.approx(a.travel, rel=1e-3)  # and no narrower than need be


def test_a_constant_force_leads_to_the_deflection_of_the_spring():
    feet = AdmittanceFilter(Admittance(mass=1.0, damping=40.0, stiffness=400.0), 6)
    for _ in range(1000):
        got = feet.step((4.0, -2.0, None, math.nan, 1e9, -math.inf), 0.01)
    np.testing.assert_allclose(got, [0.01, -0.005, 0, 0, 0.02, -0.02], rtol=0, atol=1e-12)
    for _ in range(1000):
        got = feet.step((None,) * 6, 0.01)
    np.testing.assert_allclose(got, 0, rtol=0, atol=1e-12)
    assert feet.step((1.0,) * 6, 0.0) == pytest.approx(got, abs=1e-15)
    with pytest.raises(ValueError, match="reshape"):
        feet.step((1.0,), 0.01)


@given(st.integers(0, 2**32 - 1))
def test_speed_is_continuous(seed):
    """For any force, the acceleration is bounded by force and spring."""
    rng = np.random.default_rng(seed)
    a = Admittance(mass=1.0, damping=40.0, stiffness=400.0)
    feet = AdmittanceFilter(a, 1)
    for _ in range(100):
        before, dt = feet.speeds[0], rng.uniform(0.001, 0.05)
        feet.step([rng.choice([-1e9, 0.0, 1e9, None])], dt)
        fastest = a.max_force / a.damping
        most = (a.max_force + a.stiffness * a.travel + a.damping * fastest) / a.mass
        assert abs(feet.speeds[0] - before) <= most * dt


def test_invalid_parameters_raise():
    good = {"mass": 1.0, "damping": 1.0, "stiffness": 1.0}
    for name in ("mass", "damping", "stiffness", "travel"):
        for value in (0.0, -1.0, math.nan, math.inf):
            with pytest.raises(InputError, match=f"admittance: {name} is {value:g}; it must be"):
                Admittance(**(good | {name: value}))
    with pytest.raises(InputError, match=r"stiffness is 1e\+300 for a mass of 1e-300 kg.*increase the mass"):
        Admittance(mass=1e-300, damping=1.0, stiffness=1e300)
    with pytest.raises(InputError, match=r"damping is 10.0 for a mass of 1e-06 kg: 5e\+06 rad/s"):
        Admittance(mass=1e-6, damping=10.0, stiffness=1.0)
    weak = AdmittanceFilter(Admittance(mass=1e300, damping=1e-300, stiffness=1e-300), 1)
    assert weak.step([1.0], 1.0) == pytest.approx([0.0], abs=1e-15)
