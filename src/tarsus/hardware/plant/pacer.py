"""Keeps the ticks of a run in time with a clock, and measures how well."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tarsus.hardware.transport.clock import Clock
from tarsus.representation import represented

__all__ = ["Pacer", "Timing"]


# Share of the recent lateness that is kept from one tick to the next.
_FADING = 0.97


@represented()
class Timing(NamedTuple):
    """How well the ticks were kept.

    Attributes
    ----------
    ticks, missed : int
        Ticks, and those that could not begin in time and were left out.
    rate : float
        Ticks per second [1/s].
    median, worst : float
        How late a tick began [s].
    """

    ticks: int
    missed: int
    rate: float
    median: float
    worst: float


class Pacer:
    """Waits until a tick begins. A tick that is missed is left out: two never follow each other in haste.

    Parameters
    ----------
    clock : Clock
        The clock.
    recently_late : float
        Recent lateness to start with, for example that of an earlier pacer [s].
    """

    def __init__(self, clock: Clock, *, recently_late: float = 0.0) -> None:
        self._clock = clock
        self._next: float | None = None
        self._first = 0.0
        self._missed = 0
        self._late: list[float] = []
        self._recent = recently_late

    def wait(self, dt: float, *, excused: bool = False) -> float:
        """Wait for the beginning of the next tick, and return the time [s].

        Parameters
        ----------
        dt : float
            Duration of the tick that begins [s].
        excused : bool
            Whether lateness does not count in `recently_late`, because the last tick waited for answers.
        """
        now = self._clock.now()
        if self._next is None:
            self._next = self._first = now
        if now < self._next:
            self._clock.sleep(self._next - now)
            now = self._clock.now()
        late = now - self._next
        self._late.append(max(late, 0.0))
        self._recent = max(0.0 if excused else late, self._recent * _FADING)
        if late >= dt:
            self._missed += int(late / dt)
            self._next = now
        self._next += dt
        return now

    @property
    def recently_late(self) -> float:
        """How late recent ticks began: the worst lateness, which fades within a second or so [s]."""
        return self._recent

    @property
    def timing(self) -> Timing:
        """How well the ticks were kept until now."""
        late = np.array(self._late or [0.0])
        elapsed = self._clock.now() - self._first
        rate = len(self._late) / elapsed if elapsed > 0 else 0.0
        return Timing(len(self._late), self._missed, rate, float(np.median(late)), float(late.max()))
