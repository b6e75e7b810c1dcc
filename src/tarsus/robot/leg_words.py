"""Where a leg is, according to its name."""

from __future__ import annotations

import re

__all__ = ["end_in_name", "side_in_name"]

_SIDES = {"left": 1, "right": -1}
_ENDS = {"front": 1, "rear": -1, "back": -1, "hind": -1}


def side_in_name(name: str) -> int:
    """Return 1 for a leg that is called left, -1 for one called right, 0 for others.

    Parameters
    ----------
    name : str
        Name of the leg.
    """
    return _sign(name, _SIDES)


def end_in_name(name: str) -> int:
    """Return 1 for a leg that is called front, -1 for one called rear, back or hind, 0 for others.

    Parameters
    ----------
    name : str
        Name of the leg.
    """
    return _sign(name, _ENDS)


def _sign(name: str, words: dict[str, int]) -> int:
    found = {words[word] for word in re.findall(r"[a-z]+", name.lower()) if word in words}
    return found.pop() if len(found) == 1 else 0
