"""`tarsus walk`: numbers match `plan_walk`; impossible walks are rejected with a feasible alternative."""

import csv
import json
import math

import numpy as np
import pytest
from PIL import Image

from sample_commands import run, run_json
from tarsus.gait.gait import Gait
from tarsus.gait.path import curved_path, straight_path, twist_path
from tarsus.gait.plan import plan_walk
from tarsus.report.walk_summary import walk_summary
from tarsus.robot.file import load_robot, robot_from_dict, robot_to_dict, save_robot

STRIDER = load_robot("strider")


def expected(motion):
    """Summary of a motion after a JSON round trip."""
    plain = json.loads(json.dumps(walk_summary(motion), default=lambda value: value.tolist()))
    return json.loads(json.dumps(plain), parse_float=lambda text: round(float(text), 6))


@pytest.mark.parametrize(
    ("options", "gait", "path", "more"),
    [
        ("--distance 200", "tripod", straight_path(0.2), {}),
        ("--distance 150 --heading -30 --gait wave", "wave", straight_path(0.15, math.radians(-30)), {}),
        ("--curve 40 --centre -20,300", "tripod", curved_path(math.radians(40), (-0.02, 0.3)), {}),
        ("--curve -30 --gait amble", "tetrapod", curved_path(math.radians(-30)), {}),
        ("--twist 40,-10,5 --duration 2", "tripod", twist_path(0.04, -0.01, math.radians(5), 2.0), {}),
        (
            "--distance 100 --stroke 60 --cycle 2 --body-height 120 --swing-height 25 --foot-distance 30 --rate 20",
            "tripod",
            straight_path(0.1),
            {
                "stroke": 0.06,
                "cycle_time": 2.0,
                "body_height": 0.12,
                "swing_height": 0.025,
                "foot_distance": 0.03,
                "rate": 20,
            },
        ),
        ("--distance 100 --tilt -3,5", "tripod", straight_path(0.1), {"body_tilt": np.radians([-3, 5])}),
        ("--distance 100 --speed 40", "tripod", straight_path(0.1), {"speed": 0.04}),
    ],
)
def test_numbers_match_plan_walk(options, gait, path, more):
    code, document = run_json("walk", "strider", *options.split())
    assert document.pop("files") == []
    motion = plan_walk(STRIDER, Gait.named(gait), path, **more)
    reference = expected(motion)
    assert code == (0 if motion.ok else 1)
    assert document.keys() == reference.keys()
    for key, value in reference.items():
        if isinstance(value, float) or key in ("end", "least_margin"):
            assert document[key] == pytest.approx(value, abs=2e-6), key
        else:
            assert str(document[key])[:40] == str(value)[:40], key


def test_default_walk():
    code, document = run_json("walk", "phantomx")
    assert code == 0
    assert document["end"] == {"x_mm": 500, "y_mm": 0, "turned_deg": 0}
    assert document["gait"] == load_robot("phantomx").gait.name


def test_table_and_verdict():
    result = run("walk", "strider", "--distance", "200")
    assert result.exit_code == 0
    assert result.stdout.strip().endswith("possible")
    assert "not possible" not in result.stdout
    assert "200.0 mm" in result.stdout
    assert "wrote" not in result.stdout


@pytest.mark.no_cover
def test_output_files(tmp_path):
    out = tmp_path / "deep" / "walk"
    options = "--distance 30 --stroke 20 --cycle 0.6 --rate 50"
    code, document = run_json("walk", "strider", *options.split(), "--out", out)
    assert code == 0
    names = ["walk.csv", "angles.png", "footpaths.png", "gait.png", "walk.gif"]
    assert document["files"] == [str(out / name) for name in names]
    assert sorted(path.name for path in out.iterdir()) == sorted(names)
    motion = plan_walk(STRIDER, Gait.named("tripod"), straight_path(0.03), stroke=0.02, cycle_time=0.6, rate=50)
    with (out / "walk.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(motion.time)
    assert float(rows[7]["LF_coxa_deg"]) == pytest.approx(math.degrees(motion.angles[7, 0, 0]), abs=1e-6)
    for name in names[1:]:
        with Image.open(out / name) as picture:
            assert picture.width > 300
            assert len(picture.convert("RGB").getcolors(2**24)) > 10
    assert (out / "walk.gif").stat().st_size < 3_000_000


def test_output_files_without_animation(tmp_path):
    result = run("walk", "mithi", "--distance", "100", "--rate", "20", "--no-animation", "--out", tmp_path)
    assert result.exit_code == 0
    assert result.stderr == ""
    written = [line.removeprefix("wrote ") for line in result.stdout.splitlines() if line.startswith("wrote ")]
    assert written == [str(tmp_path / name) for name in ("walk.csv", "angles.png", "footpaths.png", "gait.png")]
    assert not (tmp_path / "walk.gif").exists()


def test_unreachable_stroke_gives_the_longest_feasible_one(tmp_path):
    code, document = run_json("walk", "strider", "--distance", "300", "--stroke", "400")
    assert code == 1
    assert document["exit_code"] == 1
    longest = document["longest_stroke_mm"]
    assert f"{longest:.1f} mm" in document["error"]
    assert run("walk", "strider", "--distance", "300", "--stroke", f"{longest - 0.01:.3f}").exit_code in (0, 1)
    code, works = run_json("walk", "strider", "--distance", "300", "--stroke", f"{longest - 0.01:.3f}", "--cycle", "5")
    assert (code, works["possible"]) == (0, True)
    plain = run("walk", "strider", "--stroke", "400", "--out", tmp_path)
    assert plain.exit_code == 1
    assert plain.stdout == ""
    assert plain.stderr.startswith("Error: ")
    assert list(tmp_path.iterdir()) == []


def test_too_fast_walk(tmp_path):
    args = ("walk", "strider", "--distance", "100", "--speed", "900")
    code, document = run_json(*args, "--out", tmp_path, "--no-animation")
    assert code == 1
    assert document["possible"] is False
    assert document["problems"][0].startswith("too fast")
    assert len(document["files"]) == 4
    result = run(*args)
    assert result.exit_code == 1
    assert "not possible" in result.stdout
    assert document["problems"][0] in result.stdout


def test_feet_too_close():
    result = run("walk", "strider", "--distance", "300", "--foot-distance", "220", "--stroke", "180")
    assert result.exit_code == 1
    assert "foot distance of 220.0 mm" in result.stderr


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ("--gait rippel", "Did you mean 'ripple'?"),
        ("--stroke -80", "'--stroke': -80 mm; it must be greater than 0"),
        ("--stroke 0", "'--stroke': 0 mm; it must be greater than 0"),
        ("--stroke nan", "'nan' is not a number"),
        ("--distance inf", "'inf' is not a number"),
        ("--distance many", "'many' is not a number"),
        ("--distance 0", "has no length"),
        ("--distance 1e9", "samples"),
        ("--distance 1e300", "is not a number between"),
        ("--curve 1e9", "at most"),
        ("--twist 1,2 --duration 3", "is not 3 numbers"),
        ("--twist 0,0,0 --duration 3", "has no length"),
        ("--twist 10,0,0", "must be given together"),
        ("--duration 3", "must be given together"),
        ("--twist 10,0,0 --duration -1", "'--duration': -1 s; it must be greater than 0"),
        ("--centre 1,2", "--centre needs --curve"),
        ("--curve 10 --distance 100", "exclude each other"),
        ("--curve 10 --heading 10", "exclude each other"),
        ("--tilt 5", "is not 2 numbers"),
        ("--tilt nan,0", "is not 2 numbers"),
        ("--tilt 95,0", "body_tilt is (95, 0) deg; roll and pitch must be between -90 and 90 deg"),
        ("--rate 0", "'--rate': 0 Hz; it must be greater than 0"),
        ("--cycle -1", "'--cycle': -1 s; it must be greater than 0"),
        ("--swing-height -1", "'--swing-height': -1 mm; it must be at least 0"),
        ("--foot-distance -1", "'--foot-distance': -1 mm; it must be at least 0"),
        ("--speed -1", "'--speed': -1 mm/s; it must be greater than 0"),
        ("--stance-width -300", "is -300 mm; it must be a finite number, at most 1000 m, and more than -221.8 mm"),
        (
            "--stroke 100 --speed 100 --cycle 9",
            "stroke 100 mm, speed 100 mm/s and cycle time 9 s are inconsistent: with",
        ),
        ("--out /dev/null/walk", "is not writable"),
        ("--out /proc", "is not writable"),
        ("--bogus", "No such option"),
    ],
)
def test_usage_errors(options, text):
    result = run("walk", "strider", *options.split())
    assert result.exit_code == 2, result.output
    assert text in result.stderr
    assert result.stdout == ""
    code, document = run_json("walk", "strider", *options.split())
    assert code == document["exit_code"] == 2
    assert text in document["error"]


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ("--body-height 900", "does not reach the ground"),
        ("--tilt 60,0", "stepping on the spot is impossible: middle left can't reach its target: "),
        ("--swing-height 400", "with a swing height of 400.0 mm"),
        ("--body-height -500", "does not reach the ground"),
    ],
)
def test_impossible_walks(options, text):
    result = run("walk", "strider", *options.split())
    assert result.exit_code == 1, result.output
    assert text in result.stderr


def test_a_walk_refused_for_an_implausible_value_points_to_the_check_of_the_file(tmp_path):
    file = tmp_path / "my.toml"
    document = robot_to_dict(STRIDER)
    document["leg"]["femur_mm"] = 0.08
    save_robot(robot_from_dict(document), file)
    for command in ("walk", "loads", "simulate"):
        result = run(command, file)
        assert result.exit_code == 1
        assert "does not reach the ground" in result.stderr
        assert result.stderr.endswith(f"implausible values: see `tarsus robots check {file}`\n")
    assert "implausible" not in run("walk", "strider", "--stroke", "500").stderr


def test_progress_bar_on_a_terminal(monkeypatch, tmp_path):
    args = ("walk", "strider", "--distance", "60", "--rate", "20", "--no-animation", "--out", tmp_path)
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "70")
    watched = run(*args)
    assert watched.exit_code == 0
    assert "gait.png" in watched.stderr
    assert "gait.png" in watched.stdout


def test_gait_for_another_number_of_legs(tmp_path):
    text = robot_to_dict(load_robot("strider"))
    text["legs"] = [text["legs"][leg] for leg in (0, 2, 3, 5)]
    robot = robot_from_dict(text)
    save_robot(robot, tmp_path / "four.toml")
    result = run("walk", tmp_path / "four.toml", "--gait", "ripple")
    assert result.exit_code == 2
    assert "does not exist for 4 legs" in result.stderr


def test_unwritable_table(tmp_path):
    (tmp_path / "walk.csv").mkdir()
    result = run("walk", "strider", "--distance", "100", "--out", tmp_path)
    assert result.exit_code == 2
    assert "walk.csv can't be written" in result.stderr
