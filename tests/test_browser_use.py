"""Use of the page: keyboard, touch, driving, several visitors, lost connections, accessibility."""

from __future__ import annotations

import re

import numpy as np
import pytest
from playwright.sync_api import expect

import tarsus
from browser import PHONE, VIEWS, number, numbers
from tarsus.robot.file import robot_to_dict
from tarsus.studio.messages.state import JointsState, Picture, RobotChoice, StudioState
from tarsus.studio.server.serve import Serving
from tarsus.studio.server.settings import Settings

pytest_plugins = "browser_fixtures"

STRIDER = tarsus.load_robot("strider")
FEET = STRIDER.leg_codes
REQUESTS = ("standing", "lying", "folded")


def focused(visitor):
    """What a keyboard user is at: the test id, or the name."""
    return visitor.page.evaluate(
        "(at => at.dataset.testid || at.getAttribute('aria-label') || at.textContent)(document.activeElement)"
    )


def shown_angles(visitor):
    return np.array([[float(cell) for cell in row[1:]] for row in visitor.table("angles")])


def test_everything_is_operable_by_keyboard(visitor):
    visitor.open(StudioState(view="joints"))
    reached = []
    while "joint-LF-tibia" not in reached:
        visitor.page.keyboard.press("Tab")
        reached.append(focused(visitor))
        assert len(reached) < 40
    expected = ["robot-choice", "copy-link", "save-png", "theme", "tab-joints", "scene", "camera-free", "camera-front"]
    assert [name for name in reached if name in expected] == expected
    assert reached[-5:] == [f"joint-LF-{part}" for part in ("coxa", "coxa-number", "femur", "femur-number", "tibia")]

    before = tarsus.inverse_kinematics(STRIDER, tarsus.default_stance(STRIDER)).angles
    femur, tibia = np.degrees(np.asarray(before)[0, 1:])
    for _ in range(8):
        visitor.page.keyboard.press("ArrowUp")
    visitor.page.keyboard.press("Shift+Tab")
    visitor.page.keyboard.press("Shift+Tab")
    visitor.page.keyboard.press("ArrowRight")
    # A slider moves in steps of half a degree from its lowest value.
    expect(visitor.at("joint-LF-femur")).to_be_focused()
    tibia_now = float(visitor.at("joint-LF-tibia").input_value())
    femur_now = float(visitor.at("joint-LF-femur").input_value())
    assert tibia_now == pytest.approx(tibia + 4, abs=0.5)
    assert femur_now == pytest.approx(femur + 0.5, abs=0.5)
    angles = np.array(before)
    angles[0, 1:] = np.radians([femur_now, tibia_now])
    rest = tarsus.resting_pose(STRIDER, angles)
    expect(visitor.at("standing-facts")).to_contain_text(f"Stability margin{rest.margin * 1000:.1f} mm")

    visitor.at("tab-joints").focus()
    visitor.page.keyboard.press("ArrowDown")
    expect(visitor.at("tab-body")).to_be_focused()
    expect(visitor.page.get_by_role("heading", name="Body", exact=True)).to_be_visible()


def test_keys_drive_the_robot_and_it_stops_in_its_stance(visitor):
    visitor.open(StudioState(view="drive"))
    expect(visitor.at("drive-facts")).to_contain_text("Forward speed0 mm/s")
    expect(visitor.at("drive-state")).to_have_text("standing")
    stance = np.degrees(tarsus.WalkController(STRIDER).angles)
    assert shown_angles(visitor) == pytest.approx(stance, abs=0.02)
    visitor.page.locator("main h2").click()
    visitor.page.keyboard.down("w")
    expect(visitor.at("drive-facts")).to_contain_text(re.compile(r"Position x, y([6-9]\d|\d{3,}), "))
    facts = visitor.facts("drive-facts")
    assert 0 < number(facts["Forward speed"]) <= 120
    expect(visitor.at("drive-state")).to_have_text("walking")
    visitor.page.keyboard.up("w")
    expect(visitor.at("drive-state")).to_have_text("standing")
    expect(visitor.at("drive-facts")).to_contain_text("Forward speed0 mm/s")
    assert shown_angles(visitor) == pytest.approx(stance, abs=0.02)
    facts = visitor.facts("drive-facts")
    assert facts["Guard interventions"] == "0"
    assert facts["Heading"] == "0°"
    x, y = numbers(facts["Position x, y"])
    assert x > 60
    assert abs(y) <= 1


def test_arrow_keys_drive_after_a_click_on_the_tab(visitor):
    visitor.open(StudioState(view="joints"))
    visitor.view("drive")
    visitor.at("drive-facts").wait_for()
    visitor.page.locator(".scene").click(position={"x": 8, "y": 200})
    visitor.page.keyboard.down("ArrowUp")
    visitor.page.keyboard.down("ArrowRight")
    expect(visitor.at("drive-facts")).to_contain_text(re.compile(r"Heading([5-9]|\d{2,})° right"))
    expect(visitor.at("chip-motion")).to_contain_text(re.compile(r"^[1-9]\d* mm/s, heading \d+° right$"))
    visitor.page.keyboard.up("ArrowUp")
    visitor.page.keyboard.up("ArrowRight")
    expect(visitor.at("drive-state")).to_have_text("standing")
    expect(visitor.at("chip-motion")).to_contain_text("0 mm/s")


def test_turning_changes_the_heading(visitor):
    visitor.open(StudioState(view="drive"))
    visitor.at("drive-facts").wait_for()
    visitor.page.locator("main h2").click()
    visitor.page.keyboard.down("e")
    expect(visitor.at("drive-facts")).to_contain_text(re.compile(r"Heading([5-9]|\d{2,})° right"))
    visitor.page.keyboard.up("e")
    expect(visitor.at("drive-state")).to_have_text("standing")


def test_the_robot_sits_down_folds_and_stands_up(visitor):
    visitor.open(StudioState(view="drive"))
    state, stand, sit, fold = map(visitor.at, ("drive-state", *(f"request-{name}" for name in REQUESTS)))
    expect(state).to_have_text("standing")
    expect(stand).to_be_disabled()
    stance = shown_angles(visitor)
    sit.click()
    expect(sit).to_be_disabled()
    expect(state).to_have_text("lying")
    expect(visitor.at("chip-state")).to_have_text("lying")
    expect(visitor.at("chip-margin")).to_have_text("body on the ground")
    assert visitor.facts("drive-facts")["Stability margin"] == "body on the ground"

    visitor.page.locator("main h2").click()
    visitor.page.keyboard.down("w")
    expect(visitor.at("drive-limitations")).to_contain_text("twist: 0")
    expect(visitor.at("chip-limitations")).to_contain_text("1 limitation")
    visitor.page.keyboard.up("w")
    expect(visitor.at("drive-limitations")).to_have_count(0)

    fold.click()
    expect(state).to_have_text("folded")
    expect(fold).to_be_disabled()
    expect(sit).to_be_disabled()
    expect(visitor.at("chip-feet")).to_have_text("0 feet on the ground")
    stand.click()
    expect(state).to_have_text("standing")
    expect(visitor.at("chip-margin")).to_contain_text("stable")
    assert shown_angles(visitor) == pytest.approx(stance, abs=0.02)
    assert visitor.facts("drive-facts")["Guard interventions"] == "0"


def test_another_robot_starts_standing_with_its_own_settings(visitor):
    visitor.open(StudioState(view="drive"))
    visitor.at("request-lying").click()
    visitor.type("drive-body-height", 120)
    expect(visitor.at("drive-state")).to_have_text("lying")
    visitor.at("robot-choice").select_option("phantomx")
    expect(visitor.at("drive-state")).to_have_text("standing")
    expect(visitor.at("request-lying")).to_be_enabled()
    height = tarsus.default_body_height(tarsus.load_robot("phantomx")) * 1000
    expect(visitor.at("drive-body-height-number")).to_have_value(f"{height:g}")


def test_all_views_work_on_a_phone(arrive):
    visitor = arrive(viewport=PHONE, has_touch=True, is_mobile=True, device_scale_factor=1)
    robot = robot_to_dict(STRIDER) | {"name": "a robot whose name is much longer than a phone is wide " * 2}
    visitor.open(StudioState(robot=RobotChoice(preset=None, document=robot)))
    size = "[document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
    for view in VIEWS:
        visitor.at(f"tab-{view}").tap()
        expect(visitor.page.locator(".app")).to_have_attribute("data-view", view)
        visitor.unfold()
        assert visitor.page.evaluate(size) == list(PHONE.values()), view
        panel = "panel => [panel.scrollWidth, panel.clientWidth]"
        wide, seen = visitor.page.locator(".panel").evaluate(panel)
        assert wide == seen, view
        for word in ("Ctrl", "Shift", "Keys", "drop a", "Click"):
            assert word not in visitor.page.locator(".panel").inner_text(), view
        small = visitor.page.evaluate(
            """[...document.querySelectorAll('button, select, input.typed')]
                 .map(one => [one.getBoundingClientRect(), one.dataset.testid || one.textContent])
                 .filter(([box]) => box.width > 0 && Math.min(box.width, box.height) < 24).map(([, name]) => name)"""
        )
        assert small == [], view
    for button in ("undo", "redo", "copy-link", "save-png", "theme"):
        expect(visitor.at(button)).to_be_in_viewport(ratio=1)

    visitor.at("tab-body").tap()
    slider = visitor.at("body-pitch_deg")
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    visitor.page.touchscreen.tap(box["x"] + 0.75 * box["width"], box["y"] + box["height"] / 2)
    pitch = float(slider.input_value())
    assert pitch > 5
    expect(visitor.at("standing-facts")).to_contain_text(f"0.0, {pitch:.1f}°")

    visitor.at("tab-drive").tap()
    visitor.at("drive-facts").wait_for()
    push(visitor, "stick-walk", 0.0, -0.9)
    expect(visitor.at("drive-state")).to_have_text("walking")
    release(visitor)
    expect(visitor.at("drive-state")).to_have_text("standing")
    visitor.at("request-lying").tap()
    expect(visitor.at("drive-state")).to_have_text("lying")


def push(visitor, name, x, y):
    """Hold a finger on a stick, off its middle by so much of its radius."""
    stick = visitor.at(name)
    stick.scroll_into_view_if_needed()
    box = stick.bounding_box()
    centre = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    finger = visitor.page.context.new_cdp_session(visitor.page)
    for kind, dx, dy in (("touchStart", 0, 0), ("touchMove", x, y)):
        point = {"x": centre[0] + dx * box["width"] / 2, "y": centre[1] + dy * box["height"] / 2}
        finger.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [point]})
    visitor.finger = finger


def release(visitor):
    visitor.finger.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


def test_a_foot_is_dragged_in_the_3d_view(visitor):
    visitor.open(StudioState(view="body", picture=Picture(camera="top")))
    visitor.unfold()
    before = feet_of(visitor)
    label = visitor.page.locator(".note", has_text="LM").bounding_box()
    address = visitor.page.url
    grab(visitor, label["x"] + label["width"] / 2, label["y"] + label["height"] / 2)
    visitor.page.mouse.up()
    expect(visitor.at("undo")).to_be_enabled()
    # The address takes over what is committed: the last of the drag, that is, has come.
    expect(visitor.page).not_to_have_url(address)
    after = feet_of(visitor)
    moved = np.linalg.norm(after - before, axis=1)
    assert moved[1] > 5
    assert np.delete(moved, 1) == pytest.approx(0, abs=1e-9)
    # The picture's floor is the ground: a foot on it stays on it.
    assert after[1, 2] == pytest.approx(0, abs=0.06)
    body = tarsus.Pose(position=np.array([0, 0, tarsus.default_body_height(STRIDER)]))
    angles = tarsus.inverse_kinematics(STRIDER, after / 1000, body).angles
    assert shown_angles(visitor) == pytest.approx(np.degrees(angles), abs=0.1)


def feet_of(visitor):
    return np.array([[float(visitor.at(f"foot-{leg}-{axis}").input_value()) for axis in "xyz"] for leg in FEET])


def grab(visitor, x, y):
    """Look for something to grab around a point of the picture, and move it by a few pixels."""
    mouse, steps = visitor.page.mouse, range(-56, 57, 8)
    for dx, dy in sorted(((dx, dy) for dx in steps for dy in steps), key=lambda at: at[0] ** 2 + at[1] ** 2):
        mouse.move(x + dx, y + dy)
        if visitor.page.evaluate("document.body.style.cursor") == "grab":
            mouse.down()
            mouse.move(x + dx + 10, y + dy + 5)
            mouse.move(x + dx + 20, y + dy + 10)
            return
    pytest.fail("there is nothing to grab")


def test_two_visitors_are_independent(arrive):
    one, other = arrive().open(StudioState(view="joints")), arrive().open(StudioState(view="joints"))
    expect(other.at("standing-facts")).to_be_visible()
    before = other.facts("standing-facts")
    one.at("robot-choice").select_option("phantomx")
    one.type("joint-LF-femur", 50)
    expect(one.at("standing-facts")).not_to_contain_text(before["Stability margin"])
    other.page.wait_for_timeout(300)
    assert other.facts("standing-facts") == before
    assert other.at("robot-choice").input_value() == "strider"


def settled_facts(visitor):
    """The facts on how the robot stands, once they stay the same: the server answers each keystroke."""
    seen = None
    while (now := visitor.facts("standing-facts")) != seen:
        seen = now
        visitor.page.wait_for_timeout(500)
    return seen


def test_the_state_survives_a_restart_of_the_server(arrive):
    settings = Settings()
    with Serving(settings) as first:
        visitor = arrive(at=first).open(StudioState(view="joints"))
        port = first.settings.port
        visitor.type("joint-RM-femur", 33)
        expect(visitor.at("undo")).to_be_enabled()
        before = settled_facts(visitor)
    expect(visitor.at("banner")).to_contain_text("kept")
    # What is set meanwhile is not lost either.
    visitor.type("joint-RM-coxa", 9)
    with Serving(Settings(port=port)):
        expect(visitor.at("banner")).to_have_count(0)
        expect(visitor.at("joint-RM-femur-number")).to_have_value("33")
        expect(visitor.at("joint-RM-coxa-number")).to_have_value("9")
        # What this server answers to it has come, too: a field that is written anew while it is typed in adds to "9".
        expect(visitor.at("standing-facts")).not_to_contain_text(before["Stability margin"])
        visitor.type("joint-RM-coxa", 0)
        expect(visitor.at("standing-facts")).to_contain_text(before["Stability margin"])
        assert visitor.facts("standing-facts") == before
        # That nobody answered is all that there was to complain of.
        assert all("ERR_CONNECTION_REFUSED" in text for text in visitor.complaints)
        # Once this server is gone, too, the page would complain again.
        visitor.context.close()
        visitor.complaints.clear()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_serious_in_any_view(arrive, scheme):
    visitor = arrive(color_scheme=scheme, bypass_csp=True)
    # A pose with something wrong, so that warnings are looked at as well.
    visitor.open(StudioState(joints=JointsState(angles_deg=(0, 105, -100) + (0, 45, -127) * 5)))
    expect(visitor.page.locator("html")).to_have_attribute("data-theme", scheme)
    for view in VIEWS:
        visitor.view(view)
        visitor.page.wait_for_load_state("networkidle")
        ready = {"walk": "walk-facts", "drive": "drive-facts", "loads": "torques", "robot": "robot-facts"}
        visitor.at({**ready, "sources": "source"}.get(view, "standing-facts")).wait_for()
        visitor.unfold()
        assert visitor.barriers() == [], view
