"""The filter that smooths every command before the robot follows it.

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

__all__ = ["CriticallyDamped", "integral_factors"]

# Distance from the target and rate up to which a filter counts as settled at its target [m, rad, m/s, rad/s].
_SETTLED = 1e-7


class CriticallyDamped(NamedTuple):
    """A value that follows a target, and its rate: two arrays of the same shape.

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
        """Return a filter at rest at a value."""
        return cls(value, np.zeros_like(value))

    def step(self, target: Float[np.ndarray, "n"], dt: float, *, bandwidth: float) -> CriticallyDamped:
        """Return the filter after a time with a constant target.

        Parameters
        ----------
        target, dt, bandwidth : array, float, float
            The target; the time [s]; the bandwidth [rad/s].
        """
        decay = math.exp(-bandwidth * dt)
        gap, kept = self.value - target, decay * dt
        value = target + (decay + bandwidth * kept) * gap + kept * self.rate
        return CriticallyDamped(value, (decay - bandwidth * kept) * self.rate - bandwidth * bandwidth * kept * gap)

    def settling_step(self, target: Float[np.ndarray, "n"], dt: float, *, bandwidth: float) -> CriticallyDamped:
        """Return what `step` does; once settled at its target, the same object while that target object is given."""
        if self.value is target:
            return self
        after = self.step(target, dt, bandwidth=bandwidth)
        if max(map(abs, after.rate.tolist())) > _SETTLED:
            return after
        off = max(map(abs, (after.value - target).tolist()))
        return after if off > _SETTLED else CriticallyDamped.still(target)

    def step_with_integral(
        self, target: Float[np.ndarray, "n"], dt: float, *, bandwidth: float
    ) -> tuple[CriticallyDamped, list[float]]:
        """Return what `step` does, and the integral of each value over the time; in floats, fast for few values."""
        w, decay = bandwidth, math.exp(-bandwidth * dt)
        values, rates, integrals = [], [], []
        for goal, value, rate in zip(target.tolist(), self.value.tolist(), self.rate.tolist(), strict=True):
            gap = value - goal
            slope = rate + w * gap
            moved = gap + slope * dt
            values.append(goal + moved * decay)
            rates.append((slope - w * moved) * decay)
            # The differential equation, integrated over the time.
            integrals.append(goal * dt - (rates[-1] - rate + 2 * w * (values[-1] - value)) / (w * w))
        return CriticallyDamped(np.array(values), np.array(rates)), integrals


def integral_factors(time: Any, *, bandwidth: float) -> tuple[Any, Any, Any]:
    """Return the factors of target, initial value and initial rate in the integral of the value over a time.

    Parameters
    ----------
    time, bandwidth : float or array, float
        The time [s]; the bandwidth [rad/s].

    Returns
    -------
    of_target, of_value, of_rate : float or array
        Factors [s, s, s^2].
    """
    exponent = -bandwidth * time
    decay = np.exp(exponent)
    decayed = 1 - decay
    settled = decayed + decay * exponent
    of_value = (decayed + settled) / bandwidth
    return time - of_value, of_value, settled / (bandwidth * bandwidth)
