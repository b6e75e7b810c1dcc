"""The walker's own time: it runs slower wherever the joints could not keep up."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

__all__ = ["STOP_DURATION", "TimeScaling"]

Floats = np.ndarray[Any, Any]
_T = TypeVar("_T")

# How fast its rate may rise, how fast it falls on rough ways, and how fast to a stop [1/s].
_CHANGE, _CALMING, _STOP = 3.0, 5.0, 10.0
STOP_DURATION = 0.5 / _STOP
"""How far its own time goes until it has come to a stop [s]."""

# How often a tick is tried, at another rate each time, and what of the joints' speed and acceleration it may come to.
_TRIES, _KEPT = 5, 0.98
# From which share of the joints' acceleration on to look ahead, what share to aim at then, and how far to look [s].
_STRAINED, _CALM, _AHEAD = 0.5, 0.75, 0.02


class TimeScaling:
    """Goes on by as much of each tick as the joints' speed and acceleration allow.

    The feet's ways stay what they are; only how fast they are gone changes. So a foot that stands stays where it is,
    and the order of the steps too.

    Parameters
    ----------
    angles : array, shape (legs, 3)
        Joint angles to begin with, at rest [rad].
    speed, acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s], [rad/s^2].

    Attributes
    ----------
    angles : array, shape (legs, 3)
        The joint angles [rad].
    rate : float
        How fast its own time runs, at most 1.
    """

    def __init__(self, angles: Floats, speed: Floats, acceleration: Floats) -> None:
        self.angles = angles
        self.rate = 1.0
        self._speed, self._acceleration = speed, acceleration
        self._joint_rate = np.zeros_like(angles)
        self._last_dt = 0.01
        self._strain = 0.0

    def advance(
        self,
        move: Callable[[float], _T],
        solve: Callable[[_T], Floats],
        dt: float,
        *,
        stop: bool,
        fastest: float = 1.0,
    ) -> _T:
        """Return where the walk is after a tick.

        Parameters
        ----------
        move : callable
            From a time of its own [s] to where the walk is then.
        solve : callable
            From there to the joint angles ``(legs, 3)`` [rad].
        dt : float
            The tick [s].
        stop : bool
            Whether to come to a stop.
        fastest : float
            At which rate it is to run at most; it slows down to that as on rough ways.
        """
        rate = max(self.rate - _STOP * dt, 0.0) if stop else min(1.0, self.rate + _CHANGE * dt)
        if self._strain > _STRAINED:
            fastest = min(fastest, self._calm_rate(move, solve))
        rate = min(rate, max(fastest, self.rate - _CALMING * dt))
        between = (dt + self._last_dt) / 2
        after = move(dt * rate)
        angles = solve(after)
        turned, strain, works = self._taken(angles, dt, between)
        for _ in range(_TRIES):
            # Where it was to run slower, that may be too sudden.
            other = rate if works else self._other(turned, rate, between)
            if other == rate:
                break
            rate = other
            after = move(dt * rate)
            angles = solve(after)
            turned, strain, works = self._taken(angles, dt, between)
        self._strain = strain
        self.angles, self._joint_rate, self.rate, self._last_dt = angles, turned, rate, dt
        return after

    def _taken(self, angles: Floats, dt: float, between: float) -> tuple[Floats, float, bool]:
        """Return the joints' speed, what share of their acceleration they take, and whether both are kept."""
        turned = (angles - self.angles) / dt
        strain = float((np.abs(turned - self._joint_rate) / self._acceleration).max()) / between
        works = strain <= _KEPT and float((np.abs(turned) / self._speed).max()) <= _KEPT
        return turned, strain, works

    def _calm_rate(self, move: Callable[[float], _T], solve: Callable[[_T], Floats]) -> float:
        """Return at which rate the joints keep well within their acceleration on the next bit of the way."""
        first, second = solve(move(_AHEAD)), solve(move(2 * _AHEAD))
        bend = np.abs(second - 2 * first + self.angles) / (_AHEAD * _AHEAD)
        return math.sqrt(_CALM / max(float((bend / self._acceleration).max()), _CALM))

    def _other(self, turned: Floats, rate: float, dt: float) -> float:
        """Return at which rate the joints keep within speed and acceleration, or come nearest to that."""
        if rate == 0:  # too sudden a stop
            return self.rate / 2
        speed, reach = _KEPT * self._speed, _KEPT * self._acceleration * dt
        size = np.maximum(np.abs(turned), 1e-12)
        was = self._joint_rate * np.sign(turned)
        highest = float((np.minimum(speed, was + reach) / size).min())
        lowest = float(((was - reach) / size).max())
        if highest < lowest:
            return min(rate * 0.999 * (max(highest, 0.0) + lowest) / 2, max(rate, self.rate))
        return rate * 0.999 * max(highest, 0.0) if highest < 1 else min(rate * 1.001 * lowest, max(rate, self.rate))
