"""`tarsus drive`: what it says is what `run` says; what is wrong with a scenario is reported with its place."""

import csv
import json

import pytest

from sample_commands import run, run_json
from tarsus.gait.storage import load_motion
from tarsus.scenario.file import save_scenario, scenario_from_text
from tarsus.scenario.runner import run_scenario
from tarsus.scenario.scenario import Scenario
from tarsus.scenario.summary import drive_summary

TIMELINE = "at 0 s: walk 40 mm/s; at 1 s: gait ripple; at 4 s: stop"


@pytest.mark.no_cover
def test_the_numbers_are_those_of_the_same_scenario_in_python():
    code, document = run_json("drive", "--dry", TIMELINE, "--robot", "phantomx", "--rate", "50")
    assert code == 0
    recording = run_scenario(scenario_from_text(TIMELINE, rate=50.0), robot="phantomx")
    wanted = json.loads(json.dumps(drive_summary(recording), default=float))
    assert document.pop("files") == []
    bears = document.pop("loads")
    assert document.keys() == wanted.keys()
    for key in ("duration_s", "distance_mm", "top_speed_mm_s", "walked_s", "steps"):
        assert document[key] == pytest.approx(wanted[key], abs=1e-6)
    assert document["gaits"] == ["tripod", "ripple"]
    assert set(bears) == {"coxa", "femur", "tibia"}
    assert bears["femur"]["peak_nm"] > 0.1


def test_it_prints_a_table_and_the_verdict():
    result = run("drive", "--dry", TIMELINE)
    assert result.exit_code == 0
    assert result.stdout.strip().endswith("possible")
    for words in ("strider", "0 interventions", "peak speed", "peak torque, femur", "tripod, ripple"):
        assert words in result.stdout


@pytest.mark.no_cover
def test_out_gets_tables_motion_and_pictures(tmp_path):
    path = tmp_path / "short.toml"
    scenario = scenario_from_text("at 0 s: walk 30 mm/s", duration=0.6, rate=50.0, robot="mithi", name="short")
    save_scenario(scenario, path)
    out = tmp_path / "deep" / "driven"
    code, document = run_json("drive", "--dry", path, "--out", out)
    assert code == 0
    assert document["scenario"] == "short"
    assert document["loads"] is None
    names = ["log.csv", "motion.npz", "timeline.png", "walk.csv", "angles.png", "footpaths.png", "gait.png", "walk.gif"]
    assert document["files"] == [str(out / name) for name in names]
    assert all((out / name).stat().st_size > 500 for name in names)
    recording = run_scenario(scenario)
    assert (load_motion(out / "motion.npz").angles == recording.motion.angles).all()
    with open(out / "log.csv", encoding="utf-8") as file:
        assert len(list(csv.reader(file))) == 1 + len(recording.motion.time)


@pytest.mark.no_cover
def test_files_are_named_after_they_are_written(tmp_path):
    result = run("drive", "--dry", "at 0 s: stop", "--rate", "20", "--out", tmp_path, "--no-animation", "--no-guard")
    assert result.exit_code == 0
    assert f"wrote {tmp_path / 'timeline.png'}" in result.stdout
    assert not (tmp_path / "walk.gif").exists()


def test_without_dry_servos_are_refused():
    result = run("drive", TIMELINE)
    assert result.exit_code == 2
    assert "give --dry, which runs the scenario on an ideal plant; tarsus run drives servos" in result.stderr


def test_a_rejected_command_is_reported_with_exit_code_1():
    result = run("drive", "--dry", "at 0 s: power_off")
    assert result.exit_code == 1
    assert "not possible" in result.stdout
    assert "power_off: the robot stands" in result.stdout


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("timeline", "kind"),
    [
        ("at 0 s: walk 5 m/s", "twist"),
        ("at 0 s: body_height 400 mm", "body_height"),
        ("at 0 s: foot_target RF x 250 mm y -200 mm z 60 mm; foot_target RM x 0 mm y -300 mm z 60 mm", "foot_target"),
    ],
)
def test_a_command_that_is_not_met_in_full_is_said_and_is_exit_code_1(timeline, kind):
    code, document = run_json("drive", "--dry", timeline)
    assert code == 1
    assert not document["possible"]
    assert kind in {each["kind"] for each in document["unmet"]}
    result = run("drive", "--dry", timeline)
    assert result.exit_code == 1
    assert "not met in full" in result.stdout
    assert f"{kind}: " in result.stdout


def test_a_robot_that_never_stands_has_no_margin_and_no_loads(tmp_path):
    path = tmp_path / "lies.toml"
    save_scenario(Scenario(start="folded", duration=0.3), path)
    result = run("drive", "--dry", path)
    assert result.exit_code == 0
    assert "never off the ground" in result.stdout
    assert "peak torque" not in result.stdout


@pytest.mark.parametrize(
    ("scenario", "options", "wanted"),
    [
        ("at 0 s: wlak 1 m/s", (), "no command is called 'wlak'. Did you mean 'walk'?"),
        ("nothing.toml", (), "nothing.toml can't be read"),
        ("walk 0.05 m/s", (), "no file 'walk 0.05 m/s'; a timeline has the form 'at 0 s: walk 50 mm/s; at 5 s: stop'"),
        ("at 0 s: stop", ("--rate", "5"), "rate is 5 Hz; it must be from 20 to 1000 Hz"),
        ("at 0 s: stop", ("--rate", "nan"), "is not a number"),
        ("at 0 s: foot_target XX x 1 mm y 1 mm z 1 mm", (), "no leg is called 'XX'"),
    ],
)
def test_malformed_requests_are_reported(scenario, options, wanted):
    result = run("drive", "--dry", scenario, *options)
    assert result.exit_code == 2
    assert wanted in result.stderr
    code, document = run_json("drive", "--dry", scenario, *options)
    assert code == 2
    assert wanted in document["error"]


def test_a_long_timeline_is_no_name_of_a_file():
    timeline = "; ".join(f"at {time} s: body x {time % 3} mm" for time in range(25))
    assert len(timeline) > 400
    code, found = run_json("drive", "--dry", timeline)
    assert (code, found["possible"]) == (0, True)


def test_commands_of_a_robot_that_is_to_lie_are_not_met():
    for command in ("walk 50 mm/s", "foot_target RF x 250 mm y -150 mm z 60 mm"):
        code, found = run_json("drive", "--dry", f"at 0 s: walk 40 mm/s; at 1 s: sit; at 7 s: {command}")
        assert code == 1
        assert any("the robot is lying; it must stand" in each["text"] for each in found["unmet"])
    # What was commanded before ends as it sits down, and goes on once it stands.
    code, found = run_json("drive", "--dry", "at 0 s: walk 40 mm/s; at 2 s: sit; at 9 s: stand_up; at 18 s: stop")
    assert (code, found["unmet"]) == (0, [])
    assert found["walked_s"] > 5


def test_what_is_not_met_is_told_once():
    result = run("drive", "--dry", "at 0 s: walk 900 mm/s; at 2 s: stop")
    assert result.exit_code == 1
    assert "not met" in result.stdout
    assert "limited" not in result.stdout
