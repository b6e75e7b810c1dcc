"""How the body stands over its feet while it walks, as one row of numbers, so that all of it moves smoothly together.

The row: x, y, z of the body's origin over the heading frame's [m]; roll, pitch, yaw [rad]; the lift of the swinging
feet [m]; then the rest footholds' x, then their y [m].
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.gait.live.workspace import Stand

__all__ = ["LIFT", "posture_row", "rest_of", "rotation_of", "stand_of"]

Floats = np.ndarray[Any, Any]

LIFT = 6
"""Where the lift stands in the row."""


def posture_row(body: Floats, lift: float, rest: Floats) -> Floats:
    """Return the row.

    Parameters
    ----------
    body : array, shape (6,)
        x, y, z of the body's origin [m]; roll, pitch, yaw [rad].
    lift : float
        Lift of the swinging feet [m].
    rest : complex array, shape (legs,)
        Rest footholds [m].
    """
    return np.concatenate([body, [lift], rest.real, rest.imag])


def rest_of(row: Floats) -> Floats:
    """Return the rest footholds ``(legs,)``, complex [m]."""
    legs = (len(row) - LIFT - 1) // 2
    rest: Floats = row[LIFT + 1 : LIFT + 1 + legs] + 1j * row[LIFT + 1 + legs :]
    return rest


def rotation_of(roll: float, pitch: float, yaw: float) -> Floats:
    """Return ``Rz(yaw) Ry(pitch) Rx(roll)``."""
    a, b, c = math.cos(yaw), math.cos(pitch), math.cos(roll)
    d, e, f = math.sin(yaw), math.sin(pitch), math.sin(roll)
    return np.array(
        [
            [a * b, a * e * f - d * c, a * e * c + d * f],
            [d * b, d * e * f + a * c, d * e * c - a * f],
            [-e, b * f, b * c],
        ]
    )


def stand_of(row: Floats) -> Stand:
    """Return the body and the feet at rest.

    Parameters
    ----------
    row : array
        The posture.
    """
    _, _, _, roll, pitch, yaw, lift = row[: LIFT + 1].tolist()
    return Stand(rest_of(row), rotation_of(roll, pitch, yaw), row[:3], lift)
