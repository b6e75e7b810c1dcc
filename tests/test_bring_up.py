"""The bring-up, driven end to end over a terminal by someone who looks at an emulated machine."""

import dataclasses
import json
import os
import pty
import re
import sys
import threading

import numpy as np
import pytest

import tarsus
from sample_commands import run
from tarsus.cli import main
from tarsus.cli.bring_up import _Terminal
from tarsus.hardware import (
    Calibration,
    ManualClock,
    MemoryTransport,
    bus_over,
    emulate,
    emulated_bus,
    new_calibration,
)
from tarsus.hardware.bringup import trial, wizard
from tarsus.hardware.bringup.bench import Bench
from tarsus.hardware.bringup.dialogue import Left, Topic
from tarsus.hardware.bringup.reference_pose import reference_angles
from tarsus.hardware.bringup.wizard import BringUp
from tarsus.hardware.bus import registry

STRIDER = tarsus.load_robot("strider")


class Machine:
    """Servos as someone has built them in: ids, directions and zeros mixed up."""

    def __init__(self, kind, seed=0):
        random = np.random.default_rng(seed)
        blank = new_calibration(STRIDER, "strider", kind=kind)
        smart = blank.kind(0, 0).feedback
        numbers = random.permutation(18) + smart
        scale, limits = blank.joints[0][0].scale, blank.joints[0][0].limits
        middle = sum(limits) / 2
        truth = blank
        for leg in range(6):
            for j in range(3):
                direction = int(random.choice([-1, 1]))
                centre = float(STRIDER.limits[leg, j].mean())
                zero = middle - direction * scale * centre + random.uniform(-40, 40)
                truth = truth.with_joint(
                    leg, j, number=int(numbers[3 * leg + j]), direction=direction, zero=round(zero, 1)
                )
        self.truth, self.kind, self.clock = truth, kind, ManualClock()
        self.line = emulate(kind, sorted(int(n) for n in numbers), baud=1_000_000 if smart else 115_200)
        self.place(reference_angles(STRIDER) + 0.2)
        self.moved = None
        self.opened = 0

    def joints(self):
        return {joint.number: (leg, j) for leg, row in enumerate(self.truth.joints) for j, joint in enumerate(row)}

    def place(self, angles, only=None):
        for number, (leg, j) in self.joints().items():
            if only is None or leg == only:
                self.line.servos[number].place(float(self.truth.commands(angles)[leg, j]))

    def open(self, name, port, **options):
        self.opened += 1
        bus = bus_over(name, MemoryTransport(self.line, self.clock, port=port))
        write = bus.write_goals

        def noted(goals):
            if len(goals) == 1:
                self.moved = next(iter(goals))
            write(goals)

        bus.write_goals = noted
        return bus


class Human:
    """Reads what a terminal shows, and types what is true; sometimes something else first."""

    def __init__(self, machine, script=()):
        self.machine, self.script, self.seen = machine, dict(script), []

    def answer(self, question):
        self.seen.append(question)
        for pattern in list(self.script):
            if re.search(pattern, question):
                action = self.script.pop(pattern)
                return action() if callable(action) else action
        machine, joints = self.machine, self.machine.joints()
        leg, j = joints.get(machine.moved, (0, 0))
        if "Which leg moved?" in question:
            return str(leg + 1) if machine.moved in joints else "n"
        if "Which joint?" in question:
            return "cft"[j]
        if "Which way" in question:
            return self.way(leg, j)
        if "Which leg is wrong?" in question:
            name = re.search(r"the (\w+ \w+) \w+ is measured at .* far beyond", question)[1]
            return str(STRIDER.leg_names.index(name) + 1)
        if "is limp: hold it in the reference pose" in question:
            name = re.search(r"The (.*) leg is limp", question)[1]
            machine.place(reference_angles(STRIDER), only=STRIDER.leg_names.index(name))
            return ""
        if "move it to the reference pose" in question:
            goal = machine.truth.commands(reference_angles(STRIDER))[leg, j]
            scale = machine.truth.joints[0][0].scale
            away = np.degrees((goal - machine.line.servos[machine.moved].goal) / scale)
            if abs(away) < 0.3:
                return ""
            return ("++" if away > 0 else "--") if abs(away) > 2.5 else ("+" if away > 0 else "-")
        return ""

    def way(self, leg, j):
        sign = self.machine.truth.joints[leg][j].direction
        if j > 0:
            return "u" if sign > 0 else "d"
        forward = -np.sin(STRIDER.mount_yaw[leg]) * sign
        return "f" if forward > 0 else "r"


def drive(arguments, human, monkeypatch):
    """Run the command on a terminal of its own, and return its exit code."""
    master, slave = pty.openpty()
    machine = human.machine

    def look():
        text = ""
        while True:
            try:
                data = os.read(master, 4096).decode()
            except OSError:
                return
            text += data
            while "[q] leave" in text:
                question, text = text.split("[q] leave", 1)
                os.write(master, f"{human.answer(question)}\n".encode())

    monkeypatch.setattr(registry, "open_bus", machine.open)
    monkeypatch.setattr(wizard, "SystemClock", lambda: machine.clock)
    monkeypatch.setattr(trial, "_WALK_TIME", 0.5)
    watcher = threading.Thread(target=look, daemon=True)
    watcher.start()
    with os.fdopen(os.dup(slave), "r") as stdin, os.fdopen(os.dup(slave), "w") as stdout:
        monkeypatch.setattr(sys, "stdin", stdin)
        monkeypatch.setattr(sys, "stdout", stdout)
        monkeypatch.setenv("COLUMNS", "300")
        with pytest.raises(SystemExit) as ended:
            main(arguments)
    os.close(slave)
    watcher.join(timeout=10)
    os.close(master)
    return ended.value.code


@pytest.mark.no_cover
@pytest.mark.parametrize("kind", ["feetech-sts", "servo2040"])
def test_a_machine_is_brought_up_over_a_terminal(kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    machine = Machine(kind)
    human = Human(machine)
    code = drive(["bring-up", "strider", "c.toml", "--bus", kind, "--port", "memory"], human, monkeypatch)
    assert code == 0, human.seen[-3:]
    made, truth = Calibration.load("c.toml"), machine.truth
    assert [[j.number for j in row] for row in made.joints] == [[j.number for j in row] for row in truth.joints]
    assert [[j.direction for j in row] for row in made.joints] == [[j.direction for j in row] for row in truth.joints]
    wrong = np.degrees((made.zeros - truth.zeros) / made.slopes)
    # Steps are of half a degree, and what is seen is a step old.
    assert np.abs(wrong).max() < (0.6 if kind == "feetech-sts" else 1.1)
    assert not any(servo.torque for servo in machine.line.servos.values())
    assert any("slow walk in the air" in question for question in human.seen)


@pytest.mark.no_cover
def test_wrong_answers_unplugging_and_leaving_do_no_harm(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    machine = Machine("feetech-sts", seed=1)
    arguments = ["bring-up", "strider", "c.toml", "--bus", "feetech-sts", "--port", "memory"]

    def unplug():
        machine.line.faults.unplugged = True
        return "a"

    def plug():
        machine.line.faults.unplugged = False
        return ""

    # Nonsense, a look again, a step back, the cable pulled out, and away.
    first = Human(
        machine,
        {
            r"id 2 moves(.|\n)*Which leg": "seven",
            r"none of them(.|\n)*Which leg": "a",
            r"id 3 moves(.|\n)*Which leg": unplug,
            r"Plug it in": plug,
            r"id 5 moves(.|\n)*Which leg": "q",
        },
    )
    assert drive(arguments, first, monkeypatch) == 1
    assert first.script == {}
    saved = Calibration.load("c.toml")
    assert sum(joint.number is not None for row in saved.joints for joint in row) == 4
    assert any("the emulated line is unplugged" in question for question in first.seen)
    # Resumed: a joint that is taken, a leg held wrongly, limits by hand, and a leg that does not look right.
    leg, j = machine.joints()[1]
    where = STRIDER.leg_names[0]

    def held_wrongly():
        machine.place(np.full((6, 3), 2.6), only=0)
        return ""

    ends = iter([np.array([-0.5, 0, 0]), np.array([0.6, 0, 0])])

    def to_an_end():
        machine.place(np.tile(next(ends), (6, 1)), only=5)
        return ""

    second = Human(
        machine,
        {
            r"id 5 moves(.|\n)*Which leg": str(leg + 1),
            r"Which joint\?": "cft"[j],
            rf"The {where} leg is limp": held_wrongly,
            r"That can't be": "",
            r"Limits of the front right leg": "h",
            r"front right coxa: move it by hand to one end": to_an_end,
            r"front right coxa: move it by hand to the other end": to_an_end,
            r"front right femur: move it by hand to one end": "q",
        },
    )
    assert drive(arguments, second, monkeypatch) == 1
    assert any("already; look again" in question for question in second.seen)
    low, high = np.degrees(Calibration.load("c.toml").limits[5, 0])
    assert (low, high) == pytest.approx((np.degrees(-0.5) + 2, np.degrees(0.6) - 2), abs=0.4)
    third = Human(machine, {r"Does every leg look like": "2"})
    assert drive(arguments, third, monkeypatch) == 0
    limp = [name for question in third.seen for name in re.findall(r"The (.*) leg is limp", question)]
    assert limp == ["middle left"]


class Answers:
    def __init__(self, *answers):
        self.answers, self.said = list(answers), []

    def say(self, text):
        self.said.append(text)

    def choose(self, question, options, *, topic):
        self.said.append(question)
        if not self.answers:
            raise Left
        return self.answers.pop(0)


class Watched:
    """A clock that notes where a servo is as time passes."""

    def __init__(self, clock, servo):
        self.now, self._clock, self._servo, self.seen = clock.now, clock, servo, [servo.position]

    def sleep(self, seconds):
        self._clock.sleep(seconds)
        self.seen.append(self._servo.position)


def wiggled(start, *, limits=None):
    """The sign of the first motion of a servo that starts there, as told and as seen, and the fastest step [ticks]."""
    calibration = new_calibration(tarsus.load_robot("strider"), "strider", kind="feetech-sts", port="emulated")
    known = calibration if limits is None else calibration.with_joint(0, 0, number=1, direction=1, limits=limits)
    clock = ManualClock()
    bus, servos = emulated_bus("feetech-sts", range(1, 19), clock=clock)
    servos.servos[7].place(start)
    watched = Watched(clock, servos.servos[7])
    sign = Bench(bus, known, watched, blank=calibration).wiggle(7)
    way = np.array(watched.seen) - start
    first = way[np.abs(way) > 20][0]
    assert abs(way[-1]) < 20
    return sign, np.sign(first), np.abs(np.diff(watched.seen)).max()


@pytest.mark.parametrize("start", [2048, 3570, 4080, 520, 20])
@pytest.mark.parametrize("limits", [None, (1800.0, 2300.0)])
def test_a_servo_moves_a_little_wherever_it_is_and_whatever_limits_another_has(start, limits):
    told, seen, step = wiggled(start, limits=limits)
    assert told == seen
    assert step < 30


def test_servos_that_are_held_when_it_ends_get_their_full_torque_back():
    calibration = new_calibration(tarsus.load_robot("strider"), "strider", kind="feetech-sts", port="emulated")
    bus, line = emulated_bus("feetech-sts", range(1, 19), clock=ManualClock())
    bench = Bench(bus, calibration, ManualClock(), blank=calibration)
    for number in (3, 7):
        bench.hold(number)
        assert line.servos[number].torque_limit == pytest.approx(0.35)
    bench.close()
    assert {(servo.torque, servo.torque_limit) for servo in line.servos.values()} == {(False, 1.0)}


def test_the_port_is_found_and_missing_servos_are_named(tmp_path):
    machine = Machine("feetech-sts")
    machine.line.faults.missing |= {4, 5}
    machine.line.faults.duplicate.add(9)
    answers = Answers("", "c")
    tries = []

    def opener(settings):
        tries.append(settings.port)
        if settings.port != "B":
            raise tarsus.PortError("serial", settings.port, expected="a port", received="none", remedy="Plug it in.")
        return machine.open(settings.kind, settings.port)

    made = new_calibration(STRIDER, "strider", kind="feetech-sts")
    ports = iter([(), (), ("A", "B")])
    up = BringUp(made, tmp_path / "c.toml", answers, open_bus=opener, ports=lambda: next(ports), clock=machine.clock)
    with pytest.raises(Left):
        up.perform()
    assert tries == ["A", "B"]
    assert Calibration.load(tmp_path / "c.toml").buses[0].port == "B"
    assert "servos answer on B" in answers.said
    assert "15 of 18 servos answer: 1 to 3, 6 to 8, 10 to 18" in answers.said
    assert any("id 9: damaged answers" in text for text in answers.said)


class Watching(Answers):
    """Answers as `Human` does, and notes which channels have pulses when the first one of a channel is asked for."""

    def __init__(self, machine, script=()):
        super().__init__()
        self.human, self.first = Human(machine, script), []

    def choose(self, question, options, *, topic):
        self.said.append(question)
        if "gets its first pulse" in question:
            line = self.human.machine.line
            number, pulse = (int(text) for text in re.search(r"channel (\d+) .* pulse, (\d+) us", question).groups())
            self.first.append((number, pulse, [n for n, width in line.pulses.items() if width], topic))
        answer = self.human.answer("\n".join(self.said[-2:]) if "Which leg moved" in question else question)
        if answer == "q":
            raise Left
        assert answer in options
        return answer


def test_a_servo_of_pulses_gets_its_first_pulse_only_when_someone_says_so(tmp_path):
    machine = Machine("servo2040")
    # A board that still sends pulses, as after a crash.
    machine.open("servo2040", "memory").write_goals(dict.fromkeys(range(18), 1500.0))
    made = new_calibration(STRIDER, "strider", kind="servo2040", port="memory")
    watching = Watching(machine, {r"channel 1 gets": "s", r"Zeros|move it to the reference": "q"})
    up = BringUp(
        made,
        tmp_path / "c.toml",
        watching,
        open_bus=lambda settings: machine.open(settings.kind, settings.port),
        ports=tuple,
        clock=machine.clock,
    )
    with pytest.raises(Left):
        up.perform()
    assert [(number, pulse) for number, pulse, _, _ in watching.first] == [(number, 1500) for number in range(18)]
    # No other servo is held meanwhile.
    assert all(pulsed == [] for _, _, pulsed, _ in watching.first)
    assert sum(joint.number is not None for row in up.calibration.joints for joint in row) == 17


def test_resumed_servos_of_pulses_begin_where_they_were_left(tmp_path):
    machine = Machine("servo2040")
    truth = machine.truth
    begun = truth.with_joint(2, 1, zero=None).replace(buses=(dataclasses.replace(truth.buses[0], port="memory"),))
    script = {r"Limits of the front left": "h", r"front left coxa: move it to one end": "q"}
    watching = Watching(machine, script)
    up = BringUp(
        begun,
        tmp_path / "c.toml",
        watching,
        open_bus=lambda settings: machine.open(settings.kind, settings.port),
        ports=tuple,
        clock=machine.clock,
    )
    with pytest.raises(Left):
        up.perform()
    ((number, pulse, pulsed, topic),) = watching.first
    assert (number, pulsed, topic.leg, topic.joint) == (truth.joints[0][0].number, [], 0, 0)
    assert pulse == round(float(truth.commands(reference_angles(STRIDER))[0, 0]))


def test_a_port_that_is_wrong_is_searched_for(tmp_path):
    machine = Machine("feetech-sts")
    answers = Answers("", "s")

    def opener(settings):
        if settings.port != "B":
            raise tarsus.PortError("serial", settings.port, expected="a port", received="none", remedy="Plug it in.")
        return machine.open(settings.kind, settings.port)

    made = new_calibration(STRIDER, "strider", kind="feetech-sts", port="/dev/ttyUSB7")
    up = BringUp(made, tmp_path / "c.toml", answers, open_bus=opener, ports=lambda: ("A", "B"), clock=machine.clock)
    with pytest.raises(Left):
        up.perform()
    assert answers.said.count("Plug it in again.") == 2
    assert Calibration.load(tmp_path / "c.toml").buses[0].port == "B"


def test_a_file_of_another_robot_or_bus_is_not_resumed(tmp_path):
    new_calibration(STRIDER, "strider", kind="feetech-sts").save(tmp_path / "c.toml")
    for robot, options, message in [
        ("phantomx", (), "is the calibration of strider, which is not the robot 'phantomx'"),
        ("strider", ("--bus", "lx16a"), "is for the bus feetech-sts, not lx16a"),
    ]:
        result = run("bring-up", robot, tmp_path / "c.toml", *options)
        assert result.exit_code == 2
        assert message in result.stderr
    # Nothing was drawn over the picture of the right robot.
    assert [path.name for path in tmp_path.iterdir()] == ["c.toml"]


def test_a_terminal_that_ends_leaves(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    with open(os.devnull, encoding="utf-8") as nothing:
        monkeypatch.setattr(sys, "stdin", nothing)
        with pytest.raises(Left):
            _Terminal().choose("What?", {"": "yes"}, topic=Topic())
    assert run("bring-up", "strider", "--drawing-only", "--json").exit_code == 0
    assert (tmp_path / "strider.reference-pose.png").exists()


def test_beside_a_json_document_the_dialogue_is_on_standard_error(tmp_path):
    result = run("bring-up", "strider", tmp_path / "c.toml", "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout) == {"calibration": str(tmp_path / "c.toml"), "complete": False}
    assert "[q] leave" in result.stderr
    assert "left; nothing was saved" in result.stderr
