"""Help of every command, with examples that run."""

import errno
import io
import os
import shlex
import subprocess
import sys
from pathlib import Path

import click
import pytest

from sample_commands import run
from tarsus import GAITS, __version__
from tarsus.cli import main
from tarsus.export import to_urdf
from tarsus.report.animation import animate
from tarsus.robot.file import load_robot
from tarsus.simulation.terrain.kinds import TERRAINS

ANGLES = "[" + ", ".join(["0, 40, -100"] * 6) + "]"


def commands(command=main, path=()):
    yield path, command
    for name, child in getattr(command, "commands", {}).items():
        yield from commands(child, (*path, name))


COMMANDS = dict(commands())


def examples_of(command):
    return [line.strip() for line in command.epilog.splitlines() if line.startswith("  ")]


EXAMPLES = sorted({example for command in COMMANDS.values() for example in examples_of(command)})


@pytest.mark.parametrize("path", COMMANDS, ids=" ".join)
def test_help_shows_examples(path):
    result = run(*path, "--help")
    assert result.exit_code == 0
    examples = examples_of(COMMANDS[path])
    assert examples
    for example in examples:
        assert example.startswith("tarsus " + " ".join(path))
        assert example in result.stdout


@pytest.mark.parametrize("path", [path for path, command in COMMANDS.items() if not hasattr(command, "commands")])
def test_every_command_has_json_and_documented_options(path):
    options = [option for option in COMMANDS[path].params if isinstance(option, click.Option)]
    assert "--json" in {flag for option in options for flag in option.opts}
    assert all(option.help for option in options)


@pytest.mark.no_cover
@pytest.mark.parametrize("example", EXAMPLES)
def test_examples_run(example, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(animate.__kwdefaults__, "max_duration", 0.5)
    if "check my-robot.toml" in example:
        assert run("robots", "new", "my-robot").exit_code == 0
    if " my-strider.toml" in example and "--out my-strider.toml" not in example:
        assert (
            run("calibration", "new", "strider", "--nominal", "--bus", "ssc32", "--out", "my-strider.toml").exit_code
            == 0
        )
    if " Hex_Cfg.h" in example:
        assert run("calibration", "new", "phoenix", "--nominal", "--bus", "ssc32").exit_code == 0
        assert run("calibration", "to-phoenix", "phoenix.calibration.toml").exit_code == 0
    if "robots import" in example:
        Path("hexapod.urdf").write_text(to_urdf(load_robot("strider")), encoding="utf-8")
    Path("angles.json").write_text(ANGLES, encoding="utf-8")
    result = run(*shlex.split(example)[1:])
    assert result.exit_code == 0, result.output
    assert result.stderr == ""
    words = shlex.split(example)
    for option in ("--out", "--picture", "--html"):
        if option in words:
            assert Path(words[words.index(option) + 1]).exists()


def test_help_names_every_gait_and_terrain():
    text = run("simulate", "--help").stdout
    assert [name for name in (*GAITS, "amble", *TERRAINS) if name not in text] == []


def test_version():
    assert run("--version").stdout == f"tarsus, version {__version__}\n"


def test_help_without_a_command():
    result = run()
    assert result.exit_code == 2
    assert result.stderr.startswith("Usage: tarsus")


def test_unknown_command():
    result = run("wlak")
    assert result.exit_code == 2
    assert "wlak" in result.stderr


@pytest.mark.parametrize("command", [[], ["walk"], ["robots", "list"]])
def test_help_imports_nothing_heavy(command):
    code = (
        "import sys\nfrom tarsus.cli import main\n"
        f"try:\n    main({[*command, '--help']!r})\nexcept SystemExit as done:\n    assert not done.code\n"
        "print(sorted({'numpy', 'pydantic', 'matplotlib', 'rich'} & set(sys.modules)))"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.splitlines()[-1] == "[]"


def test_installed_command():
    script = Path(sys.executable).with_name("tarsus")
    answer = subprocess.run([script, "pose", "strider", "--pitch", "42"], capture_output=True, text=True, check=False)
    assert answer.returncode == 1
    assert "not possible" in answer.stdout
    assert answer.stderr == ""


def test_closed_pipe_is_no_error():
    script = Path(sys.executable).with_name("tarsus")
    with subprocess.Popen([script, "robots", "schema"], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        complaint = process.stderr.read()
    assert complaint == b""


class FullDisk(io.StringIO):
    def write(self, text):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.mark.parametrize("arguments", ["robots schema", "robots list", "walk strider --json", "--help"])
def test_a_full_disk_behind_the_standard_output_is_named(arguments, monkeypatch, capsys):
    monkeypatch.setattr(sys, "stdout", FullDisk())
    with pytest.raises(SystemExit) as left:
        main(arguments.split())
    assert left.value.code == 2
    assert capsys.readouterr().err == "Error: the standard output can't be written: No space left on device\n"
