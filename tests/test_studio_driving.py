"""Driving in the studio runs the robot controller, with frames of what it gives out."""

import math

import numpy as np
import pytest

from sample_studio import Asked, table
from tarsus import centre_of_mass, list_robots, load_robot, stability_margin
from tarsus.control.command import Command
from tarsus.control.robot_controller import RobotController
from tarsus.control.safety.interventions import Intervention, InterventionKind
from tarsus.robot.file import robot_to_dict

DT = 1 / 60
STOP = {"velocity_mm_s": [0, 0], "turn_deg_s": 0}
FORWARD = {"velocity_mm_s": [50, 0], "turn_deg_s": 0}


def driven(robot="strider"):
    asked = Asked()
    asked.all("view", view="drive")
    asked.all("robot", preset=robot)
    assert asked.types("drive", on=True) == ["done"]
    return asked


def frames(asked, count):
    return [asked.session.frame(DT) for _ in range(count)]


def until(asked, state, most=1200):
    """All frames up to the first in a state."""
    found = []
    while not found or found[-1].state != state:
        found.append(asked.session.frame(DT))
        assert len(found) < most, found[-1]
    return found


@pytest.mark.parametrize("name", list_robots()[::3])
def test_frames_show_what_the_controller_gives_out(name):
    asked, controller = driven(name), RobotController(load_robot(name))
    command = {"velocity_mm_s": [40, -10], "turn_deg_s": 6, "body": [0, 0, 5, 1, 2, 3]}
    assert asked.types("command", **command) == ["done"]
    turn = math.radians(1), math.radians(2), math.radians(3)
    same = Command(twist=(0.04, -0.01, math.radians(6)), body=(0, 0, 0.005, *turn))
    for frame in frames(asked, 90):
        output = controller.step(same, DT)
        angles, body = np.asarray(output.angles), output.body
        assert table(frame.angles_deg, 3) == pytest.approx(np.degrees(angles), abs=6e-4)
        assert frame.position_mm == pytest.approx(body.position * 1000, abs=0.006)
        assert frame.heading_deg == pytest.approx(math.degrees(output.heading), abs=6e-4)
        assert frame.contacts == "".join(str(int(down)) for down in output.contacts)
        com = body @ centre_of_mass(controller.robot, angles)
        assert frame.com_mm == pytest.approx(com[:2] * 1000, abs=0.006)
        margin = stability_margin(controller.robot, angles, body, output.contacts)
        assert frame.margin_mm == pytest.approx(float(margin) * 1000, abs=0.006)
        assert frame.limitations == [limitation.text() for limitation in output.limitations]
        assert (frame.intervention_count, frame.interventions, frame.guard) == (0, [], "passing")
        assert not frame.belly
    assert frame.state == "walking"
    assert frame.heading_deg > 3
    vx, vy, wz = output.twist
    assert frame.twist == pytest.approx([vx * 1e3, vy * 1e3, math.degrees(wz)], abs=1e-4)


def test_without_driving_there_are_no_frames():
    asked = Asked()
    assert asked.session.frame(DT) is None
    assert asked.types("command", **FORWARD) == ["done"]
    assert asked.session.frame(DT) is None
    assert not asked.session.driving
    assert not asked.session.is_planning


def test_a_command_holds_until_the_next_and_the_robot_stops_in_its_stance():
    asked = driven()
    asked.all("command", velocity_mm_s=[60, 0], turn_deg_s=0)
    walking = frames(asked, 200)
    assert walking[-1].state == "walking"
    asked.all("command", **STOP, gait="ripple")
    stopping = frames(asked, 600)
    assert stopping[-1].state == "standing"
    assert stopping[-1].gait == "ripple"
    assert stopping[-1].contacts == "111111"
    assert stopping[-1].position_mm[0] > 100


@pytest.mark.parametrize(
    ("command", "kind"),
    [({"gait": "gallop"}, "unknown_name"), ({"cycle_time_s": 0.0}, None), ({"body_height_mm": -90_000}, None)],
)
def test_an_impossible_command_is_reported_and_the_walk_continues(command, kind):
    asked = driven()
    asked.all("command", **FORWARD)
    frames(asked, 30)
    answers = asked.all("command", **FORWARD, **command)
    reported = [answer for answer in answers if answer["type"] == "error"] or [
        frame.model_dump() for frame in frames(asked, 200) if frame.type == "error" or frame.limitations
    ]
    assert reported
    if kind is not None:
        assert reported[0]["kind"] == kind
    assert frames(asked, 1)[0].state == "walking"


@pytest.mark.parametrize("name", list_robots()[::3])
def test_a_robot_sits_down_folds_and_stands_up_again(name):
    asked = driven(name)
    standing = frames(asked, 1)[0]
    asked.all("command", **STOP, state="lying")
    sitting = until(asked, "lying")
    assert "sitting" in {frame.state for frame in sitting}
    frames(asked, 1)
    lying = frames(asked, 1)[0]
    assert lying.belly
    assert lying.margin_mm is None
    assert lying.com_mm is None
    assert lying.position_mm[2] < standing.position_mm[2]
    asked.all("command", **STOP, state="folded")
    folding = until(asked, "folded")
    assert "folding" in {frame.state for frame in folding}
    assert all(frame.belly for frame in folding)
    asked.all("command", **STOP, state="standing")
    rising = until(asked, "standing")
    stages = {frame.activity for frame in rising if frame.state == "rising"}
    assert len(stages) > 1
    assert rising[-1].angles_deg == pytest.approx(standing.angles_deg, abs=0.1)
    assert not rising[-1].belly
    assert rising[-1].intervention_count == 0


def test_a_twist_is_reported_as_not_followed_unless_the_robot_stands():
    asked = driven()
    asked.all("command", **FORWARD)
    assert frames(asked, 60)[-1].limitations == []
    asked.all("command", **FORWARD, state="lying")
    sitting = until(asked, "lying")
    assert all("twist" in frame.limitations[-1] for frame in sitting)
    place = frames(asked, 30)[-1].position_mm
    assert place == sitting[-1].position_mm
    asked.all("command", **FORWARD, state="standing")
    rising = until(asked, "standing")[:-1]
    assert all("twist" in frame.limitations[-1] for frame in rising)
    assert until(asked, "walking")[-1].limitations == []
    asked.all("command", **STOP, state="lying")
    assert until(asked, "lying")[-1].limitations == []


def test_interventions_of_the_guard_are_counted_and_listed(monkeypatch):
    asked = driven()
    step = RobotController.step
    number = iter(range(100))

    def with_intervention(self, command, dt, readings=None):
        output = step(self, command, dt, readings)
        found = Intervention(InterventionKind.JOINT_SPEED, "LF", "femur", 9.0, 8.0, float(next(number)))
        object.__setattr__(output, "interventions", (found,))
        return output

    monkeypatch.setattr(RobotController, "step", with_intervention)
    last = frames(asked, 8)[-1]
    assert last.intervention_count == 8
    assert len(last.interventions) == 5
    assert "LF femur" in last.interventions[0]
    assert "at 7.000 s" in last.interventions[0]
    assert "at 3.000 s" in last.interventions[-1]


@pytest.mark.parametrize(
    ("kind", "more"),
    [("robot", {"preset": "phantomx"}), ("view", {"view": "walk"}), ("undo", {}), ("drive", {"on": False})],
)
def test_driving_ends_with_another_robot_view_or_state(kind, more):
    asked = driven()
    frames(asked, 5)
    asked.all(kind, **more)
    assert asked.session.frame(DT) is None


def test_a_robot_that_can_not_stand_can_not_be_driven():
    asked = Asked()
    document = robot_to_dict(load_robot("strider"))
    document["gait"]["body_height_mm"] = 400
    asked.all("document", document=document)
    assert asked.error("drive", on=True)["kind"] == "unreachable"
    assert not asked.session.driving


def test_an_unknown_state_is_refused():
    asked = driven()
    assert asked.error("command", **STOP, state="walking")["kind"] == "message"
    assert frames(asked, 1)[0].state == "standing"


def test_only_frames_that_may_plan_a_change_of_state_are_announced():
    asked = driven()
    asked.all("command", **FORWARD)
    frames(asked, 30)
    asked.all("command", **STOP, state="lying")
    assert not asked.session.is_planning
    while not asked.session.is_planning:
        frames(asked, 1)
    assert frames(asked, 1)[0].state == "sitting"
    assert not asked.session.is_planning


def test_a_defect_of_the_controller_ends_driving_and_not_the_session(monkeypatch, caplog):
    asked = driven()

    def fails(*_given):
        raise ZeroDivisionError

    monkeypatch.setattr(RobotController, "step", fails)
    assert asked.session.frame(DT).kind == "internal"
    assert asked.session.frame(DT) is None
    assert "ZeroDivisionError" in caplog.text
    assert asked.types("ping") == ["done"]
