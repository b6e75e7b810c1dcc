"""What the robot carries."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tarsus.arrays import Array
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
        if not 0 <= self.mass < math.inf:
            raise InputError(f"a payload's mass is {self.mass} kg; it must be a finite number, not negative")
        position = tuple(float(v) for v in self.position)
        if len(position) != 3 or not np.isfinite(position).all():
            raise InputError(f"a payload's position is {self.position}; it must be three finite numbers")
        object.__setattr__(self, "position", position)


def as_payload(payload: Payload | Array) -> Payload:
    """Return a payload; a bare number is a mass [kg] at the body's origin.

    Parameters
    ----------
    payload : Payload or float
        What is carried.

    Raises
    ------
    InputError
        If the mass is negative or not finite.
    """
    return payload if isinstance(payload, Payload) else Payload(float(payload))
