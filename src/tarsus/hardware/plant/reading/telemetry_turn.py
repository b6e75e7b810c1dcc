"""Chooses the servos whose telemetry is read in a tick: all in turn, but at once those with an alarm or suspected."""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterable, Iterator, Mapping

from tarsus.hardware.bus.answers import Answers, Telemetry
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.separate_telemetry import SeparateTelemetry
from tarsus.hardware.transport.clock import Clock

__all__ = ["TelemetryTurn"]

# The telemetry of every servo is read once within this time, where the wire carries it [s].
_TELEMETRY_TIME = 0.08
# Weight of a new measurement in the running mean of the duration.
_NEW = 0.2
# Where each value takes a request: the value read from each servo, the value that all servos share, and how many
# readings of the first come before one of the second.
_EACH, _SHARED, _SELDOM = "temperature", "voltage", 60
# How many suspected servos are asked out of turn, and the share of a tick that this may take beyond what is left of it.
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
        # Waiting servos are in the order in which they were last asked, the longest ago first.
        self._bus, self._clock, self._waiting = bus, clock, list(numbers)
        self._separate = bus if isinstance(bus, SeparateTelemetry) else None
        self.separate = self._separate is not None
        every, one = bus.timing(numbers).telemetry, bus.timing(numbers[:1]).telemetry
        # A board measures one value for all of its channels.
        self._together = len(numbers) > 1 and every == one
        parts = len(bus.capabilities.telemetry) if self._separate is not None else 1
        self._seconds = every / len(numbers) / parts
        self._alarms: dict[int, tuple[str, ...]] = {}
        self._urgent: list[int] = []
        self._since_shared, self._most = 0, 1

    def alarmed(self, alarms: Mapping[int, tuple[str, ...]]) -> None:
        """Take note of alarms that came with positions; only a servo whose alarms changed is asked out of turn.

        Parameters
        ----------
        alarms : mapping of int to tuple of str
            Names of the alarms, by id.
        """
        self._urgent += [number for number, names in alarms.items() if names != self._alarms.get(number)]
        self._alarms = dict(alarms)

    def slower(self, seconds: float) -> None:
        """Take note of how much longer each request takes than its time on the wire.

        Parameters
        ----------
        seconds : float
            How much longer [s].
        """
        if self.separate:
            self._seconds += seconds

    def suspect(self, numbers: Iterable[int]) -> None:
        """Ask the first few of some servos out of turn, where each value takes a request.

        Parameters
        ----------
        numbers : iterable of int
            The servos, the most suspected first.
        """
        if self._separate is not None:
            self._urgent += itertools.islice(numbers, _SUSPECTS)

    def read(
        self, dt: float, *, left: float, beside: Collection[int] = ()
    ) -> Iterator[tuple[tuple[int, ...], Answers[Telemetry]]]:
        """Read as many servos as are due in a tick and fit into the rest of it; yield them and their telemetry.

        Parameters
        ----------
        dt : float
            Duration of the tick [s].
        left : float
            How much is left of it [s].
        beside : collection of int
            Servos whose position is read in this tick: where each value takes a request, the others come first.

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
        # With the others first, each servo is asked for something in each tick, where the wire carries that.
        order = sorted(self._waiting, key=lambda number: number in beside) if self.separate else self._waiting
        chosen = tuple(dict.fromkeys((*self._urgent, *order[:count])))
        if self.separate:
            self._most = max(1, int((left + _SPARE * dt) / self._seconds))
            chosen = chosen[: self._most]
        self._urgent = []
        self._waiting = [number for number in self._waiting if number not in chosen] + list(chosen)
        return chosen
