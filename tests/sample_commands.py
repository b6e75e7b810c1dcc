"""Running commands as a shell would, but in this process."""

import json

from click.testing import CliRunner

from tarsus.cli import main


def run(*args):
    """Run `tarsus` with arguments; refuse a traceback, whatever happens."""
    result = CliRunner().invoke(main, [str(arg) for arg in args])
    assert "Traceback" not in result.output
    assert "this is a bug" not in result.output
    return result


def run_json(*args):
    """Run a command with ``--json``, and return its exit code and its document: nothing else may be printed."""
    result = run(*args, "--json")
    assert result.stderr == ""
    return result.exit_code, json.loads(result.stdout, parse_constant=_not_json)


def _not_json(name):
    raise AssertionError(f"{name} is not JSON")
