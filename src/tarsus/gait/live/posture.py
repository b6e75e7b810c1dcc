"""How the body stands over its feet while it walks, as one row of numbers, so that all of it moves smoothly together.

The row: x, y, z of the body's origin over the heading frame's [m]; roll, pitch, yaw [rad]; the lift of the swinging
feet [m]; then the amplitudes of the body's sway, x, y, z [m], roll, pitch, yaw [rad].
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.gait.live.workspace import Stand

__all__ = ["LIFT", "rotation_of", "stand_of", "swayed"]

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
    row : array, shape (7,) or more
        The posture; a sway is not looked at.
    rest : complex array, shape (legs,)
        Rest footholds in the heading frame [m].
    """
    _, _, _, roll, pitch, yaw, lift = row[: LIFT + 1].tolist()
    return Stand(rest, rotation_of(roll, pitch, yaw), row[:3], lift)


def swayed(row: Floats, clock: float, beats: int) -> Floats:
    """Return the posture ``(7,)`` at a moment of the sway.

    With every beat, when other feet take over, the body goes once forward and up and pitches; with every cycle, once
    sideways, rolls and yaws.

    Parameters
    ----------
    row : array, shape (13,)
        The posture.
    clock : float
        Time in cycles.
    beats : int
        How often in a cycle feet are lifted.
    """
    amplitude = row[LIFT + 1 :]
    if not amplitude.any():
        return row[: LIFT + 1]
    once, often = math.sin(2 * math.pi * clock), math.sin(2 * math.pi * beats * clock)
    now: Floats = row[: LIFT + 1].copy()
    now[:LIFT] += amplitude * np.array([often, once, often, once, often, once])
    return now
