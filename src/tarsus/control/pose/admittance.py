"""A foot that gives way: a virtual mass on a spring and a damper, moved by the force that is too much.

N. Hogan, "Impedance control: an approach to manipulation", parts I to III, Journal of Dynamic Systems, Measurement,
and Control 107 (1985): where a servo holds positions, the motion that a force asks for is commanded::

    mass a + damping v + stiffness x = force error

Linear, so that its motion under a constant force is known in closed form, for ticks of any length.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from tarsus.errors import InputError

__all__ = ["Admittance", "AdmittanceFilter", "StateTransition"]

_FASTEST = 1e6  # [rad/s]; far beyond any servo, far below what would overflow


class StateTransition(NamedTuple):
    """How offset and speed carry over a tick without force: rows of the matrix exponential.

    Attributes
    ----------
    xx, xv : float
        The offset after the tick by offset [1] and speed [s] before.
    vx, vv : float
        The speed after the tick by offset [1/s] and speed [1] before.
    """

    xx: float
    xv: float
    vx: float
    vv: float


@dataclass(frozen=True, kw_only=True)
class Admittance:
    """What a foot feels like.

    Attributes
    ----------
    mass : float
        Virtual mass [kg].
    damping : float
        Virtual damper [N s/m].
    stiffness : float
        Virtual spring [N/m].
    travel : float
        Greatest offset [m]: forces beyond what leads there are cut off.

    Raises
    ------
    InputError
        If a number is not finite and positive, or the mass is next to nothing.
    """

    mass: float
    damping: float
    stiffness: float
    travel: float = 0.02

    def __post_init__(self) -> None:
        for name in ("mass", "damping", "stiffness", "travel"):
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise InputError(f"admittance: {name} is {value}; it must be a positive number")
        for name, rate in (("stiffness", self.frequency), ("damping", self.decay)):
            if not rate < _FASTEST:
                raise InputError(
                    f"admittance: {name} is {getattr(self, name)} for a mass of {self.mass} kg, which makes "
                    f"{rate:.3g} rad/s of it; below {_FASTEST:g} is allowed: raise the mass"
                )

    @cached_property
    def frequency(self) -> float:
        """Angular frequency without damping [rad/s]."""
        return math.sqrt(self.stiffness / self.mass)

    @cached_property
    def decay(self) -> float:
        """Half of damping over mass [1/s]: below `frequency` the foot swings, at or above it it does not."""
        return self.damping / self.mass / 2

    @cached_property
    def max_force(self) -> float:
        """Greatest force error that is followed [N]: however it varies, the offset stays within `travel`.

        The integral of the impulse response's magnitude: ``1 / stiffness`` without swinging, with swinging
        ``coth(pi decay / (2 swing frequency)) / stiffness``.
        """
        square = self.frequency**2 - self.decay**2
        share = math.tanh(math.pi * self.decay / (2 * math.sqrt(square))) if square > 0 else 1.0
        return self.stiffness * self.travel * share

    def transition(self, dt: float) -> StateTransition:
        """Return how a tick without force carries the state over, exactly.

        Parameters
        ----------
        dt : float
            Length of the tick [s].
        """
        fade, swing = self.decay, self.frequency**2 - self.decay**2
        if swing > 0:
            rate = math.sqrt(swing)
            even = math.exp(-fade * dt) * math.cos(rate * dt)
            odd = math.exp(-fade * dt) * math.sin(rate * dt) / rate
        elif swing < 0:
            rate = math.sqrt(-swing)
            # The slow rate as a quotient: the difference of the two would cancel where the damper is strong.
            slow = math.exp(-(self.frequency**2) / (fade + rate) * dt)
            ratio = math.expm1(-2 * rate * dt)
            even, odd = slow * (1 + ratio / 2), slow * -ratio / (2 * rate)
        else:
            even = math.exp(-fade * dt)
            odd = even * dt
        return StateTransition(even + fade * odd, odd, -(self.frequency**2) * odd, even - fade * odd)


class AdmittanceFilter:
    """The offsets of some feet, tick by tick.

    Parameters
    ----------
    admittance : Admittance
        What each foot feels like.
    legs : int
        How many feet there are.

    Attributes
    ----------
    offsets : tuple of float
        How far each foot has given way: upwards, for forces upwards [m].
    speeds : tuple of float
        How fast it does [m/s].
    """

    def __init__(self, admittance: Admittance, legs: int) -> None:
        self.admittance = admittance
        self.offsets = self.speeds = (0.0,) * legs
        self._tick = (0.0, admittance.transition(0.0))

    def step(self, force_errors: Sequence[float | None], dt: float) -> tuple[float, ...]:
        """Return the offsets after a tick in which each foot is pushed by a constant force.

        Parameters
        ----------
        force_errors : sequence of (float or None), length legs
            What the ground pushes more than it should [N]; None or NaN where that is not known: the foot goes back.
        dt : float
            Length of the tick, finite, 0 or more [s].
        """
        if dt != self._tick[0]:
            self._tick = dt, self.admittance.transition(dt)
        (xx, xv, vx, vv), max_force = self._tick[1], self.admittance.max_force
        stiffness = self.admittance.stiffness
        offsets, speeds = [], []
        for x, v, force in zip(self.offsets, self.speeds, force_errors, strict=True):
            goal = 0.0
            if force is not None and not math.isnan(force):
                goal = (max_force if force > max_force else max(force, -max_force)) / stiffness
            away = x - goal
            offsets.append(goal + xx * away + xv * v)
            speeds.append(vx * away + vv * v)
        self.offsets, self.speeds = tuple(offsets), tuple(speeds)
        return self.offsets
