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

__all__ = ["PEAK_RATE", "Lag", "travel_factors"]

PEAK_RATE = 2 / math.e
"""Greatest rate over bandwidth and half the range of the targets."""


class Lag(NamedTuple):
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
    def still(cls, value: np.ndarray[Any, Any]) -> Lag:
        """Return a lag at rest at a value.

        Parameters
        ----------
        value : array
            The value.
        """
        return cls(value, np.zeros_like(value))

    def step(self, target: np.ndarray[Any, Any], dt: float, *, bandwidth: float) -> Lag:
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
        return Lag(target + moved * decay, (slope - bandwidth * moved) * decay)

    def go(self, target: np.ndarray[Any, Any], dt: float, *, bandwidth: float) -> tuple[Lag, list[float]]:
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
        return Lag(np.array(values), np.array(rates)), travels

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
        of_target, of_value, of_rate = travel_factors(time, bandwidth=bandwidth)
        total: np.ndarray[Any, Any] = target * of_target + self.value * of_value + self.rate * of_rate
        return total


def travel_factors(time: Any, *, bandwidth: float) -> tuple[Any, Any, Any]:
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
