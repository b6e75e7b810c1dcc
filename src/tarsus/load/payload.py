"""What the robot carries."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tarsus.errors import InputError

__all__ = ["Payload", "as_payload"]


@dataclass(frozen=True)
class Payload:
    """A mass carried on the body.

    Attributes
    ----------
    mass : float
        How much [kg].
    position : tuple of float
        Where its centre of mass is in the body frame B [m].
    """

    mass: float
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        try:
            mass = float(self.mass)
        except (TypeError, ValueError):
            mass = math.nan
        if not 0 <= mass < math.inf:
            raise InputError(f"a payload's mass is {self.mass!r} kg; it must be one finite number, not negative")
        try:
            position = np.asarray(self.position, dtype=np.float64)
        except (TypeError, ValueError):
            position = np.empty(0)
        if position.shape != (3,) or not np.isfinite(position).all():
            raise InputError(f"a payload's position is {self.position!r}; it must be three finite numbers [m]")
        object.__setattr__(self, "mass", mass)
        object.__setattr__(self, "position", tuple(position.tolist()))


def as_payload(payload: Payload | float) -> Payload:
    """Return a payload; a bare number is a mass [kg] at the body's origin.

    Parameters
    ----------
    payload : Payload or float
        What is carried.

    Raises
    ------
    InputError
        If the mass is negative, or not one finite number.
    """
    return payload if isinstance(payload, Payload) else Payload(payload)
