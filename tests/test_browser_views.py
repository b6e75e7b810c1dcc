"""The views in a browser agree with the Python functions."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest
from playwright.sync_api import expect

import tarsus
from browser import DESK, PHONE, number, numbers
from tarsus.load.handbook.method import handbook
from tarsus.robot.file import robot_from_dict, robot_to_dict
from tarsus.studio.messages.state import BodyState, RobotChoice, SourceChoice, StudioState, WalkOptions
from tarsus.studio.sources.errata import errata as found_errata
from tarsus.studio.sources.page import DOCUMENTS

pytest_plugins = "browser_fixtures"

STRIDER = tarsus.load_robot("strider")
TITLES = {number: document.title for number, document in DOCUMENTS.items()}


def footholds(robot):
    """Where the feet stand in G, and how high the body is over them."""
    height = tarsus.default_body_height(robot)
    return np.asarray(tarsus.default_stance(robot)) + np.array([0.0, 0.0, height]), height


FEET, HEIGHT = footholds(STRIDER)


def body_at(dx=0.0, dy=0.0, dz=0.0, *, roll=0.0, pitch=0.0, yaw=0.0):
    return tarsus.Pose.from_rpy(*np.radians([roll, pitch, yaw]), (dx / 1000, dy / 1000, HEIGHT + dz / 1000))


def total_mass(robot):
    return float(robot.body_mass + np.sum(robot.link_mass))


def shown_angles(visitor):
    return np.array([[float(cell) for cell in row[1:]] for row in visitor.table("angles")])


def test_joints_show_the_resting_pose(visitor):
    visitor.open(StudioState(view="joints"))
    visitor.unfold()
    angles = np.degrees(tarsus.inverse_kinematics(STRIDER, FEET, body_at()).angles)
    assert shown_angles(visitor) == pytest.approx(angles, abs=0.006)

    for joint, angle in {"LF-femur": 60.0, "LF-tibia": -20.0, "RM-femur": 10.0}.items():
        visitor.type(f"joint-{joint}", angle)
    angles[0, 1:], angles[4, 1] = (60, -20), 10
    rest = tarsus.resting_pose(STRIDER, np.radians(angles))
    expect(visitor.at("standing")).to_contain_text(rest.describe().split(";")[0])
    facts = visitor.facts("standing-facts")
    assert number(facts["Stability margin"]) == pytest.approx(rest.margin * 1000, abs=0.06)
    assert int(facts["Feet on the ground"]) == rest.contacts.sum()
    assert numbers(facts["Roll, pitch"]) == pytest.approx(np.degrees(rest.body.rpy[:2]), abs=0.06)
    assert shown_angles(visitor) == pytest.approx(angles, abs=0.006)
    said = [visitor.page.locator("fieldset .badge").nth(leg).inner_text() for leg in range(6)]
    assert [text == "on the ground" for text in said] == rest.contacts.tolist()


def test_a_joint_beyond_its_limit_is_reported_with_the_excess(visitor):
    visitor.open(StudioState(view="joints"))
    highest = np.degrees(STRIDER.limits[0, 1, 1])
    visitor.type("joint-LF-femur", highest + 12)
    expect(visitor.at("problems")).to_contain_text(f"12.0 deg above its upper limit of {highest:.1f} deg")
    expect(visitor.at("joint-LF-femur")).to_have_attribute("aria-invalid", "true")


def test_the_body_moves_relative_to_its_feet(visitor):
    visitor.open(StudioState(view="body"))
    visitor.unfold()
    asked = {"x_mm": 12.0, "z_mm": -9.0, "roll_deg": 4.0, "yaw_deg": -7.0}
    for name, value in asked.items():
        visitor.type(f"body-{name}", value)
    body = body_at(12, 0, -9, roll=4, yaw=-7)
    angles = tarsus.inverse_kinematics(STRIDER, FEET, body).require().angles
    margin = tarsus.stability_margin(STRIDER, angles, body, np.ones(6, bool)) * 1000
    expect(visitor.at("standing")).to_contain_text(
        f"stands on 6 feet: LF, LM, LR, RR, RM, RF; stability margin {margin:.1f} mm"
    )
    assert number(visitor.facts("standing-facts")["Stability margin"]) == pytest.approx(margin, abs=0.06)
    assert shown_angles(visitor) == pytest.approx(np.degrees(angles), abs=0.006)


def test_a_leg_out_of_reach_is_reported_with_reason_and_distance(visitor):
    visitor.open(StudioState(view="body", body=BodyState(y_mm=-130.0, z_mm=-60.0)))
    solution = tarsus.inverse_kinematics(STRIDER, FEET, body_at(0, -130, -60))
    failing = np.flatnonzero(np.asarray(solution.reach))
    assert 0 < len(failing) < 6
    problems = visitor.at("problems")
    for line in solution.explain().splitlines():
        expect(problems).to_contain_text(line.strip())
    assert re.search(r"\d mm", problems.inner_text())
    expect(visitor.at("chip-trouble")).to_contain_text(f"problems in {len(failing)} legs")
    assert "%" in visitor.at("feasible-fraction").inner_text()
    visitor.at("body-home").click()
    # Of a body that isn't moved, no fraction of the movement is possible or not.
    visitor.type("body-height", 400)
    expect(visitor.at("problems").or_(visitor.at("failure")).first).to_be_visible()
    expect(visitor.at("feasible-fraction")).to_have_count(0)
    visitor.at("body-height-auto").click()
    expect(problems).to_have_count(0)
    expect(visitor.at("standing")).to_contain_text("stands on 6 feet")


def test_a_walk_is_planned_with_the_given_options(visitor):
    visitor.open(StudioState(view="walk"))
    visitor.at("gait").select_option("ripple")
    visitor.type("distance", 420)
    visitor.type("heading", 35)
    path = tarsus.straight_path(0.42, np.radians(35))
    motion = tarsus.plan_walk(STRIDER, tarsus.Gait.named("ripple"), path)
    x, y = motion.body.position[-1, :2] * 1000
    expect(visitor.at("walk-facts")).to_contain_text(f"End position x, y{x:.1f}, {y:.1f} mm")
    facts = visitor.facts("walk-facts")
    least = motion.margin.min() * 1000
    assert number(facts["Duration"]) == pytest.approx(motion.duration, abs=0.006)
    assert int(facts["Steps"]) == motion.steps
    assert number(facts["Stroke"]) == pytest.approx(motion.stroke * 1000, abs=0.06)
    assert number(facts["Speed"]) == pytest.approx(motion.speed * 1000, abs=0.06)
    assert number(facts["Minimum stability margin"]) == pytest.approx(least, abs=0.06)
    longest = tarsus.max_stroke(STRIDER, tarsus.Gait.named("ripple"), np.radians(35)) * 1000
    assert number(facts["Longest stroke"]) == pytest.approx(longest, abs=0.06)
    expect(visitor.at("walk-verdict")).to_contain_text("Every foot reaches its whole path.")


def test_only_a_walk_that_can_be_shown_is_offered_to_be_shown(visitor):
    visitor.open(StudioState(view="walk"))
    anyway = visitor.page.get_by_role("button", name="Show it anyway")
    visitor.type("stroke_mm", 500)
    expect(anyway.first).to_be_visible()
    visitor.type("distance", 0)
    expect(visitor.at("failure").first).to_contain_text("no length")
    expect(anyway).to_have_count(0)


def test_a_stroke_too_long_is_refused_beside_its_field(visitor):
    visitor.open(StudioState(view="walk"))
    visitor.type("stroke_mm", 500)
    expect(visitor.at("failure")).to_contain_text("stroke")
    with pytest.raises(tarsus.TarsusError) as refused:
        tarsus.plan_walk(STRIDER, tarsus.Gait.named("tripod"), tarsus.straight_path(0.5), stroke=0.5)
    assert str(refused.value) in visitor.at("failure").inner_text()
    # Beside its field, and nothing says that all is well. Scrolled away, it stays in sight.
    field, refusal = visitor.at("stroke_mm-number"), visitor.at("failure")
    assert 0 < refusal.bounding_box()["y"] - field.bounding_box()["y"] < 100
    expect(refusal).to_be_in_viewport()
    expect(visitor.at("walk-verdict")).to_contain_text("The last accepted walk is shown.")
    for end in (0, 10_000):
        visitor.page.locator(".panel").evaluate("(panel, end) => panel.scrollTo(0, end)", end)
        expect(visitor.page.locator(".failures")).to_be_in_viewport(ratio=0.9)
    visitor.page.locator(".failures").get_by_role("button", name=re.compile(r"Use [\d.]+ mm")).click()
    expect(visitor.at("failure")).to_have_count(0)
    expect(visitor.at("walk-verdict")).to_contain_text("Every foot reaches its whole path.")


def test_a_number_field_shows_what_is_applied(visitor):
    visitor.open(StudioState(view="walk"))
    field, note = visitor.at("distance-number"), visitor.at("distance-number-note")
    for text, why in {"99999": "99999: must be from 0 to 20000", "": "Empty: must", "1,2,3": "1,2,3: must"}.items():
        field.fill(text)
        field.press("Enter")
        expect(field).to_have_value("500")
        expect(note).to_contain_text(why)
    for text, value in {"412,5": "412.5", "6e2": "600"}.items():
        field.fill(text)
        field.press("Enter")
        expect(field).to_have_value(value)
        expect(note).to_have_count(0)
        expect(visitor.at("walk-facts")).to_contain_text(f"End position x, y{float(value):.1f}, 0.0 mm")
    # Undo by keyboard, though the field still has the focus.
    expect(field).to_be_focused()
    visitor.page.keyboard.press("Control+z")
    expect(field).to_have_value("412.5")
    visitor.page.keyboard.press("Control+z")
    expect(field).to_have_value("500")
    expect(visitor.at("undo")).to_be_disabled()


def test_a_custom_gait_starts_as_the_present_one(visitor):
    visitor.open(StudioState(view="walk", walk=WalkOptions(gait="ripple")))
    least = visitor.facts("walk-facts")["Minimum stability margin"]
    visitor.at("gait").select_option("own")
    expect(visitor.at("phase-LF")).to_be_visible()
    expect(visitor.page.get_by_text("Touch-down of each foot")).to_be_visible()
    assert [float(visitor.at(f"phase-{code}").input_value()) for code in STRIDER.leg_codes] == pytest.approx(
        tarsus.Gait.named("ripple").offsets, abs=0.006
    )
    expect(visitor.at("walk-verdict")).to_contain_text("Every foot")
    assert visitor.facts("walk-facts")["Minimum stability margin"] == least


def test_nothing_over_the_picture_covers_anything_else(visitor):
    visitor.open(StudioState(view="loads"))
    expect(visitor.at("chip-margin")).to_be_visible()
    names = ("chip-margin", "chip-feet", "force-legend", "camera-free", "play-speed", "loop", "clock")
    boxes = [visitor.at(name).bounding_box() for name in names]
    for one, other in itertools.combinations(boxes, 2):
        apart = [
            one[at] + one[size] <= other[at] or other[at] + other[size] <= one[at]
            for at, size in (("x", "width"), ("y", "height"))
        ]
        assert any(apart), (one, other)
    player = visitor.at("player").bounding_box()
    for box in boxes[-3:]:
        assert player["x"] <= box["x"]
        assert box["x"] + box["width"] <= player["x"] + player["width"]


def test_forces_are_labelled_in_newtons_beside_the_names_of_the_legs(visitor):
    visitor.open(StudioState(view="loads"))
    expect(visitor.at("force-legend")).to_contain_text("[N]")
    motion = tarsus.plan_walk(STRIDER, tarsus.Gait.named("tripod"), tarsus.straight_path(0.5))
    forces = np.linalg.norm(tarsus.joint_loads(STRIDER, motion).forces[0], axis=-1)
    for code, force in zip(STRIDER.leg_codes, forces, strict=True):
        expect(visitor.at(f"force-{code}")).to_have_text(f"{force:.1f} N")
        expect(visitor.page.locator(".note-leg", has_text=code)).to_be_visible()


def test_the_playback_is_stepped_and_scrubbed(visitor):
    visitor.open(StudioState(view="walk"))
    visitor.unfold()
    motion = tarsus.plan_walk(STRIDER, tarsus.Gait.named("tripod"), tarsus.straight_path(0.5))
    visitor.at("scrub").fill("1.2")
    for _ in range(3):
        visitor.at("step-forward").click()
    expect(visitor.at("clock")).to_have_text("1.23 s")
    expect(visitor.page.get_by_text("Joint angles at 1.23 s")).to_be_visible()
    assert shown_angles(visitor) == pytest.approx(np.degrees(motion.angles[123]), abs=0.006)
    visitor.at("play").click()
    expect(visitor.at("clock")).not_to_have_text("1.23 s")
    visitor.at("play").click()


def test_loads_are_those_of_the_walk(visitor):
    visitor.open(StudioState(view="loads"))
    visitor.type("payload", 0.5)
    motion = tarsus.plan_walk(STRIDER, tarsus.Gait.named("tripod"), tarsus.straight_path(0.5))
    found = tarsus.joint_loads(STRIDER, motion, payload=0.5)
    weight = (total_mass(STRIDER) + 0.5) * 9.80665
    expect(visitor.at("load-facts")).to_contain_text(f"Weight{weight:.1f} N")
    peaks = np.array([[number(cell) for cell in row[1:]] for row in visitor.table("torques")])
    assert peaks == pytest.approx(np.abs(found.torques).max(0), abs=0.006)
    assert number(visitor.facts("load-facts")["Energy"]) == pytest.approx(found.energy, abs=0.06)

    visitor.at("size-servos").click()
    sizing = tarsus.size_servos(STRIDER, found, safety_factor=3.0)
    answer = visitor.at("servo-answer")
    expect(answer).to_contain_text("The present servos are" + (" sufficient." if sizing.ok else " not sufficient."))
    assert sizing.mixed is not None
    mixed = ", ".join(f"{joint} {servo.name}" for joint, servo in sizing.mixed.servos.items())
    expected = [one.servos["coxa"].name for one in sizing.candidates] + [mixed]
    assert answer.locator("td.wrap").all_inner_texts() == expected


def test_a_field_of_the_robot_changes_the_robot(visitor):
    visitor.open(StudioState(view="robot"))
    visitor.unfold()
    visitor.type("robot-tibia", 200)
    expect(visitor.at("doc-body.mass_kg")).to_have_value(f"{robot_to_dict(STRIDER)['body']['mass_kg']:g}")
    visitor.at("doc-body.mass_kg").fill("2.5")
    visitor.at("doc-body.mass_kg").press("Enter")
    document = robot_to_dict(STRIDER)
    document["leg"]["tibia_mm"], document["body"]["mass_kg"] = 200, 2.5
    robot = robot_from_dict(document)
    expect(visitor.at("robot-facts")).to_contain_text(f"Total mass{total_mass(robot):.3f} kg")
    longest = tarsus.max_stroke(robot, tarsus.Gait.named(robot.gait.name), 0.0) * 1000
    assert number(visitor.facts("robot-facts")["Longest stroke"]) == pytest.approx(longest, abs=0.06)
    visitor.view("body")
    visitor.unfold()
    feet, height = footholds(robot)
    angles = tarsus.inverse_kinematics(robot, feet, tarsus.Pose(position=np.array([0, 0, height]))).angles
    expect(visitor.at("angles")).to_contain_text(f"{np.degrees(angles[0, 2]):.2f}")
    assert shown_angles(visitor) == pytest.approx(np.degrees(angles), abs=0.006)


def test_an_invalid_field_shows_its_error(visitor):
    visitor.open(StudioState(view="robot"))
    visitor.unfold()
    field = visitor.at("doc-leg.limits_deg.femur[0]")
    field.fill("120")
    field.press("Enter")
    expect(visitor.at("failure")).to_contain_text("limits_deg")
    expect(visitor.page.locator(".field-problem").first).to_be_visible()
    visitor.view("joints")
    lowest = np.degrees(STRIDER.limits[0, 1, 0])
    expect(visitor.at("joint-LF-femur")).to_have_attribute("min", f"{lowest:g}")


def test_equations_of_the_sources_agree_with_tarsus(visitor):
    body = BodyState(x_mm=10.0, pitch_deg=5.0)
    state = StudioState(view="sources", source=SourceChoice(number="000", leg=3), body=body)
    visitor.open(state.model_copy(update={"robot": RobotChoice(preset="phantomx")}))
    robot = tarsus.load_robot("phantomx")
    feet, height = footholds(robot)
    pose = tarsus.Pose.from_rpy(0, np.radians(5), 0, (0.01, 0, height))
    coxa, femur, tibia = np.degrees(tarsus.inverse_kinematics(robot, feet, pose).require().angles[3])
    angles = {
        "000": {"6.theta_C": coxa, "10.theta_F": femur, "11.theta_gamma": tibia + 180},
        "004": {"12.q2": femur, "14.q3": -tibia},
    }
    for document, expected in angles.items():
        visitor.at("source-number").select_option(document)
        for key, ours in expected.items():
            assert number(value_of(visitor, key)) == pytest.approx(ours, abs=0.006), key

    # The torques of 004 are the handbook's.
    lines = [line for line in handbook(robot, leg=3).lines if line.key.startswith("stance.") and line.formula]
    assert len(lines) >= 2
    for line in lines:
        assert number(value_of(visitor, line.key)) == pytest.approx(line.value, rel=6e-4), line.key


@pytest.mark.parametrize("viewport", [DESK, PHONE], ids=["desk", "phone"])
def test_nothing_of_the_sources_is_cut_off_and_errata_can_be_told_apart(arrive, viewport):
    body = BodyState(roll_deg=4.0, pitch_deg=-3.0, yaw_deg=5.0)
    visitor = arrive(viewport=viewport).open(StudioState(view="sources", body=body))
    for document in ("000", "001", "002", "003", "004"):
        visitor.at("source-number").select_option(document)
        visitor.at("source").get_by_role("heading", name=TITLES[document]).wait_for()
        visitor.unfold()
        cut = "[...document.querySelectorAll('.maths')].filter(box => box.scrollWidth > box.clientWidth + 1).length"
        assert visitor.page.evaluate(cut) == 0
        errata = visitor.page.locator("dl.erratum").all()
        assert len(errata) == sum(row.number == document for row in found_errata())
        for erratum in errata:
            outputs = erratum.locator("output").all_inner_texts()
            assert len(outputs) in (0, 2)
            # On strider's circle the attachment lies in the direction of the leg.
            if outputs and "whole translation" not in erratum.inner_text():
                assert outputs[0] != outputs[1]


def value_of(visitor, key):
    return visitor.at(f"equation-{key}").locator("output").first.inner_text()
