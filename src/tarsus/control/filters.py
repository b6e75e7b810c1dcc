"""The critically damped lag: what smooths every wish before the robot follows it.

``value'' = w^2 (target - value) - 2 w value'``, of bandwidth `w`. Its impulse response ``w^2 t exp(-w t)`` is
nowhere negative and has the integral 1: the value is at any time a weighted mean of the targets so far, so that it
stays in every convex set that these lie in, and never overshoots. Between targets on opposite ends of a range of
half-width `V` its rate stays within ``2 V w / e``, and the rate's rate within ``2 (1 + exp(-2)) V w^2``. The step is
the exact solution for a constant target, whatever its length.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

__all__ = ["PEAK_RATE", "CriticallyDamped", "RateLimitedFilter", "integral_factors"]

PEAK_RATE = 2 / math.e
"""Greatest rate over bandwidth and half the range of the targets."""


class CriticallyDamped(NamedTuple):
    """A value that follows a target, and its rate; arrays of one shape.

    Attributes
    ----------
    value : array
        Where it is.
    rate : array
        How fast it changes [1/s].
    """

    value: np.ndarray[Any, Any]
    rate: np.ndarray[Any, Any]

    @classmethod
    def still(cls, value: np.ndarray[Any, Any]) -> CriticallyDamped:
        """Return a lag at rest at a value.

        Parameters
        ----------
        value : array
            The value.
        """
        return cls(value, np.zeros_like(value))

    def step(self, target: np.ndarray[Any, Any], dt: float, *, bandwidth: float) -> CriticallyDamped:
        """Return the lag after a time with a constant target.

        Parameters
        ----------
        target : array
            What it follows.
        dt : float
            The time [s].
        bandwidth : float
            How fast it follows [rad/s].
        """
        decay = math.exp(-bandwidth * dt)
        gap = self.value - target
        slope = self.rate + bandwidth * gap
        moved = gap + slope * dt
        return CriticallyDamped(target + moved * decay, (slope - bandwidth * moved) * decay)

    def go(self, target: np.ndarray[Any, Any], dt: float, *, bandwidth: float) -> tuple[CriticallyDamped, list[float]]:
        """Return the lag after a time with a constant target, and its travel; for a few numbers, in plain ones.

        Parameters
        ----------
        target : array, shape (n,)
            What it follows.
        dt : float
            The time [s].
        bandwidth : float
            How fast it follows [rad/s].
        """
        w, decay = bandwidth, math.exp(-bandwidth * dt)
        values, rates, travels = [], [], []
        for goal, value, rate in zip(target.tolist(), self.value.tolist(), self.rate.tolist(), strict=True):
            gap = value - goal
            slope = rate + w * gap
            moved = gap + slope * dt
            values.append(goal + moved * decay)
            rates.append((slope - w * moved) * decay)
            # The differential equation, integrated.
            travels.append(goal * dt - (rates[-1] - rate + 2 * w * (values[-1] - value)) / (w * w))
        return CriticallyDamped(np.array(values), np.array(rates)), travels

    def travel(self, target: np.ndarray[Any, Any], time: float, *, bandwidth: float) -> np.ndarray[Any, Any]:
        """Return the value's integral over a time from now, with a constant target.

        Parameters
        ----------
        target : array
            What it follows.
        time : float
            The time [s].
        bandwidth : float
            How fast it follows [rad/s].
        """
        of_target, of_value, of_rate = integral_factors(time, bandwidth=bandwidth)
        total: np.ndarray[Any, Any] = target * of_target + self.value * of_value + self.rate * of_rate
        return total


def integral_factors(time: Any, *, bandwidth: float) -> tuple[Any, Any, Any]:
    """Return what target, value and rate each add to the value's integral over a time.

    Parameters
    ----------
    time : float or array
        The time [s].
    bandwidth : float
        How fast the lag follows [rad/s].

    Returns
    -------
    of_target, of_value, of_rate : float or array
        Factors [s, s, s^2].
    """
    turned = bandwidth * time
    decay = np.exp(-turned) if isinstance(turned, np.ndarray) else math.exp(-turned)
    of_rate = (1 - decay * (1 + turned)) / (bandwidth * bandwidth)
    of_value = (1 - decay) / bandwidth + bandwidth * of_rate
    return time - of_value, of_value, of_rate


# Below this the way to a goal of zero is over [the numbers' unit].
_NOTHING = 1e-12


class RateLimitedFilter:
    """A pair of numbers on its way to a goal: within a circle, never faster than a rate, with a continuous rate.

    A point runs to the goal in a straight line at most at the given rate; what is given out follows the point as a
    critically damped system of second order, exactly, since the point moves linearly within a tick. Its response
    is positive and of gain 1, so that it inherits the point's bounds: the same circle, the same rate.

    Parameters
    ----------
    radius : float
        Farthest from (0, 0).
    rate : float
        Greatest change per second.
    frequency : float
        Of the system of second order [rad/s]; the greatest change of the rate is ``2 / e * frequency * rate`` per
        second and number.

    Attributes
    ----------
    values : (float, float)
        Where it is.
    """

    def __init__(self, radius: float, *, rate: float, frequency: float) -> None:
        self.radius, self.rate, self.frequency = radius, rate, frequency
        self.values = (0.0, 0.0)
        self._speeds = (0.0, 0.0)
        self._point = (0.0, 0.0)

    def step(self, goal: tuple[float, float], dt: float) -> tuple[float, float]:
        """Return where it is after a tick.

        Parameters
        ----------
        goal : (float, float)
            Where to go; the nearest place within the circle counts. Not finite: (0, 0).
        dt : float
            Length of the tick [s]; nothing moves unless it is finite and positive.
        """
        if not 0.0 < dt < math.inf:
            return self.values
        start, end = self._point, self._run(goal, dt)
        self._point = end
        keep = math.exp(-self.frequency * dt)
        x, v = _follow(start[0], end[0], self.values[0], self._speeds[0], self.frequency, dt, keep)
        y, w = _follow(start[1], end[1], self.values[1], self._speeds[1], self.frequency, dt, keep)
        if end == (0.0, 0.0) and abs(x) + abs(y) < _NOTHING and abs(v) + abs(w) < _NOTHING:
            x = y = v = w = 0.0
        self.values, self._speeds = (x, y), (v, w)
        return self.values

    def _run(self, goal: tuple[float, float], dt: float) -> tuple[float, float]:
        """Return where the point gets in a tick."""
        x, y = goal
        far = math.hypot(x, y)
        if not far < math.inf:
            x = y = 0.0
        elif far > self.radius:
            x, y = x * self.radius / far, y * self.radius / far
        dx, dy = x - self._point[0], y - self._point[1]
        way, most = math.hypot(dx, dy), self.rate * dt
        if way <= most:
            return x, y
        return self._point[0] + dx * most / way, self._point[1] + dy * most / way


def _follow(
    start: float, end: float, value: float, speed: float, frequency: float, dt: float, keep: float
) -> tuple[float, float]:
    """Return value and speed of ``x'' = w^2 (p - x) - 2 w x'`` after a tick in which p goes from start to end."""
    rate = (end - start) / dt
    lag = 2.0 * rate / frequency
    # Against the steady motion behind a moving point, what is left fades as (away + turn t) e^-wt.
    away = value - start + lag
    turn = speed - rate + frequency * away
    return end - lag + (away + turn * dt) * keep, rate + (turn - frequency * (away + turn * dt)) * keep
