"""What commands print: a JSON document, tables, messages."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol

import click

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["Progress", "fail", "print_json", "progress_bar", "show"]

_PIPE_WIDTH = 120


def print_json(document: Any) -> None:
    """Print one JSON document: numbers to a millionth, NaN and infinities as null."""
    click.echo(json.dumps(_plain(document), indent=2, ensure_ascii=False))


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, float):
        # Adding zero makes -0.0 a plain 0.0.
        return round(value, 6) + 0.0 if math.isfinite(value) else None
    return value


def fail(message: str, *, code: int, as_json: bool, details: dict[str, Any] | None = None) -> int:
    """Print what went wrong, and return the exit code."""
    if as_json:
        print_json({"error": message, "exit_code": code, **(details or {})})
    else:
        click.echo(f"Error: {message}", err=True)
    return code


def show(*parts: RenderableType) -> None:
    """Print tables and texts; not folded at 80 columns where nobody's terminal is."""
    from rich.console import Console
    from rich.text import Text

    console = Console(highlight=False, markup=False, emoji=False)
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console.width = _PIPE_WIDTH
    for part in parts:
        # Sentences are left for the terminal to fold: whoever copies or searches them finds them whole.
        console.print(part, soft_wrap=isinstance(part, str | Text))


class Progress(Protocol):
    """Told what is being done, and what share of it is done."""

    def __call__(self, doing: str, share: float, /) -> None:
        """Show it."""


@contextmanager
def progress_bar(*, wanted: bool) -> Iterator[Progress]:
    """Show a bar on stderr while something lasts, and leave nothing behind; none where nobody sees it."""
    from rich.console import Console

    console = Console(stderr=True)
    if not (wanted and console.is_terminal):
        yield lambda _doing, _share: None
        return
    from rich.progress import Progress as Bar

    with Bar(console=console, transient=True) as bar:
        task = bar.add_task("", total=1.0)
        yield lambda doing, share: bar.update(task, description=doing, completed=share)
