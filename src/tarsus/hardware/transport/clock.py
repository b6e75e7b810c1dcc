"""Clocks: the machine's, and one that only moves when it is told to."""

from __future__ import annotations

import time
from typing import Protocol

from tarsus.representation import represented

__all__ = ["Clock", "ManualClock", "SystemClock"]


class Clock(Protocol):
    """A clock that can be waited for."""

    def now(self) -> float:
        """Return the time [s]; only differences mean something."""

    def sleep(self, seconds: float) -> None:
        """Wait.

        Parameters
        ----------
        seconds : float
            How long [s].
        """


@represented("resolution")
class SystemClock:
    """The machine's own clock.

    Attributes
    ----------
    resolution : float
        Its shortest step [s].
    """

    resolution = time.get_clock_info("perf_counter").resolution

    def now(self) -> float:
        """Return the time [s]; only differences mean something."""
        return time.perf_counter()

    def sleep(self, seconds: float) -> None:
        """Wait.

        Parameters
        ----------
        seconds : float
            How long [s].
        """
        time.sleep(max(seconds, 0.0))


@represented("time")
class ManualClock:
    """A clock that stands still unless something waits: emulated servos then run as fast as the computer can.

    Parameters
    ----------
    start : float
        What it shows at first [s].

    Attributes
    ----------
    time : float
        What it shows [s].
    """

    def __init__(self, start: float = 0.0) -> None:
        self.time = start

    def now(self) -> float:
        """Return the time [s]; only differences mean something."""
        return self.time

    def sleep(self, seconds: float) -> None:
        """Move on at once.

        Parameters
        ----------
        seconds : float
            By how much [s].
        """
        self.time += max(seconds, 0.0)
