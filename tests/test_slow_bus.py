"""Servos on a line that carries less than all positions in a tick: who is asked first, and how long for."""

import dataclasses
import math
import random

import numpy as np
import pytest

import tarsus
from tarsus import Command, RobotController
from tarsus.errors import ServoFaultError, UnknownNameError
from tarsus.hardware import FootSwitches, ManualClock, ServoPlant, Telemetry, emulated_bus, nominal_calibration
from tarsus.hardware.bus.patience import Patience
from tarsus.hardware.live.emulated_feet import EmulatedFeet
from tarsus.hardware.plant.fault import FaultKind
from tarsus.hardware.plant.monitor.command_history import CommandHistory
from tarsus.hardware.plant.monitor.motion_monitor import MotionMonitor
from tarsus.hardware.plant.reading.position_turn import PositionTurn
from tarsus.hardware.plant.settings import PlantSettings

STRIDER = tarsus.load_robot("strider")
IDS = tuple(range(1, 19))


def test_a_servo_is_waited_for_as_long_as_it_has_needed():
    patience = Patience(0.02)
    assert patience.now((1, 2)) == patience.now(()) == 0.02
    for _ in range(10):
        patience.answered(1, 0.0003)
        patience.answered(2, 0.003)
    assert patience.now((1,)) == 0.004
    assert patience.now((1, 2)) == patience.usual((1, 2)) == pytest.approx(0.012)
    assert patience.now((1, 3)) == 0.02
    # One that has become slower is found again.
    raised = []
    for _ in range(6):
        patience.missed(1)
        raised.append(patience.now((1,)))
    assert raised == sorted(raised)
    assert raised[-1] == 0.02
    assert patience.usual((1,)) == 0.004
    patience.answered(1, 0.004)
    assert patience.now((1,)) == pytest.approx(0.016)
    for _ in range(500):
        patience.answered(1, 0.0003)
    assert patience.now((1,)) == 0.004


@pytest.mark.parametrize(("delay", "most"), [(0.0003, 0.007), (0.003, 0.016), (0.008, 0.023)])
def test_a_missing_servo_takes_no_longer_than_the_adapter_needs(delay, most):
    clock = ManualClock()
    bus, line = emulated_bus("lx16a", IDS, clock=clock, turnaround=delay)
    for _ in range(10):
        bus.read_positions(IDS)
    line.faults.missing = {5}
    begun = clock.now()
    assert bus.read_positions((5,)).errors[0].id == 5
    assert clock.now() - begun < most
    # After several requests it is waited for again as long as at first.
    line.faults.missing, line.faults.late = set(), {5: 0.012}
    assert any(bus.read_positions((5,)).values for _ in range(8))


@pytest.mark.parametrize("seed", range(6))
def test_answers_that_come_after_the_next_request_are_never_taken_for_another_value(seed):
    chance = random.Random(seed)
    clock = ManualClock()
    bus, line = emulated_bus("lx16a", IDS, clock=clock)
    line.faults._random = chance
    for id in IDS:
        line.servos[id].place(400.0 + 11 * id)
        line.servos[id].temperature = 20.0 + 2 * id
    for _ in range(10):
        bus.read_positions(IDS)
    for _ in range(300):
        line.faults.late = {chance.choice(IDS): chance.choice((0.004, 0.006, 0.01, 0.03))}
        line.faults.corrupt = {chance.choice(IDS): chance.random()}
        line.faults.missing = {chance.choice(IDS)} if chance.random() < 0.3 else set()
        asked = chance.sample(IDS, 3)
        for id, value in bus.read_positions(asked).values.items():
            assert value == 400 + 11 * id
        for id, measured in bus.read_one("temperature", asked).values.items():
            # They cool down meanwhile.
            assert measured == Telemetry(temperature=pytest.approx(line.servos[id].temperature, abs=0.7))
    line.faults.late, line.faults.corrupt, line.faults.missing = {}, {}, set()
    assert all(len(bus.read_positions(IDS).values) + 3 > len(IDS) for _ in range(3))
    assert set(bus.read_positions(IDS).require()) == set(IDS)


def test_one_value_of_telemetry_is_read_in_less_time_than_all():
    clock = ManualClock()
    bus, line = emulated_bus("lx16a", IDS, clock=clock)
    line.servos[3].temperature = 47.0
    assert bus.read_one("temperature", (3,)).require() == {3: Telemetry(temperature=47.0)}
    begun = clock.now()
    bus.read_one("voltage", IDS)
    middle = clock.now()
    bus.read_telemetry(IDS)
    assert middle - begun < 0.4 * (clock.now() - middle)
    with pytest.raises(UnknownNameError, match="voltage"):
        bus.read_one("volts", IDS)


def test_everybody_has_a_turn_and_who_failed_is_first():
    bus, _ = emulated_bus("lx16a", IDS, clock=ManualClock())
    turn = PositionTurn(bus, IDS)
    assert turn.seconds == bus.timing(IDS).positions
    assert turn.next(1.2) == (IDS,)
    last = dict.fromkeys(IDS, 0)
    for tick in range(1, 100):
        turn.suspect((3, 4, 5, 6))
        (group,) = turn.next(0.5)
        assert len(group) == 9
        assert group[:2] == (3, 4)
        assert max(tick - last[number] for number in group) <= 3
        last.update(dict.fromkeys(group, tick))
    turn.asked((7, 8, 9), {8: 0.0})
    turn.asked((10,), {})
    failed, others = turn.next(0.5)
    assert failed == turn.failed == (7, 9, 10)
    assert len(others) == 6
    assert not set(failed) & set(others)
    turn.asked((7, 9, 10), {7: 0.0, 9: 0.0, 10: 0.0})
    assert turn.failed == ()
    # There is always time for one.
    assert len(turn.next(0.0)[0]) == 1


class Slow:
    """A robot on a bus at the rate that its wire carries, in the servos' own time."""

    def __init__(self, buses=1, adapter=300e-6):
        calibration = nominal_calibration(STRIDER, "strider", kind="lx16a")
        self.clock, self.lines, opened = ManualClock(), [], {}
        first = calibration.buses[0]
        names = ["main", "other"][:buses]
        joints = tuple(
            tuple(joint.__class__(**{**vars(joint), "bus": names[leg * buses // 6]}) for joint in row)
            for leg, row in enumerate(calibration.joints)
        )
        settings = tuple(first.__class__(name=name, kind="lx16a", port=name) for name in names)
        calibration = calibration.replace(buses=settings, joints=joints)
        self.controller = RobotController(calibration.limited_robot)
        commands = calibration.commands(self.controller.output.angles)
        for name in names:
            numbers = {joint.number: (i, j) for i, row in enumerate(joints) for j, joint in enumerate(row)}
            numbers = {n: at for n, at in numbers.items() if joints[at[0]][at[1]].bus == name}
            opened[name], line = emulated_bus("lx16a", numbers, clock=self.clock, turnaround=adapter)
            for number, place in numbers.items():
                line.servos[number].place(float(commands[place]))
            self.lines.append(line)
        self.records = []
        self.plant = ServoPlant(
            calibration.limited_robot, calibration, buses=opened, clock=self.clock, observer=self.records.append
        )
        # The emulated wires of two buses send one after the other.
        self.rate = float(math.floor(self.plant.usual_rate)) if buses == 1 else 26.0
        self.began, self.timing = math.nan, None

    def walk(self, cause, at=1.5, until=2.5):
        walk = self

        class Source:
            def command(self, time, _output, _note):
                if time >= at and math.isnan(walk.began):
                    walk.began = walk.clock.now()
                    cause(walk.lines[0])
                return Command(twist=(0.08, 0.0, 0.0))

            def over(self, time, _output):
                walk.timing = walk.plant.timing
                return time > until

        return tarsus.run(self.controller, self.plant, Source(), rate=self.rate)


@pytest.mark.parametrize(
    ("cause", "kind"),
    [
        (lambda line: line.faults.missing.add(15), FaultKind.NO_ANSWER),
        (lambda line: line.faults.duplicate.add(15), FaultKind.CORRUPT),
        (lambda line: setattr(line.supply, "source", 3.0), FaultKind.BROWN_OUT),
    ],
)
@pytest.mark.parametrize("at", [1.5, 1.54])
def test_a_silent_servo_on_a_slow_line_is_noticed_soon(cause, kind, at):
    robot = Slow()
    with pytest.raises(ServoFaultError) as caught:
        robot.walk(cause, at)
    assert caught.value.fault.kind is kind
    # A tick until each was asked, 60 ms of silence, and the time of the last request.
    assert caught.value.fault.time - robot.began < 0.1


@pytest.mark.parametrize(("joint", "at"), [(4, 1.5), (9, 1.54), (14, 1.58), (0, 1.62)])
def test_a_hot_servo_on_a_slow_line_is_noticed_within_two_ticks(joint, at):
    robot = Slow()
    assert robot.rate > 20
    with pytest.raises(ServoFaultError) as caught:
        robot.walk(lambda line: setattr(line.servos[joint + 1], "temperature", 72.0), at)
    assert caught.value.fault.kind is FaultKind.OVERHEATED
    assert caught.value.fault.time - robot.began < 0.1


def test_a_joint_that_is_stuck_where_its_command_turns_back_is_noticed_soon():
    # The command goes 2.4 deg past it and comes back: between two looks the joint came only part of the way.
    robot = Slow()
    robot.plant._observer = robot.records.append
    with pytest.raises(ServoFaultError) as caught:
        robot.walk(lambda line: setattr(line.servos[7], "stuck", True), 5.6, 8.0)
    assert caught.value.fault.kind is FaultKind.STUCK
    measured = [record.measured[2, 0] for record in robot.records]
    away = [
        r.time for r in robot.records if r.time > robot.began and abs(r.sent[2, 0] - measured[-1]) > math.radians(2)
    ]
    assert caught.value.fault.time - away[0] < 0.1


def test_a_lost_answer_on_a_slow_line_is_asked_for_again_in_the_same_tick():
    robot = Slow()
    lost = []

    def lose(line):
        honest = line._answers

        def answers():
            for id, answer in honest():
                if id != 15 or lost:
                    yield id, answer
                else:
                    lost.append(id)

        line._answers = answers

    recording = robot.walk(lose)
    assert lost == [15]
    assert recording.problems == ()
    assert recording.states[-1] == "walking"


@pytest.mark.parametrize("buses", [1, 2])
def test_a_slow_line_carries_what_a_tick_asks_of_it(buses):
    robot = Slow(buses)
    temperatures, voltages = [], []
    for bus in robot.plant._ports.buses.values():
        read = bus.read_one

        def noted(value, ids, read=read):
            (temperatures if value == "temperature" else voltages).extend((robot.clock.now(), id) for id in ids)
            return read(value, ids)

        bus.read_one = noted
    timings = [bus.timing(IDS[: 18 // buses]) for bus in robot.plant._ports.buses.values()]
    taken = timings[0].goals + sum(each.positions for each in timings) / 2
    assert robot.plant.greatest_rate == pytest.approx(1 / taken)
    robot.walk(lambda line: None)
    timing = robot.timing
    assert timing.missed == 0
    assert timing.worst < 0.2 / robot.rate
    # All temperatures within two ticks, and the voltage from time to time.
    walked = [(time, id) for time, id in temperatures if time < robot.began + 1.0]
    for id in IDS:
        times = [time for time, other in walked if other == id]
        assert max(np.diff(times)) < (0.1 if buses == 1 else 0.5)
    assert max(np.diff([time for time, _ in voltages])) < 0.5 * buses


def test_every_servo_on_a_slow_line_is_asked_for_something_in_each_tick():
    robot = Slow()
    (bus,) = robot.plant._ports.buses.values()
    asked, write = [set()], bus.write_goals

    def noted(read):
        def reading(*arguments):
            asked[-1].update(arguments[-1])
            return read(*arguments)

        return reading

    def writing(goals):
        asked.append(set())
        write(goals)

    bus.read_one, bus.read_positions, bus.write_goals = noted(bus.read_one), noted(bus.read_positions), writing
    robot.walk(lambda line: None)
    walked = asked[20:55]
    assert [sorted(set(IDS) - tick) for tick in walked if tick != set(IDS)] == []


def test_an_adapter_that_adds_to_each_request_costs_readings_and_no_ticks():
    # USB adapters pass bytes on in frames.
    robot = Slow(adapter=2e-3)
    robot.walk(lambda line: None)
    assert robot.timing.missed == 0
    assert robot.timing.worst < 0.2 / robot.rate
    assert robot.plant.fault is None


def following(every):
    """Return the bound of a monitor after a healthy walk at 10 ms, each joint looked at now and then."""
    watch = MotionMonitor(nominal_calibration(STRIDER, "strider", kind="lx16a"), PlantSettings())
    time = 0.01 * np.arange(2000)
    sent = 0.4 * np.sin(math.pi * time)
    measured = np.interp(time - 0.06, time, sent)
    for i, now in enumerate(time):
        angles, found, read = np.zeros((6, 3)), np.zeros((6, 3)), np.zeros((6, 3), dtype=bool)
        angles[2, 1], found[2, 1], read[2, 1] = sent[i], measured[i], i % every == 0
        assert watch.followed(angles, found, read=read, now=float(now)) is None
    return float(np.degrees(watch.bound[1]))


def test_a_joint_that_is_looked_at_less_often_has_no_larger_dead_zone():
    often = following(1)
    assert often < 3
    assert following(8) < often + 0.8


def test_a_joint_whose_command_goes_on_is_suspected_before_it_is_stuck():
    watch = MotionMonitor(nominal_calibration(STRIDER, "strider", kind="lx16a"), PlantSettings())
    seen = []
    for i in range(40):
        sent, read = np.zeros((6, 3)), np.ones((6, 3), dtype=bool)
        sent[4, 2] = math.radians(60) * 0.01 * i
        fault = watch.followed(sent, np.zeros((6, 3)), read=read, now=0.01 * i)
        seen.append(float(watch.suspicion[4, 2]))
        if fault is not None:
            break
    assert fault is not None
    assert fault.joint == "middle right tibia"
    assert seen == sorted(seen)
    assert seen[-1] > 1 > seen[-4] > 0.5
    assert np.count_nonzero(watch.suspicion) == 1


@pytest.mark.parametrize("delay", [0.0, 0.02, 0.05])
def test_the_delay_of_servos_is_measured_where_readings_are_rare(delay):
    history, seen = CommandHistory(0.03), None
    where = lambda time: 0.4 * np.sin(5 * time + np.arange(18.0)).reshape(6, 3)  # noqa: E731
    sent, which = {}, np.ones((6, 3), dtype=bool)
    for tick in range(120):
        time = 0.045 * tick
        sent[tick] = where(time)
        history.add(time, sent[tick])
        # Measured at another moment of each tick, where the joints were told to be a delay before.
        at = np.full((6, 3), time + 0.045 * (tick * 0.618 % 1.0))
        told = max((i for i in sent if 0.045 * i <= at[0, 0] - delay + 1e-9), default=0)
        if seen is not None and tick > 3:
            history.moved(seen[0], sent[told], times=np.stack([seen[1], at]), which=which)
        seen = sent[told], at
    assert history.delay == pytest.approx(delay, abs=0.0101)


def test_commands_are_expected_after_the_delay_and_not_known_before_the_first():
    history = CommandHistory(0.03)
    assert history.add(1.0, np.zeros((6, 3))) == (0.0, 0.0)
    assert history.expected(np.full((6, 3), 1.02)) is None
    passed, way = history.add(1.1, np.full((6, 3), 0.2))
    assert (passed, way) == (pytest.approx(0.1), 0.2)
    # The same time again: nothing new was sent.
    history.add(1.1, np.full((6, 3), 0.2))
    times = np.full((6, 3), 1.12)
    times[0] = 1.14
    expected = history.expected(times)
    assert (expected[0] == 0.2).all()
    assert (expected[1:] == 0.0).all()
    # Motions from before the first command tell nothing.
    history.moved(expected, expected, times=np.stack([times - 1.0, times]), which=np.ones((6, 3), dtype=bool))
    assert history.delay == 0.03


@pytest.mark.no_cover
@pytest.mark.parametrize(("kind", "rate"), [("lx16a", 25), ("dynamixel-mx", 20)])
def test_feet_of_a_robot_whose_servos_are_read_in_turn_neither_slip_nor_meet_obstacles(kind, rate):
    # Angles of up to 150 ms ago were taken for those of now: feet slipped by 250 mm/s, and some were stopped.
    calibration, clock = nominal_calibration(STRIDER, "strider", kind=kind), ManualClock()
    feet = dataclasses.replace(calibration.buses[0], name="feet", kind="servo2040", port="feet")
    switches = FootSwitches(bus="feet", inputs=tuple(range(6)))
    calibration = calibration.replace(buses=(*calibration.buses, feet), foot_switches=switches)
    controller, source = RobotController(calibration.limited_robot), [(0.0, Command(twist=(0.1, 0.0, 0.0)))]
    goals = calibration.commands(controller.output.angles).ravel().tolist()
    bus, line = emulated_bus(kind, dict(zip(IDS, goals, strict=True)), clock=clock)
    for number, goal in zip(IDS, goals, strict=True):
        line.servos[number].place(goal)
    board, device = emulated_bus("servo2040", {}, clock=clock)
    device.levels = EmulatedFeet(calibration, {"main": line})
    buses = {"main": bus, "feet": board}
    plant = ServoPlant(calibration.limited_robot, calibration, buses=buses, clock=clock)
    recording = tarsus.run(controller, plant, source, duration=6.0, rate=rate)
    assert recording.problems == ()
    assert recording.motion.body.position[-1, 0] > 0.55
