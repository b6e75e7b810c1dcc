"""`tarsus robots`, and errors of all commands from robot files and missing packages."""

import json
import sys
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

import tarsus.robot.file
from sample_commands import run, run_json
from tarsus.cli import main
from tarsus.report.robot_summary import dimensions, robot_summary
from tarsus.robot.file import list_robots, load_robot, template_text

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
    assert (code, document) == (0, {"name": "third", "file": "3.toml"})


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
    assert "longest stroke straight ahead" in result.stdout
    code, document = run_json("robots", "check", "mithi")
    assert code == 0
    assert len(document["missing"]) == 4


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


def test_missing_matplotlib(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    result = run("walk", "strider", "--distance", "100", "--out", tmp_path)
    assert result.exit_code == 1
    assert "pip install 'tarsus[plots]'" in result.stderr
    assert "possible" in result.stdout


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
