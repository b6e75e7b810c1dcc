"""Chooses the servos whose positions are read in a tick: all where the wire carries them, else urgent ones first."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable

from tarsus.hardware.bus.protocol import Bus

__all__ = ["PositionTurn"]

# Joints suspected to be stuck get at most this share of the turns, so that the others are not left out.
_SUSPECTS = 1 / 4
# Weight of a new measurement in the running mean of the duration.
_NEW = 0.2


class PositionTurn:
    """Chooses the servos of a bus whose positions are read next.

    Parameters
    ----------
    bus : Bus
        The bus.
    numbers : tuple of int
        Its servos.

    Attributes
    ----------
    failed : tuple of int
        Those whose last request failed.
    last : tuple of int
        Those that were chosen in the last tick.
    """

    def __init__(self, bus: Bus, numbers: tuple[int, ...]) -> None:
        self._whole = bus.timing(numbers).positions
        self._one_by_one = math.isclose(self._whole, len(numbers) * bus.timing(numbers[:1]).positions)
        # In the order in which they were last asked, the longest ago first.
        self._waiting = list(numbers)
        self._numbers = numbers
        self._suspects: tuple[int, ...] = ()
        self._timed = False
        self.failed: tuple[int, ...] = ()
        self.last: tuple[int, ...] = ()

    @property
    def seconds(self) -> float:
        """How long reading all positions takes [s]."""
        return self._whole

    def share(self, count: int) -> float:
        """Return how long reading some positions takes, of servos that are asked one by one [s].

        Parameters
        ----------
        count : int
            How many.
        """
        return self._whole * count / len(self._numbers)

    def took(self, servos: int, seconds: float) -> float:
        """Take note of how long reading took, and return how much longer each request took than known so far [s].

        Adapters add a delay to each request.

        Parameters
        ----------
        servos : int
            How many were read.
        seconds : float
            How long it took [s].
        """
        longer = seconds / servos - self._whole / len(self._numbers) if self._one_by_one else 0.0
        self._whole += (_NEW if self._timed else 1.0) * longer * len(self._numbers)
        self._timed = True
        return longer

    def next(self, share: float) -> tuple[tuple[int, ...], ...]:
        """Return the next servos: those that did not answer, then some suspected ones, then the others in turn.

        Those that did not answer are a group of their own, so that they are judged before the others are read.

        Parameters
        ----------
        share : float
            Share of all servos for which there is time in the tick.
        """
        if share >= 1.0:
            self.last = self._numbers
            return (self._numbers,)
        count, failed = max(1, int(len(self._numbers) * share)), self.failed
        urgent = (*failed, *self._suspects[: int(count * _SUSPECTS)])
        chosen = tuple(dict.fromkeys((*urgent, *self._waiting)))[: max(count, len(failed))]
        self.last = chosen
        self._waiting = [number for number in self._waiting if number not in chosen] + list(chosen)
        return tuple(group for group in (failed, chosen[len(failed) :]) if group)

    def suspect(self, numbers: Iterable[int]) -> None:
        """Set the servos that are to be read more often.

        Parameters
        ----------
        numbers : iterable of int
            The servos, the most suspected first.
        """
        self._suspects = tuple(numbers)

    def asked(self, numbers: Collection[int], answered: Collection[int]) -> None:
        """Take note of which servos were asked and which answered.

        Parameters
        ----------
        numbers, answered : collection of int
            The servos.
        """
        kept = tuple(number for number in self.failed if number not in numbers)
        self.failed = kept + tuple(number for number in numbers if number not in answered)
