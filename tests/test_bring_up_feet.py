"""The step of the bring-up that finds foot switches: each foot is pressed in turn."""

import pytest

import tarsus
from tarsus.hardware import BusSettings, Calibration, FootSwitches, ManualClock, nominal_calibration
from tarsus.hardware.bringup.dialogue import Left
from tarsus.hardware.bringup.emulated_machine import EmulatedMachine
from tarsus.hardware.bringup.wizard import BringUp
from tarsus.hardware.bus.registry import bus_over
from tarsus.hardware.emulation.registry import emulate
from tarsus.hardware.transport.memory import MemoryTransport

STRIDER = tarsus.load_robot("strider")


class Hand:
    """Answers the questions about feet, presses them, and leaves at the one after them."""

    def __init__(self, press, answers=()):
        self.press, self.answers, self.texts = press, list(answers), []

    def say(self, text):
        self.texts.append(text)

    def choose(self, question, options, *, topic):
        self.texts.append(question)
        assert len(self.texts) < 200, self.texts[-4:]
        if topic.title == "Check pose and walk":
            raise Left
        key = "y" if topic.title == "Foot switches" and "y" in options else ""
        if topic.pose == "pressed" and self.answers:
            key = self.answers.pop(0)
        if callable(key):
            key = key()
        if key is None:
            raise Left
        if not key:
            self.press(topic)
        return key

    def told(self, pattern):
        return [text for text in self.texts if pattern in text]


def brought_up(calibration, path, hand, opened):
    """Go through the step of the feet; return what was saved, None for nothing."""
    up = BringUp(calibration, path, hand, open_bus=opened, ports=tuple, clock=ManualClock())
    with pytest.raises(Left):
        up.perform()
    return Calibration.load(path).foot_switches if path.exists() else None


@pytest.mark.parametrize("kind", ["servo2040", "maestro", "ssc32", "lines"])
def test_inputs_and_polarity_are_found_by_pressing_each_foot(kind, tmp_path):
    machine = EmulatedMachine(STRIDER, kind, clock=ManualClock())
    begun = machine.truth.replace(foot_switches=None)
    hand = Hand(machine.hold)
    found = brought_up(begun, tmp_path / "c.toml", hand, lambda bus: machine.open(bus.kind, bus.port))
    assert found == machine.truth.foot_switches
    # Servos are not held up by a hand that presses their foot.
    assert not any(servo.torque for servo in machine.servos.values())


def test_the_step_is_left_resumed_and_corrected(tmp_path):
    machine = EmulatedMachine(STRIDER, "servo2040", clock=ManualClock())
    truth, path = machine.truth.foot_switches, tmp_path / "c.toml"
    opened = lambda bus: machine.open(bus.kind, bus.port)  # noqa: E731
    levels = machine._line
    free, down = 1.0 - float(truth.closed), float(truth.closed)

    def pressed(*legs):
        levels.levels = {number: down if leg in legs else free for leg, number in enumerate(truth.inputs)}

    # Not pressed, two feet at once, then rightly; for the second leg the first foot again, then the visitor leaves.
    moves = iter([(), (0, 3), (0,), (0,)])

    def press(topic):
        pressed(*(next(moves) if topic.pose == "pressed" else ()))

    first = Hand(press, ["", "", "", "", lambda: None])
    found = brought_up(machine.truth.replace(foot_switches=None), path, first, opened)
    assert found.inputs == (truth.inputs[0], None, None, None, None, None)
    assert first.told("no input changed: input 0")
    assert first.told("changed both; press this foot alone")
    assert first.told("is that of the front left foot already")
    second = Hand(machine.hold, ["", "n"])
    found = brought_up(Calibration.load(path), path, second, opened)
    assert second.told("more foot switches than the 1 that are known")
    assert found.inputs == (*truth.inputs[:2], None, *truth.inputs[3:])
    third = Hand(machine.hold, ["n"])
    assert brought_up(Calibration.load(path), path, third, opened) == found
    assert not third.told("Press the front left foot")


def test_a_switch_that_works_the_other_way_is_named(tmp_path):
    machine = EmulatedMachine(STRIDER, "lines", clock=ManualClock())
    numbers = machine.truth.foot_switches.inputs
    levels = {None: (0, 1), 0: (1, 1), 1: (0, 0)}

    def press(topic):
        leg = topic.leg if topic.pose == "pressed" else None
        machine._line.levels = dict(zip(numbers[:2], levels[leg], strict=True))

    hand = Hand(press, ["", "", lambda: None])
    begun = machine.truth.replace(foot_switches=None)
    found = brought_up(begun, tmp_path / "c.toml", hand, lambda bus: machine.open(bus.kind, bus.port))
    assert (found.inputs[:2], found.closed) == ((numbers[0], None), True)
    assert hand.told("goes low, the others go high: connect all switches alike")


def test_sensors_of_force_get_a_threshold_between_free_and_pressed(tmp_path):
    machine = EmulatedMachine(STRIDER, "servo2040", clock=ManualClock())
    numbers = machine.truth.foot_switches.inputs
    volts = (1.0, 1.2, 1.4, 1.6, 1.8, 2.0)

    def press(topic):
        leg = topic.leg if topic.pose == "pressed" else None
        machine._line.levels = {number: (volts[at] if at == leg else 0.4) / 3.3 for at, number in enumerate(numbers)}

    begun = machine.truth.replace(foot_switches=None)
    hand = Hand(press)
    found = brought_up(begun, tmp_path / "c.toml", hand, lambda bus: machine.open(bus.kind, bus.port))
    assert (found.inputs, found.closed) == (numbers, True)
    assert found.thresholds == pytest.approx([(each + 0.4) / 2 for each in volts], abs=0.02)
    assert found.hysteresis == pytest.approx(0.3 * 0.6, abs=0.01)
    assert hand.told("0.40 V free and 1.00 V pressed")


def test_feet_on_a_second_board_whose_cable_is_pulled_out(tmp_path):
    made = nominal_calibration(STRIDER, "strider", kind="lx16a", port="A")
    made = made.replace(buses=(*made.buses, BusSettings(name="feet", kind="lines", port="B")))
    servos, board = emulate("lx16a", range(1, 19)), emulate("lines", ())
    lines = {"main": servos, "feet": board}
    clock = ManualClock()

    def opened(bus):
        return bus_over(bus.kind, MemoryTransport(lines[bus.name], clock, port=bus.port))

    plugged = iter([True, False])

    def press(topic):
        if topic.title == "Foot switches":
            leg = topic.leg if topic.pose == "pressed" else None
            board.levels = {number: float(number != leg) for number in range(6)}
            board.faults.unplugged = leg == 2 and next(plugged)

    class Plugging(Hand):
        def choose(self, question, options, *, topic):
            if "Plug it in" in question:
                board.faults.unplugged = False
                self.texts.append(question)
                return ""
            return super().choose(question, options, topic=topic)

    hand = Plugging(press)
    found = brought_up(made, tmp_path / "c.toml", hand, opened)
    assert found == FootSwitches(bus="feet", inputs=(0, 1, 2, 3, 4, 5), closed=False)
    assert hand.told("Plug it in")


def test_without_inputs_and_without_switches_nothing_is_kept(tmp_path):
    for kind in ("servo2040", "pca9685"):
        machine = EmulatedMachine(STRIDER, kind, clock=ManualClock())
        begun = machine.truth.replace(foot_switches=None)

        class No(Hand):
            def choose(self, question, options, *, topic):
                super().choose(question, options, topic=topic)
                return ""

        hand = No(machine.hold)
        path = tmp_path / f"{kind}.toml"
        assert brought_up(begun, path, hand, lambda bus, machine=machine: machine.open(bus.kind, bus.port)) is None
        assert bool(hand.told("Does the robot have foot switches")) == (kind == "servo2040")


def test_inputs_that_none_can_read_are_said(tmp_path):
    machine = EmulatedMachine(STRIDER, "ssc32", clock=ManualClock())
    begun = machine.truth.replace(foot_switches=None)
    machine._line._answers = list
    hand = Hand(machine.hold)

    def opened(bus):
        return machine.open(bus.kind, bus.port)

    assert brought_up(begun, tmp_path / "c.toml", hand, opened) is None
    assert hand.told("no input can be read")
