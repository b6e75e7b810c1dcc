"""`tarsus pose` and `tarsus rest`: numbers match Python; all formats of angles."""

import json
import math
import os

import numpy as np
import pytest
from PIL import Image

from sample_commands import run, run_json
from tarsus.kinematics.body import reachable_fraction
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.stance import default_stance
from tarsus.robot.file import load_robot

STRIDER = load_robot("strider")
EIGHTEEN = ["0", "40", "-100"] * 6


def posed(roll=0.0, pitch=0.0, yaw=0.0, by=(0.0, 0.0, 0.0), body_height=110.0, knee="up"):
    height = body_height / 1000
    feet = default_stance(STRIDER, height) + np.array([0, 0, height])
    place = np.array([0, 0, height]) + np.array(by) / 1000
    body = Pose.from_rpy(*np.radians([roll, pitch, yaw]), position=place)
    return inverse_kinematics(STRIDER, feet, body, knee=knee)


@pytest.mark.parametrize(
    ("options", "move"),
    [
        ("", {}),
        ("--pitch 12 --z 20", {"pitch": 12, "by": (0, 0, 20)}),
        ("--x -30 --y 10 --yaw -8", {"yaw": -8, "by": (-30, 10, 0)}),
        ("--roll 5 --body-height 130", {"roll": 5, "body_height": 130}),
        ("--roll=-5 --pitch=-3.5", {"roll": -5, "pitch": -3.5}),
        ("--pitch 42", {"pitch": 42}),
        ("--z 300", {"by": (0, 0, 300)}),
    ],
)
def test_pose_matches_inverse_kinematics(options, move):
    code, document = run_json("pose", "strider", *options.split())
    solution = posed(**move)
    np.testing.assert_allclose(document["angles_deg"], np.degrees(solution.angles), atol=1e-6)
    assert document["legs"] == list(STRIDER.leg_codes)
    assert document["possible"] == bool(solution.ok)
    assert code == (0 if solution.ok else 1)
    if not solution.ok:
        lines = solution.explain().splitlines()
        assert document["problems"][: len(lines)] == lines
        start = Pose.from_rpy(position=(0, 0, 0.11))
        fraction = reachable_fraction(STRIDER, solution.feet, start, solution.body)
        assert document["feasible_fraction"] == pytest.approx(fraction, abs=1e-6)


def test_feasible_fraction_is_the_limit():
    _, document = run_json("pose", "strider", "--pitch", "42")
    fraction = document["feasible_fraction"]
    assert run("pose", "strider", "--pitch", f"{42 * fraction - 0.01:.3f}").exit_code == 0
    assert run("pose", "strider", "--pitch", f"{42 * fraction + 0.01:.3f}").exit_code == 1


def test_a_body_that_is_not_displaced_has_no_feasible_fraction_of_its_displacement():
    assert "of this displacement" in run("pose", "strider", "--z", "500").stdout
    assert "of this displacement" not in run("pose", "strider", "--body-height", "-10").stdout


def test_a_body_in_the_ground_is_not_feasible():
    stdout = run("pose", "strider", "--z", "-109.9").stdout
    assert "the body is 16.9 mm below the ground" in stdout
    assert "feasible with every foot on its foothold: 84.6 % of this displacement" in stdout


def test_zero_has_no_sign():
    assert "pitch 0.00 deg, body height 0.0 mm" in run("rest", "mithi", "--all", "0,0,0").stdout


def test_knees_down():
    _, document = run_json("pose", "mithi", "--knee", "down")
    assert (np.array(document["angles_deg"])[:, 2] > 0).all()
    assert document["feasible_fraction"] is None


def test_a_knee_that_cannot_be_down_is_not_possible():
    code, document = run_json("pose", "makeyourpet", "--knee", "down")
    assert code == 1
    assert (np.array(document["angles_deg"])[:, 2] < 0).all()
    assert document["problems"] == [
        (
            "all legs: the knee can't be down, as the tibia's limits are -161.4 and -41.4 deg; the angles are those "
            "with the knee up"
        )
    ]
    assert not any("knee" in line for line in run_json("pose", "makeyourpet")[1]["assumed"])


def test_pose_output():
    good = run("pose", "strider", "--pitch", "5")
    assert good.exit_code == 0
    for angle in posed(pitch=5).angles[1]:
        assert f"{math.degrees(angle):.2f}" in good.stdout
    assert good.stdout.strip().endswith("possible")
    bad = run("pose", "strider", "--pitch", "42")
    assert bad.exit_code == 1
    assert "femur limit" in bad.stdout
    assert "front left and front right can't reach their targets: the femur angle would be " in bad.stdout
    assert "the robot tips" in bad.stdout
    assert "% of this displacement" in bad.stdout
    assert "none, no foot is on the ground" in run("pose", "strider", "--z", "300").stdout
    assert "assumed: the robot file gives no masses" in run("pose", "mithi").stdout


def test_no_margin_in_json_if_no_leg_reaches():
    _, document = run_json("pose", "strider", "--z", "300")
    assert document["margin_mm"] is None
    assert document["stands"] is False


@pytest.mark.parametrize(
    ("options", "code", "text"),
    [
        ("--pitch nan", 2, "'nan' is not a number"),
        ("--z 1e300", 2, "is not a number between"),
        ("--swing-height -1", 2, "'--swing-height': -1 mm; it must be at least 0"),
        ("--knee sideways", 2, "'sideways' is not one of"),
        ("--body-height 900", 1, "does not reach the ground"),
        ("--picture /dev/null/pose.png", 2, "can't be written"),
        ("--picture pose.nonsense", 2, "can't be written"),
    ],
)
def test_pose_errors(options, code, text):
    result = run("pose", "strider", *options.split())
    assert result.exit_code == code, result.output
    assert text in result.stderr


def test_figures_of_pose_and_rest(tmp_path):
    result = run("pose", "strider", "--pitch", "42", "--picture", tmp_path / "pose.png")
    assert result.exit_code == 1
    assert f"wrote {tmp_path / 'pose.png'}" in result.stdout
    code, document = run_json("rest", "strider", "--all", "0,-30,-60", "--picture", tmp_path / "rest.png")
    assert code == 0
    assert document["files"] == [str(tmp_path / "rest.png")]
    for name in ("pose.png", "rest.png"):
        with Image.open(tmp_path / name) as picture:
            assert len(picture.convert("RGB").getcolors(2**24)) > 50


# Resting


def test_formats_of_angles_are_equivalent(tmp_path):
    numbers = [float(angle) for angle in EIGHTEEN]
    forms = {
        "flat.json": numbers,
        "nested.json": np.reshape(numbers, (6, 3)).tolist(),
        "object.json": {"angles_deg": np.reshape(numbers, (6, 3)).tolist(), "robot": "strider"},
    }
    answers = [run_json("rest", "strider", *EIGHTEEN), run_json("rest", "strider", "--all", "0,40,-100")]
    for name, form in forms.items():
        (tmp_path / name).write_text(json.dumps(form), encoding="utf-8")
        answers.append(run_json("rest", "strider", "--file", tmp_path / name))
    assert all(answer == answers[0] for answer in answers)
    code, document = answers[0]
    assert code == 0
    rest = resting_pose(STRIDER, np.radians(np.reshape(numbers, (6, 3))))
    assert document["description"] == rest.describe()
    assert document["body"]["z_mm"] == pytest.approx(rest.body.position[2] * 1000, abs=1e-6)
    assert document["contacts"] == list(STRIDER.leg_codes)


def test_output_of_pose_is_input_of_rest(tmp_path):
    file = tmp_path / "pose.json"
    file.write_text(run("pose", "strider", "--pitch", "5", "--json").stdout, encoding="utf-8")
    _, document = run_json("rest", "strider", "--file", file)
    assert document["body"]["pitch_deg"] == pytest.approx(5, abs=1e-4)
    assert document["body"]["z_mm"] == pytest.approx(110, abs=1e-3)


def test_rest_output():
    result = run("rest", "strider", "--all", "0,80,0")
    assert result.exit_code == 0
    assert "lies on its belly" in result.stdout
    assert "roll 0.00 deg, pitch 0.00 deg, body height 25.0 mm" in result.stdout
    assert "feet on the ground: none" in result.stdout
    assert "assumed" in run("rest", "mithi", "--all", "0,40,-100").stdout


def test_angles_outside_their_limits():
    result = run("rest", "strider", "--all", "0,-90,-60")
    assert result.exit_code == 1
    assert "all legs: femur angle -90 deg is outside its limits, -80 to 100 deg" in result.stdout
    code, document = run_json("rest", "strider", "--all", "0,-90,-60")
    assert code == 1
    assert document["problems"] == ["all legs: femur angle -90 deg is outside its limits, -80 to 100 deg"]


@pytest.mark.parametrize(
    ("args", "text"),
    [
        ([], "either as arguments"),
        (["--all", "0,0,0", *EIGHTEEN], "either as arguments"),
        (EIGHTEEN[:-1], "17 angles; strider needs 18"),
        ([*EIGHTEEN, "1"], "19 angles"),
        ([*EIGHTEEN[:-1], "nan"], "'nan' is not an angle"),
        ([*EIGHTEEN[:-1], "-inf"], "'-inf' is not an angle"),
        ([*EIGHTEEN[:-1], "--bogus"], "'--bogus' is not an angle"),
        ([*EIGHTEEN[:-1], "1e300"], "is not an angle"),
        (["--all", "0,0"], "is not 3 numbers"),
        (["--file", "missing.json"], "No such file"),
        (["--file", "/"], "Is a directory"),
    ],
)
def test_invalid_angles(args, text):
    result = run("rest", "strider", *args)
    assert result.exit_code == 2, result.output
    assert text in result.stderr
    code, document = run_json("rest", "strider", *args)
    assert code == 2
    assert text in document["error"]


def test_a_pipe_of_angles_is_refused_without_waiting_for_it(tmp_path):
    os.mkfifo(tmp_path / "angles.json")
    result = run("rest", "strider", "--file", tmp_path / "angles.json")
    assert result.exit_code == 2
    assert "is a pipe or a device" in result.stderr


@pytest.mark.parametrize(
    ("content", "text"),
    [
        (b"", "not valid JSON"),
        (os.urandom(100), "not valid JSON"),
        (b"\xff\xfe\x00", "not valid JSON"),
        (b"[" * 100_000, "not valid JSON"),
        (b"[" + b"0," * 5_000_000 + b"0]", "larger than 1 MiB"),
        (b"7", "expected a list"),
        (b'{"angles": []}', "expected a list"),
        (b"[[1, 2, 3], [4, 5]]", "5 angles"),
        (b'["x"]', "'x' is not an angle"),
        (b"[true]", ": true is not an angle"),
        (b"[null]", ": null is not an angle"),
        (b"[NaN]", ": NaN is not an angle"),
        (b"[1e999]", ": Infinity is not an angle"),
        (b"[1" + b"0" * 400 + b"]", "is not an angle"),
        (b"[[[1]]]", ": [1] is not an angle"),
    ],
    ids=range(15),
)
def test_invalid_angle_files(tmp_path, content, text):
    file = tmp_path / "angles.json"
    file.write_bytes(content)
    result = run("rest", "strider", "--file", file)
    assert result.exit_code == 2, result.output
    assert text in result.stderr
    assert len(result.stderr) < 2000
