"""Feet that find no ground where it was expected: they look for it further down."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tarsus.gait.live.lag import Lag
from tarsus.gait.live.moment import Moment

__all__ = ["Search", "Searches"]

Floats = np.ndarray[Any, Any]

# How fast a foot goes down [m/s], how fast it stops once it has found ground [rad/s], and when it is at rest [m/s];
# and what the joints' acceleration must be for that [rad/s^2].
_SPEED, _STOPPING, _RESTING, _BRISK = 0.05, 40.0, 1e-3, 60.0


class Search(NamedTuple):
    """A foot on its way down.

    Attributes
    ----------
    height : Lag
        Where it is ``(1,)`` [m].
    lowest : float
        How low it goes at most [m].
    bandwidth, stopping : float
        How fast it goes there, and how fast it stops [rad/s].
    found : float or None
        Where it comes to rest, once there is ground [m].
    """

    height: Lag
    lowest: float
    bandwidth: float
    stopping: float
    found: float | None = None

    @classmethod
    def begin(cls, height: float, lowest: float, pace: float) -> Search:
        """Return the search of a foot that is at rest.

        Parameters
        ----------
        height : float
            Where it is [m].
        lowest : float
            How low it goes at most; no lower, if it is as low already [m].
        pace : float
            How fast it goes and stops, of what it does at its fastest.
        """
        lowest, stopping = min(lowest, height), pace * _STOPPING
        bandwidth = min(math.e * pace * _SPEED / max(height - lowest, 1e-6), stopping)
        return cls(Lag.still(np.array([height])), lowest, bandwidth, stopping)

    def step(self, dt: float, *, ground: bool) -> Search:
        """Return the search after a time.

        Parameters
        ----------
        dt : float
            The time [s].
        ground : bool
            Whether the foot touches ground.
        """
        found = self.found
        if ground and found is None:
            found = float(self.height.value[0] + 2 * self.height.rate[0] / self.stopping)
        target, bandwidth = (self.lowest, self.bandwidth) if found is None else (found, self.stopping)
        height = self.height.step(np.array([target]), dt, bandwidth=bandwidth)
        return self._replace(height=height, found=found)

    @property
    def at_rest(self) -> bool:
        """Whether the foot has found ground, and stands."""
        return self.found is not None and abs(float(self.height.rate[0])) < _RESTING

    @property
    def in_vain(self) -> bool:
        """Whether the foot is as low as it goes, without ground."""
        return self.found is None and float(self.height.value[0]) - self.lowest < 1e-3


class Searches:
    """All feet that look for ground, by their legs.

    Parameters
    ----------
    acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s^2]: where it is low, feet go more slowly.
    """

    def __init__(self, acceleration: Floats) -> None:
        self._feet: dict[int, Search] = {}
        # The foot's acceleration goes with the square of its pace.
        self._pace = min(1.0, math.sqrt(float(acceleration.min()) / _BRISK))

    def __bool__(self) -> bool:
        return bool(self._feet)

    @property
    def in_vain(self) -> list[int]:
        """The legs under which there is no ground."""
        return [leg for leg, search in self._feet.items() if search.in_vain]

    @property
    def all_in_vain(self) -> bool:
        """Whether there is no ground under any foot that looks for it."""
        return bool(self._feet) and all(search.in_vain for search in self._feet.values())

    def give_up(self) -> None:
        """Look for ground no more."""
        self._feet = {}

    def stands(self, leg: int, *, touches: bool) -> bool:
        """Return whether a foot at the end of its swing may stand where it is: on ground, if it had to look for it.

        Parameters
        ----------
        leg : int
            The leg.
        touches : bool
            Whether it touches ground.
        """
        return self._feet[leg].at_rest if leg in self._feet else touches

    def step(self, now: Moment, dt: float, *, touches: Callable[[int], bool], lowest: Callable[[int], float]) -> Moment:
        """Let feet that have come down where there is no ground look for it, in the world's time.

        Parameters
        ----------
        now : Moment
            The moment.
        dt : float
            The time [s].
        touches : callable
            Whether the foot of a leg touches ground.
        lowest : callable
            How low the foot of a leg may go [m].
        """
        over = ~now.down & (now.share >= 1.0)
        ground = now.ground.copy()
        for leg in np.flatnonzero(over).tolist():
            if leg not in self._feet:
                if touches(leg):
                    continue
                self._feet[leg] = Search.begin(float(ground[leg]), lowest(leg), self._pace)
            self._feet[leg] = self._feet[leg].step(dt, ground=touches(leg))
            ground[leg] = float(self._feet[leg].height.value[0])
        return now._replace(ground=ground, met=np.where(over, np.inf, now.met))

    def land(self, landed: Floats) -> None:
        """Note which feet have been put down.

        Parameters
        ----------
        landed : array of bool, shape (legs,)
            The feet.
        """
        self._feet = {leg: search for leg, search in self._feet.items() if not landed[leg]}
