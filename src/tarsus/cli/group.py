"""Command group that turns errors into one message and an exit code."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Sequence
from typing import Any, NoReturn

import click

from tarsus.cli.output import fail
from tarsus.errors import InputError, StrokeError, TarsusError, UnknownNameError

__all__ = ["TarsusGroup"]

_EXTRAS = {
    "rich": "cli",
    "matplotlib": "plots",
    "PIL": "plots",
    "xarray": "data",
    "zarr": "data",
    "fastapi": "studio",
    "uvicorn": "studio",
}
_PRINTING = {"click.utils", "rich.console"}
_IMPOSSIBLE, _USAGE, _BUG, _INTERRUPTED = 1, 2, 70, 130


class TarsusGroup(click.Group):
    """Command group with errors as messages on stderr, or with ``--json`` as a document on stdout."""

    def main(self, args: Sequence[str] | None = None, *rest: Any, **extra: Any) -> NoReturn:
        """Run a command and exit."""
        arguments = list(sys.argv[1:] if args is None else args)
        # Looked for here, as an option before --json may be malformed, so that --json is never parsed.
        as_json = "--json" in arguments
        extra["standalone_mode"] = False
        try:
            code = super().main(arguments, *rest, **extra)
        except click.Abort:
            code = _INTERRUPTED
        except click.ClickException as error:
            code = _USAGE
            if as_json:
                fail(error.format_message(), code=code, as_json=True)
            else:
                error.show()
        except Exception as error:
            if os.environ.get("TARSUS_DEBUG"):
                raise
            message, code = _message_and_code(error)
            fail(message, code=code, as_json=as_json and not _while_printing(error), details=_details(error))
        sys.exit(code or 0)


def _message_and_code(error: Exception) -> tuple[str, int]:
    """Return the message and the exit code of an error."""
    if isinstance(error, InputError | UnknownNameError):
        return str(error), _USAGE
    if isinstance(error, TarsusError):
        return str(error), _IMPOSSIBLE
    if isinstance(error, ModuleNotFoundError) and error.name in _EXTRAS:
        return f"this command needs {error.name}: pip install 'tarsus[{_EXTRAS[error.name]}]'", _IMPOSSIBLE
    if isinstance(error, MemoryError):
        return "out of memory: choose a shorter walk or a lower --rate", _USAGE
    if _while_printing(error) and isinstance(error, OSError):
        return f"the standard output can't be written: {error.strerror}", _USAGE
    what = f"{type(error).__name__}: {error}"
    return f"bug in Tarsus, please report it: {what} (set TARSUS_DEBUG=1 for a traceback)", _BUG


def _while_printing(error: Exception) -> bool:
    """Return whether the error occurred in a function of click or rich that prints, as where the disk is full."""
    modules = {frame.f_globals.get("__name__") for frame, _ in traceback.walk_tb(error.__traceback__)}
    return isinstance(error, OSError) and bool(modules & _PRINTING)


def _details(error: Exception) -> dict[str, Any]:
    return {"longest_stroke_mm": error.longest * 1000} if isinstance(error, StrokeError) else {}
