"""Pulses beside joint angles: a calibration in a session, and what contradicts the robot."""

import math

import numpy as np
import pytest

import tarsus
from sample_commands import run, run_json
from sample_studio import Asked, table
from tarsus.cli.studio import _robot
from tarsus.hardware import Calibration, nominal_calibration
from tarsus.hardware.calibration.file import calibration_text
from tarsus.hardware.pulses.table import whole_commands
from tarsus.robot.file import robot_to_dict, save_robot
from tarsus.studio.machine.calibration import CalibrationText
from tarsus.studio.messages.state import StudioState
from tarsus.studio.session import Session

STRIDER = tarsus.load_robot("strider")
PULSES = nominal_calibration(STRIDER, "strider", kind="pca9685")
TICKS = nominal_calibration(STRIDER, "strider", kind="feetech-sts")


def shown(message, angles_deg):
    """The commands that a page computes."""
    zero, slope = table(message["zero"], 3), table(message["per_deg"], 3)
    return np.clip(np.rint(zero + slope * angles_deg), table(message["low"], 3), table(message["high"], 3))


@pytest.mark.parametrize("calibration", [PULSES, TICKS])
def test_the_pulses_are_those_of_the_command_line(calibration):
    asked = Asked()
    message = asked("calibration", "calibration", name="my.toml", text=calibration_text(calibration))
    assert (message["name"], message["problem"]) == ("my.toml", None)
    assert message["unit"] == [unit for row in calibration.units for unit in row]
    random = np.random.default_rng(0)
    low, high = np.moveaxis(calibration.limits, -1, 0)
    for _ in range(20):
        angles = random.uniform(low, high)
        assert (shown(message, np.degrees(angles)) == whole_commands(calibration, angles)).all()
    assert table(message["low_deg"], 3) == pytest.approx(np.degrees(low), abs=6e-4)
    assert table(message["high_deg"], 3) == pytest.approx(np.degrees(high), abs=6e-4)
    assert asked("calibration", "calibration")["name"] is None


def contradicting():
    """Texts of calibrations, and what is wrong with them for a strider."""
    text = calibration_text(PULSES)
    other = nominal_calibration(tarsus.load_robot("phantomx"), "phantomx")
    twice = text.replace("channel = 1,", "channel = 0,", 1)
    blank = tarsus.hardware.new_calibration(STRIDER, "strider", kind="pca9685")
    return {
        "another robot": (calibration_text(other), "calibration of 'phantomx'; the robot is 'strider'"),
        "one channel twice": (twice, "channel"),
        "incomplete": (calibration_text(blank), "not calibrated yet"),
        "no TOML": ("name = ", "not valid TOML"),
        "a key": (text + "\nvolts = 3\n", "volts"),
    }


@pytest.mark.parametrize("what", contradicting())
def test_a_calibration_that_contradicts_the_robot_is_refused_and_the_last_one_stays(what):
    text, why = contradicting()[what]
    asked = Asked()
    asked("calibration", "calibration", name="good.toml", text=calibration_text(PULSES))
    assert why in asked.error("calibration", name="bad.toml", text=text)["text"]
    assert asked("hello", "calibration", state=None)["name"] == "good.toml"


def test_with_another_robot_the_page_says_that_the_calibration_does_not_fit():
    given = CalibrationText("mine.toml", calibration_text(PULSES))
    asked = Asked(Session(StudioState(view="joints"), calibration=given))
    assert asked("hello", "calibration", state=None)["problem"] is None
    away = asked("robot", "calibration", preset="phantomx")
    assert (away["unit"], away["name"]) == ([], "mine.toml")
    assert away["problem"]
    back = asked("undo", "calibration")
    assert len(back["unit"]) == 18
    # A change of the robot's limits changes those of its pulses.
    document = robot_to_dict(STRIDER)
    document["leg"]["limits_deg"]["coxa"] = [-10, 10]
    narrow = asked("document", "calibration", document=document)
    assert narrow["high_deg"][0] == pytest.approx(10)
    assert math.isclose(abs(narrow["high"][0] - narrow["low"][0]), 20 * abs(narrow["per_deg"][0]), abs_tol=2)


def test_a_calibration_is_given_to_the_command(tmp_path):
    file, other = tmp_path / "c.toml", tmp_path / "other.toml"
    TICKS.save(file)
    nominal_calibration(tarsus.load_robot("phantomx"), "phantomx").save(other)
    for arguments in ((), ("strider",)):
        code, found = run_json("studio", *arguments, "--calibration", file, "--check")
        assert (code, found["status"]) == (0, "ok")
    # An own robot keeps its file: a bring-up in this studio writes no other one.
    save_robot(STRIDER.replace(name="mine"), tmp_path / "mine.toml")
    own = tarsus.load_robot(tmp_path / "mine.toml")
    nominal_calibration(own, "mine.toml").save(tmp_path / "mine.calibration.toml")
    assert _robot(None, tmp_path / "mine.calibration.toml") == (own, tmp_path / "mine.toml")
    assert _robot(str(tmp_path / "mine.toml"), None) == (own, tmp_path / "mine.toml")
    assert _robot(None, file)[1] is _robot(None, None)[1] is None
    for arguments, code, why in [
        (("strider", "--calibration", other), 2, "which is not the robot 'strider'"),
        (("--calibration", tmp_path / "none.toml"), 1, "can't be read"),
    ]:
        result = run("studio", *arguments, "--check")
        assert result.exit_code == code
        assert why in result.stderr
    read = Calibration.from_text(file.read_text(encoding="utf-8"), STRIDER)
    assert calibration_text(read) == calibration_text(TICKS)
