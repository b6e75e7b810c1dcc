"""Early contact: feet stop as soon as their joints can, within acceleration limits."""

import numpy as np
import pytest

from gait_robots import PRESETS
from sample_gait_states import begun, rest_of, setup_of, step_inputs_of
from tarsus.control.filters import CriticallyDamped
from tarsus.control.terrain.early_contact import relaxed_rate, stop_on_contact
from tarsus.control.walk.joint_solver import JointSolver
from tarsus.control.walk.state import EARLY_STOP_FRACTION
from tarsus.control.walk.stepper import advance
from tarsus.robot.joint_limits import joint_limits

DT = 5e-4


def falling(name, share, frequency):
    """A walking state with some feet in the last part of their swing."""
    setup, rest = setup_of(name), rest_of(name)
    inputs = step_inputs_of(setup, rest, (0.05, 0.02, 0.1), frequency=frequency)
    now = begun(setup, rest)
    for _ in range(20_000):
        now = advance(now, inputs, DT)
        if now.clock > 1.5 and (~now.down & (now.swing_phase > share)).any():
            return setup, inputs, now
    raise AssertionError("no foot came so far")


def met(setup, inputs, now):
    """The state in which all swinging feet have early contact, and which of them can stop."""
    _, acceleration = joint_limits(setup.robot, None, None)
    rate = inputs.frequency / (1 - setup.gait.duty_factor - now.lift_delay)
    after = stop_on_contact(setup.robot, now, ~now.down, acceleration=acceleration, swing_rate=rate)
    stops = np.isfinite(after.contact_phase)
    assert not stops[now.down].any()
    return after, stops


@pytest.mark.lengthy
@pytest.mark.parametrize("share", [0.55, 0.75, 0.9])
@pytest.mark.parametrize("name", PRESETS)
def test_stops_keep_to_the_acceleration_limits(name, share):
    setup, inputs, now = falling(name, share, 0.8)
    after, stops = met(setup, inputs, now)
    assert stops.any()
    _, acceleration = joint_limits(setup.robot, None, None)
    solver = JointSolver(setup.robot)
    before = advance(now, inputs, -DT)
    angles, heights = [solver.angles(before), solver.angles(after)], [after.height(setup.swing_height)]
    while not after.down[stops].all():
        after = advance(after, inputs, DT)
        angles.append(solver.angles(after))
        heights.append(after.height(setup.swing_height))
    rate = np.diff(angles, axis=0) / DT
    # Nothing jumps as it is met.
    assert np.abs(rate[1] - rate[0])[stops].max() < 0.1
    bend = np.abs(np.diff(rate[1:], axis=0)) / DT / acceleration
    assert bend[:-1][:, stops].max() <= 1.0
    assert (np.diff(np.array(heights), axis=0)[:, stops] <= 1e-12).all()
    np.testing.assert_allclose(heights[-1][stops], after.ground_height[stops], atol=1e-12)
    # No foot sinks lower than it was bound for anyway.
    assert (after.ground_height[stops] >= now.ground_height[stops] - 1e-9).all()


def test_the_duration_of_a_stop_grows_with_speed_and_the_fastest_feet_do_not_stop():
    gives, sunk = [], []
    for frequency in (0.3, 0.8, 1.2, 3.0):
        setup, inputs, now = falling("strider", 0.75, frequency)
        after, stops = met(setup, inputs, now)
        gives.append(after.stop_phase[stops].max(initial=0.0))
        sunk.append((now.height(setup.swing_height) - after.ground_height)[~now.down].max())
    assert gives[0] == pytest.approx(EARLY_STOP_FRACTION)
    assert gives == [*sorted(gives[:3]), 0.0]
    assert gives[2] > EARLY_STOP_FRACTION
    assert (np.diff(sunk) > -1e-4).all()
    assert sunk[2] > 1.2 * sunk[0]


def test_demanding_swings_slow_scaled_time_down():
    setup, rest = setup_of("strider"), rest_of("strider")
    duty_factor = setup.gait.duty_factor
    swing = 1 - duty_factor
    now = begun(setup, rest)
    assert relaxed_rate(now, duty_factor) == 1
    up = now._replace(down=np.arange(6) > 0)
    assert relaxed_rate(up, duty_factor) == 1
    late = up._replace(lift_delay=np.full(6, swing / 2))
    lower = up._replace(ground_height=np.full(6, -setup.swing_height))
    assert relaxed_rate(late, duty_factor) == pytest.approx((1.1 / 4) ** 0.5)
    assert relaxed_rate(lower, duty_factor) == pytest.approx((1.1 / 1.5) ** 0.5)
    # Of feet on the ground neither says anything.
    assert relaxed_rate(late._replace(down=np.ones(6, dtype=bool)), duty_factor) == 1
    # Without a lift there still is one.
    flat = up._replace(posture=CriticallyDamped.still(np.zeros(13)))
    assert relaxed_rate(flat, duty_factor) == 1
