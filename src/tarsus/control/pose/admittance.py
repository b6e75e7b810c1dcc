"""Admittance control of a foot: a virtual mass on a spring and a damper, driven by the force error.

N. Hogan, "Impedance control: an approach to manipulation", parts I to III, Journal of Dynamic Systems, Measurement,
and Control 107 (1985): position-controlled joints are commanded the motion of the virtual mass::

    mass a + damping v + stiffness x = force error

The equation is linear: its solution for a constant force is exact for ticks of any length.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Admittance", "AdmittanceFilter"]

# Bound on natural frequency and decay rate [rad/s]: far above any servo, far below overflow.
_FASTEST = 1e6


@dataclass(frozen=True, kw_only=True)
class Admittance:
    """Parameters of the virtual mass, spring and damper of a foot.

    Attributes
    ----------
    mass, damping, stiffness : float
        Virtual mass [kg], damping [N s/m] and stiffness [N/m].
    travel : float
        Greatest offset [m]; force errors are limited so that it is not exceeded.

    Raises
    ------
    InputError
        If a number is not finite and positive, or the mass is too small for the stiffness or damping.
    """

    mass: float
    damping: float
    stiffness: float
    travel: float = 0.02

    def __post_init__(self) -> None:
        for name in ("mass", "damping", "stiffness", "travel"):
            object.__setattr__(self, name, require_number(f"admittance: {name}", getattr(self, name), zero=False))
        for name, rate in (("stiffness", self.frequency), ("damping", self.decay)):
            if not rate < _FASTEST:
                raise InputError(
                    f"admittance: {name} is {getattr(self, name)} for a mass of {self.mass} kg: {rate:.3g} rad/s; "
                    f"it must be below {_FASTEST:g} rad/s: increase the mass"
                )

    @cached_property
    def frequency(self) -> float:
        """Undamped natural frequency [rad/s]."""
        return math.sqrt(self.stiffness / self.mass)

    @cached_property
    def decay(self) -> float:
        """Decay rate, damping / (2 mass) [1/s]; below `frequency` the motion is underdamped."""
        return self.damping / self.mass / 2

    @cached_property
    def max_force(self) -> float:
        """Bound on the force error [N] for which the offset stays within `travel`, however the force varies.

        That is `travel` over the integral of the magnitude of the impulse response: ``1 / stiffness``, or if
        underdamped ``coth(pi decay / (2 damped frequency)) / stiffness``.
        """
        square = self.frequency**2 - self.decay**2
        fraction = math.tanh(math.pi * self.decay / (2 * math.sqrt(square))) if square > 0 else 1.0
        return self.stiffness * self.travel * fraction

    def transition(self, dt: float) -> tuple[float, float, float, float]:
        """Return the exact state transition of offset and speed over a tick without force: the matrix exponential.

        Parameters
        ----------
        dt : float
            Length of the tick [s].

        Returns
        -------
        xx, xv : float
            Offset after the tick, per offset [1] and speed [s] before.
        vx, vv : float
            Speed after the tick, per offset [1/s] and speed [1] before.
        """
        decay, damped2 = self.decay, self.frequency**2 - self.decay**2
        if damped2 > 0:
            rate = math.sqrt(damped2)
            even = math.exp(-decay * dt) * math.cos(rate * dt)
            odd = math.exp(-decay * dt) * math.sin(rate * dt) / rate
        elif damped2 < 0:
            rate = math.sqrt(-damped2)
            # The slow rate as a quotient: the difference of both rates would cancel under strong damping.
            slow = math.exp(-(self.frequency**2) / (decay + rate) * dt)
            ratio = math.expm1(-2 * rate * dt)
            even, odd = slow * (1 + ratio / 2), slow * -ratio / (2 * rate)
        else:
            even = math.exp(-decay * dt)
            odd = even * dt
        return even + decay * odd, odd, -(self.frequency**2) * odd, even - decay * odd


class AdmittanceFilter:
    """Admittance offsets of the feet, tick by tick.

    Parameters
    ----------
    admittance, legs : Admittance, int
        Parameters, the same for all feet; number of feet.

    Attributes
    ----------
    offsets, speeds : array, shape (legs,)
        Upward offset of each foot [m], and its rate [m/s].
    """

    def __init__(self, admittance: Admittance, legs: int) -> None:
        self.admittance = admittance
        self.offsets = self.speeds = np.zeros(legs)

    def step(self, force_errors: Sequence[float | None], dt: float) -> Float[np.ndarray, "legs"]:
        """Return the offsets after a tick with constant force errors.

        Parameters
        ----------
        force_errors : sequence of (float or None), length legs
            Measured minus expected upward force [N]; None or NaN where unknown: the offset returns to 0.
        dt : float
            Length of the tick, finite and at least 0 [s].
        """
        (xx, xv, vx, vv), most = self.admittance.transition(dt), self.admittance.max_force
        forces = np.array(force_errors, dtype=float).reshape(self.offsets.shape)
        target = np.where(np.isnan(forces), 0.0, forces.clip(-most, most)) / self.admittance.stiffness
        distance, speeds = self.offsets - target, self.speeds
        self.offsets, self.speeds = target + xx * distance + xv * speeds, vx * distance + vv * speeds
        return self.offsets
