"""Errors that Tarsus raises deliberately.

::

    TarsusError
    ├── RobotFileError      a robot file can't be read or written, or something in it is wrong
    ├── CalibrationError    a calibration file can't be read or written, is incomplete, or contradicts the robot
    ├── UnknownNameError    no robot, servo, gait or leg has that name
    ├── InputError          an argument has the wrong shape, is not finite or is out of range (also a ValueError)
    ├── MissingDataError    the robot file lacks data that a computation needs
    ├── UnreachableError    a foot is out of reach
    │   └── StrokeError     the stroke leaves the workspace; `.longest` is the longest possible
    ├── CollisionError      two feet come closer to each other than allowed
    ├── SimulationError     the physics of a simulated robot becomes unstable
    ├── ServoFaultError     a servo, its bus or the supply fails while the robot runs; `.fault` says which
    └── BusError            communication with servos fails
        ├── PortError           a port can't be opened, or is gone
        ├── NoAnswerError       a servo or board does not answer in time
        ├── CorruptAnswerError  an answer is damaged, or is not the one expected
        └── ServoStatusError    a servo or board reports an error

A message says what is wrong, where, the number and its bound, and what is possible.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from typing import Self

__all__ = [
    "BusError",
    "CalibrationError",
    "CollisionError",
    "CorruptAnswerError",
    "InputError",
    "MissingDataError",
    "NoAnswerError",
    "PortError",
    "RobotFileError",
    "ServoFaultError",
    "ServoStatusError",
    "SimulationError",
    "StrokeError",
    "TarsusError",
    "UnknownNameError",
    "UnreachableError",
    "nearest_name",
]


class TarsusError(Exception):
    """Base of all errors that Tarsus raises deliberately."""


class RobotFileError(TarsusError):
    """A robot file can't be read or written, or something in it is wrong.

    Attributes
    ----------
    problems : tuple of str
        One line for each problem.
    """

    def __init__(self, where: str, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__(_listed(where, self.problems))


class CalibrationError(TarsusError):
    """A calibration file can't be read or written, is incomplete, or contradicts itself or the robot.

    Attributes
    ----------
    problems : tuple of str
        One line for each problem.
    """

    def __init__(self, where: str, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__(_listed(where, self.problems))


class UnknownNameError(TarsusError):
    """No robot, servo, gait or leg has that name."""

    @classmethod
    def of(cls, kind: str, name: str, known: Iterable[str]) -> Self:
        """Return the error whose message lists the known names and suggests the nearest one.

        Parameters
        ----------
        kind : str
            What was searched, such as ``"gait"``.
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
    """An argument has the wrong shape, is not finite, or is out of range."""


class MissingDataError(TarsusError):
    """The robot file lacks data that a computation needs."""


class UnreachableError(TarsusError):
    """A foot is out of reach."""


class StrokeError(UnreachableError):
    """The stroke leaves the workspace.

    Attributes
    ----------
    longest : float
        The longest stroke possible [m]; 0 if none is.
    """

    def __init__(self, message: str, longest: float) -> None:
        self.longest = longest
        super().__init__(message)


class CollisionError(TarsusError):
    """Two feet come closer to each other than allowed."""


class SimulationError(TarsusError):
    """The physics of a simulated robot becomes unstable."""


class ServoFaultError(TarsusError):
    """A servo, its bus or the supply fails while the robot runs.

    Attributes
    ----------
    fault : ServoFault
        What failed, which joint, what the robot did, and what would help.
    """

    def __init__(self, message: str, fault: object) -> None:
        self.fault = fault
        super().__init__(message)


class BusError(TarsusError):
    """Communication with servos fails.

    Attributes
    ----------
    bus : str
        Name of the bus, such as ``"feetech-sts"``.
    port : str
        Name of the port, such as ``"/dev/ttyUSB0"``.
    id : int or None
        Id or channel of the servo; None if the whole bus is concerned.
    expected, received : str
        What should have come, and what came.
    remedy : str
        What would work.
    late : float
        How late this computer itself was when it looked for the answer, as other programs kept it from running [s].
    """

    def __init__(
        self,
        bus: str,
        port: str,
        *,
        expected: str,
        received: str,
        remedy: str,
        id: int | None = None,
        late: float = 0.0,
    ) -> None:
        self.bus, self.port, self.id, self.late = bus, port, id, late
        self.expected, self.received, self.remedy = expected, received, remedy
        where = f"{bus} on {port}" + (f", id {id}" if id is not None else "")
        super().__init__(f"{where}: expected {expected}, received {received}. {remedy}")


class PortError(BusError):
    """A port can't be opened, or is gone."""


class NoAnswerError(BusError):
    """A servo or board does not answer in time."""


class CorruptAnswerError(BusError):
    """An answer is damaged, or is not the one expected."""


class ServoStatusError(BusError):
    """A servo or board reports an error."""


def _listed(where: str, problems: Sequence[str]) -> str:
    """Return the message that lists problems, a line for each."""
    lines = "".join(f"\n  {problem}" for problem in problems)
    return f"{where}: {len(problems)} problem{'s' * (len(problems) != 1)}{lines}"


def nearest_name(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that is most similar to `name`, else one that it begins with, or None.

    Parameters
    ----------
    name : str
        The name that was not found.
    known : iterable of str
        The names that exist.
    """
    by_lower = {candidate.lower(): candidate for candidate in known}
    lower = name.lower()
    found = difflib.get_close_matches(lower, by_lower, n=1, cutoff=0.65)
    found = found or [candidate for candidate in by_lower if lower.startswith(candidate)]
    return by_lower[found[0]] if found else None
