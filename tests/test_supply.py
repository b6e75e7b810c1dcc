"""Supply current, battery life and coinciding peaks, for prescribed torques."""

import math
from dataclasses import replace

import numpy as np
import pytest

from sample_loads import sample_loads
from tarsus.errors import InputError
from tarsus.load.supply import supply_load
from tarsus.robot.servo import Servo


def with_torques(torques, **changes):
    """The strider's walk with torques ``(n, legs)`` in its femur joints, on servos of 2 N m and 4 A at 6 V."""
    found = sample_loads(**changes)
    servo = Servo(name="S", stall_torque=2.0, torque_at=6.0, stall_current=4.0)
    full = np.zeros_like(found.torques)
    full[:, :, 1] = torques
    return replace(found, robot=found.robot.replace(servos=((servo,) * 3,) * 6), torques=full)


def samples():
    return len(sample_loads().motion.time)


def test_current_is_proportional_to_torque_up_to_the_stall_current():
    drawn = supply_load(with_torques(np.array([0.5, -0.5, 1.0, 0.0, 2.0, 3.0])))
    np.testing.assert_allclose(drawn.current, 1 + 1 + 2 + 0 + 4 + 4)
    assert drawn.peak_current == pytest.approx(12)
    assert drawn.mean_current == pytest.approx(12)
    assert drawn.unknown == ()


def test_voltage_changes_the_stall_current_only():
    torques = np.array([0.5, 0, 0, 0, 0, 0.0])
    assert supply_load(with_torques(torques, supply=12.0)).peak_current == pytest.approx(1)
    assert supply_load(with_torques(torques * 20, supply=12.0)).peak_current == pytest.approx(8)
    assert supply_load(with_torques(torques * 20)).peak_current == pytest.approx(4)


def test_a_supply_too_high_for_the_ratings_leaves_the_current_without_its_limit():
    found = with_torques(np.array([0.5, 0, 0, 0, 0, 0.0]), supply=12.0)
    servo = replace(found.robot.servos[0][0], supply=(4.8, 6.0))
    rated = replace(found, robot=found.robot.replace(servos=((servo,) * 3,) * 6))
    assert np.isnan(rated.stall_torque).all()
    assert supply_load(rated).peak_current == pytest.approx(1)


def test_battery_life_is_capacity_over_mean_current():
    ramp = np.linspace(0, 2, samples())[:, None] * np.eye(6)[0]
    drawn = supply_load(with_torques(ramp), capacity=3.0)
    assert drawn.mean_current == pytest.approx(2.0)
    assert drawn.battery_time == pytest.approx(3.0 / 2.0 * 3600)
    assert supply_load(with_torques(ramp)).battery_time is None
    assert supply_load(with_torques(np.zeros(6)), capacity=3.0).battery_time == math.inf


def test_unknown_stall_current():
    drawn = supply_load(sample_loads(), capacity=3.0)
    assert drawn.unknown == ("DS3225",)
    assert (drawn.current, drawn.peak_current, drawn.mean_current, drawn.battery_time) == (None,) * 4
    found = sample_loads("burnt-mg996r")
    rows = [list(row) for row in found.robot.servos]
    rows[0][0] = None
    some = supply_load(replace(found, robot=found.robot.replace(servos=rows)))
    assert some.unknown == ("a joint without a servo",)
    assert some.current is None


def test_current_of_an_overloaded_robot():
    drawn = supply_load(sample_loads("burnt-mg996r"))
    found = sample_loads("burnt-mg996r")
    expected = (np.minimum(np.abs(found.torques), 1.079) * 2.5 / 1.079).sum((1, 2))
    np.testing.assert_allclose(drawn.current, expected)


def test_coinciding_peaks_give_a_warning():
    n = samples()
    torques = np.full((n, 6), 0.1)
    torques[7, :3] = 1.0
    torques[9, 3] = 1.5
    torques[11, 4:] = 1.2
    drawn = supply_load(with_torques(torques))
    assert drawn.peak_legs == ("LF", "LM", "LR")
    assert drawn.peak_time == sample_loads().motion.time[7]
    peaks = "the peak loads of 3 legs (LF LM LR) coincide, 6.6 A in total"
    assert f"at {drawn.peak_time:.2f} s {peaks}" in drawn.warning
    torques[7, 0] = 0.5
    torques[3, 0] = 1.0
    apart = supply_load(with_torques(torques))
    assert len(apart.peak_legs) == 2
    assert apart.warning is None


def test_warning_without_known_currents():
    found = with_torques(np.full((samples(), 6), 0.5))
    unknown = replace(found, robot=found.robot.replace(servos=((Servo(name="S", stall_torque=2.0),) * 3,) * 6))
    assert "coincide: if the supply cannot deliver it" in supply_load(unknown).warning


def test_unloaded_legs_have_no_peak():
    assert supply_load(with_torques(np.zeros(6))).peak_legs == ()


@pytest.mark.parametrize("capacity", [0.0, -1.0, math.nan, math.inf])
def test_invalid_capacity(capacity):
    with pytest.raises(InputError, match="capacity is"):
        supply_load(sample_loads(), capacity=capacity)
