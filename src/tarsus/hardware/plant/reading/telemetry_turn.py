"""Whose telemetry is read in a tick: all servos in turn, those with an alarm or suspected at once."""

from __future__ import annotations

import itertools
import math
from collections import deque
from collections.abc import Iterable, Iterator, Mapping

from tarsus.hardware.bus.answers import Telemetry
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.separate_telemetry import SeparateTelemetry
from tarsus.hardware.transport.clock import Clock

__all__ = ["TelemetryTurn"]

# Within this time the telemetry of each servo is read, where the wire carries it [s].
_TELEMETRY_TIME = 0.08
# How much of a measured duration is believed at once.
_NEW = 0.2
# Where each value takes a request, temperatures are read: the voltage, that of all servos, after so many of them.
_EACH, _SHARED, _SELDOM = "temperature", "voltage", 20


class TelemetryTurn:
    """Reads the telemetry of some servos.

    Parameters
    ----------
    bus : Bus
        The bus.
    numbers : tuple of int
        Its servos.
    clock : Clock
        The clock.
    """

    def __init__(self, bus: Bus, numbers: tuple[int, ...], clock: Clock) -> None:
        self._bus, self._clock, self._numbers = bus, clock, deque(numbers)
        self._separate = bus if isinstance(bus, SeparateTelemetry) else None
        every, one = bus.timing(numbers).telemetry, bus.timing(numbers[:1]).telemetry
        # Boards measure the same for all of their channels.
        self._together = len(numbers) > 1 and every == one
        parts = len(bus.capabilities.telemetry) if self._separate is not None else 1
        self._seconds = every / len(numbers) / parts
        self._alarms: dict[int, tuple[str, ...]] = {}
        self._urgent: list[int] = []
        self._since_shared = 0

    def alarmed(self, alarms: Mapping[int, tuple[str, ...]]) -> None:
        """Take note of alarms that came with positions; what a servo has reported before is known.

        Parameters
        ----------
        alarms : mapping of int to tuple of str
            What servos complain of, by id.
        """
        self._urgent += [number for number, names in alarms.items() if names != self._alarms.get(number)]
        self._alarms = dict(alarms)

    def suspect(self, numbers: Iterable[int]) -> None:
        """Let the first of some servos come first, where telemetry is slow.

        Parameters
        ----------
        numbers : iterable of int
            The servos.
        """
        if self._separate is not None:
            self._urgent += itertools.islice(numbers, 1)

    def read(self, dt: float, *, left: float) -> Iterator[Mapping[int, Telemetry]]:
        """Read as many servos as are needed in a tick and fit into what is left of it, and yield what they tell.

        Parameters
        ----------
        dt : float
            Duration of the tick [s].
        left : float
            How much is left of it [s].

        Raises
        ------
        BusError
            If the line fails.
        """
        start, chosen = self._clock.now(), self._chosen(dt, left)
        if self._separate is None:
            yield self._bus.read_telemetry(chosen).values
        elif self._since_shared >= _SELDOM:
            # It takes the place of one temperature.
            self._since_shared = 0
            self._numbers.rotate(1)
            yield self._separate.read_one(_SHARED, chosen[-1:]).values
            yield self._separate.read_one(_EACH, chosen[:-1]).values
        else:
            self._since_shared += len(chosen)
            yield self._separate.read_one(_EACH, chosen).values
        # Adapters add to the time on the wire.
        self._seconds += _NEW * ((self._clock.now() - start) / len(chosen) - self._seconds)

    def _chosen(self, dt: float, left: float) -> tuple[int, ...]:
        if self._together:
            return tuple(self._numbers)
        wanted = math.ceil(len(self._numbers) * min(dt / _TELEMETRY_TIME, 1.0))
        count = max(1, min(wanted, int(left / self._seconds)))
        chosen = dict.fromkeys((*self._urgent, *itertools.islice(self._numbers, count)))
        self._urgent = []
        self._numbers.rotate(-count)
        return tuple(chosen)
