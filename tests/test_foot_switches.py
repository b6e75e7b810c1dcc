"""Foot switches on the inputs of boards: bytes, contacts in a walk, and what happens when a board is silent."""

import dataclasses

import numpy as np
import pytest

import tarsus
from tarsus import Command, RobotController, hardware
from tarsus.errors import BusError, CorruptAnswerError, InputError, ServoFaultError
from tarsus.hardware import FootSwitches, ManualClock, ServoPlant, emulated_bus, nominal_calibration
from tarsus.hardware.bus.inputs import InputBoard
from tarsus.hardware.calibration.bus_commands import BUS_COMMANDS
from tarsus.hardware.codec import lines, maestro, ssc32
from tarsus.hardware.live.emulated_feet import EmulatedFeet
from tarsus.hardware.live.emulated_robot import EmulatedRobot
from tarsus.hardware.plant.reading.foot_contacts import FootContacts

STRIDER = tarsus.load_robot("strider")
BOARDS = {
    "servo2040": FootSwitches(bus="main", inputs=(0, 1, 2, 3, 4, 5)),
    "maestro": FootSwitches(bus="main", inputs=(18, 19, 20, 21, 22, 23), closed=False),
    "ssc32": FootSwitches(bus="main", inputs=(5, 4, 3, 2, 1, 0), closed=False),
    "lines": FootSwitches(bus="main", inputs=(0, 1, 2, 3, 4, 5), closed=False),
}


def test_requests_and_answers_are_those_of_the_makers_documents():
    # SSC-32U user guide, "Digital Input": A B E answers three characters.
    assert ssc32.query_inputs(0, 1, 4) == b"A B E\r"
    assert ssc32.read_inputs(b"101") == (1, 0, 1)
    assert ssc32.read_inputs(b"1 0") is None
    # Maestro user's guide, 5.e: Get Position of channel 2; the low byte first, 0 to 1023 for 0 to 5 V.
    assert maestro.get_position(2) == bytes((0x90, 0x02))
    assert maestro.levels_in(bytes((0xFF, 0x03, 0x00, 0x02))) == (1023, 512)
    assert lines.checked("I") == lines.INPUTS == b"I*49\n"
    assert lines.levels("I 0110") == (0, 1, 1, 0)
    assert [lines.levels(text) for text in ("I", "I ", "I 012", "tarsus 18")] == [None] * 4


@pytest.mark.parametrize("kind", BUS_COMMANDS)
def test_boards_with_inputs_read_their_levels(kind):
    bus, device = emulated_bus(kind, range(18))
    assert isinstance(bus, InputBoard) == bool(BUS_COMMANDS[kind].inputs) == (kind in BOARDS)
    if kind not in BOARDS:
        with pytest.raises(InputError, match="has no inputs"):
            FootContacts(FootSwitches(bus="main", inputs=(0,) * 6), bus, ManualClock())
        return
    assert len(bus.inputs) == BUS_COMMANDS[kind].inputs
    numbers = BOARDS[kind].inputs[:4]
    levels = dict(zip(numbers, (0.0, 1.0, 1.0, 0.0), strict=True))
    device.levels = levels
    for chosen in (numbers, numbers[::-1], numbers[2:], ()):
        assert bus.read_inputs(chosen) == pytest.approx([levels[number] for number in chosen], abs=1e-3)
    assert 0 < bus.input_seconds(numbers) < 0.01
    with pytest.raises(InputError, match=f"{kind} has no input 99: inputs are 0 to"):
        bus.read_inputs((0, 99))
    device.faults.unplugged = True
    with pytest.raises(BusError):
        bus.read_inputs(numbers)


@pytest.mark.parametrize(
    ("kind", "answer", "message"),
    [
        (
            "maestro",
            bytes((0x70, 0x17)),
            "channel 18 from 0 to 1023, received 6000. Set the mode of this channel",
        ),
        ("ssc32", b"?", "1 times 0 or 1, received 3F"),
        ("lines", lines.checked("I 0"), "the levels of 6 inputs or more, .*received 'I 0'"),
        ("lines", b"I 000000*00\n", "received 49 20 30"),
    ],
)
def test_answers_that_are_no_levels_are_refused(kind, answer, message):
    bus, device = emulated_bus(kind, range(18))
    device._answers = lambda: [(-1, answer)]
    with pytest.raises(CorruptAnswerError, match=message):
        bus.read_inputs(BOARDS[kind].inputs[:1] if kind != "lines" else (5,))


class Rig:
    """A plant on emulated servos with foot switches."""

    def __init__(self, calibration, **more):
        self.clock, self.robot = ManualClock(), calibration.limited_robot
        self.controller = RobotController(self.robot, **more)
        commands = calibration.commands(self.controller.output.angles)
        self.buses, self.devices = {}, {}
        for settings in calibration.buses:
            joints = {
                joint.number: float(commands[leg, j])
                for leg, row in enumerate(calibration.joints)
                for j, joint in enumerate(row)
                if joint.bus == settings.name
            }
            bus, device = emulated_bus(settings.kind, joints, clock=self.clock, baud=1_000_000)
            for number, command in joints.items():
                device.servos[number].place(command)
            self.buses[settings.name], self.devices[settings.name] = bus, device
        self.board = self.devices[calibration.foot_switches.bus]
        self.board.levels = EmulatedFeet(calibration, self.devices)
        self.plant = ServoPlant(self.robot, calibration, buses=self.buses, clock=self.clock)
        self.planned, self.felt, self.ages = [], [], []
        step = self.plant.step

        def noted(output, dt):
            readings = step(output, dt)
            self.planned.append(output.contacts.copy())
            self.felt.append(readings.contacts)
            self.ages.append(readings.age.get("contacts"))
            return readings

        self.plant.step = noted

    def stand(self, ticks):
        for _ in range(ticks):
            self.plant.step(self.controller.output, 0.01)

    def run(self, duration, twist=(0.06, 0.0, 0.0)):
        return tarsus.run(self.controller, self.plant, [(0.0, Command(twist=twist))], duration=duration)


@pytest.mark.no_cover
@pytest.mark.parametrize("kind", BOARDS)
def test_a_robot_walks_with_what_its_feet_feel(kind):
    rig = Rig(nominal_calibration(STRIDER, "strider", kind=kind).replace(foot_switches=BOARDS[kind]))
    recording = rig.run(2.5)
    assert recording.problems == ()
    agreed = np.mean(np.array(rig.planned[20:]) == np.array(rig.felt[20:]))
    assert 0.9 < agreed < 1.0
    # Each leg was lifted, and felt so.
    assert (~np.array(rig.felt)).any(axis=0).all()
    ideal, walk = tarsus.IdealPlant(STRIDER), [(0.0, Command(twist=(0.06, 0.0, 0.0)))]
    blind = tarsus.run(RobotController(STRIDER), ideal, walk, duration=2.5)
    way, planned = (np.linalg.norm(each.motion.body.position[-1, :2]) for each in (recording, blind))
    assert way == pytest.approx(planned, rel=0.1)


@pytest.mark.parametrize(
    ("kind", "highest", "closed"), [("servo2040", 3.3, True), ("maestro", 5.0, True), ("servo2040", 3.3, False)]
)
def test_sensors_of_force_have_thresholds_with_hysteresis(kind, highest, closed):
    bus, device = emulated_bus(kind, ())
    volts = (0.6, 0.8, 1.0, 1.2, 1.4, 1.6)
    switches = FootSwitches(bus="main", inputs=(5, 4, 3, 2, 1, None), closed=closed, thresholds=volts, hysteresis=0.3)
    feet = FootContacts(switches, bus, ManualClock())
    planned = np.zeros(6, dtype=bool)

    def high(offset):
        device.levels = {5 - leg: (volts[leg] + offset) / highest for leg in range(5)}
        feet.read()
        return set(feet.contacts(planned)[:5] == closed)

    # Between the two voltages an input stays as it was: at first low.
    found = [high(offset) for offset in (0.1, 0.2, 0.0, -0.1, -0.2, 0.1, 0.17)]
    assert found == [{False}, {True}, {True}, {True}, {False}, {False}, {True}]
    assert feet.contacts(planned)[5] == planned[5]


def second_board(inputs=(0, 1, 2, 3, 4, 5)):
    made = nominal_calibration(STRIDER, "strider", kind="feetech-sts")
    feet = dataclasses.replace(made.buses[0], name="feet", kind="lines", baud=None)
    switches = FootSwitches(bus="feet", inputs=inputs, closed=False)
    return made.replace(buses=(*made.buses, feet), foot_switches=switches)


def test_a_second_board_may_have_the_switches_and_a_leg_may_have_none():
    rig = Rig(second_board(inputs=(0, None, 2, 3, 4, 5)))
    assert rig.run(1.0).problems == ()
    felt, planned = np.array(rig.felt), np.array(rig.planned)
    np.testing.assert_array_equal(felt[:, 1], planned[:, 1])
    assert (felt[:, 2] != planned[:, 2]).any()
    assert max(rig.ages) < 0.01


def test_a_board_that_falls_silent_leaves_old_contacts_and_a_note_and_an_unplugged_one_is_a_fault():
    rig = Rig(second_board())
    rig.plant.start(rig.controller.output)
    rig.stand(1)
    rig.board._answers = list
    began = rig.clock.now()
    rig.stand(60)
    assert rig.ages[-1] == pytest.approx(rig.clock.now() - began, abs=0.03)
    assert [note[:30] for note in rig.plant.notes] == ["foot switches can't be read: l"]
    # It is asked now and then only: the ticks go on in time.
    assert rig.clock.now() - began < 1.0
    rig.board.faults.unplugged = True
    with pytest.raises(ServoFaultError, match="port gone"):
        rig.stand(30)
    rig.plant.stop()


def test_switches_without_a_reading_yet_are_no_contacts():
    rig = Rig(second_board())
    rig.board._answers = list
    rig.plant.start(rig.controller.output)
    assert rig.plant.step(rig.controller.output, 0.01).contacts is None
    rig.plant.stop()


def test_emulated_feet_touch_as_the_robot_rests():
    made = nominal_calibration(STRIDER, "strider", kind="servo2040").replace(foot_switches=BOARDS["servo2040"])
    line = hardware.emulate("servo2040", range(18))
    angles = np.array(RobotController(STRIDER).output.angles)
    angles[1] += (0.0, 0.4, 0.0)
    for number, command in enumerate(made.commands(angles).ravel()):
        line.servos[number].place(float(command))
    feet = EmulatedFeet(made, {"main": line})
    assert dict(feet) == {0: 1.0, 1: 0.0, 2: 1.0, 3: 1.0, 4: 1.0, 5: 1.0}
    assert 6 not in feet


def test_an_emulated_robot_has_switches_behind_its_port():
    made = nominal_calibration(STRIDER, "strider", kind="pca9685")
    feet = dataclasses.replace(made.buses[0], name="feet", kind="lines", baud=None)
    switches = FootSwitches(bus="feet", inputs=(5, 4, 3, 2, 1, 0), closed=False)
    made = made.replace(buses=(*made.buses, feet), foot_switches=switches)
    angles = np.array(RobotController(STRIDER).output.angles)
    angles[4, 1] += 0.4
    with EmulatedRobot(made, angles) as robot:
        assert set(robot.buses) == {"main", "feet"}
        assert robot.buses["feet"].read_inputs((5, 4, 3, 2, 1, 0)) == (0, 0, 0, 0, 1, 0)
