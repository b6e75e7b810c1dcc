"""Driving in the studio is the live walker with the guard behind it."""

import math

import numpy as np
import pytest

from sample_studio import Asked, table
from tarsus import centre_of_mass, list_robots, load_robot, stability_margin
from tarsus.control.command import Command
from tarsus.control.walk_controller import WalkController

DT = 1 / 60


def driven(robot="strider"):
    asked = Asked()
    asked.all("view", view="drive")
    asked.all("robot", preset=robot)
    assert asked.types("drive", on=True) == ["done"]
    return asked


def frames(asked, count):
    return [asked.session.frame(DT) for _ in range(count)]


@pytest.mark.parametrize("name", list_robots())
def test_frames_are_what_the_walker_does(name):
    asked, controller = driven(name), WalkController(load_robot(name))
    command = {"velocity_mm_s": [40, -10], "turn_deg_s": 6, "body": [0, 0, 5, 1, 2, 3]}
    assert asked.types("wish", **command) == ["done"]
    turn = math.radians(1), math.radians(2), math.radians(3)
    same = Command(twist=(0.04, -0.01, math.radians(6)), body=(0, 0, 0.005, *turn))
    for frame in frames(asked, 90):
        angles = np.asarray(controller.step(same, DT))
        assert table(frame.angles_deg, 3) == pytest.approx(np.degrees(angles), abs=6e-4)
        body = controller.body
        assert frame.position_mm == pytest.approx(body.position * 1000, abs=0.006)
        assert frame.contacts == "".join(str(int(down)) for down in controller.contacts)
        com = body @ centre_of_mass(controller.robot, angles)
        assert frame.com_mm == pytest.approx(com[:2] * 1000, abs=0.006)
        margin = stability_margin(controller.robot, angles, body, controller.contacts)
        assert frame.margin_mm == pytest.approx(float(margin) * 1000, abs=0.006)
        assert frame.interventions == 0
    assert frame.mode == "walking"
    assert frame.twist == pytest.approx(
        [controller.twist[0] * 1e3, controller.twist[1] * 1e3, math.degrees(controller.twist[2])], abs=1e-4
    )


def test_nobody_drives_until_it_is_asked_for():
    asked = Asked()
    assert asked.session.frame(DT) is None
    assert asked.types("wish", velocity_mm_s=[50, 0], turn_deg_s=0) == ["done"]
    assert asked.session.frame(DT) is None
    assert not asked.session.driving


def test_a_wish_holds_until_the_next_and_the_robot_stops_in_its_stance():
    asked = driven()
    asked.all("wish", velocity_mm_s=[60, 0], turn_deg_s=0)
    walking = frames(asked, 200)
    assert walking[-1].mode == "walking"
    asked.all("wish", velocity_mm_s=[0, 0], turn_deg_s=0, gait="ripple")
    stopping = frames(asked, 600)
    assert stopping[-1].mode == "standing"
    assert stopping[-1].gait == "ripple"
    assert stopping[-1].contacts == "111111"
    assert stopping[-1].position_mm[0] > 100


@pytest.mark.parametrize(
    ("wish", "kind"),
    [({"gait": "gallop"}, "unknown_name"), ({"cycle_time_s": 0.0}, None), ({"body_height_mm": -90_000}, None)],
)
def test_a_wish_that_can_not_be_is_told_and_the_walk_goes_on(command, kind):
    asked = driven()
    asked.all("wish", velocity_mm_s=[50, 0], turn_deg_s=0)
    frames(asked, 30)
    answers = asked.all("wish", velocity_mm_s=[50, 0], turn_deg_s=0, **command)
    told = [answer for answer in answers if answer["type"] == "error"] or [
        frame.model_dump() for frame in frames(asked, 200) if frame.type == "error" or frame.limited
    ]
    assert told
    if kind is not None:
        assert told[0]["kind"] == kind
    assert frames(asked, 1)[0].mode == "walking"


@pytest.mark.parametrize(
    ("kind", "more"),
    [("robot", {"preset": "phantomx"}), ("view", {"view": "walk"}), ("undo", {}), ("drive", {"on": False})],
)
def test_driving_ends_where_something_else_begins(kind, more):
    asked = driven()
    frames(asked, 5)
    asked.all(kind, **more)
    assert asked.session.frame(DT) is None


def test_a_robot_that_can_not_walk_can_not_be_driven():
    asked = Asked()
    document = load_robot("strider").to_dict()
    document["gait"]["body_height_mm"] = 400
    asked.all("document", document=document)
    assert asked.error("drive", on=True)["kind"] == "unreachable"
    assert not asked.session.driving


def test_a_bug_in_the_walker_ends_the_drive_and_not_the_session(monkeypatch, caplog):
    asked = driven()

    def fails(*_given):
        raise ZeroDivisionError

    monkeypatch.setattr(WalkController, "step", fails)
    assert asked.session.frame(DT).kind == "internal"
    assert asked.session.frame(DT) is None
    assert "ZeroDivisionError" in caplog.text
    assert asked.types("ping") == ["done"]
