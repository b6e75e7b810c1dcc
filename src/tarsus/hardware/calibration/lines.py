"""Line numbers of a TOML text's tables and keys, for messages."""

from __future__ import annotations

import re
from typing import TypeAlias

__all__ = ["Place", "key_lines", "line_of"]

Place: TypeAlias = tuple[str | int, ...]

_PART = r"""(?:[\w-]+|"[^"]*"|'[^']*')"""
_PATH = rf"{_PART}(?:\s*\.\s*{_PART})*"
# Strings and comments, in which brackets do not count; three quotes begin a string of several lines.
_HIDDEN = re.compile(r"""\"{3}|'{3}|"(?:[^"\\]|\\.)*"|'[^']*'|#.*""")


def key_lines(text: str) -> dict[Place, int]:
    """Return the line of each table and key; the key ``femur`` of the second ``[[legs]]`` is ``("legs", 1, "femur")``.

    Parameters
    ----------
    text : str
        The text; lines that are neither a header nor a key are skipped.
    """
    # The table of the whole file begins with its first line.
    found: dict[Place, int] = {(): 1}
    counts: dict[Place, int] = {}
    inside: Place = ()
    open_brackets, quotes = 0, ""
    for number, line in enumerate(text.splitlines(), 1):
        if open_brackets > 0 or quotes:
            open_brackets, quotes = _open(line, open_brackets, quotes)
        elif header := re.match(rf"\s*(\[\[?)\s*({_PATH})\s*\]", line):
            *outer, last = _parts(header[2])
            base = (*_resolved(outer, (), counts), last)
            if header[1] == "[[":
                counts[base] = counts.get(base, -1) + 1
            inside = _resolved([last], base[:-1], counts)
            _note(found, inside, number)
        elif key := re.match(rf"\s*({_PATH})\s*=(.*)", line):
            _note(found, (*inside, *_parts(key[1])), number)
            open_brackets, quotes = _open(key[2], 0, "")
    return found


def line_of(place: Place, lines: dict[Place, int]) -> int | None:
    """Return the line of a place, or of the nearest table or key that contains it; None where there is none.

    Parameters
    ----------
    place : tuple
        Path to a key.
    lines : dict
        As from `key_lines`.
    """
    for length in range(len(place), -1, -1):
        if place[:length] in lines:
            return lines[place[:length]]
    return None


def _parts(path: str) -> list[str]:
    return [part.strip("\"'") for part in re.findall(_PART, path)]


def _resolved(parts: list[str], inside: Place, counts: dict[Place, int]) -> Place:
    """Return the place of a path, in the last entry of each list of tables on its way."""
    for part in parts:
        inside = (*inside, part)
        if inside in counts:
            inside = (*inside, counts[inside])
    return inside


def _note(found: dict[Place, int], place: Place, number: int) -> None:
    """Take note of the line of a place; tables that are only named in its path begin there too."""
    for length in range(1, len(place)):
        found.setdefault(place[:length], number)
    found[place] = number


def _open(line: str, brackets: int, quotes: str) -> tuple[int, str]:
    """Return how many brackets are open after a line, and the quotes of a string that goes on; empty without one."""
    if quotes:
        _, closed, line = line.partition(quotes)
        if not closed:
            return brackets, quotes
    at = 0
    for hidden in _HIDDEN.finditer(line):
        brackets += _balance(line[at : hidden.start()])
        at = hidden.end()
        if hidden[0] in ('"""', "'''"):
            return _open(line[at:], brackets, hidden[0])
    return brackets + _balance(line[at:]), ""


def _balance(text: str) -> int:
    return sum((letter in "[{") - (letter in "]}") for letter in text)
