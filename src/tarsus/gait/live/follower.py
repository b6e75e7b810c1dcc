"""Two numbers that follow a goal smoothly, whatever the goal does."""

from __future__ import annotations

import math

__all__ = ["Follower"]

# Below this the way to a goal of zero is over [the numbers' unit].
_NOTHING = 1e-12


class Follower:
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
