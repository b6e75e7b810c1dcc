"""The plant of servos: limits, soft start, faults in the middle of a walk, and how it lets go."""

import dataclasses
import itertools
import math

import numpy as np
import pytest

import tarsus
from tarsus import Command, RobotController
from tarsus.errors import CalibrationError, InputError, NoAnswerError, ServoFaultError
from tarsus.hardware import BUSES, ManualClock, MemoryTransport, ServoPlant, bus_over, emulated_bus, nominal_calibration
from tarsus.hardware.plant.command_limiter import CommandLimiter
from tarsus.hardware.plant.fault import REACTIONS, FaultKind, Reaction
from tarsus.hardware.plant.settings import PlantSettings
from tarsus.hardware.plant.soft_start import release_order

STRIDER = tarsus.load_robot("strider")
WALK = [(0.0, Command(twist=(0.08, 0.0, 0.0)))]
# Buses on which 18 servos are told their goals, and say where they are, within a tick.
SMART = ("feetech-sts", "feetech-scs", "dynamixel-x", "dynamixel-mx", "dynamixel-ax", "lx16a")


class Watched:
    """A bus whose goals are noted with their times."""

    def __init__(self, bus, clock):
        self._bus, self._clock, self.sent = bus, clock, []

    def __getattr__(self, name):
        return getattr(self._bus, name)

    def write_goals(self, goals):
        self.sent.append((self._clock.now(), dict(goals)))
        self._bus.write_goals(goals)


class BusyClock(ManualClock):
    """A clock of a process that other programs keep from running, so that each wait ends late."""

    late = 0.0

    def sleep(self, seconds):
        super().sleep(seconds + (self.late if seconds > 0 else 0.0))


class Rig:
    """A plant on emulated servos, in their own time."""

    def __init__(self, kind="feetech-sts", *, calibration=None, away=0.0, start="standing", timeout=None, **more):
        self.calibration = calibration or nominal_calibration(STRIDER, "strider", kind=kind)
        self.clock = BusyClock()
        self.ids = [joint.number for row in self.calibration.joints for joint in row]
        baud = {} if kind == "pca9685" else {"baud": max(BUSES[kind].baud, 500_000)}
        bus, self.line = emulated_bus(kind, self.ids, clock=self.clock, **baud)
        if timeout is not None:
            bus = bus_over(kind, MemoryTransport(self.line, self.clock), timeout=timeout)
        self.bus = Watched(bus, self.clock)
        self.robot = self.calibration.limited_robot
        self.controller = RobotController(self.robot, start=start)
        self.place(self.controller.output.angles + away)
        self.records = []
        self.plant = ServoPlant(
            self.robot,
            self.calibration,
            buses={"main": self.bus},
            clock=self.clock,
            observer=self.records.append,
            **more,
        )

    def place(self, angles):
        for number, command in zip(self.ids, self.calibration.commands(angles).ravel().tolist(), strict=True):
            self.line.servos[number].place(command)

    def run(self, commands=WALK, duration=1.0):
        return tarsus.run(self.controller, self.plant, commands, duration=duration)

    def stand(self, ticks):
        for _ in range(ticks):
            self.plant.step(self.controller.output, 0.01)

    def check_sent(self):
        """Every command within the limits, and no way faster than the joints, but for less than one command."""
        limits = self.calibration.command_limits.reshape(-1, 2)
        speed = (tarsus.robot.joint_limits.joint_limits(STRIDER).speed * np.abs(self.calibration.slopes)).ravel()
        last, beyond = {}, dict.fromkeys(self.ids, 0.0)
        for time, goals in self.bus.sent:
            for number, goal in goals.items():
                i = self.ids.index(number)
                assert limits[i, 0] <= goal <= limits[i, 1]
                assert goal == round(goal)
                if number in last:
                    way = abs(goal - last[number][1]) - speed[i] * (time - last[number][0])
                    # The greatest sum up to here, from any command before.
                    beyond[number] = max(beyond[number], 0.0) + way
                    assert beyond[number] < 1 + 1e-6
                last[number] = time, goal

    @property
    def holding(self):
        return [number for number in self.ids if self.line.servos[number].torque]


@pytest.mark.no_cover
@pytest.mark.parametrize("kind", BUSES)
def test_a_robot_walks_on_every_bus_sits_down_and_lets_go(kind):
    rig = Rig(kind)
    recording = rig.run(duration=0.5)
    assert recording.problems == ()
    assert recording.states[-1] == "walking"
    rig.check_sent()
    walked = rig.records[:-1]
    asked, sent = (np.array([getattr(each, name) for each in walked]) for name in ("asked", "sent"))
    step = 1 / np.abs(rig.calibration.slopes).min()
    assert np.abs(asked - sent).max() < 0.51 * step + 1e-9
    assert rig.holding == []
    assert rig.plant.notes == []
    # It sits: the body is lower than the feet can hold it.
    feet = tarsus.forward_kinematics(STRIDER, rig.records[-1].sent)[..., 3, 2]
    assert feet.min() > -0.06
    if kind in SMART:
        measured = np.array([each.measured for each in walked[20:50]])
        assert np.degrees(np.abs(measured - sent[20:50]).max()) < 8
        np.testing.assert_array_equal(recording.measured_angles[30].shape, (6, 3))
        assert not np.isnan(recording.measured_angles[30]).any()


FAULTS = {
    "missing": (lambda rig: rig.line.faults.missing.add(5), FaultKind.NO_ANSWER, "middle left femur"),
    "duplicate": (lambda rig: rig.line.faults.duplicate.add(5), FaultKind.CORRUPT, "middle left femur"),
    "corrupt": (lambda rig: rig.line.faults.corrupt.update({5: 1.0}), None, "middle left femur"),
    "late": (lambda rig: rig.line.faults.late.update({18: 0.2}), None, "front right tibia"),
    "unplugged": (lambda rig: setattr(rig.line.faults, "unplugged", True), FaultKind.PORT_GONE, ""),
    "brown-out": (lambda rig: setattr(rig.line.supply, "source", 3.0), FaultKind.BROWN_OUT, ""),
    "stuck": (lambda rig: setattr(rig.line.servos[6], "stuck", True), FaultKind.STUCK, "middle left tibia"),
    "hot": (lambda rig: setattr(rig.line.servos[9], "temperature", 74.0), FaultKind.OVERHEATED, "rear left tibia"),
}


@pytest.mark.no_cover
@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_in_the_middle_of_a_walk_ends_it(name):
    cause, kind, joint = FAULTS[name]
    rig = Rig()
    began = []

    class Source:
        def command(self, time, output, note):
            # In the middle of a swing of the leg, so that each of its joints moves.
            if time > 1.64 and not began:
                began.append(rig.clock.now())
                cause(rig)
            return Command(twist=(0.08, 0.0, 0.0))

        def over(self, time, output):
            return time > 4

    with pytest.raises(ServoFaultError) as caught:
        tarsus.run(rig.controller, rig.plant, Source())
    fault = caught.value.fault
    assert fault is rig.plant.fault
    assert kind is None or fault.kind is kind
    assert fault.joint == joint
    assert fault.time - began[0] <= 0.1
    assert fault.remedy in str(caught.value)
    assert joint in str(caught.value)
    assert [each.fault for each in rig.records if each.fault] == [str(caught.value)]
    rig.check_sent()
    if name == "unplugged":
        assert "may still hold" in rig.plant.notes[0]
        return
    assert [number for number in rig.holding if number not in rig.line.faults.missing] == []
    sat = tarsus.forward_kinematics(STRIDER, rig.records[-1].sent)[..., 3, 2].min() > -0.06
    assert sat == (fault.reaction is Reaction.SIT)


@pytest.mark.parametrize("kind", ["feetech-sts", "feetech-scs", "dynamixel-x", "dynamixel-mx", "dynamixel-ax"])
def test_an_alarm_in_the_answer_of_a_position_is_looked_at_at_once(kind):
    rig = Rig(kind)
    rig.plant.start(rig.controller.output)
    rig.plant.step(rig.controller.output, 0.01)
    servo = rig.line.servos[rig.ids[7]]
    servo.temperature, began = 90.0, rig.clock.now()
    with pytest.raises(ServoFaultError, match="90 deg C") as caught:
        rig.stand(5)
    assert caught.value.fault.joint == "rear left femur"
    # Where half a tick is too short for all positions, the servo's turn comes a few ticks later.
    assert caught.value.fault.time - began < (0.06 if kind in ("dynamixel-mx", "dynamixel-x", "dynamixel-ax") else 0.02)
    # It has let go by itself; the others hold until the plant is stopped.
    assert set(rig.holding) == set(rig.ids) - {rig.ids[7]}
    rig.plant.stop()


def test_the_telemetry_of_all_servos_is_read_in_80_ms_also_where_one_keeps_its_alarm():
    rig = Rig()
    asked, alarms = [], {}
    read, positions = rig.bus._bus.read_telemetry, rig.bus._bus.read_positions
    rig.bus.read_telemetry = lambda ids: asked.append(ids) or read(ids)
    rig.bus.read_positions = lambda ids: dataclasses.replace(positions(ids), alarms=alarms)
    rig.plant.start(rig.controller.output)
    asked.clear()
    alarms[12] = ("voltage",)
    rig.stand(8)
    assert {number for ids in asked for number in ids} == set(rig.ids)
    assert asked[0][0] == 12
    assert [len(ids) for ids in asked[1:]] == [3] * 7
    rig.plant.stop()


@pytest.mark.no_cover
@pytest.mark.parametrize("kind", ["feetech-scs", "lx16a"])
def test_servos_that_are_asked_one_by_one_are_noticed_to_be_silent_together_or_alone(kind):
    # The supply is gone: 18 servos are not waited for. At first the computer may be late itself.
    rig = Rig(kind, timeout=0.02)
    rig.plant.start(rig.controller.output)
    rig.stand(100)
    rig.line.supply.source, began = 1.0, rig.clock.now()
    with pytest.raises(ServoFaultError, match="brown-out") as caught:
        rig.stand(20)
    assert caught.value.fault.time - began < (0.1 if kind == "feetech-scs" else 0.2)
    # The cable of a leg is gone, that of the first servos: others are asked.
    rig = Rig(kind, timeout=0.02)
    rig.plant.start(rig.controller.output)
    rig.stand(3)
    rig.line.faults.missing |= set(rig.ids[:3])
    with pytest.raises(ServoFaultError, match="front left coxa: no answer"):
        rig.stand(60)
    rig.plant.stop()


def test_every_kind_of_fault_has_a_reaction_and_a_remedy():
    assert set(REACTIONS) == set(FaultKind)
    assert all(remedy.endswith(".") for _, remedy in REACTIONS.values())


@pytest.mark.no_cover
def test_a_lost_answer_now_and_then_is_no_fault():
    # As plants open their buses.
    rig = Rig(timeout=0.015)
    rig.line.faults.corrupt = dict.fromkeys(rig.ids, 0.02)
    assert rig.run().problems == ()
    assert rig.plant.fault is None


@pytest.mark.no_cover
@pytest.mark.parametrize("seed", range(3))
def test_whatever_comes_in_no_command_leaves_beyond_limits_or_speeds(seed):
    random = np.random.default_rng(seed)
    calibration = nominal_calibration(STRIDER, "strider", kind="feetech-sts").with_joint(0, 1, soft_limits=(-0.2, 0.9))
    rig = Rig(calibration=calibration)
    output = rig.controller.output
    rig.plant.start(output)
    kinds = set()
    for _ in range(400):
        scale = 10.0 ** random.uniform(-3, 3)
        angles = output.angles + random.normal(0, scale, (6, 3))
        if random.random() < 0.1:
            angles = np.where(random.random((6, 3)) < 0.1, random.choice([np.inf, -np.inf, np.nan, 1e308]), angles)
        dt = float(random.choice([0.01, 0.001, 1e-7, 0.3, -1.0, math.nan]))
        rig.clock.sleep(float(random.exponential(0.01)))
        try:
            rig.plant.step(dataclasses.replace(output, angles=angles, belly=False), dt)
        except InputError as error:
            kinds.add(str(error)[:5])
        except ServoFaultError as error:
            kinds.add(error.fault.kind)
    rig.check_sent()
    # What is not finite ends a run; that servos don't follow noise may be taken for a fault.
    assert {"dt is", FaultKind.INVALID_COMMAND} <= kinds <= {"dt is", *FaultKind}
    assert len(rig.bus.sent) > 200


def test_the_limiter_moves_nothing_without_a_time():
    limiter = CommandLimiter(nominal_calibration(STRIDER, "strider", kind="feetech-sts"))
    with pytest.raises(InputError, match="call begin"):
        limiter.limited(np.zeros((6, 3)), 0.01)
    before = limiter.begin(np.zeros((6, 3)))
    for elapsed in (0.0, -1.0, math.nan, math.inf):
        np.testing.assert_array_equal(limiter.limited(np.full((6, 3), 0.5), elapsed), before)
    for wrong, message in [
        (np.zeros(3), r"shape \(3,\)"),
        ("x", "must be numbers"),
        (np.full((6, 3), np.nan), "is nan"),
    ]:
        with pytest.raises(InputError, match=message):
            limiter.limited(wrong, 0.01)
    narrow = nominal_calibration(STRIDER, "strider", kind="feetech-sts").with_joint(0, 0, limits=(2000.2, 2000.8))
    with pytest.raises(InputError, match="front left coxa contain no whole command"):
        CommandLimiter(narrow)


@pytest.mark.parametrize("seed", range(20))
def test_joints_of_any_speed_reach_it_and_never_exceed_it(seed):
    random = np.random.default_rng(seed)
    servo = tarsus.Servo(name="s", stall_torque=2.0, no_load_speed=10.0 ** random.uniform(-2, 1))
    kind = str(random.choice(["dynamixel-ax", "feetech-sts", "lx16a"]))
    made = nominal_calibration(STRIDER.replace(servos=((servo,) * 3,) * 6), "strider", kind=kind)
    limiter, speed = CommandLimiter(made), servo.no_load_speed * np.abs(made.slopes)
    low, high = made.limits[..., 0], made.limits[..., 1]
    first = limiter.begin(low)
    distance = np.abs(CommandLimiter(made).begin(high) - first)
    for tick in range(1, 200):
        moved = np.abs(limiter.limited(high, 0.005) - first)
        assert np.abs(moved - np.minimum(distance, speed * 0.005 * tick)).max() < 1 + 1e-6
    # Whatever is asked: the way in any span of time, and that since the beginning, which is not greater by any part.
    sent, most, whole, goal = limiter.begin(low), np.zeros((6, 3)), np.zeros((6, 3)), low
    for _ in range(1000):
        dt = float(random.choice([0.0, 0.003, 0.01]))
        goal = np.where(random.random((6, 3)) < 0.05, random.uniform(low, high), goal)
        before, sent = sent, limiter.limited(goal, dt)
        way = np.abs(sent - before) - speed * dt
        most, whole = np.maximum(most, 0.0) + way, whole + way
        assert most.max() < 1 + 1e-6
        assert whole.max() < 1e-6


def test_a_soft_start_moves_slowly_from_where_the_servos_are():
    away = np.radians(20) * np.sign(np.arange(18).reshape(6, 3) % 2 - 0.5)
    rig = Rig(start="lying", away=0.0)
    start = np.clip(rig.controller.output.angles + away, rig.robot.limits[..., 0], rig.robot.limits[..., 1])
    rig.place(start)
    rig.plant.start(rig.controller.output)
    first = [goals for _, goals in rig.bus.sent[:6]]
    assert [len(goals) for goals in first] == [3] * 6
    for number, goal in (pair for goals in first for pair in goals.items()):
        place = divmod(rig.ids.index(number), 3)
        assert rig.calibration.angles(np.full((6, 3), goal))[place] == pytest.approx(start[place], abs=0.02)
    sent = np.array([each.sent for each in rig.records])
    times = np.array([each.time for each in rig.records])
    speeds = np.abs(np.diff(sent, axis=0)) / np.diff(times)[:, None, None]
    assert speeds.max() <= PlantSettings().start_speed * 1.1
    np.testing.assert_allclose(rig.records[-1].measured, rig.controller.output.angles, atol=0.02)
    rig.check_sent()
    rig.plant.stop()


def test_pulses_begin_servo_by_servo_and_leg_by_leg_at_the_declared_angles():
    declared = np.tile([0.1, 0.2, -0.5], (6, 1))
    rig = Rig("servo2040", start="lying", declared=declared)
    rig.plant.start(rig.controller.output)
    first = rig.bus.sent[:18]
    assert all(len(goals) == 1 for _, goals in first)
    order = [next(iter(goals)) // 3 for _, goals in first]
    assert order == [leg for leg in release_order(6) for _ in range(3)]
    assert np.diff([time for time, _ in first]).min() >= PlantSettings().start_interval
    angles = np.empty(18)
    for _, goals in first:
        for number, goal in goals.items():
            angles[number] = rig.calibration.angles(np.full((6, 3), goal)).ravel()[number]
    np.testing.assert_allclose(angles.reshape(6, 3), declared, atol=0.01)
    rig.check_sent()
    rig.plant.stop()


@pytest.mark.parametrize("legs", [4, 5, 6, 8])
def test_neighbours_are_never_switched_on_one_after_the_other(legs):
    order = list(release_order(legs))
    assert sorted(order) == list(range(legs))
    assert all((b - a) % legs not in (1, legs - 1) for a, b in itertools.pairwise(order) if legs > 5)


def test_what_keeps_a_plant_from_starting():
    made = nominal_calibration(STRIDER, "strider", kind="feetech-sts")
    with pytest.raises(CalibrationError, match="not calibrated yet"):
        ServoPlant(STRIDER, made.with_joint(0, 0, zero=None), buses={})
    with pytest.raises(InputError, match="no bus is given for main"):
        ServoPlant(STRIDER, made, buses={})
    with pytest.raises(InputError, match="the calibration is for 'strider'"):
        ServoPlant(STRIDER.replace(leg_names=tuple("abcdef")), made)
    with pytest.raises(InputError, match="has no port in the calibration"):
        ServoPlant(STRIDER, made)
    with pytest.raises(tarsus.PortError, match="/dev/none"):
        ServoPlant(STRIDER, made.replace(buses=(dataclasses.replace(made.buses[0], port="/dev/none"),)))
    rig = Rig()
    with pytest.raises(InputError, match="has not been started"):
        rig.plant.step(rig.controller.output, 0.01)
    rig.line.faults.missing |= {2, 9}
    with pytest.raises(NoAnswerError, match=r"front left femur \(id 2 on main\), rear left tibia \(id 9 on main\)"):
        rig.plant.start(rig.controller.output)
    assert rig.bus.sent == []
    rig = Rig()
    rig.line.servos[4].place(100)
    with pytest.raises(
        InputError, match=r"middle left coxa is measured at -171.* far beyond its limits of -60.0 to 60"
    ):
        rig.plant.start(rig.controller.output)
    assert rig.bus.sent == []
    for wrong in ({"warm": 0.0}, {"hot": 50.0}, {"silence": math.nan}):
        with pytest.raises(InputError):
            PlantSettings(**wrong)


def test_an_interrupt_sits_down_and_a_second_one_lets_go_at_once():
    rig = Rig()
    with pytest.raises(KeyboardInterrupt):
        tarsus.run(rig.controller, rig.plant, _Interrupting(0.5))
    assert rig.holding == []
    assert rig.records[-1].time - rig.records[0].time > 1.0
    rig = Rig()
    rig.plant.start(rig.controller.output)
    rig.plant.step(rig.controller.output, 0.01)
    write = rig.bus.write_goals

    def interrupted(goals):
        if len(rig.records) > 20:
            raise KeyboardInterrupt
        write(goals)

    rig.bus.write_goals = interrupted
    with pytest.raises(KeyboardInterrupt):
        rig.plant.stop()
    assert rig.holding == []
    rig.plant.stop()


class _Interrupting:
    def __init__(self, at):
        self._at = at

    def command(self, time, output, note):
        if time >= self._at:
            raise KeyboardInterrupt
        return Command(twist=(0.05, 0.0, 0.0))

    def over(self, time, output):
        return False


def test_an_error_in_the_soft_start_lets_go():
    rig = Rig(start="lying")
    rig.place(rig.controller.output.angles * 0.9)
    write = rig.bus.write_goals

    def failing(goals):
        if len(rig.bus.sent) > 10:
            raise RuntimeError
        write(goals)

    rig.bus.write_goals = failing
    with pytest.raises(RuntimeError):
        rig.plant.start(rig.controller.output)
    assert rig.holding == []


def test_warm_servos_make_the_robot_slower():
    rig = Rig()
    for servo in rig.line.servos.values():
        servo.temperature = 65.0
    assert rig.plant.speed_factor == 1.0
    rig.plant.start(rig.controller.output)
    for _ in range(20):
        rig.plant.step(rig.controller.output, 0.01)
    assert rig.plant.speed_factor == pytest.approx(0.65, abs=0.1)
    rig.plant.stop()


def test_two_boards_and_a_rig_that_can_t_sit_down():
    made = nominal_calibration(STRIDER, "strider", kind="feetech-sts")
    rows = [[dataclasses.replace(j, bus="b") if leg > 2 else j for j in row] for leg, row in enumerate(made.joints)]
    second = dataclasses.replace(made.buses[0], name="b")
    made = made.replace(buses=(made.buses[0], second), joints=tuple(map(tuple, rows)))
    clock = ManualClock()
    halves = {"main": range(1, 10), "b": range(10, 19)}
    rigs = {name: emulated_bus("feetech-sts", ids, clock=clock) for name, ids in halves.items()}
    controller = RobotController(made.limited_robot)
    for name, ids in halves.items():
        for number in ids:
            goal = made.commands(controller.output.angles).ravel()[number - 1]
            rigs[name][1].servos[number].place(float(goal))
    buses = {name: bus for name, (bus, _) in rigs.items()}
    plant = ServoPlant(made.limited_robot, made, buses=buses, clock=clock)
    with plant:
        assert tarsus.run(controller, plant, WALK, duration=0.2).problems == ()
        # Left standing, with legs that can't be told to sit down: the torque of the others fades.
        plant._servos.switch_on(controller.output.angles, measured=True)
        plant._belly = False
        rigs["b"][1].faults.unplugged = True
    assert "could not sit down" in plant.notes[0]
    assert "b may still hold" in plant.notes[1]
    assert not any(servo.torque for servo in rigs["main"][1].servos.values())


@pytest.mark.parametrize("kind", ["feetech-sts", "dynamixel-x", "dynamixel-mx", "dynamixel-ax"])
def test_servos_have_their_full_torque_again_after_letting_down_and_in_every_run(kind):
    rig = Rig(kind)
    servos, angles = rig.line.servos.values(), rig.controller.output.angles
    # As a program leaves them that is killed while it lets down.
    for number, servo in rig.line.servos.items():
        servo.torque, servo.torque_limit = True, 0.08
        if kind == "dynamixel-x":
            rig.line.memory[number].set("watchdog", -1)
    write = rig.bus.write_goals

    def written(goals):
        # Full torque before the goals would let them jump to the old ones.
        assert {servo.torque_limit for servo in servos} == {0.08}
        write(goals)
        assert {number: rig.line.memory[number].get("goal") for number in goals} == goals

    rig.bus.write_goals = written
    rig.plant._servos.switch_on(angles, measured=True)
    assert {servo.torque_limit for servo in servos} == {1.0}
    rig.plant._servos.let_down()
    assert max(servo.torque_limit for servo in servos) < 0.1
    rig.plant.release()
    assert {(servo.torque, servo.torque_limit) for servo in servos} == {(False, 1.0)}


def test_readings_have_what_every_servo_told():
    rig = Rig()
    rig.plant.start(rig.controller.output)
    first = rig.plant.step(rig.controller.output, 0.01)
    assert first.temperatures is None
    for _ in range(20):
        readings = rig.plant.step(rig.controller.output, 0.01)
    for channel in ("joint_angles", "joint_speeds", "temperatures", "voltages", "currents"):
        assert getattr(readings, channel).shape == (6, 3)
    assert readings.age["joint_angles"].shape == (6, 3)
    assert readings.age["joint_angles"].max() < 0.005
    assert rig.plant.greatest_rate > 200
    rig.plant.stop()


@pytest.mark.no_cover
def test_a_process_that_is_kept_from_running_does_not_take_servos_for_silent():
    rig = Rig()
    rig.plant.start(rig.controller.output)
    rig.stand(100)
    rig.line.faults.missing, rig.clock.late = set(rig.ids), 0.3
    rig.stand(2)
    rig.line.faults.missing, rig.clock.late = set(), 0.0
    rig.stand(300)
    assert rig.plant.fault is None
    # Servos that are silent while it runs are noticed as ever.
    rig.line.faults.missing, silent = set(rig.ids), rig.clock.now()
    with pytest.raises(ServoFaultError, match="all 18 servos on main fell silent at once"):
        rig.stand(20)
    assert rig.clock.now() - silent < 0.1


def test_servos_that_stay_silent_on_a_busy_computer_are_noticed_in_the_time_in_which_it_runs():
    rig = Rig()
    rig.plant.start(rig.controller.output)
    rig.stand(100)
    rig.line.faults.missing, rig.clock.late = {rig.ids[4]}, 0.3
    with pytest.raises(ServoFaultError, match=r"none for \d+ ms, beside \d+ ms in which this computer did not run"):
        rig.stand(40)


def test_a_robot_whose_observer_fails_sits_down_before_it_lets_go():
    rig, sent = Rig(), []

    def observe(record):
        sent.append(record.sent)
        if len(sent) > 60:
            raise OSError("no space left")

    rig.plant._observer = observe
    with pytest.raises(OSError, match="no space left"):
        rig.run()
    assert len(sent) == 61
    assert rig.holding == []
    positions = np.reshape([rig.line.servos[number].position for number in rig.ids], (6, 3))
    feet = tarsus.forward_kinematics(STRIDER, rig.calibration.angles(positions))[..., 3, 2]
    assert feet.min() > -0.06
