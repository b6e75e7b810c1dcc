"""What went wrong, as a message."""

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

# The first that fits: a stroke error is an unreachable one too.
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
# A line of a robot file's problems: the key, maybe its value, and what is wrong.
_PROBLEM = re.compile(r"(?P<key>[A-Za-z_][\w.\[\]-]*)(?: = .*?)?: ")


def error_message(error: Exception, *, id: int | None) -> ErrorMessage:
    """Return the message on an error; what is no `TarsusError` is a bug, and is logged.

    Parameters
    ----------
    error : Exception
        The error.
    id : int or None
        Of the message that it answers.
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
        return ErrorMessage(type="error", id=id, kind="limit", text="not enough memory here for so much at once")
    _log.error("%s", _BUG, exc_info=error)
    return ErrorMessage(type="error", id=id, kind="internal", text=f"{_BUG}: {type(error).__name__}")


def malformed(text: str, *, id: int | None = None) -> ErrorMessage:
    """Return the message on a message that is none.

    Parameters
    ----------
    text : str
        What is wrong with it.
    id : int or None
        Its id, where that could be read.
    """
    return ErrorMessage(type="error", id=id, kind="message", text=text)


def _problem(line: str) -> Problem:
    found = _PROBLEM.match(line)
    return Problem(key=found["key"] if found else None, text=line)
