"""The documents keep up with what they describe."""

import importlib.util
import re
import sys
import tomllib
from pathlib import Path

import pytest

import tarsus

DOCS = Path(__file__).parents[1] / "docs"
ROBOT_FILE = (DOCS / "robot-file.md").read_text(encoding="utf-8")
CONVENTIONS = (DOCS / "conventions.md").read_text(encoding="utf-8")


def schema_keys():
    schema = tarsus.robot_schema()
    tables = [schema, *schema["$defs"].values()]
    return sorted({key for table in tables for key in table.get("properties", {})})


@pytest.mark.parametrize("key", schema_keys())
def test_every_key_of_a_robot_file_is_described(key):
    assert re.search(rf"\b{key}\b", ROBOT_FILE)


def test_every_key_the_page_describes_exists():
    keys = set(schema_keys())
    named = set(re.findall(r"`([a-z_]+_(?:mm|deg|kg|nm|v|rad_s|a|g))`", ROBOT_FILE))
    assert named
    assert named <= keys


def test_the_pages_examples_are_toml():
    blocks = re.findall(r"```toml\n(.*?)```", ROBOT_FILE, flags=re.DOTALL)
    assert len(blocks) == 3
    for block in blocks:
        tomllib.loads(block)


@pytest.mark.parametrize("name", tarsus.GAITS)
def test_the_gaits_are_described_with_their_duty_factors(name):
    row = re.search(rf"^\| {name}[^|]*\| (\d)/(\d) \|", CONVENTIONS, flags=re.MULTILINE)
    assert row
    legs = 4 if name == "creep" else 6
    assert tarsus.Gait.named(name, legs=legs).duty_factor == pytest.approx(int(row[1]) / int(row[2]))


def test_the_legs_are_numbered_as_described():
    robot = tarsus.load_robot("strider")
    assert f"| leg | {' | '.join(robot.leg_names)} |" in CONVENTIONS
    assert f"| short | {' | '.join(robot.leg_codes)} |" in CONVENTIONS


@pytest.mark.parametrize("path", sorted((DOCS.parent / "examples").glob("burnt-*.toml")), ids=lambda path: path.stem)
def test_the_example_robots_load_and_account_for_their_numbers(path):
    robot = tarsus.load_robot(path)
    assert robot.has_masses
    assert {"guess"} <= {source.confidence for source in robot.sources}


def refresh_module():
    sys.path.insert(0, str(DOCS))
    spec = importlib.util.spec_from_file_location("refresh", DOCS / "refresh.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.path.remove(str(DOCS))
    return module


@pytest.mark.parametrize(
    "page",
    ["README.md", "docs/commands.md", "docs/loads.md", "docs/firmware.md", "docs/calibration.md", "docs/first-hour.md"],
)
def test_what_the_pages_show_is_what_is_printed(page):
    text = (DOCS.parent / page).read_text(encoding="utf-8")
    assert refresh_module().refreshed(text) == text, "run: make figures"


def test_the_table_of_mistakes_is_what_is_said():
    text = (DOCS / "robot-check.md").read_text(encoding="utf-8")
    assert refresh_module().with_mistakes(text) == text, "run: make figures"
    rows = [line for line in text.splitlines() if line.startswith("| ") and "| strider |" in line]
    assert len(rows) >= 40


def test_every_key_of_a_calibration_is_described_and_its_example_loads(tmp_path):
    text = (DOCS / "calibration.md").read_text(encoding="utf-8")
    schema = tarsus.hardware.calibration_schema()
    tables = [schema, *schema["$defs"].values()]
    keys = {key for table in tables for key in table.get("properties", {})}
    assert [key for key in sorted(keys) if not re.search(rf"`{key}`", text)] == []
    (tmp_path / "c.toml").write_text(re.search(r"```toml\n(.*?)```", text, re.DOTALL)[1], encoding="utf-8")
    found = tarsus.hardware.Calibration.load(tmp_path / "c.toml")
    assert found.joints[0][2].missing == ()
    assert len(found.missing) == 15


def test_the_faults_of_the_page_are_those_there_are():
    text = (DOCS / "first-hour.md").read_text(encoding="utf-8")
    table = text.split("| fault | noticed by")[1].split("\n\n")[0]
    rows = dict(re.findall(r"^\| ([a-z -]+) \| [^|]* \| ([a-z, ]+)", table, flags=re.MULTILINE))
    from tarsus.hardware.plant.fault import REACTIONS

    assert set(rows) == {str(kind) for kind in REACTIONS}
    for kind, (reaction, _) in REACTIONS.items():
        assert ("limp" in rows[str(kind)]) == (reaction == "limp")
