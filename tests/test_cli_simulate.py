"""`tarsus simulate`: numbers are those of `compare`; files are written; falls have an exit code."""

import json
import shlex

import numpy as np
import pytest
from PIL import Image

from sample_commands import run as run_arguments
from sample_commands import run_json as run_json_arguments
from tarsus.gait.gait import Gait
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.report.simulation_summary import simulation_summary
from tarsus.robot.file import load_robot
from tarsus.simulation.truth.comparison import compare

SHORT = "simulate strider --distance 60"


def run(line):
    """Run a command line, and return its exit code and its output."""
    result = run_arguments(*shlex.split(line))
    return result.exit_code, result.output


def run_json(line):
    return run_json_arguments(*shlex.split(line))


def test_numbers_are_those_of_the_comparison():
    truth = compare(plan_walk(load_robot("strider"), Gait.named("tripod"), straight_path(0.06), rate=100.0))
    expected = simulation_summary(truth.outcome, (truth.planned_peak, truth.planned_rms))
    code, found = run_json(SHORT)
    assert code == 0
    assert {name: found[name] for name in expected} == json.loads(
        json.dumps(expected), parse_float=lambda text: round(float(text), 6)
    )
    assert found["ok"]
    assert found["terrain"] == "flat"


@pytest.mark.parametrize("servos", ["catalogue", "ideal"])
def test_feet_slide_less_with_commands_that_compensate(servos):
    options = f"{SHORT} --servos {servos} --seed 3"
    (_, before), (code, after) = run_json(options), run_json(f"{options} --compensate")
    assert code == 0
    assert after["slip_mm"] < before["slip_mm"]
    assert any("compensate for 75 % of the deflection" in line for line in after["assumed"])


@pytest.mark.no_cover
@pytest.mark.parametrize("servos", ["catalogue", "ideal"])
def test_a_scenario_is_compensated_too(servos):
    options = f'simulate strider --scenario "at 0 s: walk 50 mm/s; at 0.3 s: stop" --servos {servos} --sensors blind'
    (_, before), (code, after) = run_json(options), run_json(f"{options} --compensate")
    assert code == 0
    assert after["slip_mm"] < before["slip_mm"]
    assert any("compensate for 75 % of the deflection" in line for line in after["assumed"])


def test_the_table_has_plan_and_physics():
    code, text = run(SHORT)
    assert code == 0
    for part in ("quantity", "planned", "physics", "coxa torque, peak", "cost of transport", "neither fell nor"):
        assert part in text


@pytest.mark.no_cover
def test_files_are_written(tmp_path):
    code, text = run(f"{SHORT} --servos ideal --out {tmp_path / 'out'} --zarr --video {tmp_path / 'walk.gif'}")
    assert code == 0
    assert text.count("wrote") == 3
    table = np.genfromtxt(tmp_path / "out" / "trace.csv", delimiter=",", names=True)
    assert table["body_x_mm"][-1] == pytest.approx(60, abs=3)
    assert (tmp_path / "out" / "trace.zarr").is_dir()
    with Image.open(tmp_path / "walk.gif") as picture:
        assert picture.n_frames > 10


# JAX, which other tests of this process may have started, warns of every fork.
@pytest.mark.no_cover
@pytest.mark.filterwarnings("ignore:os.fork:RuntimeWarning")
def test_a_video_is_an_mp4_file(tmp_path):
    code, _ = run(f"{SHORT} --servos ideal --terrain blocks:rise=10,clear=200 --video {tmp_path / 'walk.mp4'}")
    assert code == 0
    assert (tmp_path / "walk.mp4").read_bytes()[4:8] == b"ftyp"


def test_a_scenario_that_is_not_met_in_full_is_not_completed():
    code, shown = run('simulate strider --scenario "at 0 s: walk 500 mm/s; at 0.5 s: stop" --servos ideal')
    assert code == 1
    verdict = (
        "the robot neither fell nor stalled, but did not do all that was commanded\n  not met in full, 0.01 to 0.50 s"
    )
    assert f"{verdict}: twist: " in shown


def test_a_scenario_runs_through_the_controller():
    timeline = '--scenario "at 0 s: walk 50 mm/s; at 1.5 s: stop"'
    code, found = run_json(f"simulate strider {timeline} --sensors smart --seed 3")
    assert code == 0
    assert found["sensors"] == "smart"
    assert found["commanded_end"]["x_mm"] > 50
    assert found["way_ratio"] == pytest.approx(1, abs=0.1)


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (f"{SHORT} --zarr", 2, "--zarr needs --out"),
        (f"{SHORT} --sensors hobby", 2, "--sensors hobby needs --scenario: a planned walk is executed as it is"),
        (f"{SHORT} --video walk.avi", 2, "--video walk.avi: the name must end in .mp4 or .gif"),
        (f"{SHORT} --video nowhere/w.mp4", 2, "--video nowhere/w.mp4 can't be written: No such file or directory"),
        ("simulate strider --scenario ''", 2, "the scenario is empty; give a TOML file, or commands such as"),
        (
            'simulate strider --scenario "at 0 s: stop" --distance 100',
            2,
            "--distance and --scenario exclude each other",
        ),
        (f"{SHORT} --seed -1", 2, "seed is -1; it must be a whole number, not negative"),
        (f"{SHORT} --terrain blocks:seed=-1", 2, "seed is -1; it must be a whole number, not negative"),
        (f"{SHORT} --terrain smooth:seed=-2", 2, "seed is -2; it must be a whole number, not negative"),
        ("simulate strider --terrain hills", 2, "no terrain is called 'hills'"),
        ("simulate strider --distance 100 --cycle 0.2", 1, "the walk is not possible: "),
        ("simulate mithi", 1, "unknown; add it to its file ([leg] servo); `tarsus simulate` with --servos ideal"),
        (f"{SHORT} --terrain step:rise=60,start=0", 1, "failed\n  covered 17 mm of 60 mm"),
    ],
)
def test_what_is_wrong_is_named(arguments, code, message):
    found, text = run(arguments)
    assert found == code, text
    assert message in text


def test_the_viewer_needs_a_screen(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    code, text = run(f"{SHORT} --view")
    assert code == 1
    assert "--view needs a screen" in text
    # Said before anything is simulated.
    assert "distance" not in text
