"""The bring-up from a page: sessions without a browser, an emulated machine in its own time."""

import os
import threading
import time

import numpy as np
import pytest

import tarsus
from sample_studio import Asked
from tarsus.hardware import BUSES, Calibration, ManualClock
from tarsus.hardware.bringup import beginning, opening, trial
from tarsus.hardware.bringup.dialogue import Topic
from tarsus.hardware.bringup.emulated_machine import EmulatedMachine
from tarsus.hardware.bringup.reference_pose import reference_angles
from tarsus.robot.file import robot_from_dict, robot_to_dict, save_robot
from tarsus.studio.machine.hardware import Hardware
from tarsus.studio.messages.state import RobotChoice, StudioState
from tarsus.studio.server.settings import Settings
from tarsus.studio.session import Session

STRIDER = tarsus.load_robot("strider")
FILE = "strider.calibration.toml"


class Looking(ManualClock):
    """A clock whose owner is looked at whenever something moves."""

    def __init__(self):
        super().__init__()
        self.look = lambda: None

    def sleep(self, seconds):
        super().sleep(seconds)
        self.look()


class Page:
    """A page whose visitor looks at the picture, and answers what is true; sometimes something else first."""

    def __init__(self, folder, *, kind="feetech-sts", answers=(), start=None, hardware=None, robot=STRIDER):
        self.clock = Looking()
        self.hardware = hardware or Hardware(folder, clock=self.clock)
        self.asked = Asked(Session(start or StudioState(view="robot"), hardware=self.hardware))
        self.kind, self.answers, self.robot = kind, dict(answers), robot
        self.seen, self.texts, self.angles = [], [], []
        self.clock.look = self.look
        self.truth = EmulatedMachine(robot, kind).truth

    def look(self):
        emulated = getattr(self.bring_up, "_emulated", None)
        if emulated is not None:
            self.angles.append(emulated.angles)

    @property
    def bring_up(self):
        return self.asked.session._live.bring_up

    def begin(self):
        assert self.asked.types("bring_up", on=True) == ["done"]

    def next(self):
        """Wait for the next question, or the end."""
        for _ in range(5_000):
            message = self.asked.session.frame(1 / 60)
            if message is not None and message.state != "moving":
                self.seen.append(message)
                return message
            time.sleep(0.001)
        raise AssertionError(self.seen[-1])

    def go(self):
        """Answer until the end, or until an answer is None."""
        while (message := self.next()).state == "asking":
            question = message.question
            self.texts.append(question.text)
            moved, self.angles = self.angles, []
            key = self.key(message, moved)
            if key is None:
                return message
            assert self.asked.types("answer", number=question.number, key=key) == ["done"], question
            assert len(self.texts) < 200, self.texts[-5:]
        return message

    def key(self, message, moved):
        text = message.question.text
        for pattern in [pattern for pattern in self.answers if pattern in text]:
            answer = self.answers.pop(pattern)
            return answer() if callable(answer) else answer
        keys = {choice.text: choice.key for choice in message.question.choices}
        if "Which servos" in text:
            return keys[BUSES[self.kind].title]
        if "To which port" in text:
            return "e"
        if moved:
            self.path = np.array(moved) - moved[0]
        if "Which leg moved" in text:
            self.leg, self.joint = np.unravel_index(np.abs(self.path).max(axis=0).argmax(), (self.robot.legs, 3))
            return str(self.leg + 1)
        if "Which joint" in text:
            assert (message.question.leg, message.question.joint) == (self.leg, None)
            return "cft"[self.joint]
        if "Which way" in text:
            assert (message.question.leg, message.question.joint) == (self.leg, self.joint)
            return self.way(keys)
        return ""

    def way(self, keys):
        way = self.path[:, self.leg, self.joint]
        sign = np.sign(way[np.abs(way).argmax()])
        if self.joint > 0:
            return keys["up" if sign > 0 else "down"]
        yaw = float(np.asarray(self.robot.mount_yaw)[self.leg])
        forward, left = -np.sin(yaw) * sign, np.cos(yaw) * sign
        if "forward" in keys:
            return keys["forward" if forward > 0 else "rearward"]
        return keys["left" if left > 0 else "right"]


@pytest.fixture(autouse=True)
def short_walk(monkeypatch):
    monkeypatch.setattr(trial, "_WALK_TIME", 0.3)


@pytest.mark.no_cover
def test_a_machine_is_brought_up_from_a_page(tmp_path):
    page = Page(tmp_path)
    assert page.asked("hello", "welcome", state=None)["hardware"] == {"missing": None}
    page.begin()
    end = page.go()
    assert (end.state, end.problem, end.known, end.joints) == ("done", None, 18, 18)
    assert end.emulated
    assert end.file == str(tmp_path / FILE)
    made, truth = Calibration.load(tmp_path / FILE), page.truth
    assert [[j.number for j in row] for row in made.joints] == [[j.number for j in row] for row in truth.joints]
    assert [[j.direction for j in row] for row in made.joints] == [[j.direction for j in row] for row in truth.joints]
    assert np.abs(np.degrees((made.zeros - truth.zeros) / made.slopes)).max() < 0.6
    titles = [message.question.title for message in page.seen[:-1]]
    steps = list(dict.fromkeys(titles))
    assert steps == ["Port and servos", "Which servo is which joint", "Zeros", "Limits", "Check pose and walk"]
    assert "it walked for" in end.said[-1]
    assert not page.asked.session.driving
    assert page.asked.session.frame(0.1) is None


@pytest.mark.no_cover
def test_it_is_left_and_resumed_and_wrong_answers_do_no_harm(tmp_path):
    page = Page(tmp_path)
    page.begin()
    number = page.next().question.number
    assert "no choice of this question; there are" in page.asked.error("answer", number=number, key="x")["text"]
    assert "not asked now" in page.asked.error("answer", number=number + 1, key="")["text"]
    page.answers = {"Which joint": "b", "Which way": "b"}
    key = page.key(page.seen[-1], [])
    assert page.asked.types("answer", number=number, key=key) == ["done"]
    for kind, more in [("robot", {"preset": "phantomx"}), ("undo", {}), ("hello", {})]:
        assert "leave the bring-up first" in page.asked.error(kind, **more)["text"]
    assert page.asked.types("view", view="joints") == ["pose", "done"]
    assert page.asked.types("bring_up", on=True) == ["done"]  # it is on already
    while len([text for text in page.texts if "Which way" in text]) < 4:
        message = page.next()
        page.texts.append(message.question.text)
        moved, page.angles = page.angles, []
        key = page.key(message, moved)
        assert page.asked.types("answer", number=message.question.number, key=key) == ["done"], (message, key)
    assert page.asked.types("bring_up", on=False) == ["done"]
    left = page.next()
    assert left.state == "left"
    known = {j.number for row in Calibration.load(tmp_path / FILE).joints for j in row} - {None}
    assert len(known) in (2, 3)
    assert "no servos are being brought up" in page.asked.error("answer", number=1, key="")["text"]
    assert page.asked.types("bring_up", on=False) == ["done"]
    again = Page(tmp_path)
    again.begin()
    assert again.go().state == "done"
    asked_again = [text for text in again.texts if "Which leg moved" in text]
    assert len(asked_again) == 18 - len(known)


@pytest.mark.parametrize("way", ["leave", "close"])
def test_a_visitor_who_leaves_in_the_middle_of_a_motion_releases_the_servos_at_once(tmp_path, way):
    page = Page(tmp_path)
    page.begin()
    machines = []

    def leave():
        emulated = page.bring_up._emulated
        if emulated is not None and any(servo.torque for servo in emulated.servos.values()) and not machines:
            machines.append((emulated, page.bring_up, page.clock.now()))
            page.asked.session.close() if way == "close" else page.asked.types("bring_up", on=False)

    page.clock.look = leave
    for _ in range(2):
        page.asked.types("answer", number=page.next().question.number, key=page.key(page.seen[-1], []))
    while not machines:
        time.sleep(0.001)
    emulated, bring_up, when = machines[0]
    bring_up._end_now()
    assert not any(servo.torque for servo in emulated.servos.values())
    assert page.clock.now() - when < 0.1
    assert bring_up.message().state == "left"


def test_servos_belong_to_one_visitor(tmp_path):
    first = Page(tmp_path)
    second = Page(tmp_path, hardware=first.hardware)
    first.begin()
    assert "another visitor uses the servos" in second.asked.error("bring_up", on=True)["text"]
    first.next()
    first.asked.session.close()
    while (message := first.asked.session.frame(0.1)) is None or message.state != "left":
        time.sleep(0.001)
    second.begin()
    second.next()
    second.asked.session.close()


def test_without_hardware_the_page_says_why(monkeypatch):
    local, public = Asked(), Asked(Session(public=True))
    for asked, why in [(local, "started without access to hardware"), (public, "any visitor could move the servos")]:
        assert why in asked("hello", "welcome", state=None)["hardware"]["missing"]
        assert why in asked.error("bring_up", on=True)["text"]
    monkeypatch.setattr("sys.platform", "emscripten")
    assert "the studio in the browser has no access" in local.error("bring_up", on=True)["text"]
    with pytest.raises(tarsus.InputError, match="a public server has no access to hardware"):
        Settings(public=True, hardware=Hardware(None))


def own_robot():
    document = robot_to_dict(STRIDER)
    document["name"] = "my own"
    document["leg"]["femur_mm"] = 104
    return robot_from_dict(document), document


def test_an_own_robot_gets_a_file_beside_its_calibration(tmp_path):
    robot, document = own_robot()
    start = StudioState(view="robot", robot=RobotChoice(preset=None, document=document))
    page = Page(tmp_path, start=start, robot=robot)
    page.begin()
    for _ in range(2):
        page.asked.types("answer", number=page.next().question.number, key=page.key(page.seen[-1], []))
    page.next()
    page.asked.session.close()
    made = Calibration.load(tmp_path / "my-own.calibration.toml")
    assert (made.robot, made.robot_file) == (robot, "my-own.toml")
    # A file with another robot is never overwritten.
    other = tmp_path / "other"
    other.mkdir()
    save_robot(STRIDER, other / "my-own.toml")
    refused = Page(other, start=start).asked.error("bring_up", on=True)["text"]
    assert "my-own.toml is another robot than the one of this page" in refused
    # The file from which the studio was started is used where it is.
    mine = tmp_path / "mine.toml"
    save_robot(robot, mine)
    assert Hardware(other, robot_file=mine).files(robot) == ("mine.toml", tmp_path / "mine.calibration.toml")
    given = Hardware(other, robot_file=mine, calibration=other / "c.toml").files(robot)
    assert given == (os.path.join("..", "mine.toml"), other / "c.toml")


class Answers:
    """A dialogue that gives prepared answers, and keeps what was offered."""

    def __init__(self, *answers):
        self.answers, self.offered = list(answers), []

    def say(self, text):
        self.offered.append(text)

    def choose(self, question, options, *, topic):
        assert topic.title == "Port and servos"
        self.offered.append(options)
        return self.answers.pop(0)


def test_servos_and_ports_are_asked_for_where_they_are_not_given(tmp_path, monkeypatch):
    monkeypatch.setattr(beginning, "list_ports", lambda: ("/dev/ttyUSB0", "/dev/ttyUSB1"))
    monkeypatch.setattr(beginning, "glob", lambda pattern: [pattern.replace("*", "1")])
    kinds = {title: key for key, title in _offered_kinds(tmp_path).items()}
    assert set(kinds) == {kind.title for kind in BUSES.values()}
    asked = Answers(kinds[BUSES["lx16a"].title], "2")
    made = beginning.begin(STRIDER, "strider", tmp_path / "a.toml", asked)
    assert (made.buses[0].kind, made.buses[0].port) == ("lx16a", "/dev/ttyUSB1")
    assert "e" not in asked.offered[1]
    asked = Answers("1")
    made = beginning.begin(STRIDER, "strider", tmp_path / "b.toml", asked, kind="pca9685", emulated=True)
    assert (made.buses[0].port, asked.offered[0]["e"]) == ("/dev/i2c-1", "emulated servos, without hardware")
    given = Answers()
    made = beginning.begin(STRIDER, "strider", tmp_path / "c.toml", given, kind="lines", port="")
    assert (made.buses[0].port, given.offered) == ("", [])
    again = beginning.begin(STRIDER, "strider", tmp_path / "c.toml", given)
    assert again.joints == made.joints
    assert "18 joints are not complete" in given.offered[0]


def _offered_kinds(folder):
    asked = Answers("", "")
    beginning.begin(STRIDER, "strider", folder / "usual.toml", asked)
    return asked.offered[0]


def test_what_fails_is_said_in_the_page(tmp_path):
    (tmp_path / FILE).write_text("name = 3\n", encoding="utf-8")
    page = Page(tmp_path)
    page.begin()
    end = page.next()
    assert end.state == "failed"
    assert FILE in end.problem
    # Another robot's calibration is refused.
    page = Page(tmp_path, hardware=Hardware(tmp_path, calibration=tmp_path / "other.toml"))
    tarsus.hardware.nominal_calibration(tarsus.load_robot("phantomx"), "phantomx").save(tmp_path / "other.toml")
    page.begin()
    assert "which is not the robot 'strider'" in page.next().problem


def test_a_bug_is_said_in_the_page_too(tmp_path, monkeypatch):
    def broken(*_args, **_more):
        raise ZeroDivisionError

    monkeypatch.setattr("tarsus.studio.machine.page_bring_up.begin", broken)
    page = Page(tmp_path)
    page.begin()
    assert page.next().problem == "this is a bug in Tarsus, please report it: ZeroDivisionError"


@pytest.mark.parametrize("kind", ["feetech-sts", "pca9685"])
def test_hands_bring_limp_joints_of_the_emulated_machine_where_they_are_asked_to(kind):
    machine = EmulatedMachine(STRIDER, kind, clock=ManualClock())
    reference = reference_angles(STRIDER)
    assert np.abs(machine.angles - reference).max() > np.radians(5)
    machine.hold(Topic(leg=2, pose="reference"))
    assert machine.angles[2] == pytest.approx(reference[2])
    for end, at in (("one end", 0), ("the other end", 1)):
        machine.hold(Topic(leg=3, joint=1, pose=end))
        assert abs(machine.angles[3, 1] - machine.truth.limits[3, 1, at]) == pytest.approx(np.radians(5), abs=1e-3)
    before = machine.angles
    machine.servos[machine.truth.joints[2][0].number].torque = True
    machine.hold(Topic(leg=2))
    machine.hold(Topic(leg=2, pose="one end"))
    np.testing.assert_allclose(machine.angles, before)
    assert opening.emulated_machine_of(machine.truth).truth.joints == machine.truth.joints
    with pytest.raises(tarsus.errors.PortError, match="Begin with another calibration file"):
        machine.open(kind, "/dev/ttyUSB0")
    assert machine.open(kind, "emulated").port == "emulated"
    assert threading.active_count() < 20


def test_foot_switches_are_found_from_a_page(tmp_path):
    truth = EmulatedMachine(STRIDER, "servo2040").truth
    truth.replace(foot_switches=None).save(tmp_path / FILE)
    page = Page(tmp_path, kind="servo2040", answers={"Does the robot have foot switches": "y"})
    page.begin()
    assert page.go().state == "done"
    assert Calibration.load(tmp_path / FILE).foot_switches == truth.foot_switches
    feet = [message.question for message in page.seen[:-1] if "Press the" in message.question.text]
    assert [(each.title, each.leg) for each in feet] == [("Foot switches", leg) for leg in range(6)]
