"""Payload on the body."""

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
        Mass [kg].
    position : tuple of float
        Centre of mass in the body frame B [m].
    """

    mass: float
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        try:
            mass = float(self.mass)
        except (TypeError, ValueError):
            mass = math.nan
        if not 0 <= mass < math.inf:
            raise InputError(f"payload mass is {self.mass!r} kg; it must be a finite number, at least 0")
        try:
            position = np.asarray(self.position, dtype=np.float64)
        except (TypeError, ValueError):
            position = np.empty(0)
        if position.shape != (3,) or not np.isfinite(position).all():
            raise InputError(f"payload position is {self.position!r}; it must be three finite numbers [m]")
        object.__setattr__(self, "mass", mass)
        object.__setattr__(self, "position", tuple(position.tolist()))


def as_payload(payload: Payload | float) -> Payload:
    """Convert a number, a mass [kg] at the body's origin, to a payload.

    Parameters
    ----------
    payload : Payload or float
        Payload, or its mass [kg].

    Raises
    ------
    InputError
        If the mass is negative or not a finite number.
    """
    return payload if isinstance(payload, Payload) else Payload(payload)
