"""Output of commands: JSON documents, tables, messages."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import click

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["Progress", "fail", "file_name", "print_json", "progress_bar", "show", "write_new"]

_PIPE_WIDTH = 120


def print_json(document: Any) -> None:
    """Print a JSON document, with numbers to 6 decimal places, and NaN and infinities as null."""
    click.echo(json.dumps(_plain(document), indent=2, ensure_ascii=False))


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, float):
        # Adding zero turns -0.0 into 0.0.
        return round(value, 6) + 0.0 if math.isfinite(value) else None
    return value


def fail(message: str, *, code: int, as_json: bool, details: dict[str, Any] | None = None) -> int:
    """Print an error message and return the exit code."""
    if as_json:
        print_json({"error": message, "exit_code": code, **(details or {})})
    else:
        click.echo(f"Error: {message}", err=True)
    return code


def file_name(name: str) -> str:
    """Return a name without separators or characters that are special to a shell."""
    return "".join(letter if letter.isalnum() or letter in "-_" else "-" for letter in name)[:100]


def write_new(path: Path, text: str) -> None:
    """Write a text file; a file that exists already is not overwritten, but reported as a usage error."""
    try:
        with path.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except FileExistsError:
        raise click.UsageError(f"{path} already exists; choose another file with --out") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise click.UsageError(f"{path} can't be written: {reason}") from None


def show(*items: RenderableType) -> None:
    """Print tables and texts; output to a pipe is wider than 80 columns."""
    from rich.console import Console
    from rich.text import Text

    console = Console(highlight=False, markup=False, emoji=False)
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console.width = _PIPE_WIDTH
    for item in items:
        # Sentences are not folded here but by the terminal, so that they can be copied and searched.
        console.print(item, soft_wrap=isinstance(item, str | Text))


class Progress(Protocol):
    """Callback that takes the current activity and the completed fraction."""

    def __call__(self, activity: str, fraction: float, /) -> None:
        """Show the progress."""


@contextmanager
def progress_bar(*, enabled: bool) -> Iterator[Progress]:
    """Show a transient progress bar on stderr, if it is a terminal."""
    from rich.console import Console

    console = Console(stderr=True)
    if not (enabled and console.is_terminal):
        yield lambda _activity, _fraction: None
        return
    from rich.progress import Progress as Bar

    with Bar(console=console, transient=True) as bar:
        task = bar.add_task("", total=1.0)
        yield lambda activity, fraction: bar.update(task, description=activity, completed=fraction)
