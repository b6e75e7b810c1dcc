"""What counts as a fault of servos: answers, motion, telemetry."""

import math

import numpy as np
import pytest

import tarsus
from tarsus.errors import CorruptAnswerError, NoAnswerError
from tarsus.hardware import ManualClock, SupplySettings, Telemetry, nominal_calibration
from tarsus.hardware.plant.fault import FaultKind
from tarsus.hardware.plant.joint_map import JointMap
from tarsus.hardware.plant.monitor import ServoMonitor
from tarsus.hardware.plant.pacer import Pacer
from tarsus.hardware.plant.settings import PlantSettings

STRIDER = tarsus.load_robot("strider")
SUPPLY = SupplySettings(voltage=7.4, least_voltage=6.0)


def monitor(supply=SUPPLY, robot=STRIDER):
    made = nominal_calibration(robot, "strider", kind="feetech-sts").replace(supply=supply)
    return ServoMonitor(made, JointMap(made), PlantSettings())


def no_answer(number, kind=NoAnswerError):
    return kind("feetech-sts", "memory", id=number, expected="an answer", received="nothing", remedy="Look.")


def test_a_silent_servo_is_a_fault_after_some_time_and_answers():
    watch = monitor()
    asked = range(1, 19)
    answered = [number for number in asked if number != 7]
    assert watch.answered("main", asked, answered, [no_answer(7)], 0.0) is None
    assert watch.answered("main", asked, answered, [no_answer(7)], 0.03) is None
    assert watch.answered("main", asked, asked, [], 0.035) is None
    assert watch.answered("main", asked, answered, [no_answer(7, CorruptAnswerError)], 0.04) is None
    assert watch.answered("main", asked, answered, [no_answer(7, CorruptAnswerError)], 0.05) is None
    fault = watch.answered("main", asked, answered, [no_answer(7, CorruptAnswerError)], 0.1)
    assert (fault.kind, fault.joint, fault.leg, fault.number) == (FaultKind.CORRUPT, "rear left coxa", 2, 0)
    assert "3 answers in a row failed, none for 65 ms: nothing" in fault.text
    # Errors of what was not asked, and of no servo, are none of a joint.
    assert watch.answered("main", [1, 2], [1], [no_answer(None), no_answer(9)], 0.1) is None


def test_a_computer_that_is_late_itself_waits_longer():
    watch = monitor()
    asked = range(1, 19)
    watch.grace = 0.2
    errors = [no_answer(number) for number in asked]
    assert watch.answered("main", asked, asked, [], 0.0) is None
    for time in (0.02, 0.1, 0.25):
        assert watch.answered("main", asked, [], errors, time) is None
    assert watch.answered("main", asked, [], errors, 0.27).kind is FaultKind.BROWN_OUT


def test_a_pause_without_requests_is_no_silence():
    watch = monitor()
    asked = range(1, 19)
    assert watch.answered("main", asked, asked, [], 0.0) is None
    assert watch.answered("main", asked, range(2, 19), [no_answer(1)], 1.0) is None
    assert watch.answered("main", asked, range(2, 19), [no_answer(1)], 1.02) is None
    assert watch.answered("main", asked, range(2, 19), [no_answer(1)], 1.035).kind is FaultKind.NO_ANSWER
    assert watch.answered("main", asked, asked, [], 2.0) is None
    errors = [no_answer(number) for number in asked]
    assert watch.answered("main", asked, [], errors, 3.0) is None
    assert watch.answered("main", asked, [], errors, 3.02) is None
    assert watch.answered("main", asked, [], errors, 3.035).kind is FaultKind.BROWN_OUT


def test_a_silent_bus_is_a_brown_out_with_the_last_voltage():
    watch = monitor()
    asked = range(1, 19)
    assert watch.answered("main", asked, asked, [], 0.0) is None
    errors = [no_answer(number) for number in asked]
    assert watch.answered("main", asked, [], errors, 0.02) is None
    assert watch.answered("main", asked, [], errors, 0.04) is None
    fault = watch.answered("main", asked, [], errors, 0.065)
    assert fault.kind is FaultKind.BROWN_OUT
    assert "all 18 servos on main fell silent at once: the supply" in fault.text
    assert watch.answered("main", [], [], [], 0.03) is None


@pytest.mark.parametrize(
    ("volts", "seconds", "kind"),
    [(6.1, 1.0, None), (5.9, 0.4, None), (5.9, 0.6, FaultKind.LOW_VOLTAGE), (5.0, 0.0, FaultKind.BROWN_OUT)],
)
def test_the_voltage_of_the_supply(volts, seconds, kind):
    watch = monitor()
    found = watch.measured("main", {3: Telemetry(voltage=volts)}, 0.0)
    found = found or watch.measured("main", {4: Telemetry(voltage=volts)}, seconds)
    assert (found and found.kind) == kind
    assert watch.lowest_voltage == volts


def test_without_a_supply_the_servos_own_least_voltage_counts():
    assert monitor(None).least_voltage == 4.8
    unknown = monitor(None, STRIDER.replace(servos=()))
    assert unknown.least_voltage is None
    assert unknown.measured("main", {3: Telemetry(voltage=0.1)}, 0.0) is None
    assert unknown.lowest_voltage == 0.1


@pytest.mark.parametrize(
    ("telemetry", "kind"),
    [
        (Telemetry(temperature=70.0), FaultKind.OVERHEATED),
        (Telemetry(temperature=69.0), None),
        (Telemetry(alarms=("overload",)), FaultKind.OVERLOADED),
        (Telemetry(alarms=("voltage", "temperature")), FaultKind.OVERHEATED),
        (Telemetry(load=-1.0), None),
    ],
)
def test_what_a_servo_tells(telemetry, kind):
    watch = monitor()
    fault = watch.measured("main", {18: telemetry}, 0.0)
    assert (fault and fault.kind) == kind
    assert kind is None or fault.joint == "front right tibia"


def test_full_drive_is_a_fault_after_a_second():
    watch = monitor()
    full, half = {1: Telemetry(load=0.97)}, {1: Telemetry(load=0.5)}
    assert watch.measured("main", full, 0.0) is None
    assert watch.measured("main", half, 0.9) is None
    assert watch.measured("main", full, 1.0) is None
    fault = watch.measured("main", full, 2.1)
    assert "97 % of its full drive for 1.1 s" in fault.text


def test_a_warm_servo_allows_less_speed():
    watch = monitor()
    assert watch.speed_factor == 1.0
    for temperature, factor in ((50, 1.0), (60, 1.0), (65, 0.65), (69.9, 0.307)):
        watch.measured("main", {2: Telemetry(temperature=temperature)}, 0.0)
        assert watch.speed_factor == pytest.approx(factor)


def motion(watch, sent, measured, dt=0.01):
    """Return when a fault is noticed of one joint that moves, and the fault."""
    for i, (a, b) in enumerate(zip(sent, measured, strict=True)):
        angles, found = np.zeros((6, 3)), np.zeros((6, 3))
        angles[2, 1], found[2, 1] = a, b
        fault = watch.followed(angles, found, i * dt)
        if fault is not None:
            return i * dt, fault
    return None, None


def test_joints_that_lag_as_servos_do_are_none_that_are_stuck():
    time = np.arange(0, 2, 0.01)
    for rate in (0.5, 1.0, 2.0):
        sent = 0.5 * np.sin(2 * math.pi * rate * time)
        # 40 ms behind, with a gear play of 1 deg and a sag of 4 deg.
        lagging = np.interp(time - 0.04, time, sent) - math.radians(4)
        play = math.radians(0.5)
        shaft = [lagging[0]]
        for motor in lagging[1:]:
            shaft.append(min(max(shaft[-1], motor - play), motor + play))
        assert motion(monitor(), sent, shaft) == (None, None)


def test_a_joint_that_stands_still_is_stuck_within_100_ms_of_its_command():
    time = np.arange(0, 1, 0.01)
    sent = np.clip(time - 0.3, 0, None) * math.radians(100)
    noticed, fault = motion(monitor(), sent, np.zeros_like(sent))
    assert noticed - 0.3 <= 0.1
    assert (fault.kind, fault.joint) == (FaultKind.STUCK, "rear left femur")
    # Far behind and still moving: it follows, but not its command.
    noticed, fault = motion(monitor(), sent * 3, sent)
    assert "deg behind its command" in fault.text
    watch = monitor()
    motion(watch, sent[:40], sent[:40])
    watch.forget_motion()
    assert watch.followed(np.ones((6, 3)), np.zeros((6, 3)), 0.5) is None


def test_a_missed_tick_is_left_out_and_never_made_up_for():
    clock = ManualClock()
    pacer = Pacer(clock)
    begun = []
    for i in range(10):
        begun.append(pacer.wait(0.01))
        clock.sleep(0.035 if i == 4 else 0.002)
    np.testing.assert_allclose(np.diff(begun), [0.01] * 4 + [0.035] + [0.01] * 4)
    timing = pacer.timing
    assert (timing.ticks, timing.missed) == (10, 2)
    assert timing.worst == pytest.approx(0.025)
    assert timing.rate == pytest.approx(10 / clock.now())
    assert Pacer(clock).timing.rate == 0.0
