"""Every error that Tarsus raises on purpose.

::

    TarsusError
    ├── RobotFileError      a robot file can't be read, or something in it is wrong
    ├── UnknownNameError    no robot, servo, gait or leg has that name
    ├── InputError          an argument has the wrong shape, is NaN, is out of its range (also a ValueError)
    ├── MissingDataError    the robot file lacks what the calculation needs
    ├── UnreachableError    a foot can't be where it is asked to be
    │   └── StrokeError     the stroke leaves the workspace; `.longest` is the longest that works
    └── CollisionError      two feet would come nearer to each other than allowed

A message says what is wrong, where, the number against its bound, and what would work.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from typing import Self

__all__ = [
    "CollisionError",
    "InputError",
    "MissingDataError",
    "RobotFileError",
    "StrokeError",
    "TarsusError",
    "UnknownNameError",
    "UnreachableError",
    "nearest_name",
]


class TarsusError(Exception):
    """Base of all errors that Tarsus raises on purpose."""


class RobotFileError(TarsusError):
    """A robot file can't be read, or something in it is wrong.

    Attributes
    ----------
    problems : tuple of str
        One line for each thing that is wrong.
    """

    def __init__(self, where: str, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        lines = "".join(f"\n  {problem}" for problem in self.problems)
        super().__init__(f"{where}: {len(self.problems)} problem{'s' * (len(self.problems) != 1)}{lines}")


class UnknownNameError(TarsusError):
    """No robot, servo, gait or leg has that name."""

    @classmethod
    def of(cls, kind: str, name: str, known: Iterable[str]) -> Self:
        """Build the message that lists the known names and suggests the nearest.

        Parameters
        ----------
        kind : str
            What was looked for, such as ``"gait"``.
        name : str
            The name that was not found.
        known : iterable of str
            The names that exist.
        """
        names = list(known)
        nearest = nearest_name(name, names)
        hint = f" Did you mean {nearest!r}?" if nearest else ""
        return cls(f"no {kind} is called {name!r}.{hint} There are: {', '.join(names)}")


class InputError(TarsusError, ValueError):
    """An argument has the wrong shape, is NaN or infinite, or is out of its range."""


class MissingDataError(TarsusError):
    """The robot file lacks what the calculation needs."""


class UnreachableError(TarsusError):
    """A foot can't be where it is asked to be."""


class StrokeError(UnreachableError):
    """The stroke leaves the workspace.

    Attributes
    ----------
    longest : float
        The longest stroke that works [m]; 0 where none does.
    """

    def __init__(self, message: str, longest: float) -> None:
        self.longest = longest
        super().__init__(message)


class CollisionError(TarsusError):
    """Two feet would come nearer to each other than allowed."""


def nearest_name(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that is spelt most like `name`, or None where none is near.

    Parameters
    ----------
    name : str
        The name that was not found.
    known : iterable of str
        The names that exist.
    """
    by_lower = {candidate.lower(): candidate for candidate in known}
    found = difflib.get_close_matches(name.lower(), by_lower, n=1, cutoff=0.5)
    return by_lower[found[0]] if found else None
