"""Line numbers of a TOML text's tables and keys, for messages."""

from __future__ import annotations

import re
from typing import TypeAlias

__all__ = ["Place", "key_lines", "line_of"]

Place: TypeAlias = tuple[str | int, ...]


def key_lines(text: str) -> dict[Place, int]:
    """Return the line of each table and key; the key ``femur`` of the second ``[[legs]]`` is ``("legs", 1, "femur")``.

    Parameters
    ----------
    text : str
        The text; what is no header and no key is passed over.
    """
    found: dict[Place, int] = {}
    counts: dict[str, int] = {}
    inside: Place = ()
    for number, line in enumerate(text.splitlines(), 1):
        if header := re.match(r"\s*\[\[\s*([\w-]+)\s*\]\]", line):
            name = header[1]
            counts[name] = counts.get(name, -1) + 1
            inside = (name, counts[name])
            found[inside] = number
        elif header := re.match(r"\s*\[\s*([\w.-]+)\s*\]", line):
            inside = ()
            for part in header[1].split("."):
                inside += (part, counts[part]) if not inside and part in counts else (part,)
            found[inside] = number
        elif key := re.match(r"\s*([\w-]+)\s*=", line):
            found[(*inside, key[1])] = number
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
    for length in range(len(place), 0, -1):
        if place[:length] in lines:
            return lines[place[:length]]
    return None
