"""Swing monitor: legs that are stopped are found by the measured angles of their coxa joints, whatever the lag."""

import math
from collections import deque

import numpy as np
import pytest

import tarsus
from tarsus.control.readings import ValidReadings
from tarsus.control.sensing.swing_monitor import SwingMonitor

DT = 0.01
AIR = [False] * 6


def swung(time: float) -> float:
    """A joint that swings to and fro in 0.8 s, at 2.4 rad/s at most."""
    return 0.3 * math.sin(2 * math.pi * time / 0.8)


def monitored(lag: float, stops_at: float, *, until: float = 4.0, noise: float = 0.0, down=AIR):
    """Return when each leg has been found; joints follow after a lag, and that of leg 2 stops at a time."""
    monitor, found, random = SwingMonitor(), dict[int, float](), np.random.default_rng(0)
    for tick in range(round(until / DT)):
        time = tick * DT
        angles = [swung(time - lag)] * 6
        angles[2] = swung(min(time, stops_at) - lag)
        measured = [(angle + noise * random.standard_normal(), 0.0, 0.0) for angle in angles]
        for leg in monitor.step([swung(time)] * 6, ValidReadings(joint_angles=measured), DT, down):
            found.setdefault(leg, time)
    return found


@pytest.mark.parametrize("noise", [0.0, math.radians(0.3)])
@pytest.mark.parametrize("lag", [0.0, 0.013, 0.05, 0.1])
def test_a_leg_that_is_stopped_in_its_swing_is_noticed_within_30_ms_and_no_other_is(lag, noise):
    assert monitored(lag, math.inf, noise=noise) == {}
    # Stopped at full speed; the sensor tells of it after the lag.
    found = monitored(lag, 3.2, noise=noise)
    assert set(found) == {2}
    assert 0.0 < found[2] - 3.2 <= 0.03


@pytest.mark.parametrize(
    ("ticks", "within"),
    [
        ((10, 20, 20, 30, 50), 0.08),
        ((8, 16, 16, 24, 40), 0.07),
        ((8, 10, 12), 0.04),
        ((10,) * 30 + (100,), 0.12),
        ((5,), 0.03),
    ],
)
@pytest.mark.parametrize("stops_at", [math.inf, 5.6])
def test_ticks_of_any_lengths_stop_no_leg_that_follows_its_commands(ticks, within, stops_at):
    # Servos of 8 ms, commanded in steps that are on their way for 4 ms; leg 2 is stopped at full speed.
    monitor, random, found = SwingMonitor(), np.random.default_rng(0), dict[int, float]()
    offsets, angles, now = [0.13 * leg for leg in range(6)], [0.0] * 6, 0.0
    offsets[2] = 0.0
    before = sent = [0.0] * 6
    while now < 8.0:
        dt = int(random.choice(ticks)) / 1e3
        before, sent = sent, [swung(now + offset) for offset in offsets]
        for ms in range(round(1e3 * dt)):
            free = [leg for leg in range(6) if leg != 2 or now + ms / 1e3 < stops_at]
            for leg in free:
                angles[leg] += ((sent if ms >= 4 else before)[leg] - angles[leg]) / 8
        now += dt
        valid = ValidReadings(joint_angles=tuple((angle, 0.0, 0.0) for angle in angles))
        for leg in monitor.step(sent, valid, dt, AIR):
            found.setdefault(leg, now)
    assert set(found) == ({2} if stops_at < math.inf else set())
    assert all(0.0 < time - stops_at <= within for time in found.values())


def test_feet_that_stand_and_joints_that_are_not_measured_tell_nothing():
    assert monitored(0.02, 3.2, down=[True] * 6) == {}
    monitor = SwingMonitor()
    for tick in range(100):
        commanded = [swung(tick * DT)] * 6
        assert monitor.step(commanded, ValidReadings(), DT, AIR) == []
        assert monitor.step(commanded, ValidReadings(joint_angles=(None,) * 6), DT, AIR) == []


def test_the_noise_of_joint_angles_is_no_stop_as_a_walk_begins(monkeypatch):
    stopped, step = [], SwingMonitor.step
    monkeypatch.setattr(SwingMonitor, "step", lambda *args: stopped.append(found := step(*args)) or found)
    for seed in (3, 6, 9):
        controller, random = tarsus.WalkController(tarsus.load_robot("strider")), np.random.default_rng(seed)
        angles, speed = [controller.angles] * 4, 0.5 * controller.top_speed((1, 0, 0))
        for _ in range(100):
            measured = angles[-4] + math.radians(0.5) * random.standard_normal((6, 3))
            readings = tarsus.SensorReadings(joint_angles=measured, contacts=controller.contacts, attitude=(0.0, 0.0))
            angles.append(controller.step((speed, 0.0, 0.0), DT, readings))
    assert len(stopped) == 300
    assert not any(stopped)


def test_only_joints_that_have_been_measured_tell_of_a_stop():
    monitor, found = SwingMonitor(), dict[int, float]()
    for tick in range(400):
        time = tick * DT
        stopped = swung(min(time, 3.2) - 0.02)
        valid = ValidReadings(joint_angles=((stopped, 0.0, 0.0),) * 6, predicted=frozenset(range(6)) - {tick % 6})
        for leg in monitor.step([swung(time)] * 6, valid, DT, AIR):
            assert leg == tick % 6
            found.setdefault(leg, time)
    assert set(found) == set(range(6))
    assert all(3.2 < time <= 3.2 + 0.03 + 6 * DT for time in found.values())


def test_a_soft_servo_that_swings_about_its_command_is_not_stopped():
    # Inertia and a spring: it overshoots by a tenth of the way, and comes back.
    monitor, angle, speed, sent = SwingMonitor(), 0.0, 0.0, deque([0.0] * 3, maxlen=3)
    for tick in range(400):
        commanded = swung(tick * DT)
        sent.append(commanded)
        for _ in range(10):
            speed += DT / 10 * (3000.0 * (sent[0] - angle) - 60.0 * speed)
            angle += DT / 10 * speed
        valid = ValidReadings(joint_angles=((angle, 0.0, 0.0),) * 6)
        assert monitor.step([commanded] * 6, valid, DT, AIR) == []


@pytest.mark.parametrize("stops_at", [math.inf, 4.095])
def test_a_servo_that_is_started_suddenly_lags_and_is_not_stopped(stops_at):
    # After calm swings one begins with the speed that it would have had by then, as from the limit of a joint.
    monitor, found, sent, angle, speed = SwingMonitor(), math.inf, deque([0.0] * 3, maxlen=3), 0.0, 0.0
    for tick in range(440):
        time = tick * DT
        commanded = swung(time) if time < 3.8 else -0.3 if time < 4.0 else min(6.0 * (time - 4.0) - 0.3, 0.6)
        sent.append(commanded)
        for _ in range(10):
            change = (sent[0] - angle) / 0.02 - speed
            speed = (speed + min(max(change, -0.1), 0.1)) * (time < stops_at)
            angle += DT / 10 * speed
        valid = ValidReadings(joint_angles=((angle, 0.0, 0.0),) * 6)
        if monitor.step([commanded] * 6, valid, DT, AIR):
            found = min(found, time)
    assert found == stops_at or 0.0 < found - stops_at <= 0.03


@pytest.mark.parametrize("lag", [0.01, 0.03])
def test_a_leg_that_turns_around_before_its_lag_is_learnt_is_not_stopped(lag):
    # It is drawn back as a standing leg, and swings forward faster.
    def angle(time):
        return 0.2 - 0.5 * time if time < 0.2 else 0.1 + 20.0 * (time - 0.2) ** 2

    monitor = SwingMonitor()
    for tick in range(30):
        valid = ValidReadings(joint_angles=((angle(tick * DT - lag), 0.0, 0.0),) * 6)
        assert monitor.step([angle(tick * DT)] * 6, valid, DT, [tick < 20] * 6) == []


@pytest.mark.parametrize(("stops_at", "found"), [(math.inf, set()), (0.2, {0})])
def test_a_long_first_tick_counts_no_longer_than_up_to_the_lag(stops_at, found):
    # As long as the lag is not learnt, the longest one counts, which reaches back into the first tick.
    monitor, now, stopped = SwingMonitor(), 0.0, set[int]()
    for dt in (0.05, *[DT] * 40):
        now += dt
        measured = ((min(now, stops_at) - 0.12, 0.0, 0.0), *[(now - 0.12, 0.0, 0.0)] * 5)
        stopped |= set(monitor.step([now] * 6, ValidReadings(joint_angles=measured), dt, AIR))
    assert stopped == found
