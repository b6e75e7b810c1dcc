"""How the body stands over its feet while it walks, as one row of numbers, so that all of it moves smoothly together.

The row: x, y, z of the body's origin over the heading frame's [m]; roll, pitch, yaw [rad]; the lift of the swinging
feet [m].
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.gait.live.workspace import Stand

__all__ = ["LIFT", "rotation_of", "stand_of"]

Floats = np.ndarray[Any, Any]

LIFT = 6
"""Where the lift stands in the row."""


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


def stand_of(row: Floats, rest: Floats) -> Stand:
    """Return the body and the feet at rest.

    Parameters
    ----------
    row : array, shape (7,)
        The posture.
    rest : complex array, shape (legs,)
        Rest footholds in the heading frame [m].
    """
    _, _, _, roll, pitch, yaw, lift = row.tolist()
    return Stand(rest, rotation_of(roll, pitch, yaw), row[:3], lift)
