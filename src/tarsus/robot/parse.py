"""Parsing of robot files, and the likely cause where a text, also of other files, is not valid TOML."""

from __future__ import annotations

import json
import re
import tomllib
from decimal import Decimal
from typing import Any

from tarsus.errors import RobotFileError

__all__ = ["parse_toml", "toml_problem"]


def parse_toml(text: str, *, where: str) -> dict[str, Any]:
    """Return the document of a TOML text, with decimals for numbers with a point.

    Parameters
    ----------
    text : str
        The text.
    where : str
        Name of the file in messages.

    Raises
    ------
    RobotFileError
        If it is not valid TOML; the message names the line and, where it is known, the likely cause.
    """
    try:
        return tomllib.loads(text, parse_float=Decimal)
    except (ValueError, ArithmeticError, RecursionError) as error:
        json_text = isinstance(error, tomllib.TOMLDecodeError) and _is_json(text)
        raise RobotFileError(where, [_NOT_JSON if json_text else toml_problem(error, text)]) from None


def toml_problem(error: Exception, text: str) -> str:
    """Return what is wrong with a text that is not valid TOML: with its line and, where it is known, the likely cause.

    Parameters
    ----------
    error : Exception
        A `ValueError`, `ArithmeticError` or `RecursionError` of the TOML parser.
    text : str
        The text.
    """
    if isinstance(error, tomllib.TOMLDecodeError):
        return _not_toml(str(error), text)
    if isinstance(error, RecursionError):
        return "lists or tables are nested too deeply; no key takes more than a few levels"
    return "a number has too many digits or too large an exponent"


_NOT_JSON = (
    'is JSON; a robot file is TOML: write name = "...", [leg] and [[legs]] instead of braces, or load the document '
    "in Python and save it with tarsus.save_robot(tarsus.robot_from_dict(document), path)"
)


def _is_json(text: str) -> bool:
    try:
        return isinstance(json.loads(text), dict)
    except (ValueError, RecursionError):
        # JSON with a mistake in it still begins with a brace, which no TOML does.
        return text.lstrip().startswith("{")


def _not_toml(message: str, text: str) -> str:
    """Return the message on an error of the TOML parser, with its line."""
    reason, _, place = message.rpartition(" (at ")
    reason = reason[:1].lower() + reason[1:]
    found = re.fullmatch(r"line (\d+), column (\d+)\)", place)
    lines = text.splitlines() or [""]
    if found is None:
        return f"line {len(lines)}, at the end: not valid TOML: {reason}"
    number, column = int(found[1]), int(found[2])
    line = text.split("\n")[number - 1].strip()
    shown = line if len(line) <= 60 else line[:57] + "..."
    return f"line {number}, column {column}: not valid TOML: {reason}; in: {shown}{_likely_slip(line)}"


def _likely_slip(line: str) -> str:
    """Return the likely cause why a line is not valid TOML, or an empty string."""
    if comma := re.fullmatch(r"[^#\"']*=\s*(-?\d+),(\d+)\s*(#.*)?", line):
        return f". Likely cause: a decimal comma; write {comma[1]}.{comma[2]}"
    if line.partition("#")[0].count('"') % 2:
        return ". Likely cause: a quote is missing"
    if unit := re.fullmatch(r"[^#\"']*=\s*-?[\d.]+\s*([a-zA-Z%°]+)\s*(#.*)?", line):
        return f". Likely cause: a unit after the number; leave out {unit[1]!r}"
    return ""
