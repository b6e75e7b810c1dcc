"""Filters that smooth every command before the robot follows it: the critically damped filter, and a rate limit.

The critically damped filter is ``value'' = w^2 (target - value) - 2 w value'``, of bandwidth `w`. Its impulse response
``w^2 t exp(-w t)`` is never negative and has the integral 1: the value is a weighted mean of the targets so far. It
stays in every convex set that contains them, and never overshoots. Between targets on opposite ends of a range of
half-width `V` its rate stays within ``2 V w / e``, its second derivative within ``2 (1 + exp(-2)) V w^2``. A step is
the exact solution for a constant target, whatever its length.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["PEAK_RATE", "CriticallyDamped", "RateLimitedFilter", "integral_factors"]

PEAK_RATE = 2 / math.e
"""Greatest rate over bandwidth and half the range of the targets."""


class CriticallyDamped(NamedTuple):
    """A value that follows a target, and its rate; arrays of one shape.

    Attributes
    ----------
    value : array
        The value.
    rate : array
        Its derivative [1/s].
    """

    value: Float[np.ndarray, "n"]
    rate: Float[np.ndarray, "n"]

    @classmethod
    def still(cls, value: Float[np.ndarray, "n"]) -> CriticallyDamped:
        """Return a filter at rest at a value.

        Parameters
        ----------
        value : array
            The value.
        """
        return cls(value, np.zeros_like(value))

    def step(self, target: Float[np.ndarray, "n"], dt: float, *, bandwidth: float) -> CriticallyDamped:
        """Return the filter after a time with a constant target.

        Parameters
        ----------
        target : array
            The target.
        dt : float
            The time [s].
        bandwidth : float
            The bandwidth [rad/s].
        """
        decay = math.exp(-bandwidth * dt)
        gap = self.value - target
        slope = self.rate + bandwidth * gap
        moved = gap + slope * dt
        return CriticallyDamped(target + moved * decay, (slope - bandwidth * moved) * decay)

    def step_with_integral(
        self, target: Float[np.ndarray, "n"], dt: float, *, bandwidth: float
    ) -> tuple[CriticallyDamped, list[float]]:
        """Return the filter after a time with a constant target, and the value's integral; in floats, for few values.

        Parameters
        ----------
        target : array, shape (n,)
            The target.
        dt : float
            The time [s].
        bandwidth : float
            The bandwidth [rad/s].
        """
        w, decay = bandwidth, math.exp(-bandwidth * dt)
        values, rates, integrals = [], [], []
        for goal, value, rate in zip(target.tolist(), self.value.tolist(), self.rate.tolist(), strict=True):
            gap = value - goal
            slope = rate + w * gap
            moved = gap + slope * dt
            values.append(goal + moved * decay)
            rates.append((slope - w * moved) * decay)
            # The differential equation, integrated.
            integrals.append(goal * dt - (rates[-1] - rate + 2 * w * (values[-1] - value)) / (w * w))
        return CriticallyDamped(np.array(values), np.array(rates)), integrals

    def integral(self, target: Float[np.ndarray, "n"], time: float, *, bandwidth: float) -> Float[np.ndarray, "n"]:
        """Return the value's integral over a time, with a constant target.

        Parameters
        ----------
        target : array
            The target.
        time : float
            The time [s].
        bandwidth : float
            The bandwidth [rad/s].
        """
        of_target, of_value, of_rate = integral_factors(time, bandwidth=bandwidth)
        total: np.ndarray = target * of_target + self.value * of_value + self.rate * of_rate
        return total


def integral_factors(time: Any, *, bandwidth: float) -> tuple[Any, Any, Any]:
    """Return the factors of target, value and rate in the value's integral over a time.

    Parameters
    ----------
    time : float or array
        The time [s].
    bandwidth : float
        The bandwidth [rad/s].

    Returns
    -------
    of_target, of_value, of_rate : float or array
        Factors [s, s, s^2].
    """
    exponent = -bandwidth * time
    decay = np.exp(exponent) if isinstance(exponent, np.ndarray) else math.exp(exponent)
    decayed = 1 - decay
    settled = decayed + decay * exponent
    of_value = (decayed + settled) / bandwidth
    return time - of_value, of_value, settled / (bandwidth * bandwidth)


# Values and rates below this are 0 [unit of the values].
_NOTHING = 1e-12


class RateLimitedFilter:
    """A pair of values that approaches a target: within a circle, no faster than a rate, with a continuous rate.

    A point moves to the target in a straight line at most at the given rate; the values follow the point through a
    critically damped filter, exactly, since the point moves linearly within a tick. As the filter's response is
    positive with gain 1, the values have the point's bounds: the same circle, the same rate.

    Parameters
    ----------
    radius : float
        Greatest distance from (0, 0).
    rate : float
        Greatest change per second.
    frequency : float
        Bandwidth of the filter [rad/s]; the rate changes by at most ``2 / e * frequency * rate`` per second and value.

    Attributes
    ----------
    values : (float, float)
        The values.
    """

    def __init__(self, radius: float, *, rate: float, frequency: float) -> None:
        self.radius, self.rate, self.frequency = radius, rate, frequency
        self.values = (0.0, 0.0)
        self._speeds = (0.0, 0.0)
        self._point = (0.0, 0.0)

    def step(self, target: tuple[float, float], dt: float) -> tuple[float, float]:
        """Return the values after a tick.

        Parameters
        ----------
        target : (float, float)
            The target; the nearest point within the circle counts. Not finite: (0, 0).
        dt : float
            Length of the tick [s]; the values stay unless it is finite and positive.
        """
        if not 0.0 < dt < math.inf:
            return self.values
        start, end = self._point, self._moved(target, dt)
        self._point = end
        keep = math.exp(-self.frequency * dt)
        x, v = _follow(start[0], end[0], self.values[0], self._speeds[0], self.frequency, dt, keep)
        y, w = _follow(start[1], end[1], self.values[1], self._speeds[1], self.frequency, dt, keep)
        if end == (0.0, 0.0) and abs(x) + abs(y) < _NOTHING and abs(v) + abs(w) < _NOTHING:
            x = y = v = w = 0.0
        self.values, self._speeds = (x, y), (v, w)
        return self.values

    def _moved(self, target: tuple[float, float], dt: float) -> tuple[float, float]:
        """Return the point after a tick."""
        x, y = target
        far = math.hypot(x, y)
        if not far < math.inf:
            x = y = 0.0
        elif far > self.radius:
            x, y = x * self.radius / far, y * self.radius / far
        dx, dy = x - self._point[0], y - self._point[1]
        distance, most = math.hypot(dx, dy), self.rate * dt
        if distance <= most:
            return x, y
        return self._point[0] + dx * most / distance, self._point[1] + dy * most / distance


def _follow(
    start: float, end: float, value: float, speed: float, frequency: float, dt: float, keep: float
) -> tuple[float, float]:
    """Return value and speed of ``x'' = w^2 (p - x) - 2 w x'`` after a tick in which p goes from start to end."""
    rate = (end - start) / dt
    lag = 2.0 * rate / frequency
    # The deviation from the steady motion behind a moving point fades as (away + turn t) e^-wt.
    away = value - start + lag
    turn = speed - rate + frequency * away
    return end - lag + (away + turn * dt) * keep, rate + (turn - frequency * (away + turn * dt)) * keep
