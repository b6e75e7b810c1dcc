"""What counts as a fault of servos: answers, motion, telemetry."""

import math

import numpy as np
import pytest

import tarsus
from tarsus.errors import CorruptAnswerError, NoAnswerError
from tarsus.hardware import ManualClock, SupplySettings, Telemetry, nominal_calibration
from tarsus.hardware.plant.fault import FaultKind
from tarsus.hardware.plant.joint_map import JointMap
from tarsus.hardware.plant.monitor.answer_monitor import AnswerMonitor
from tarsus.hardware.plant.monitor.motion_monitor import MotionMonitor
from tarsus.hardware.plant.monitor.telemetry_monitor import TelemetryMonitor, least_voltage
from tarsus.hardware.plant.pacer import Pacer
from tarsus.hardware.plant.settings import PlantSettings

STRIDER = tarsus.load_robot("strider")
SUPPLY = SupplySettings(voltage=7.4, least_voltage=6.0)


def calibration(supply=SUPPLY, robot=STRIDER):
    return nominal_calibration(robot, "strider", kind="feetech-sts").replace(supply=supply)


def monitor(supply=SUPPLY, robot=STRIDER, kind=TelemetryMonitor):
    made = calibration(supply, robot)
    return kind(made, JointMap(made), PlantSettings())


class Answering:
    """An answer monitor on one bus."""

    def __init__(self):
        self.watch = monitor(kind=AnswerMonitor)

    def __call__(self, asked, answered, errors, now, **more):
        return self.watch.answered("main", asked, answered=answered, errors=errors, now=now, **more)


def no_answer(number, kind=NoAnswerError):
    return kind("feetech-sts", "memory", id=number, expected="an answer", received="nothing", remedy="Look.")


def test_a_silent_servo_is_a_fault_after_some_time_and_answers():
    watch = Answering()
    asked = range(1, 19)
    answered = [number for number in asked if number != 7]
    assert watch(asked, answered, [no_answer(7)], 0.0) is None
    assert watch(asked, answered, [no_answer(7)], 0.03) is None
    assert watch(asked, asked, [], 0.035) is None
    assert watch(asked, answered, [no_answer(7, CorruptAnswerError)], 0.04) is None
    assert watch(asked, answered, [no_answer(7, CorruptAnswerError)], 0.05) is None
    fault = watch(asked, answered, [no_answer(7, CorruptAnswerError)], 0.1)
    assert (fault.kind, fault.joint, fault.leg, fault.number) == (FaultKind.CORRUPT, "rear left coxa", 2, 0)
    assert "3 answers in a row failed, none for 65 ms: nothing" in fault.text
    # Errors of what was not asked, and of no servo, are none of a joint.
    assert watch([1, 2], [1], [no_answer(None), no_answer(9)], 0.1) is None


def test_a_computer_that_is_late_itself_waits_longer():
    watch = Answering()
    asked = range(1, 19)
    watch.watch.grace = 0.2
    errors = [no_answer(number) for number in asked]
    assert watch(asked, asked, [], 0.0) is None
    for time in (0.02, 0.1, 0.25):
        assert watch(asked, [], errors, time) is None
    assert watch(asked, [], errors, 0.27).kind is FaultKind.BROWN_OUT


def test_a_pause_without_requests_is_no_silence():
    watch = Answering()
    asked = range(1, 19)
    assert watch(asked, asked, [], 0.0) is None
    assert watch(asked, range(2, 19), [no_answer(1)], 1.0) is None
    assert watch(asked, range(2, 19), [no_answer(1)], 1.02) is None
    assert watch(asked, range(2, 19), [no_answer(1)], 1.035).kind is FaultKind.NO_ANSWER
    assert watch(asked, asked, [], 2.0) is None
    errors = [no_answer(number) for number in asked]
    assert watch(asked, [], errors, 3.0) is None
    assert watch(asked, [], errors, 3.02) is None
    assert watch(asked, [], errors, 3.035).kind is FaultKind.BROWN_OUT


def test_a_silent_bus_is_a_brown_out_with_the_last_voltage():
    watch = Answering()
    asked = range(1, 19)
    assert watch(asked, asked, [], 0.0) is None
    errors = [no_answer(number) for number in asked]
    assert watch(asked, [], errors, 0.02) is None
    assert watch(asked, [], errors, 0.04) is None
    fault = watch(asked, [], errors, 0.065)
    assert fault.kind is FaultKind.BROWN_OUT
    assert "all 18 servos on main fell silent at once: the supply" in fault.text
    assert watch([], [], [], 0.03) is None


@pytest.mark.parametrize(
    ("volts", "seconds", "kind"),
    [(6.1, 1.0, None), (5.9, 0.4, None), (5.9, 0.6, FaultKind.LOW_VOLTAGE), (5.0, 0.0, FaultKind.BROWN_OUT)],
)
def test_the_voltage_of_the_supply(volts, seconds, kind):
    watch = monitor()
    found = watch.measured("main", {3: Telemetry(voltage=volts)}, now=0.0)
    found = found or watch.measured("main", {4: Telemetry(voltage=volts)}, now=seconds)
    assert (found and found.kind) == kind
    assert watch.lowest_voltage == volts


def test_a_servo_at_the_end_of_a_cable_has_a_low_voltage_whatever_the_others_have():
    watch = monitor()
    enough, low = Telemetry(voltage=6.0), Telemetry(voltage=5.7)
    for time in (0.0, 0.1, 0.2, 0.3, 0.4):
        # The third has enough at first.
        assert watch.measured("main", {1: enough, 2: low, 3: low if time > 0.2 else enough}, now=time) is None
    assert watch.measured("main", {3: low}, now=0.6) is None
    fault = watch.measured("main", {2: low}, now=0.6)
    assert fault.kind is FaultKind.LOW_VOLTAGE
    assert fault.text == "the supply has 5.7 V at the front left femur, less than 6.0 V for 0.6 s"


def test_without_a_supply_the_servos_own_least_voltage_counts():
    assert least_voltage(calibration(None)) == 4.8
    assert least_voltage(calibration(None, STRIDER.replace(servos=()))) is None
    unknown = monitor(None, STRIDER.replace(servos=()))
    assert unknown.measured("main", {3: Telemetry(voltage=0.1)}, now=0.0) is None
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
    fault = watch.measured("main", {18: telemetry}, now=0.0)
    assert (fault and fault.kind) == kind
    assert kind is None or fault.joint == "front right tibia"


def test_full_drive_is_a_fault_after_a_second():
    watch = monitor()
    full, half = {1: Telemetry(load=0.97)}, {1: Telemetry(load=0.5)}
    assert watch.measured("main", full, now=0.0) is None
    assert watch.measured("main", half, now=0.9) is None
    assert watch.measured("main", full, now=1.0) is None
    fault = watch.measured("main", full, now=2.1)
    assert "97 % of its full drive for 1.1 s" in fault.text


def test_a_warm_servo_allows_less_speed():
    watch = monitor()
    assert watch.speed_factor == 1.0
    for temperature, factor in ((50, 1.0), (60, 1.0), (65, 0.65), (69.9, 0.307)):
        watch.measured("main", {2: Telemetry(temperature=temperature)}, now=0.0)
        assert watch.speed_factor == pytest.approx(factor)


class Following:
    """A motion monitor, and one joint of six legs that moves."""

    def __init__(self, place=(2, 1), dt=0.01):
        self.watch, self.place, self.dt = MotionMonitor(calibration(), PlantSettings()), place, dt
        self.time = 0.0

    def __call__(self, sent, measured, *, every=1):
        """Return when a fault is noticed, after the beginning of this motion, and the fault."""
        for i, (a, b) in enumerate(zip(sent, measured, strict=True)):
            angles, found, read = np.zeros((6, 3)), np.zeros((6, 3)), np.zeros((6, 3), dtype=bool)
            angles[self.place], found[self.place] = a, b
            read[self.place] = i % every == 0
            fault = self.watch.followed(angles, found, read=read, now=self.time)
            self.time += self.dt
            if fault is not None:
                return i * self.dt, fault
        return None, None


def swinging(seconds, rate=1.0, amplitude=0.5):
    return amplitude * np.sin(2 * math.pi * rate * np.arange(0, seconds, 0.01))


def follows(sent, delay=0.04, play=0.5, sag=4.0, load=0.0):
    """Where a healthy shaft is: late, in the play of its gears, below its command, by more where the load changes."""
    time = 0.01 * np.arange(len(sent))
    motor = np.interp(time - delay, time, sent) - math.radians(sag) + math.radians(load) * np.sin(9 * time)
    shaft = [motor[0]]
    for at in motor[1:]:
        shaft.append(min(max(shaft[-1], at - math.radians(play)), at + math.radians(play)))
    return np.array(shaft)


@pytest.mark.parametrize("rate", [0.2, 0.5, 1.0, 2.0])
@pytest.mark.parametrize("machine", [{}, {"play": 1.0}, {"play": 0.2, "load": 1.5}, {"delay": 0.02, "sag": 0.0}])
def test_joints_that_lag_as_servos_do_are_none_that_are_stuck(rate, machine):
    sent = swinging(8.0, rate)
    assert Following()(sent, follows(sent, **machine)) == (None, None)


def test_a_joint_that_stands_still_in_a_swing_is_stuck_within_100_ms():
    follow = Following()
    time = np.arange(0, 1, 0.01)
    sent = np.clip(time - 0.3, 0, None) * math.radians(100)
    noticed, fault = follow(sent, np.zeros_like(sent))
    # Of a machine of which nothing is known yet, the command must go farther.
    assert noticed - 0.3 <= 0.13
    assert (fault.kind, fault.joint) == (FaultKind.STUCK, "rear left femur")
    assert "while its command moved by" in fault.text
    follow = Following()
    before = swinging(10.0, 0.5)
    assert follow(before, follows(before)) == (None, None)
    noticed, _ = follow(sent, np.full_like(sent, math.radians(-4)))
    assert noticed - 0.3 <= 0.1


@pytest.mark.no_cover
def test_the_dead_zone_of_the_machine_decides_how_soon_a_slow_joint_is_stuck():
    noticed = []
    for play in (0.2, 1.2):
        follow = Following()
        before = swinging(20.0, 0.5)
        assert follow(before, follows(before, play=play, sag=0.0)) == (None, None)
        sent = math.radians(20) * np.arange(0, 2, 0.01)
        time, _ = follow(sent, np.zeros_like(sent))
        noticed.append((time, np.degrees(follow.watch.bound[1])))
    (stiff, small), (soft, large) = noticed
    assert stiff < 0.17 < soft
    assert small < 2.5 < 3 < large
    # What nothing is known of begins anew.
    follow.watch.forget()
    assert np.degrees(follow.watch.bound) == pytest.approx([5.3] * 3)


def test_a_leg_that_is_relieved_of_its_load_is_none_that_is_stuck():
    # Bent by 4 deg, it stands still while its command comes to where it is.
    sent = math.radians(15) * np.arange(0, 0.3, 0.01)
    assert Following()(sent, np.full_like(sent, math.radians(4))) == (None, None)


def test_joints_that_are_read_now_and_then_are_watched_too():
    sent = math.radians(60) * np.arange(0, 1, 0.01)
    assert Following()(sent, follows(sent, sag=0.0), every=4) == (None, None)
    noticed, _ = Following()(sent, np.zeros_like(sent), every=4)
    assert noticed <= 0.2


def test_a_joint_that_falls_far_behind_is_stuck():
    # It follows, but not its command.
    sent = math.radians(300) * np.arange(0, 1, 0.01)
    noticed, fault = Following()(sent, sent / 3)
    assert noticed < 0.3
    assert fault.text.endswith("more than 25 deg for 80 ms")
    far = Following()
    assert far(np.full(6, 1.0), np.zeros(6)) == (None, None)
    assert far(np.full(20, 1.0), np.zeros(20))[1].kind is FaultKind.STUCK


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


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("name", "kind", "speed"), [("strider", "feetech-sts", 0.08), ("phantomx", "dynamixel-ax", 0.1)]
)
def test_no_joint_of_a_walk_in_physics_is_stuck_unless_it_is(name, kind, speed):
    robot = tarsus.load_robot(name)
    plant, made = tarsus.simulation.SimulatedPlant(robot), nominal_calibration(robot, name, kind=kind)
    steps = np.abs(made.slopes)
    sent, measured = [], []
    step = plant.step

    def noted(output, dt):
        sent.append(output.angles.copy())
        # As servos tell it, at the beginning of the tick.
        measured.append(np.rint(plant.state.joint_angles * steps) / steps)
        return step(output, dt)

    plant.step = noted
    walk = [(0.0, tarsus.Command(twist=(speed, 0.0, 0.0)))]
    tarsus.run(tarsus.RobotController(robot), plant, walk, duration=3.3)

    def noticed(angles):
        watch = MotionMonitor(made, PlantSettings())
        for tick, (a, b) in enumerate(zip(sent, angles, strict=True)):
            fault = watch.followed(a, b, read=np.ones(b.shape, dtype=bool), now=0.01 * tick)
            if fault is not None:
                return 0.01 * tick, fault.joint
        return None, None

    assert noticed(measured) == (None, None)
    # From 3 s on the joint whose command moves most in a tenth of a second stands still.
    way = np.abs(sent[310] - sent[300])
    place = np.unravel_index(np.argmax(way), way.shape)
    stuck = np.array(measured)
    stuck[300:, *place] = stuck[300][place]
    time, joint = noticed(stuck)
    assert (time, joint) == (pytest.approx(3.05, abs=0.06), made.joint_name(*place))
