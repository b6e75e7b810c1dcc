"""docs/studio.md agrees with the code."""

import re
from pathlib import Path

import pytest

from tarsus.studio.messages import CLOSED, SOCKET
from tarsus.studio.physics.terrains import MOST_BLOCKS, MOST_COUNT, MOST_POINTS
from tarsus.studio.physics.walk import COMMAND_RATE, MOST_SIMULATED
from tarsus.studio.robots import MOST_LEGS
from tarsus.studio.server.settings import Limits
from tarsus.studio.walks import MOST_SAMPLES

ROOT = Path(__file__).parent.parent
PAGE = (ROOT / "docs" / "studio.md").read_text(encoding="utf-8")


def row(name):
    return re.search(rf"^\| {name} \| (.*) \|$", PAGE, flags=re.MULTILINE)[1]


def test_the_limits_are_those_of_the_code():
    limits = Limits()
    assert row("simultaneous sessions").startswith(f"{limits.sessions};")
    messages = row("messages")
    assert messages.startswith(f"{limits.messages_per_s:g} messages".split()[0])
    assert f"{limits.waiting} queued; {limits.message_bytes // 1024} KiB each" in messages
    assert row("malformed or rejected messages").startswith(f"{limits.malformed} in a row")
    assert row("time without messages").startswith(f"{limits.idle_s / 3600:g} hour")
    assert row("planned walk").startswith(f"{MOST_SAMPLES:,} samples")
    assert row("legs").startswith(f"{MOST_LEGS};")
    assert row("simulated walk").startswith(f"{MOST_SIMULATED:,} samples at {COMMAND_RATE:g} Hz")
    assert row("terrain").startswith(
        f"{MOST_BLOCKS:,} blocks, {MOST_POINTS:,} points of smooth ground, {MOST_COUNT} steps"
    )


def test_the_socket_and_its_codes_are_those_of_the_code():
    assert f"`{SOCKET}`" in PAGE
    assert set(re.findall(r"^\| (\d{4}) \|", PAGE, flags=re.MULTILINE)) == {str(code) for code, _ in CLOSED.values()}


def test_all_named_files_exist():
    named = re.findall(r"`([a-z_]+\.py)`", PAGE)
    here = {path.name for path in (ROOT / "src" / "tarsus" / "studio").rglob("*.py")} | {"hatch_build.py"}
    assert len(named) > 15
    assert set(named) <= here


def test_the_example_runs(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    exec(example, {})
    assert capsys.readouterr().out.startswith("stands on 6 feet")


@pytest.mark.parametrize("target", ["studio", "web", "protocol"])
def test_all_named_make_targets_exist(target):
    assert f"make {target}" in PAGE
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(encoding="utf-8"), flags=re.MULTILINE)
