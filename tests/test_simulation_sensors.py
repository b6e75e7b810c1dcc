"""Sensor suites: noise, bias, resolution, delay, rate, drop-outs and flips are as stated, and follow the seed."""

import math
import re

import numpy as np
import pytest

from tarsus.errors import InputError, UnknownNameError
from tarsus.simulation import FootSwitch, Sensor, SensorSuite
from tarsus.simulation.sensors.sampler import Sampler
from tarsus.simulation.sensors.suite import CHANNELS

ATTITUDE = np.array([0.1, -0.2])


def readings(suite, exact, *, ticks=200, seed=0):
    """Readings of values that are the same, or functions of the time, at 100 Hz."""

    def at(time):
        return {name: value(time) if callable(value) else value for name, value in exact.items()}

    sampler = Sampler(suite, at(0.0), seed=seed)
    return [sampler.read((tick + 1) / 100, at((tick + 1) / 100)) for tick in range(ticks)]


def ramp(time):
    return np.array([time, -time])


def test_an_exact_sensor_gives_what_is_there():
    for tick, each in enumerate(readings(SensorSuite(attitude=Sensor()), {"attitude": ramp}, ticks=5)):
        assert each.attitude == pytest.approx(ramp((tick + 1) / 100), abs=0)
        assert each.age == 0.0
        assert each.joint_angles is None


def test_noise_and_bias_have_their_standard_deviations():
    suite = SensorSuite(joint_angles=Sensor(noise=0.02, bias=0.5))
    found = np.array([each.joint_angles for each in readings(suite, {"joint_angles": np.zeros((60, 3))}, ticks=400)])
    assert found.std(axis=0).mean() == pytest.approx(0.02, rel=0.02)
    assert found.mean(axis=0).std() == pytest.approx(0.5, rel=0.1)


def test_resolution_rounds():
    suite = SensorSuite(attitude=Sensor(resolution=0.3))
    assert readings(suite, {"attitude": np.array([0.4, -0.5])}, ticks=1)[0].attitude == pytest.approx([0.3, -0.6])


def test_a_delayed_reading_has_its_age():
    found = readings(SensorSuite(attitude=Sensor(delay=0.03)), {"attitude": ramp}, ticks=10)
    assert [each.attitude[0] for each in found] == pytest.approx([0, 0, *np.arange(8) / 100], abs=1e-12)
    assert [each.age["attitude"] for each in found] == pytest.approx([0.01, 0.02, *[0.03] * 8])


def test_a_slow_sensor_repeats_its_reading_with_its_age():
    found = readings(SensorSuite(attitude=Sensor(rate=50.0)), {"attitude": ramp}, ticks=6)
    assert [each.attitude[0] for each in found] == pytest.approx([0, 0.02, 0.02, 0.04, 0.04, 0.06])
    assert [each.age if each.age == 0 else each.age["attitude"] for each in found] == pytest.approx(
        [0.01, 0, 0.01, 0, 0.01, 0]
    )


@pytest.mark.parametrize("rate", [99.0, 60.0, 30.0, 7.0])
def test_a_sensor_measures_at_its_rate_whatever_the_ticks(rate):
    found = readings(SensorSuite(attitude=Sensor(rate=rate)), {"attitude": ramp}, ticks=1000)
    times = {each.attitude[0] for each in found}
    assert len(times) == pytest.approx(10 * rate, abs=1.5)
    assert max(each.age["attitude"] for each in found if each.age) < 1 / rate


def test_a_lost_measurement_repeats_the_last_one():
    found = readings(SensorSuite(attitude=Sensor(dropout=0.2)), {"attitude": ramp}, ticks=1000)
    stale = [each for each in found if each.age != 0.0]
    assert len(stale) / 1000 == pytest.approx(0.2, abs=0.04)
    for tick, each in enumerate(found):
        age = each.age["attitude"] if each.age else 0.0
        assert each.attitude[0] == pytest.approx((tick + 1) / 100 - age)


def test_foot_switches_close_at_their_threshold_and_flip():
    forces = np.array([0.0, 0.9, 1.1, 5.0])
    exact = readings(SensorSuite(contacts=FootSwitch(threshold=1.0)), {"contacts": forces}, ticks=1)[0].contacts
    assert exact.tolist() == [False, False, True, True]
    noisy = readings(SensorSuite(contacts=FootSwitch(threshold=1.0, flips=0.1)), {"contacts": forces}, ticks=1000)
    wrong = np.mean([each.contacts != exact for each in noisy])
    assert wrong == pytest.approx(0.1, abs=0.02)


def test_the_same_seed_gives_the_same_readings():
    suite, exact = SensorSuite.named("hobby"), {"attitude": ATTITUDE, "angular_rates": np.zeros(3)}
    exact["contacts"] = np.ones(6)
    runs = [[each.attitude for each in readings(suite, exact, seed=seed)] for seed in (1, 1, 2)]
    assert np.array_equal(runs[0], runs[1])
    assert not np.array_equal(runs[0], runs[2])


def test_the_named_suites_measure_what_they_say():
    measured = {
        name: {channel for channel in CHANNELS if getattr(SensorSuite.named(name), channel)}
        for name in ("ideal", "camera", "hobby", "smart", "blind")
    }
    assert measured == {
        "ideal": set(CHANNELS) - {"ground"},
        "camera": set(CHANNELS),
        "hobby": {"contacts", "attitude", "angular_rates"},
        "smart": {"joint_angles", "joint_speeds", "torques"},
        "blind": set(),
    }
    with pytest.raises(UnknownNameError, match="Did you mean 'hobby'"):
        SensorSuite.named("hoby")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Sensor(noise=-1), "noise is -1; it must be a finite number, not negative"),
        (lambda: Sensor(bias=math.nan), "bias is nan"),
        (lambda: Sensor(resolution=math.inf), "resolution is inf"),
        (lambda: Sensor(delay=-0.1), "delay is -0.1 s"),
        (lambda: Sensor(rate=0), "rate is 0 1/s; it must be greater than 0"),
        (lambda: Sensor(dropout=1.0), "dropout is 1; it must be at least 0 and less than 1"),
        (lambda: FootSwitch(flips=math.nan), "flips is nan"),
        (lambda: FootSwitch(threshold=-1), "threshold is -1 N"),
    ],
)
def test_a_sensor_that_cannot_be_is_refused(make, message):
    with pytest.raises(InputError, match=re.escape(message)):
        make()
