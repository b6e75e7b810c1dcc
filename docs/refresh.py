"""Keep what the pages show true: run the commands and examples in them, and put what they print in its place."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

from click.testing import CliRunner

from tarsus.cli import main as tarsus

ROOT = Path(__file__).parents[1]
PAGES = (ROOT / "README.md", *(ROOT / "docs" / name for name in ("commands.md", "walking-live.md")))


def refreshed(text: str) -> str:
    """Return a page with the outputs of its console blocks and of its Python example as they are now."""
    text = re.sub(r"```console\n(\$ tarsus [^\n]*)\n.*?```", _console, text, flags=re.DOTALL)
    return re.sub(r"```python\n(.*?)```\n\n```text\n.*?```", _example, text, flags=re.DOTALL)


def _console(block: re.Match[str]) -> str:
    command = block[1].removeprefix("$ tarsus ")
    answer = CliRunner(env={"COLUMNS": "100"}).invoke(tarsus, command.split())
    lines = [line.rstrip() for line in answer.output.strip("\n").splitlines()]
    return "```console\n" + "\n".join([block[1], *lines]) + "\n```"


def _example(block: re.Match[str]) -> str:
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(block[1], "example", "exec"), {})
    return f"```python\n{block[1]}```\n\n```text\n{printed.getvalue()}```"


def main() -> None:
    for page in PAGES:
        page.write_text(refreshed(page.read_text(encoding="utf-8")), encoding="utf-8")
        print(f"refreshed {page.name}")


if __name__ == "__main__":
    main()
