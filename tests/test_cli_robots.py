"""`tarsus robots`, and errors of all commands from robot files and missing packages."""

import json
import shlex
import sys
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

import tarsus.robot.file
from sample_commands import run, run_json
from tarsus.cli import main
from tarsus.report.robot_summary import dimensions, robot_summary
from tarsus.robot.copied import copied_text
from tarsus.robot.file import (
    file_text,
    list_robots,
    load_robot,
    robot_from_dict,
    robot_from_text,
    robot_to_dict,
    save_robot,
    template_text,
)
from tarsus.robot.robot import JOINTS

SCHEMA = Path(tarsus.robot.file.__file__).with_name("robot.schema.json")


def test_list():
    result = run("robots", "list")
    assert result.exit_code == 0
    for name in list_robots():
        assert name in result.stdout
    code, document = run_json("robots", "list")
    assert code == 0
    assert [robot["name"] for robot in document] == [load_robot(name).name for name in list_robots()]


@pytest.mark.parametrize("name", list_robots())
def test_show(name):
    result = run("robots", "show", name)
    assert result.exit_code == 0
    robot = load_robot(name)
    for row in dimensions(robot):
        assert row["key"] in result.stdout
    for number, source in enumerate(robot.sources, start=1):
        assert f"({number}) {source.source}. {source.note}".strip() in result.stdout
    code, document = run_json("robots", "show", name)
    assert code == 0
    assert [row["key"] for row in document["dimensions"]] == [row["key"] for row in dimensions(robot)]
    assert document["servos"] == robot_summary(robot)["servos"]


def test_new_writes_the_template_and_does_not_overwrite(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run("robots", "new", "my robot/../x").exit_code == 0
    (file,) = tmp_path.iterdir()
    assert file.name == "my-robot----x.toml"
    assert file.read_text(encoding="utf-8") == template_text("my robot/../x")
    again = run("robots", "new", "other", "--out", file)
    assert again.exit_code == 2
    assert "already exists" in again.stderr
    assert file.read_text(encoding="utf-8") == template_text("my robot/../x")
    code, document = run_json("robots", "new", "third", "--out", "3.toml")
    assert (code, document) == (0, {"name": "third", "file": "3.toml", "from": None, "has_masses": True})


@pytest.mark.parametrize("name", list_robots())
def test_new_copies_a_preset_with_its_comments(tmp_path, name):
    file = tmp_path / "mine.toml"
    result = run("robots", "new", "mine", "--from", name, "--out", file)
    assert result.exit_code == 0
    preset, copy, text = load_robot(name), load_robot(file), file.read_text(encoding="utf-8")
    assert copy == preset.replace(name="mine")
    assert "#:schema" not in text
    comments = [line for line in file_text(name).splitlines()[1:] if line.startswith("#")]
    assert all(line in text.splitlines() for line in comments)
    assert ("masses are not known" in result.stdout) == (not preset.has_masses)
    assert ("Weigh the body" in text) == (not preset.has_masses)
    # The numbers of the comments, taken over as they are, make a robot with masses.
    filled = robot_from_text(text.replace("# mass_kg = ", "mass_kg = "), where="filled")
    assert filled.has_masses


def test_new_copies_a_file_and_keeps_what_it_can(tmp_path):
    first, second = tmp_path / "first.toml", tmp_path / "second.toml"
    first.write_text(template_text("first").replace("mass_kg = 1.2 ", "# "), encoding="utf-8")
    assert "body" in run("robots", "new", "x", "--from", first, "--out", second).stderr or second.exists()
    second.unlink(missing_ok=True)
    # A name over several lines can't be replaced where it stands.
    first.write_text(template_text("first").replace('"first"', '"""\nfirst"""'), encoding="utf-8")
    assert run("robots", "new", "x", "--from", first, "--out", second).exit_code == 0
    assert load_robot(second) == load_robot(first).replace(name="x")
    code, document = run_json("robots", "new", "y", "--from", "freenove", "--out", tmp_path / "y.toml")
    assert code == 0
    assert document == {"name": "y", "file": str(tmp_path / "y.toml"), "from": "freenove", "has_masses": False}
    assert run("robots", "new", "y", "--from", "nobody").exit_code == 1


@pytest.mark.parametrize("known", [{"body": {"mass_kg": 1.0}}, {"leg": {"mass_kg": dict.fromkeys(JOINTS, 0.1)}}])
def test_a_copy_asks_for_the_masses_that_are_unknown(tmp_path, known):
    document = robot_to_dict(load_robot("phantomx"))
    for table in ("body", "leg"):
        del document[table]["mass_kg"]
        document[table] |= known.get(table, {})
    path = tmp_path / "part.toml"
    save_robot(robot_from_dict(document), path)
    text = copied_text(path, "copy")
    assert text.count("# mass_kg = ") == 1
    assert text.count("Weigh the body") == 1
    assert robot_from_text(text.replace("# mass_kg = ", "mass_kg = "), where="filled").has_masses


@pytest.mark.no_cover
def test_check_warns_with_the_cause_and_strict_makes_it_an_error(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(template_text("mine").replace("size_mm = [220, 140, 50]", "size_mm = [22, 14, 5]"), "utf-8")
    result = run("robots", "check", file)
    assert result.exit_code == 0
    assert "no errors, 1 warning" in result.stdout
    assert "warning: body.size_mm: 22 x 14 x 5 mm" in result.stdout
    assert "Likely cause: these look like cm" in result.stdout
    strict = run("robots", "check", file, "--strict")
    assert strict.exit_code == 1
    assert "error: body.size_mm" in strict.stdout
    code, document = run_json("robots", "check", file, "--strict")
    assert code == 1
    assert [warning["code"] for warning in document["warnings"]] == ["box-unit"]
    assert all(run("robots", "check", name, "--strict").exit_code == 0 for name in ("strider", "freenove"))


def test_check_plans_a_walk_with_every_gait(tmp_path):
    _, document = run_json("robots", "check", "strider")
    assert all(trial["possible"] for trial in document["gaits"])
    heavy = tmp_path / "heavy.toml"
    text = template_text("heavy").replace("[body]", "[body]\ncom_mm = [300, 0, 0]")
    heavy.write_text(text, encoding="utf-8")
    result = run("robots", "check", heavy)
    assert result.exit_code == 1
    assert "tips over" in result.stdout
    assert "cannot walk: " in result.stdout


@pytest.mark.no_cover
def test_check_says_what_is_estimated_and_what_to_weigh(tmp_path):
    file = tmp_path / "mine.toml"
    assert run("robots", "new", "mine", "--out", file).exit_code == 0
    assert "estimated, not measured: body.mass_kg, leg.mass_kg, leg.servo" in run("robots", "check", file).stdout
    assert "tarsus robots new my-freenove --from freenove" in run("robots", "check", "freenove").stdout
    assert "tarsus robots new my-freenove --from freenove" in run("loads", "freenove").stderr


@pytest.mark.no_cover
def test_verdicts_on_estimated_masses_say_so(tmp_path):
    file = tmp_path / "mine.toml"
    assert run("robots", "new", "mine", "--out", file).exit_code == 0
    estimated = "(with estimated body.mass_kg, leg.mass_kg, leg.servo)"
    assert run("loads", file, "--distance", 100).stdout.rstrip().endswith(estimated)
    assert run("servos", file, "--distance", 100).stdout.rstrip().endswith(estimated)
    line = "estimated in the robot file, not measured: body.mass_kg, leg.mass_kg"
    assert f"assumed: {line}\n" in run("rest", file, "--all", "0,40,-100").stdout
    assert line in " ".join(run("walk", file, "--distance", 100).stdout.split())
    measured = file.read_text(encoding="utf-8").replace('"body.mass_kg", "leg.mass_kg", ', "")
    file.write_text(measured, encoding="utf-8")
    assert "estimated" not in run("rest", file, "--all", "0,40,-100").stdout


@pytest.mark.parametrize(
    ("args", "code"),
    [(["new", "", "--out", "x.toml"], 1), (["new", "x" * 2000], 1), (["new", "x", "--out", "/dev/null/x.toml"], 2)],
)
def test_new_errors(tmp_path, monkeypatch, args, code):
    monkeypatch.chdir(tmp_path)
    result = run("robots", *args)
    assert result.exit_code == code, result.output
    assert result.stderr.count("Error: ") == 1
    assert list(tmp_path.iterdir()) == []


def test_check_of_a_valid_file(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(template_text("mine"), encoding="utf-8")
    result = run("robots", "check", file)
    assert result.exit_code == 0
    assert "no errors" in result.stdout
    assert "can walk with its own gait, tripod" in result.stdout
    code, document = run_json("robots", "check", "mithi")
    assert code == 0
    assert len(document["missing"]) == 3


def test_check_lists_all_errors(tmp_path):
    file = tmp_path / "mine.toml"
    wrong = template_text("mine").replace("coxa_mm = 50", "coxa_mm = -50").replace("tibia_mm = 130", "tibbia_mm = 130")
    file.write_text(wrong, encoding="utf-8")
    result = run("robots", "check", file)
    assert result.exit_code == 1
    assert "leg.coxa_mm" in result.stderr
    assert "tibbia_mm" in result.stderr
    code, document = run_json("robots", "check", file)
    assert code == 1
    assert len(document["problems"]) >= 2
    assert document["possible"] is False


def test_check_of_a_robot_that_cannot_walk(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(template_text("mine").replace("body_height_mm = 80", "body_height_mm = 900"), encoding="utf-8")
    result = run("robots", "check", file)
    assert result.exit_code == 1
    assert "does not reach the ground" in result.stdout


def test_schema_is_the_bundled_file():
    result = run("robots", "schema")
    assert result.stdout_bytes == SCHEMA.read_bytes()
    assert json.loads(run("robots", "schema", "--json").stdout) == json.loads(SCHEMA.read_text(encoding="utf-8"))


# Invalid robot files


@pytest.fixture
def files(tmp_path):
    (tmp_path / "empty.toml").write_bytes(b"")
    (tmp_path / "binary.toml").write_bytes(bytes(range(256)) * 10)
    (tmp_path / "huge.toml").write_bytes(b"# a long comment\n" * 640_000)
    (tmp_path / "prose.toml").write_text("This is no robot.", encoding="utf-8")
    (tmp_path / "folder.toml").mkdir()
    return tmp_path


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("missing.toml", "no such file"),
        ("empty.toml", "the file is empty"),
        ("binary.toml", "not UTF-8"),
        ("huge.toml", "larger than 1 MiB"),
        ("prose.toml", "not valid TOML"),
        ("folder.toml", "is a folder"),
    ],
)
@pytest.mark.parametrize(
    "command", [["walk"], ["pose"], ["rest", "--all", "0,0,0"], ["robots", "show"], ["robots", "check"]]
)
def test_invalid_robot_files(files, command, name, text):
    first, *rest = command
    args = [first, *rest, files / name] if first == "robots" else [first, files / name, *rest]
    result = run(*args)
    assert result.exit_code == 1, result.output
    assert text in result.stderr
    assert result.stdout == ""


def test_misspelt_name_gives_a_suggestion():
    for command in (["walk"], ["pose"], ["robots", "show"], ["robots", "check"]):
        assert "Did you mean 'strider'?" in run(*command, "stridr").stderr
    code, document = run_json("pose", "stridr")
    assert code == 1
    assert "Did you mean 'strider'?" in document["error"]


# Missing packages, bugs, interruptions


@pytest.mark.parametrize(
    ("arguments", "package", "extra"),
    [
        ("walk strider --out w", "matplotlib", "plots"),
        ("loads strider --out w", "matplotlib", "plots"),
        ("drive --dry 'at 0 s: stop' --out w", "matplotlib", "plots"),
        ("run strider --duration 1 --out w", "matplotlib", "plots"),
        ("pose strider --picture p.png", "matplotlib", "plots"),
        ("rest strider --all 0,0,0 --picture p.png", "matplotlib", "plots"),
        ("simulate strider --video w.gif", "matplotlib", "plots"),
        ("simulate strider --out w --zarr", "zarr", "data"),
    ],
)
def test_a_package_that_writes_files_is_missed_before_anything_is_computed(
    arguments, package, extra, monkeypatch, tmp_path
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, package, None)
    result = run(*shlex.split(arguments))
    assert result.exit_code == 1
    assert result.stdout == ""
    assert f"this command needs {package}: pip install 'tarsus[{extra}]'" in result.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ("walk strider --html .", "--html . can't be written: it is a folder"),
        ("walk strider --html nowhere/w.html", "--html nowhere/w.html can't be written: No such file or directory"),
        ("walk strider --pulses nosuch.toml", "nosuch.toml: 1 problem\n  can't be read: No such file or directory"),
        ("pose strider --picture .", "--picture . can't be written: it is a folder"),
        ("rest strider --all 0,0,0 --picture .", "--picture . can't be written: it is a folder"),
    ],
)
def test_outputs_are_checked_before_anything_is_computed(arguments, text, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    result = run(*arguments.split())
    assert result.exit_code in (1, 2)
    assert result.stdout == ""
    assert text in result.stderr


def test_pages_that_are_not_built_are_missed_before_a_walk_is_planned(monkeypatch, tmp_path):
    monkeypatch.setattr("tarsus.studio.player.WEB", tmp_path)
    result = run("walk", "strider", "--html", tmp_path / "w.html")
    assert result.exit_code == 1
    assert result.stdout == ""
    assert "the studio's pages are not built" in result.stderr


def _command_that_fails(monkeypatch, error):
    @click.command("fail")
    def fails():
        raise error

    monkeypatch.setitem(main.commands, "fail", fails)


def test_missing_rich(monkeypatch):
    _command_that_fails(monkeypatch, ModuleNotFoundError("No module named 'rich'", name="rich"))
    result = run("fail")
    assert result.exit_code == 1
    assert result.stderr == "Error: this command needs rich: pip install 'tarsus[cli]'\n"


def test_bugs_are_one_line_unless_debugging(monkeypatch):
    _command_that_fails(monkeypatch, ZeroDivisionError("half of nothing"))
    result = CliRunner().invoke(main, ["fail"])
    assert result.exit_code == 70
    assert result.stderr.count("\n") == 1
    assert "please report it: ZeroDivisionError: half of nothing" in result.stderr
    monkeypatch.setenv("TARSUS_DEBUG", "1")
    assert isinstance(CliRunner().invoke(main, ["fail"]).exception, ZeroDivisionError)


@pytest.mark.parametrize(
    ("error", "code", "text"),
    [
        (KeyboardInterrupt(), 130, ""),
        (MemoryError(), 2, "out of memory"),
        (click.ClickException("so it is"), 2, "so it is"),
    ],
)
def test_other_exit_codes(monkeypatch, error, code, text):
    _command_that_fails(monkeypatch, error)
    result = run("fail")
    assert result.exit_code == code
    assert text in result.stderr
    assert bool(text) == bool(result.stderr.strip())
