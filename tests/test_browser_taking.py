"""Exports of the page, and their import."""

from __future__ import annotations

import io
import tomllib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import expect

import tarsus
from browser import Visitor
from tarsus.errors import RobotFileError
from tarsus.gait.storage import motion_to_csv
from tarsus.hardware import nominal_calibration
from tarsus.hardware.pulses.table import whole_commands
from tarsus.robot.file import load_robot, robot_from_dict, robot_to_dict
from tarsus.studio.messages.state import BodyState, Curve, Picture, StudioState, WalkOptions
from tarsus.studio.state_text import state_of

pytest_plugins = "browser_fixtures"

STRIDER = tarsus.load_robot("strider")


def saved(visitor: Visitor, button: str) -> Path:
    """Press a button, and return the file that the browser saves."""
    with visitor.page.expect_download() as download:
        visitor.at(button).click()
    return download.value.path()


def clipboard(visitor: Visitor) -> str:
    return visitor.page.evaluate("navigator.clipboard.readText()")


def test_angles_are_copied_as_tab_separated_text(visitor):
    visitor.open(StudioState(view="body", body=BodyState(pitch_deg=6.0)))
    visitor.unfold()
    visitor.at("copy-angles").click()
    expect(visitor.at("toast")).to_contain_text("copied")
    head, *rows = [line.split("\t") for line in clipboard(visitor).splitlines()]
    height = tarsus.default_body_height(STRIDER)
    feet = np.asarray(tarsus.default_stance(STRIDER)) + np.array([0, 0, height])
    body = tarsus.Pose.from_rpy(0, np.radians(6), 0, (0, 0, height))
    angles = np.degrees(tarsus.inverse_kinematics(STRIDER, feet, body).require().angles)
    assert head == ["leg", "coxa_deg", "femur_deg", "tibia_deg"]
    assert [row[0] for row in rows] == list(STRIDER.leg_codes)
    assert np.array([row[1:] for row in rows], dtype=float) == pytest.approx(angles, abs=1e-3)


def test_pulses_of_a_calibration_stand_beside_the_angles_and_are_copied(arrive, tmp_path):
    visitor = arrive(bypass_csp=True)
    made = nominal_calibration(STRIDER, "strider", kind="feetech-sts")
    narrow = made.with_joint(0, 0, soft_limits=(-0.2, 0.2))
    narrow.save(tmp_path / "mine.toml")
    visitor.open(StudioState(view="joints"))
    expect(visitor.at("copy-angles")).to_have_count(1)
    visitor.at("calibration-file").set_input_files(tmp_path / "mine.toml")
    expect(visitor.at("remove-calibration")).to_have_text("Remove mine.toml")
    visitor.unfold()
    visitor.at("copy-pulses").click()
    expect(visitor.at("toast")).to_contain_text("Pulses copied")
    head, *rows = [line.split("\t") for line in clipboard(visitor).splitlines()]
    height = tarsus.default_body_height(STRIDER)
    feet = np.asarray(tarsus.default_stance(STRIDER)) + np.array([0, 0, height])
    angles = tarsus.inverse_kinematics(STRIDER, feet, tarsus.Pose.from_rpy(position=(0, 0, height))).require().angles
    assert head == ["leg", "coxa_ticks", "femur_ticks", "tibia_ticks"]
    commands = whole_commands(narrow, np.asarray(angles))
    # Angles have three decimals in the page.
    assert np.abs(np.array([row[1:] for row in rows], dtype=int) - commands).max() <= 1
    expect(visitor.at("angles").locator("tbody tr").first).to_contain_text(f"{rows[0][2]} ticks")

    # Beyond its limits, a joint has no pulse to be copied.
    visitor.type("joint-LF-coxa", 20)
    expect(visitor.at("pulses-beyond")).to_contain_text("LF coxa is at 20.0°; the calibration allows -11.5° to 11.5°")
    expect(visitor.at("copy-pulses")).to_be_disabled()
    assert visitor.barriers() == []
    visitor.type("joint-LF-coxa", 10)
    expect(visitor.at("copy-pulses")).to_be_enabled()

    # A file for another robot is refused, and the first one stays; with another robot it does not fit.
    nominal_calibration(tarsus.load_robot("phantomx"), "phantomx").save(tmp_path / "other.toml")
    visitor.at("calibration-file").set_input_files(tmp_path / "other.toml")
    expect(visitor.at("failure")).to_contain_text("the calibration of 'phantomx'; the robot is 'strider'")
    expect(visitor.at("remove-calibration")).to_have_text("Remove mine.toml")
    visitor.at("robot-choice").select_option("phantomx")
    expect(visitor.at("calibration-problem")).to_contain_text("the robot is 'phantomx'")
    expect(visitor.at("copy-pulses")).to_have_count(0)
    visitor.at("undo").click()
    expect(visitor.at("copy-pulses")).to_have_count(1)
    visitor.at("remove-calibration").click()
    expect(visitor.at("copy-pulses")).to_have_count(0)


def test_csv_of_a_walk_equals_that_of_python(visitor, tmp_path):
    visitor.open(StudioState(view="walk", walk=WalkOptions(gait="wave", path=Curve(kind="curve", angle_deg=40.0))))
    visitor.at("walk-facts").wait_for()
    motion = tarsus.plan_walk(
        STRIDER, tarsus.Gait.named("wave"), tarsus.curved_path(np.radians(40), (0.0, 0.0)), rate=100.0
    )
    motion_to_csv(motion, tmp_path / "walk.csv")
    assert saved(visitor, "download-csv").read_text(encoding="utf-8") == (tmp_path / "walk.csv").read_text("utf-8")


def test_the_3d_view_is_saved_with_its_labels(visitor):
    visitor.open(StudioState(view="joints"))
    expect(visitor.at("chip-margin")).to_contain_text("stable")
    picture = Image.open(io.BytesIO(saved(visitor, "save-png").read_bytes()))
    box = visitor.page.locator(".scene canvas").bounding_box()
    assert picture.size == (round(box["width"]), round(box["height"]))
    # A robot in the middle, not one colour.
    width, height = picture.size
    middle = picture.convert("RGB").crop((width // 4, height // 4, 3 * width // 4, 3 * height // 4))
    assert len(middle.getcolors(maxcolors=1_000_000)) > 500


def test_a_robot_file_is_exported_and_imported(visitor, tmp_path):
    visitor.open(StudioState(view="robot"))
    visitor.type("robot-femur", 104)
    expect(visitor.at("undo")).to_be_enabled()
    mine = saved(visitor, "save-toml").read_text(encoding="utf-8")
    document = robot_to_dict(STRIDER)
    document["leg"]["femur_mm"] = 104
    assert robot_from_dict(tomllib.loads(mine)) == robot_from_dict(document)

    other = tmp_path / "other.toml"
    other.write_text(mine.replace('name = "strider"', 'name = "my own"', 1).replace("104", "91"), encoding="utf-8")
    visitor.at("toml-file").set_input_files(other)
    expect(visitor.at("robot-facts")).to_contain_text("my own")
    expect(visitor.at("robot-femur-number")).to_have_value("91")
    expect(visitor.page).to_have_title("my own – Tarsus Studio")

    # Dropped on the page, a file that is none is refused with its place, and the robot stays.
    visitor.page.evaluate(
        """text => {
          const data = new DataTransfer();
          data.items.add(new File([text], 'bad.toml'));
          window.dispatchEvent(new DragEvent('drop', { dataTransfer: data, cancelable: true }));
        }""",
        mine.replace("femur_mm = 104", "femur_mm = -5"),
    )
    expect(visitor.at("failure")).to_contain_text("leg.femur_mm")
    expect(visitor.at("robot-femur-number")).to_have_value("91")

    # So is one in another encoding, in the words of the command line; another view makes the refusal disappear.
    other.write_bytes(mine.replace("strider", "Käfer").encode("latin-1"))
    visitor.at("toml-file").set_input_files(other)
    with pytest.raises(RobotFileError) as refused:
        load_robot(other)
    expect(visitor.at("failure")).to_contain_text(str(refused.value).partition("byte")[2])
    visitor.view("joints")
    visitor.view("robot")
    expect(visitor.at("robot-femur-number")).to_have_value("91")
    expect(visitor.at("failure")).to_have_count(0)


def test_a_link_restores_exactly_the_state(visitor, arrive):
    visitor.open(StudioState(view="body", picture=Picture(camera="top", leg=2)))
    visitor.type("body-z_mm", 17)
    visitor.type("body-roll_deg", -3.5)
    expect(visitor.at("standing-facts")).to_contain_text("-3.5, 0.0°")
    visitor.at("copy-link").click()
    expect(visitor.at("toast")).to_contain_text("Link to this state copied")
    link = clipboard(visitor)
    state = state_of(link.partition("#s=")[2])
    assert state == StudioState(
        view="body", body=BodyState(z_mm=17.0, roll_deg=-3.5), picture=state.picture.model_copy(update={"leg": 2})
    )

    # So does the address bar.
    before = visitor.facts("standing-facts")
    visitor.page.reload()
    expect(visitor.at("standing-facts")).to_contain_text("-3.5, 0.0°")

    other = arrive().open(url=link)
    expect(other.at("standing-facts")).to_contain_text("-3.5, 0.0°")
    expect(other.at("body-z_mm-number")).to_have_value("17")
    expect(other.at("camera-top")).to_have_attribute("aria-pressed", "true")
    expect(other.at("workspace-leg")).to_have_value("2")
    assert other.facts("standing-facts") == visitor.facts("standing-facts") == before


def test_a_walk_plays_offline_from_one_file(visitor, arrive, tmp_path):
    visitor.open(StudioState(view="walk"))
    visitor.at("walk-facts").wait_for()
    file = tmp_path / "walk.html"
    file.write_bytes(saved(visitor, "download-html").read_bytes())

    context = arrive(offline=True).context
    page, asked = context.pages[0], []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(file.as_uri())
    expect(page.get_by_role("heading", name="strider")).to_be_visible()
    clock = page.get_by_test_id("clock")
    expect(clock).to_have_text("0.00 s")
    page.get_by_test_id("step-forward").click()
    expect(clock).to_have_text("0.01 s")
    page.get_by_test_id("play").click()
    expect(clock).not_to_have_text("0.01 s")
    page.get_by_test_id("camera-top").click()
    expect(page.get_by_test_id("chip-margin")).to_contain_text("stable")
    assert {url.partition(":")[0] for url in asked} <= {"file", "data", "blob"}
    assert len([url for url in asked if url.startswith("file:")]) == 1


def test_undo_and_redo_work_across_views(visitor):
    visitor.open(StudioState(view="joints"))
    expect(visitor.at("undo")).to_be_disabled()
    # By keyboard at once, where the choice still has the focus.
    visitor.at("robot-choice").focus()
    visitor.at("robot-choice").select_option("phantomx")
    expect(visitor.at("undo")).to_be_enabled()
    visitor.page.keyboard.press("Control+z")
    expect(visitor.at("robot-choice")).to_have_value("strider")
    expect(visitor.at("undo")).to_be_disabled()
    visitor.type("joint-LF-coxa", 21)
    visitor.view("robot")
    visitor.type("robot-coxa", 55)
    visitor.at("undo").click()
    expect(visitor.at("robot-coxa-number")).to_have_value("68")
    visitor.page.locator("main h2").click()
    visitor.page.keyboard.press("Control+z")
    visitor.view("joints")
    expect(visitor.at("joint-LF-coxa-number")).to_have_value("0")
    expect(visitor.at("undo")).to_be_disabled()
    for _ in range(2):
        visitor.at("redo").click()
    # It shows what it brings back: the last change was in the view Robot.
    expect(visitor.at("robot-coxa-number")).to_have_value("55")
    expect(visitor.at("redo")).to_be_disabled()
    visitor.view("joints")
    expect(visitor.at("joint-LF-coxa-number")).to_have_value("21")
