"""Error messages for exceptions and malformed input."""

from __future__ import annotations

import logging
import re
from typing import Literal, TypeAlias

from tarsus.errors import (
    CollisionError,
    InputError,
    MissingDataError,
    RobotFileError,
    StrokeError,
    TarsusError,
    UnknownNameError,
    UnreachableError,
)
from tarsus.studio.messages.general import ErrorMessage, Problem

__all__ = ["error_message", "malformed"]

_log = logging.getLogger(__name__)

Kind: TypeAlias = Literal[
    "stroke", "unreachable", "collision", "robot_file", "unknown_name", "missing_data", "input", "internal"
]

# The first match counts: a StrokeError is an UnreachableError too.
_KINDS: tuple[tuple[type[TarsusError], Kind], ...] = (
    (StrokeError, "stroke"),
    (UnreachableError, "unreachable"),
    (CollisionError, "collision"),
    (RobotFileError, "robot_file"),
    (UnknownNameError, "unknown_name"),
    (MissingDataError, "missing_data"),
    (InputError, "input"),
    (TarsusError, "input"),
)
_BUG = "this is a bug in Tarsus, please report it"
# A line on a problem in a robot file: the key, an optional value, and the problem.
_PROBLEM = re.compile(r"(?P<key>[A-Za-z_][\w.\[\]-]*)(?: = .*?)?: ")


def error_message(error: Exception, *, id: int | None) -> ErrorMessage:
    """Return the message for an exception; anything but a `TarsusError` is a bug, and is logged.

    Parameters
    ----------
    error : Exception
        The exception.
    id : int or None
        Id of the message that is answered.
    """
    for family, kind in _KINDS:
        if isinstance(error, family):
            return ErrorMessage(
                type="error",
                id=id,
                kind=kind,
                text=str(error),
                problems=[_problem(line) for line in getattr(error, "problems", ())],
                longest_stroke_mm=error.longest * 1000 if isinstance(error, StrokeError) else None,
            )
    if isinstance(error, MemoryError):
        return ErrorMessage(type="error", id=id, kind="limit", text="the server has not enough memory for this request")
    _log.error("%s", _BUG, exc_info=error)
    return ErrorMessage(type="error", id=id, kind="internal", text=f"{_BUG}: {type(error).__name__}")


def malformed(text: str, *, id: int | None = None) -> ErrorMessage:
    """Return the message for malformed input.

    Parameters
    ----------
    text : str
        The problem.
    id : int or None
        Id of the malformed message, if it could be read.
    """
    return ErrorMessage(type="error", id=id, kind="message", text=text)


def _problem(line: str) -> Problem:
    found = _PROBLEM.match(line)
    return Problem(key=found["key"] if found else None, text=line)
