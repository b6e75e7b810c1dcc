"""The group of all commands: whatever goes wrong in one of them becomes one clear message and an exit code."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

import click

from tarsus.cli.output import fail
from tarsus.errors import InputError, StrokeError, TarsusError, UnknownNameError

__all__ = ["TarsusGroup"]

_EXTRAS = {"rich": "cli", "matplotlib": "plots", "PIL": "plots", "fastapi": "studio", "uvicorn": "studio"}
_IMPOSSIBLE, _ASKED_WRONGLY, _BUG, _INTERRUPTED = 1, 2, 70, 130


class TarsusGroup(click.Group):
    """A group whose errors are messages: for people on stderr, with ``--json`` as one document on stdout."""

    def main(self, args: Sequence[str] | None = None, *rest: Any, **extra: Any) -> NoReturn:
        """Run a command, and exit."""
        given = list(sys.argv[1:] if args is None else args)
        # An option may be malformed before --json is parsed, so that it is looked for here.
        as_json = "--json" in given
        extra["standalone_mode"] = False
        try:
            code = super().main(given, *rest, **extra)
        except click.Abort:
            code = _INTERRUPTED
        except click.ClickException as error:
            code = _ASKED_WRONGLY
            if as_json:
                fail(error.format_message(), code=code, as_json=True)
            else:
                error.show()
        except Exception as error:
            if os.environ.get("TARSUS_DEBUG"):
                raise
            message, code = _answer(error)
            fail(message, code=code, as_json=as_json, details=_details(error))
        sys.exit(code or 0)


def _answer(error: Exception) -> tuple[str, int]:
    """Return the message and the exit code."""
    if isinstance(error, InputError | UnknownNameError):
        return str(error), _ASKED_WRONGLY
    if isinstance(error, TarsusError):
        return str(error), _IMPOSSIBLE
    if isinstance(error, ModuleNotFoundError) and error.name in _EXTRAS:
        return f"this needs {error.name}: pip install 'tarsus[{_EXTRAS[error.name]}]'", _IMPOSSIBLE
    if isinstance(error, MemoryError):
        return "not enough memory for so many samples: ask for a shorter walk or a lower --rate", _ASKED_WRONGLY
    what = f"{type(error).__name__}: {error}"
    return f"this is a bug in Tarsus, please report it: {what} (TARSUS_DEBUG=1 in the environment shows where)", _BUG


def _details(error: Exception) -> dict[str, Any]:
    return {"longest_stroke_mm": error.longest * 1000} if isinstance(error, StrokeError) else {}
