"""`tarsus loads` and `tarsus servos`: output matches the functions, and the exit code the verdict."""

import csv
import dataclasses
import json

import numpy as np
import pytest

from sample_commands import run, run_json
from sample_loads import EXAMPLES
from tarsus.gait.gait import Gait
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.load.compliant.compliant_loads import compliant_loads
from tarsus.load.compliant.decisive_loads import decisive_loads
from tarsus.load.loads import joint_loads
from tarsus.load.sizing import size_servos
from tarsus.load.supply import supply_load
from tarsus.report.loads_summary import loads_summary, servos_summary
from tarsus.report.loads_table import load_rows, loads_lines, motion_line
from tarsus.report.walk_summary import walk_summary
from tarsus.robot.file import load_robot, save_robot

SHORT = ("--distance", "150", "--rate", "40")


def short_walk(name="strider", gait="tripod"):
    robot = load_robot(name)
    return plan_walk(robot, Gait.named(gait), straight_path(0.15), rate=40)


@pytest.mark.parametrize(
    ("options", "conditions"),
    [
        ("", {}),
        ("--static", {"inertial": False}),
        ("--payload 0.4 --supply 6", {"payload": 0.4, "supply": 6.0}),
    ],
)
def test_numbers_match_the_functions(options, conditions):
    code, document = run_json("loads", "strider", *SHORT, *options.split())
    motion = short_walk()
    found = joint_loads(motion.robot, motion, **conditions)
    pressed = compliant_loads(motion.robot, motion, **conditions)
    factors = decisive_loads(found, pressed).factor
    assert code == (0 if factors.min() >= 1.5 else 1)
    assert document["carried"] is (code == 0)
    for row, peak, rms, factor in zip(
        document["joints"], found.peak.ravel(), found.rms.ravel(), factors.ravel(), strict=True
    ):
        assert row["peak_nm"] == pytest.approx(peak, abs=1e-6)
        assert row["rms_nm"] == pytest.approx(rms, abs=1e-6)
        assert row["factor"] == (pytest.approx(factor, abs=1e-6) if np.isfinite(factor) else None)
    peaks = [row["compliant_peak_nm"] for row in document["joints"]]
    assert peaks == pytest.approx(pressed.loads.peak.ravel(), abs=1e-6)
    assert document["possible"] is True
    assert document["compliant"]["carried"] is pressed.ok
    assert document["cost_of_transport"] == pytest.approx(found.cost_of_transport, abs=1e-6)
    assert document["files"] == []


@pytest.mark.parametrize(
    ("name", "code", "text"),
    [
        ("strider", 0, "marginal: "),
        (str(EXAMPLES / "burnt-mg996r.toml"), 1, "at least 1.5 is required"),
        (str(EXAMPLES / "burnt-5kg.toml"), 1, "cannot stand: "),
    ],
)
def test_exit_code_and_critical_joint(name, code, text):
    result = run("loads", name, *SHORT)
    assert result.exit_code == code
    last = result.stdout.splitlines()[-1]
    assert text in last
    assert "femur" in last


def test_good_robot():
    result = run("loads", "strider", *SHORT, "--gait", "wave", "--body-height", "140")
    assert result.exit_code == 0
    assert result.stdout.splitlines()[-1].startswith("good: ")


def test_table_has_every_joint(monkeypatch):
    monkeypatch.setenv("COLUMNS", "120")
    lines = run("loads", "strider", *SHORT).stdout.splitlines()
    rows = [line for line in lines if " DS3225 " in line and line.rstrip().endswith("%")]
    assert len(rows) == 18
    assert all("█" in line for line in rows if "femur" in line)
    assert any(line.startswith("assumed: inertia") for line in lines)
    assert any("as the stall current of DS3225 is unknown" in line for line in lines)
    assert any(line.startswith("cost of transport: 0.") for line in lines)


def test_current_and_battery_life():
    name = EXAMPLES / "burnt-mg996r.toml"
    text = run("loads", name, *SHORT, "--capacity", "3").stdout
    _, document = run_json("loads", name, *SHORT, "--capacity", "3")
    drawn = document["supply"]
    assert drawn["battery_min"] == pytest.approx(3 / drawn["mean_a"] * 60)
    assert f"mean {drawn['mean_a']:.1f} A" in text
    assert f"battery life {drawn['battery_min']:.0f} min" in text


def test_a_supply_far_above_the_rated_one_leaves_no_verdict():
    result = run("loads", "strider", *SHORT, "--supply", "600")
    assert result.exit_code == 1
    verdict = result.stdout.splitlines()[-1]
    assert verdict.startswith(
        "unknown: LF coxa: DS3225 is rated for 4.8 to 6.8 V; torque and speed are unknown at the "
    )
    assert "supply of 600 V, more than 1.5 times that" in verdict
    sized = run("servos", "strider", *SHORT, "--supply", "12")
    assert sized.exit_code == 1
    assert "payload: unknown, as the torque of some servos is unknown" in sized.stdout
    assert "XL430-W250-T" in sized.stdout


@pytest.mark.no_cover
def test_robot_without_servos(tmp_path):
    save_robot(load_robot("strider").replace(servos=()), tmp_path / "bare.toml")
    result = run("loads", tmp_path / "bare.toml", *SHORT, "--out", tmp_path / "out")
    assert result.exit_code == 1
    assert "unknown: the robot file names no servo for " in result.stdout
    code, document = run_json("loads", tmp_path / "bare.toml", *SHORT)
    assert (code, document["class"]) == (1, "unknown")
    sized = run("servos", tmp_path / "bare.toml", *SHORT, "--factor", "1.5")
    assert sized.exit_code == 1
    assert "payload: unknown" in sized.stdout
    assert "the robot file names no servo for the coxa of LF: the masses of the robot file are used" in sized.stdout


@pytest.mark.no_cover
def test_tipping_robot(tmp_path):
    save_robot(load_robot("strider").replace(body_com=np.array([0.4, 0.0, 0.0])), tmp_path / "nose.toml")
    result = run("loads", tmp_path / "nose.toml", *SHORT)
    assert result.exit_code == 1
    assert "the robot tips: the load is " in result.stdout
    assert "not carried: the robot tips" in result.stdout
    sized = run("servos", tmp_path / "nose.toml", *SHORT, "--factor", "0.01")
    assert sized.exit_code == 1
    assert "; the robot tips" in sized.stdout


@pytest.mark.no_cover
def test_output_files(tmp_path):
    code, document = run_json("loads", "strider", *SHORT, "--out", tmp_path)
    assert code == 0
    assert document["files"] == [
        str(tmp_path / name) for name in ("loads.csv", "torques.png", "torque-speed.png", "report.html")
    ]
    with (tmp_path / "loads.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    motion = short_walk()
    found = joint_loads(motion.robot, motion)
    assert len(rows) == len(motion.time)
    np.testing.assert_allclose([float(row["RM_femur_nm"]) for row in rows], found.torques[:, 4, 1], atol=1e-6)
    np.testing.assert_allclose([float(row["LF_fz_n"]) for row in rows], found.forces[:, 0, 2], atol=1e-6)
    np.testing.assert_allclose([float(row["margin_mm"]) for row in rows], found.margin * 1000, atol=1e-3)
    shown = run("loads", "strider", *SHORT, "--out", tmp_path).stdout
    assert f"wrote {tmp_path / 'report.html'}" in shown


@pytest.mark.no_cover
@pytest.mark.parametrize("name", ["loads.csv", "report.html", "torques.png"])
def test_unwritable_file(tmp_path, name):
    (tmp_path / name).mkdir()
    result = run("loads", "strider", *SHORT, "--out", tmp_path)
    assert result.exit_code == 2
    assert f"{name} can't be written" in result.stderr


@pytest.mark.no_cover
def test_servos_match_size_servos(monkeypatch):
    monkeypatch.setenv("COLUMNS", "120")
    code, document = run_json("servos", "strider", *SHORT, "--factor", "1.5", "--payload", "0.1")
    motion = short_walk()
    found = joint_loads(motion.robot, motion, payload=0.1)
    pressed = compliant_loads(motion.robot, motion, payload=0.1)
    expected = servos_summary(size_servos(motion.robot, found, safety_factor=1.5, compliant=pressed), found)
    assert code == 0
    assert document["candidates"]
    assert [c["name"] for c in document["candidates"]] == [c["name"] for c in expected["candidates"]]
    assert document["mixed"]["servos"] == expected["mixed"]["servos"]
    assert document["largest_payload_kg"] == pytest.approx(expected["largest_payload_kg"], abs=1e-5)
    assert json.dumps(document["excluded"]) == json.dumps(expected["excluded"])
    text = run("servos", "strider", *SHORT, "--factor", "1.5", "--payload", "0.1").stdout
    for candidate in expected["candidates"]:
        assert candidate["name"] in text
    for advice in expected["advice"]:
        assert f"length: {advice}" in text
    assert "not evaluated, as the no-load speed is unknown: HTS-35H, HTD-45H" in text
    # The robot's servos are sufficient: nothing needs to help them.
    assert "changes for the robot's servos" not in text
    assert document["changes"] == []
    assert text.splitlines()[-1] == "the robot's servos are sufficient (with estimated leg.servo)"


@pytest.mark.no_cover
def test_insufficient_servos(monkeypatch):
    monkeypatch.setenv("COLUMNS", "120")
    result = run("servos", EXAMPLES / "burnt-mg996r.toml", *SHORT)
    assert result.exit_code == 1
    assert "LM femur (MG996R): " in result.stdout or "RM femur (MG996R): " in result.stdout
    assert "XM430-W350-T" in result.stdout
    assert result.stdout.index("changes for the robot's servos") < result.stdout.index("sufficient servos ")
    assert "factor: smallest stall torque over peak torque (below 1 cannot stand" in result.stdout
    assert "thermal: largest RMS torque over 1/5 of the stall torque" in result.stdout
    assert result.stdout.splitlines()[-1] == (
        "the robot's servos are not sufficient (with estimated body.mass_kg, leg.mass_kg)"
    )
    hopeless = run("servos", EXAMPLES / "burnt-5kg.toml", *SHORT, "--factor", "50")
    assert "no servo of the catalogue is sufficient in all joints" in hopeless.stdout


@pytest.mark.no_cover
def test_continuous_rule():
    code, document = run_json(
        "servos", "strider", *SHORT, "--rule", "continuous", "--gait", "wave", "--body-height", "140"
    )
    assert document["rule"] == "continuous"
    assert document["sufficient"] is (code == 0)
    text = run("servos", "strider", *SHORT, "--rule", "continuous").stdout
    assert "payload: none at the continuous load limit; " in text


@pytest.mark.no_cover
def test_advice_comes_first_with_a_factor_for_each_change_and_payload_in_plain_words(monkeypatch):
    monkeypatch.setenv("COLUMNS", "120")
    text = run("servos", "strider", *SHORT).stdout
    _, document = run_json("servos", "strider", *SHORT)
    assert document["changes"][0]["factor"] > 3
    for change in document["changes"]:
        assert change["text"] in text
        assert f"{change['factor']:.2f}" in text
    assert "Dynamixel 2.0" in text
    at_limit = document["maximum_payload_kg"]
    assert f"payload: none at factor 3; {at_limit:.2f} kg at the limit, factor 1.5, below which" in text
    weak = run("servos", EXAMPLES / "burnt-5kg.toml", *SHORT).stdout
    assert "payload: none at factor 3; none at the limit, factor 1.5" in weak
    nearer = run_json("servos", "strider", *SHORT, "--stance-width", "-10")[1]
    assert all(row["factor"] > 1 for row in nearer["changes"])


def test_a_joint_that_bears_nothing_has_no_factor():
    motion = short_walk()
    found = joint_loads(motion.robot, motion, inertial=False)
    summary = loads_summary(found, supply_load(found), None, "the servos are unknown")
    assert {row[6] for row in load_rows(summary) if row[0].endswith("coxa")} == {"no load"}
    assert max(row["factor"] or 0.0 for row in summary["joints"]) < 1e3
    assert {row["text"] for row in summary["joints"] if row["joint"] == "coxa"} == {"no load"}
    assert "compliant statics: not computed: the servos are unknown" in loads_lines(summary)


def test_possible_and_carried_are_two_verdicts():
    assert "walk: possible\n" in run("loads", "strider", *SHORT).stdout
    text = run("walk", EXAMPLES / "burnt-5kg.toml", *SHORT).stdout
    assert "servos: cannot stand: " in text
    assert text.rstrip().endswith("possible")
    for name, why in (("mithi", "has no masses"), ("strider", "does not name them all")):
        robot = load_robot(name)
        planned = plan_walk(robot, Gait.named("tripod"), straight_path(0.02), rate=40)
        if name == "strider":
            planned = dataclasses.replace(planned, robot=robot.replace(servos=((None,) * 3,) * 6))
        assert why in walk_summary(planned)["servos"]["text"]
    airborne = dataclasses.replace(planned, robot=robot, contacts=np.zeros_like(planned.contacts))
    assert walk_summary(airborne)["servos"]["carried"] is None
    impossible = loads_summary(found := joint_loads(robot, short_walk()), supply_load(found))
    assert motion_line({**impossible, "possible": False, "problems": ["tips over"]}) == "walk: not possible: tips over"


def test_loads_explains_its_columns():
    text = run("loads", "strider", *SHORT).stdout
    for column in ("of stall", "factor", "utilisation", "thermal"):
        assert f"\n{column}: " in text


@pytest.mark.parametrize("command", ["loads", "servos"])
@pytest.mark.parametrize(
    ("options", "text"),
    [
        ("--payload -1", "'--payload': -1 kg; it must be at least 0"),
        ("--supply 0", "'--supply': 0 V; it must be greater than 0"),
        ("--payload many", "'many' is not a number"),
        ("--gait rippel", "Did you mean 'ripple'?"),
        ("--distance 0", "has no length"),
    ],
)
def test_usage_errors(command, options, text):
    result = run(command, "strider", *options.split())
    assert result.exit_code == 2
    assert text in result.stderr
    assert result.stdout == ""


def test_usage_errors_of_single_commands():
    assert "'--capacity': 0 A h; it must be greater than 0" in run("loads", "strider", *SHORT, "--capacity", "0").stderr
    assert "'--factor': 0; it must be greater than 0" in run("servos", "strider", *SHORT, "--factor", "0").stderr
    assert "'half' is not one of" in run("servos", "strider", "--rule", "half").stderr
    assert "is not writable" in run("loads", "strider", "--out", "/dev/null/x").stderr


@pytest.mark.parametrize("command", ["loads", "servos"])
def test_missing_masses(command):
    result = run(command, "freenove", *SHORT)
    assert result.exit_code == 1
    assert "missing from its file" in result.stderr
