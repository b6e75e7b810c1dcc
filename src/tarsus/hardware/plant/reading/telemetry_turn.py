"""Whose telemetry is read in a tick: all servos in turn, those with an alarm or suspected at once."""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterable, Iterator, Mapping

from tarsus.hardware.bus.answers import Answers, Telemetry
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.separate_telemetry import SeparateTelemetry
from tarsus.hardware.transport.clock import Clock

__all__ = ["TelemetryTurn"]

# Within this time the telemetry of each servo is read, where the wire carries it [s].
_TELEMETRY_TIME = 0.08
# How much of a measured duration is believed at once.
_NEW = 0.2
# Where each value takes a request, temperatures are read: the voltage, that of all servos, after so many of them.
_EACH, _SHARED, _SELDOM = "temperature", "voltage", 60
# How many suspects tell more than their turn at most, and which share of a tick may be taken for what is not its turn.
_SUSPECTS, _SPARE = 2, 0.05


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

    Attributes
    ----------
    separate : bool
        Whether each value takes a request of its own.
    """

    def __init__(self, bus: Bus, numbers: tuple[int, ...], clock: Clock) -> None:
        # Those first that were not asked for longest.
        self._bus, self._clock, self._waiting = bus, clock, list(numbers)
        self._separate = bus if isinstance(bus, SeparateTelemetry) else None
        self.separate = self._separate is not None
        every, one = bus.timing(numbers).telemetry, bus.timing(numbers[:1]).telemetry
        # Boards measure the same for all of their channels.
        self._together = len(numbers) > 1 and every == one
        parts = len(bus.capabilities.telemetry) if self._separate is not None else 1
        self._seconds = every / len(numbers) / parts
        self._alarms: dict[int, tuple[str, ...]] = {}
        self._urgent: list[int] = []
        self._since_shared, self._most = 0, 1

    def alarmed(self, alarms: Mapping[int, tuple[str, ...]]) -> None:
        """Take note of alarms that came with positions; what a servo has reported before is known.

        Parameters
        ----------
        alarms : mapping of int to tuple of str
            What servos complain of, by id.
        """
        self._urgent += [number for number, names in alarms.items() if names != self._alarms.get(number)]
        self._alarms = dict(alarms)

    def slower(self, seconds: float) -> None:
        """Take note of how much longer each request takes than on the wire.

        Parameters
        ----------
        seconds : float
            How much longer [s].
        """
        if self.separate:
            self._seconds += seconds

    def suspect(self, numbers: Iterable[int]) -> None:
        """Let the first of some servos come first, where telemetry is slow.

        Parameters
        ----------
        numbers : iterable of int
            The servos.
        """
        if self._separate is not None:
            self._urgent += itertools.islice(numbers, _SUSPECTS)

    def read(
        self, dt: float, *, left: float, beside: Collection[int] = ()
    ) -> Iterator[tuple[tuple[int, ...], Answers[Telemetry]]]:
        """Read as many servos as are needed in a tick and fit into what is left of it; yield them and what they tell.

        Parameters
        ----------
        dt : float
            Duration of the tick [s].
        left : float
            How much is left of it [s].
        beside : collection of int
            Whose position was read in this tick: where each value takes a request, the others come first.

        Raises
        ------
        BusError
            If the line fails.
        """
        start, chosen = self._clock.now(), self._chosen(dt, left, beside)
        if self._separate is None:
            yield chosen, self._bus.read_telemetry(chosen)
        else:
            yield chosen, self._separate.read_one(_EACH, chosen)
        # Adapters add to the time on the wire.
        self._seconds += _NEW * ((self._clock.now() - start) / len(chosen) - self._seconds)
        if self._separate is not None:
            self._since_shared += len(chosen)
            if self._since_shared > _SELDOM and (len(chosen) < self._most or self._since_shared > 2 * _SELDOM):
                self._since_shared = 0
                yield chosen[:1], self._separate.read_one(_SHARED, chosen[:1])

    def _chosen(self, dt: float, left: float, beside: Collection[int]) -> tuple[int, ...]:
        if self._together:
            return tuple(self._waiting)
        wanted = math.ceil(len(self._waiting) * min(dt / _TELEMETRY_TIME, 1.0))
        count = max(1, min(wanted, int(left / self._seconds)))
        # So each servo is asked for something in each tick, where the wire carries that.
        order = sorted(self._waiting, key=lambda number: number in beside) if self.separate else self._waiting
        chosen = tuple(dict.fromkeys((*self._urgent, *order[:count])))
        if self.separate:
            self._most = max(1, int((left + _SPARE * dt) / self._seconds))
            chosen = chosen[: self._most]
        self._urgent = []
        self._waiting = [number for number in self._waiting if number not in chosen] + list(chosen)
        return chosen
