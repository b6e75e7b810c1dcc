"""Regenerate the outputs and tables in README.md and docs: run the commands, the examples and the calculations."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

from click.testing import CliRunner

from bus_tables import with_buses
from mistyped import table as mistakes_table
from page_tables import with_tables
from tarsus import load_robot
from tarsus.cli import main as tarsus
from tarsus.load.handbook.page import docs_page

ROOT = Path(__file__).parents[1]
PAGES = (
    ROOT / "README.md",
    *(
        ROOT / "docs" / name
        for name in ("commands.md", "loads.md", "walking-live.md", "firmware.md", "calibration.md", "first-hour.md")
    ),
    ROOT / "docs" / "other-simulators.md",
)


def refreshed(text: str) -> str:
    """Return a page with the current outputs of its console blocks and of its Python example."""
    text = re.sub(r"```console\n(\$ tarsus [^\n]*)\n.*?```", _console, text, flags=re.DOTALL)
    return re.sub(r"```python\n(.*?)```\n\n```text\n.*?```", _example, text, flags=re.DOTALL)


def _console(match: re.Match[str]) -> str:
    command = match[1].removeprefix("$ tarsus ")
    result = CliRunner(env={"COLUMNS": "100"}).invoke(tarsus, command.split())
    lines = [line.rstrip() for line in result.output.strip("\n").splitlines()]
    return "```console\n" + "\n".join([match[1], *lines]) + "\n```"


def _example(match: re.Match[str]) -> str:
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(match[1], "example", "exec"), {})
    return f"```python\n{match[1]}```\n\n```text\n{printed.getvalue()}```"


def with_mistakes(text: str) -> str:
    """Return the page on checking robot files with the current table of mistakes."""
    return with_tables(text, {"mistakes": mistakes_table()})


def main() -> None:
    for page in PAGES:
        page.write_text(refreshed(page.read_text(encoding="utf-8")), encoding="utf-8")
        print(f"refreshed {page.name}")
    check = ROOT / "docs" / "robot-check.md"
    check.write_text(with_mistakes(check.read_text(encoding="utf-8")), encoding="utf-8")
    print(f"refreshed {check.name}")
    buses = ROOT / "docs" / "buses.md"
    buses.write_text(with_buses(refreshed(buses.read_text(encoding="utf-8"))), encoding="utf-8")
    print(f"refreshed {buses.name}")
    handbook = ROOT / "docs" / "handbook.md"
    handbook.write_text(docs_page(handbook.read_text(encoding="utf-8"), load_robot("strider")), encoding="utf-8")
    print(f"refreshed {handbook.name}")


if __name__ == "__main__":
    main()
