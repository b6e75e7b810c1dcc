"""Feet that find no ground where it was expected: they look for it further down."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from tarsus.gait.live.lag import Lag

__all__ = ["Search"]

Floats = np.ndarray[Any, Any]

# How fast a foot goes down [m/s], how fast it stops once it has found ground [rad/s], and when it is at rest [m/s].
_SPEED, _STOPPING, _RESTING = 0.05, 40.0, 1e-3


class Search(NamedTuple):
    """A foot on its way down.

    Attributes
    ----------
    height : Lag
        Where it is ``(1,)`` [m].
    lowest : float
        How low it goes at most [m].
    bandwidth : float
        How fast it goes there [rad/s].
    found : float or None
        Where it comes to rest, once there is ground [m].
    """

    height: Lag
    lowest: float
    bandwidth: float
    found: float | None = None

    @classmethod
    def begin(cls, height: float, depth: float) -> Search:
        """Return the search of a foot that is at rest.

        Parameters
        ----------
        height : float
            Where it is [m].
        depth : float
            How much farther down it goes at most [m].
        """
        return cls(Lag.still(np.array([height])), height - depth, min(math.e * _SPEED / max(depth, 1e-6), _STOPPING))

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
            found = float(self.height.value[0] + 2 * self.height.rate[0] / _STOPPING)
        target, bandwidth = (self.lowest, self.bandwidth) if found is None else (found, _STOPPING)
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
