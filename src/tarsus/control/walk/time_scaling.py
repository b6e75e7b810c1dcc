"""Time scaling: the walk advances more slowly wherever the joints could not follow it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["STOP_DURATION", "TimeScaling"]

_T = TypeVar("_T")

# How fast the rate may rise, how fast it falls ahead of high accelerations, and how fast to a stop [1/s].
_RISE, _FALL, _STOP = 3.0, 5.0, 10.0
STOP_DURATION = 0.5 / _STOP
"""Time of the walk that passes until it has stopped [s]."""

# Number of rates that are tried in a tick, and the fraction of the joints' speed and acceleration that is used.
_TRIES, _USED = 5, 0.98
# Fraction of the joints' acceleration from which on to look ahead, the one to aim at then, and how far to look [s].
_HIGH, _AIM, _AHEAD = 0.5, 0.75, 0.02


class TimeScaling:
    """Advances the walk by as much of each tick as the joints' speed and acceleration allow.

    The trajectories stay the same; only the rate at which they are followed changes. So a standing foot stays where it
    is, and the order of the steps is kept.

    Parameters
    ----------
    angles : array, shape (legs, 3)
        Joint angles at the start, at rest [rad].
    speed, acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s], [rad/s^2].

    Attributes
    ----------
    angles : array, shape (legs, 3)
        The joint angles [rad].
    rate : float
        Rate of the walk's time, 0 to 1.
    """

    def __init__(
        self,
        angles: Float[np.ndarray, "legs 3"],
        speed: Float[np.ndarray, "legs 3"],
        acceleration: Float[np.ndarray, "legs 3"],
    ) -> None:
        self.angles = angles
        self.rate = 1.0
        self._speed, self._acceleration = speed, acceleration
        self._speeds = np.zeros_like(angles)
        self._last_dt = 0.01
        self._used = 0.0

    def advance(
        self,
        integrate: Callable[[float], _T],
        solve: Callable[[_T], np.ndarray],
        dt: float,
        *,
        stop: bool,
        fastest: float = 1.0,
    ) -> _T:
        """Return the state of the walk after a tick.

        Parameters
        ----------
        integrate : callable
            Returns the state after a time of the walk [s].
        solve : callable
            Returns the joint angles of a state: array, shape (legs, 3) [rad].
        dt : float
            Length of the tick [s].
        stop : bool
            Whether the walk stops.
        fastest : float
            Greatest rate; the walk slows down to it gradually.
        """
        rate = max(self.rate - _STOP * dt, 0.0) if stop else min(1.0, self.rate + _RISE * dt)
        if self._used > _HIGH:
            fastest = min(fastest, self._relaxed_rate(integrate, solve))
        rate = min(rate, max(fastest, self.rate - _FALL * dt))
        between = (dt + self._last_dt) / 2
        after = integrate(dt * rate)
        angles = solve(after)
        speeds, used, works = self._demand(angles, dt, between)
        for _ in range(_TRIES):
            # Slowing down may be too sudden, too.
            other = rate if works else self._other_rate(speeds, rate, between)
            if other == rate:
                break
            rate = other
            after = integrate(dt * rate)
            angles = solve(after)
            speeds, used, works = self._demand(angles, dt, between)
        self._used = used
        self.angles, self._speeds, self.rate, self._last_dt = angles, speeds, rate, dt
        return after

    def _demand(
        self, angles: Float[np.ndarray, "legs 3"], dt: float, between: float
    ) -> tuple[Float[np.ndarray, "legs 3"], float, bool]:
        """Return the joints' speeds, the fraction of their acceleration that is used, and whether both are kept."""
        speeds = (angles - self.angles) / dt
        used = float((np.abs(speeds - self._speeds) / self._acceleration).max()) / between
        works = used <= _USED and float((np.abs(speeds) / self._speed).max()) <= _USED
        return speeds, used, works

    def _relaxed_rate(self, integrate: Callable[[float], _T], solve: Callable[[_T], np.ndarray]) -> float:
        """Return the rate at which the joints keep well within their acceleration for the next moments."""
        first, second = solve(integrate(_AHEAD)), solve(integrate(2 * _AHEAD))
        acceleration = np.abs(second - 2 * first + self.angles) / (_AHEAD * _AHEAD)
        return math.sqrt(_AIM / max(float((acceleration / self._acceleration).max()), _AIM))

    def _other_rate(self, speeds: Float[np.ndarray, "n 3"], rate: float, dt: float) -> float:
        """Return a rate at which the joints keep within speed and acceleration, or come closest to that."""
        if rate == 0:  # the stop is too sudden
            return self.rate / 2
        speed, reach = _USED * self._speed, _USED * self._acceleration * dt
        size = np.maximum(np.abs(speeds), 1e-12)
        was = self._speeds * np.sign(speeds)
        highest = float((np.minimum(speed, was + reach) / size).min())
        lowest = float(((was - reach) / size).max())
        if highest < lowest:
            return min(rate * 0.999 * (max(highest, 0.0) + lowest) / 2, max(rate, self.rate))
        return rate * 0.999 * max(highest, 0.0) if highest < 1 else min(rate * 1.001 * lowest, max(rate, self.rate))
