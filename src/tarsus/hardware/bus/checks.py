"""Checks of what is asked of a bus, before anything is sent."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Mapping

from tarsus.errors import InputError
from tarsus.hardware.bus.capabilities import Capabilities

__all__ = [
    "checked_goals",
    "checked_ids",
    "checked_numbers",
    "checked_range",
    "checked_share",
    "checked_speed",
    "checked_time",
]


def checked_numbers(bus: str, what: str, known: range, numbers: Iterable[int]) -> tuple[int, ...]:
    """Return numbers, of ids or inputs, that a bus has.

    Parameters
    ----------
    bus : str
        Name of the bus, for messages.
    what : str
        What is numbered: ``"id"``, ``"input"``.
    known : range
        The numbers that the bus has.
    numbers : iterable of int
        The numbers asked for.

    Raises
    ------
    InputError
        If the bus does not have one of them.
    """
    found = []
    for asked in numbers:
        number = operator.index(asked) if hasattr(asked, "__index__") else -1
        if number not in known:
            raise InputError(f"{bus} has no {what} {asked!r}: {what}s are {known.start} to {known.stop - 1}")
        found.append(number)
    return tuple(found)


def checked_ids(bus: str, can: Capabilities, ids: Iterable[int]) -> tuple[int, ...]:
    """Return ids in their order, each once.

    Parameters
    ----------
    bus : str
        Name of the bus, for messages.
    can : Capabilities
        What it can do.
    ids : iterable of int
        Ids or channels.

    Raises
    ------
    InputError
        If the bus does not have one of them.
    """
    return tuple(dict.fromkeys(checked_numbers(bus, "id", can.ids, ids)))


def _checked(bus: str, can: Capabilities, what: str, value: float) -> float:
    if not can.lowest <= value <= can.highest:
        raise InputError(f"{bus}, {what}: {value:g} {can.unit} is outside {can.lowest:g} to {can.highest:g} {can.unit}")
    return float(value)


def checked_goals(bus: str, can: Capabilities, goals: Mapping[int, float]) -> dict[int, float]:
    """Return goals that a bus accepts.

    Parameters
    ----------
    bus : str
        Name of the bus, for messages.
    can : Capabilities
        What it can do.
    goals : mapping of int to float
        Goals by id.

    Raises
    ------
    InputError
        If the bus does not have an id, or a goal is NaN or outside the range of the bus.
    """
    return {id: _checked(bus, can, f"goal of id {id}", goals[id]) for id in checked_ids(bus, can, goals)}


def checked_range(bus: str, can: Capabilities, id: int, lowest: float, highest: float) -> tuple[int, int]:
    """Return limits that a bus accepts, rounded inwards.

    Parameters
    ----------
    bus : str
        Name of the bus, for messages.
    can : Capabilities
        What it can do.
    id : int
        The servo.
    lowest, highest : float
        Range of its goals.

    Raises
    ------
    InputError
        If the bus does not have the id, or the range is empty or outside that of the bus.
    """
    checked_ids(bus, can, (id,))
    low = math.ceil(_checked(bus, can, f"lower limit of id {id}", lowest))
    high = math.floor(_checked(bus, can, f"upper limit of id {id}", highest))
    if low > high:
        raise InputError(f"{bus}, id {id}: the lower limit {lowest:g} is above the upper limit {highest:g} {can.unit}")
    return low, high


def checked_speed(bus: str, can: Capabilities, speed: float | None) -> float | None:
    """Return a checked speed limit, or None for the servo's own highest speed.

    Parameters
    ----------
    bus : str
        Name of the bus, for messages.
    can : Capabilities
        What it can do.
    speed : float or None
        Speed limit, in the unit of the bus per second.

    Raises
    ------
    InputError
        If it is not finite and positive.
    """
    if speed is not None and not 0 < speed < math.inf:
        raise InputError(f"{bus}: a speed limit of {speed:g} {can.unit}/s is none; give one above 0")
    return speed


def checked_share(bus: str, share: float) -> float:
    """Return a checked share of the highest torque.

    Parameters
    ----------
    bus : str
        Name of the bus, for messages.
    share : float
        Share of the highest torque.

    Raises
    ------
    InputError
        If it is outside 0 to 1.
    """
    if not 0 <= share <= 1:
        raise InputError(f"{bus}: a torque limit of {share:g} is outside 0 to 1, shares of the highest torque")
    return float(share)


def checked_time(bus: str, can: Capabilities, seconds: float | None) -> float | None:
    """Return the checked time of a watchdog, or None for never.

    Parameters
    ----------
    bus : str
        Name of the bus, for messages.
    can : Capabilities
        What it can do.
    seconds : float or None
        The time [s].

    Raises
    ------
    InputError
        If the time is outside the range of the bus's watchdog.
    """
    low, high = can.watchdog or (0.0, math.inf)
    if seconds is not None and not low <= seconds <= high:
        raise InputError(f"{bus}: a watchdog of {seconds:g} s is outside {low:g} to {high:g} s")
    return seconds
