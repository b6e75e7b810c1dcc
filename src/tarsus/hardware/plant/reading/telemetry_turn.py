"""Whose telemetry is read in a tick: all servos in turn, those with an alarm at once."""

from __future__ import annotations

import itertools
import math
from collections import deque
from collections.abc import Mapping

from tarsus.hardware.bus.protocol import Bus

__all__ = ["TelemetryTurn"]

# Within this time the telemetry of each servo is read, where the wire carries it [s].
_TELEMETRY_TIME = 0.08
# How much of a measured duration is believed at once.
_NEW = 0.2


class TelemetryTurn:
    """Tells whose telemetry is read next.

    Parameters
    ----------
    bus : Bus
        The bus.
    numbers : tuple of int
        Its servos.
    """

    def __init__(self, bus: Bus, numbers: tuple[int, ...]) -> None:
        self._numbers = deque(numbers)
        every, one = bus.timing(numbers).telemetry, bus.timing(numbers[:1]).telemetry
        # Boards measure the same for all of their channels.
        self._together = len(numbers) > 1 and every == one
        self._seconds = every / len(numbers)
        self._alarms: dict[int, tuple[str, ...]] = {}
        self._urgent: list[int] = []

    def alarmed(self, alarms: Mapping[int, tuple[str, ...]]) -> None:
        """Take note of alarms that came with positions; what a servo has reported before is known.

        Parameters
        ----------
        alarms : mapping of int to tuple of str
            What servos complain of, by id.
        """
        self._urgent += [number for number, names in alarms.items() if names != self._alarms.get(number)]
        self._alarms = dict(alarms)

    def next(self, dt: float, *, left: float) -> tuple[int, ...]:
        """Return the next servos, as many as are needed in a tick and fit into the time that is left of it.

        Parameters
        ----------
        dt : float
            Duration of the tick [s].
        left : float
            How much is left of it [s].
        """
        if self._together:
            return tuple(self._numbers)
        wanted = math.ceil(len(self._numbers) * min(dt / _TELEMETRY_TIME, 1.0))
        count = max(1, min(wanted, int(left / self._seconds)))
        chosen = dict.fromkeys((*self._urgent, *itertools.islice(self._numbers, count)))
        self._urgent = []
        self._numbers.rotate(-count)
        return tuple(chosen)

    def took(self, servos: int, seconds: float) -> None:
        """Take note of how long reading took: adapters add to the time on the wire.

        Parameters
        ----------
        servos : int
            How many were read.
        seconds : float
            How long it took [s].
        """
        self._seconds += _NEW * (seconds / servos - self._seconds)
