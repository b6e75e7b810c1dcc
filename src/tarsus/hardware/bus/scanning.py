"""Finding the servos on a bus by asking id after id."""

from __future__ import annotations

from collections.abc import Iterable

from tarsus.errors import BusError, CorruptAnswerError
from tarsus.hardware.bus.answers import Answers, BusServo
from tarsus.hardware.bus.checks import checked_ids
from tarsus.hardware.bus.protocol import Bus

__all__ = ["scanned"]


def scanned(bus: Bus, ids: Iterable[int] | None) -> Answers[BusServo]:
    """Return the servos that answer, and an error for each id whose answer is damaged.

    Parameters
    ----------
    bus : Bus
        The bus.
    ids : iterable of int, or None
        Ids to ask; None for all.
    """
    found: dict[int, BusServo] = {}
    errors: list[BusError] = []
    for id in checked_ids(bus.name, bus.capabilities, bus.capabilities.ids if ids is None else ids):
        try:
            servo = bus.ping(id)
        except CorruptAnswerError as error:
            errors.append(error)
            continue
        if servo is not None:
            found[id] = servo
    return Answers(found, tuple(errors))
