"""Continued readings: what is missing, or given again, stands for what would be measured now."""

import math

import numpy as np
import pytest

import sensor_faults
import tarsus
from tarsus import SensorReadings
from tarsus.control.sensing.continued_readings import ContinuedReadings

STRIDER = tarsus.load_robot("strider")
DT, LAG = 0.01, 0.03
STILL = tarsus.WalkController(STRIDER).angles
PHASES = np.arange(18.0).reshape(6, 3)
GIVEN = {
    "joint_angles": STILL,
    "attitude": np.array([0.1, -0.2]),
    "angular_rates": np.array([0.0, 0.0, 0.3]),
    "forces": np.full((6, 3), 2.0),
    "torques": np.full((6, 3), 0.2),
}


def swung(time):
    """Joints that swing to and fro in 0.8 s, at 2.4 rad/s at most."""
    return STILL + 0.3 * np.sin(2 * math.pi * time / 0.8 + PHASES)


def all_at_once(tick):
    return np.full((6, 3), tick % 6 == 0)


def legs_in_turn(tick):
    return np.arange(6)[:, None] + np.zeros(3) == tick % 6


def servos_in_turn(tick):
    return (np.arange(18) + 4 * tick) % 18 < 4 if tick else np.ones(18, dtype=bool)


def lost(tick):
    return np.random.default_rng(tick).random((6, 3)) < 0.4


def errors(asked, *, delay=0.0, ticks=300, one_age=False, lag=LAG):
    """Return the greatest errors of continued joint angles and of those that are given, once they are known."""
    continued, found, angles, times = ContinuedReadings(STRIDER), [], swung(-LAG), np.zeros((6, 3))
    for tick in range(1, ticks):
        now = tick * DT
        new = np.reshape(asked(tick), (6, 3)) | (tick < 2)
        angles, times = np.where(new, swung(now - delay - LAG), angles), np.where(new, now - delay, times)
        age = now - times
        readings = SensorReadings(joint_angles=angles, age={"joint_angles": age.max() if one_age else age})
        measured = continued.step(readings, swung(now), DT, lag=lag + delay)
        true = swung(now - delay - LAG)
        if tick > 40:
            found.append((np.abs(np.array(measured.joint_angles) - true).max(), np.abs(angles - true).max()))
            assert measured.joint_age == pytest.approx(delay, abs=0.003)
            # Of a leg of which another joint is too old, nothing is new.
            assert measured.predicted >= set(np.flatnonzero(~new[:, 0]).tolist())
            assert age.max() > 0.1 or measured.predicted == set(np.flatnonzero(~new[:, 0]).tolist())
    return np.max(found, axis=0)


@pytest.mark.parametrize("delay", [0.0, 0.02])
@pytest.mark.parametrize("asked", [all_at_once, legs_in_turn, servos_in_turn])
def test_joints_that_are_not_measured_in_a_tick_are_where_they_would_be(asked, delay):
    predicted, given = errors(asked, delay=delay, one_age=asked is all_at_once)
    assert given > 0.08
    assert predicted < 0.008


def test_joints_whose_answers_are_lost_are_where_they_would_be():
    predicted, given = errors(lost)
    assert given > 0.1
    assert predicted < 0.008


def test_a_lag_that_is_not_known_well_matters_little():
    predicted, given = errors(legs_in_turn, lag=0.0)
    assert predicted < 0.5 * given


@pytest.mark.parametrize("age", [0.0, 0.02, {"joint_angles": 0.04}])
def test_angles_that_are_measured_in_each_tick_are_left_as_they_are(age):
    continued = ContinuedReadings(STRIDER)
    for tick in range(30):
        readings = SensorReadings(joint_angles=swung(tick * DT), age=age)
        assert continued.step(readings, swung(tick * DT), DT, lag=LAG) == continued.valid
    assert continued.valid.predicted == frozenset()


def test_ages_that_vary_by_less_than_a_tick_are_those_of_new_angles():
    continued, random = ContinuedReadings(STRIDER), np.random.default_rng(0)
    for tick in range(100):
        age = 0.02 + 0.004 * random.random()
        measured = continued.step(SensorReadings(joint_angles=swung(tick * DT), age=age), STILL, DT, lag=LAG)
        assert measured.predicted == frozenset()
        assert measured.joint_angles == continued.valid.joint_angles


def test_angles_that_are_later_from_some_time_on_are_new_after_some_seconds():
    continued = ContinuedReadings(STRIDER)
    for tick in range(400):
        readings = SensorReadings(joint_angles=STILL, age=0.01 if tick < 100 else 0.06)
        measured = continued.step(readings, STILL, DT, lag=LAG)
        assert bool(measured.predicted) == (100 <= tick < 325)


def test_what_a_joint_is_off_by_stays_until_it_is_measured_again():
    continued = ContinuedReadings(STRIDER)
    for tick in range(30):
        command, last = STILL + 0.02 * tick, min(tick, 24)
        angles = STILL + np.where(np.arange(6)[:, None] == 2, 0.1, 0.02 * last)
        readings = SensorReadings(joint_angles=angles, age=(tick - last) * DT)
        measured = continued.step(readings, command, DT, lag=0.0)
        assert measured.joint_angles[1] == pytest.approx(tuple(command[1]), abs=0.003)
    assert measured.joint_angles[2] == pytest.approx(tuple(angles[2] + 5 * 0.02), abs=0.003)
    measured = continued.step(SensorReadings(joint_angles=angles), command, DT, lag=0.0)
    assert measured.joint_angles[2] == tuple(angles[2])


@pytest.mark.parametrize("name", GIVEN)
def test_a_channel_that_is_missing_stays_for_a_tenth_of_a_second(name):
    continued = ContinuedReadings(STRIDER)
    first = continued.step(SensorReadings(**GIVEN), STILL, DT, lag=LAG)
    some = SensorReadings(**{other: value for other, value in GIVEN.items() if other != name})
    for readings in [some, None, SensorReadings(), some] * 2 + [some] * 2:
        assert getattr(continued.step(readings, STILL, DT, lag=LAG), name) == getattr(first, name)
    for _ in range(3):
        found = continued.step(some, STILL, DT, lag=LAG)
        assert getattr(found, name) is getattr(continued.valid, name) is None
    # It counts again at once, and for as long.
    for readings in [SensorReadings(**GIVEN), *[some] * 10]:
        assert getattr(continued.step(readings, STILL, DT, lag=LAG), name) == getattr(first, name)
    assert getattr(continued.step(some, STILL, DT, lag=LAG), name) is None


def test_contacts_that_are_missing_are_not_known():
    continued = ContinuedReadings(STRIDER)
    assert continued.step(SensorReadings(contacts=[True] * 6), STILL, DT, lag=LAG).contacts == (True,) * 6
    assert continued.step(SensorReadings(contacts=[True, None] * 3), STILL, DT, lag=LAG).contacts == (True, None) * 3
    assert continued.step(SensorReadings(), STILL, DT, lag=LAG).contacts is None


def test_a_leg_whose_readings_are_rejected_moves_on_as_commanded_for_a_tenth_of_a_second():
    continued = ContinuedReadings(STRIDER)
    bad = [[math.nan] * 3, *STILL.tolist()[1:]]
    for tick in range(20):
        command = STILL + 0.02 * tick
        readings = SensorReadings(joint_angles=bad if tick > 5 else STILL, torques=STILL)
        measured = continued.step(readings, command, DT, lag=0.0)
        known = measured.joint_angles[0]
        if tick > 15:
            assert known is None
        else:
            assert known == pytest.approx(tuple(STILL[0] + 0.02 * max(tick - 5, 0)))
        assert measured.joint_angles[1] == tuple(STILL[1])
        assert 1 not in measured.predicted
    assert continued.valid.joint_angles[0] is None


def test_a_leg_that_has_never_been_measured_is_unknown():
    continued = ContinuedReadings(STRIDER)
    ages = np.zeros((6, 3))
    ages[3, 1] = math.nan
    for _ in range(5):
        readings = SensorReadings(joint_angles=STILL, age={"joint_angles": ages})
        measured = continued.step(readings, STILL, DT, lag=LAG)
        known = [tuple(leg) for leg in STILL.tolist()]
        assert measured.joint_angles == (*known[:3], None, *known[4:])
        assert measured.joint_age == 0.0


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("name", "ground", "fault"),
    [
        ("strider", "blocks40", "joint angles of one leg in each tick"),
        ("strider", "flat", "joint angles measured 16 times a second"),
        ("phantomx", "blocks40", "30 % of readings lost and the last given again"),
    ],
)
def test_a_robot_with_stiff_servos_walks_on_with_joint_angles_of_earlier_ticks(name, ground, fault):
    # Before these were continued, it made 0.57, 0.74 and 0.85.
    way, tilt = sensor_faults.walk(name, ground, fault, 0, servos="ideal")
    assert way > 0.92
    assert tilt < 1.5
