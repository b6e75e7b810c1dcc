"""How the body stands over its feet while it walks, as one row of numbers, so that all of it moves smoothly together.

The row: x, y, z of the body's origin over the heading frame's [m]; roll, pitch, yaw [rad]; the lift of the swinging
feet [m]; then the amplitudes of the body's sway, x, y, z [m], roll, pitch, yaw [rad].
"""

from __future__ import annotations

import math
from typing import Any, TypeAlias

import numpy as np

from tarsus.gait.live.stand import LEVEL, Stand, Terrain, rise

__all__ = ["LIFT", "Rows", "calm_sway", "rotation_rows", "stand_of", "swayed"]

Floats = np.ndarray[Any, Any]
Rows: TypeAlias = tuple[tuple[float, ...], ...]

LIFT = 6
"""Where the lift stands in the row."""

# How fast a sway may change the speed of the feet past the body [m/s^2], and how far from it they are [m].
_SWAY_BEND, _ARM = 1.5, 0.3


def rotation_rows(roll: float, pitch: float, yaw: float) -> Rows:
    """Return the rows of ``Rz(yaw) Ry(pitch) Rx(roll)``."""
    a, b, c = math.cos(yaw), math.cos(pitch), math.cos(roll)
    d, e, f = math.sin(yaw), math.sin(pitch), math.sin(roll)
    return (
        (a * b, a * e * f - d * c, a * e * c + d * f),
        (d * b, d * e * f + a * c, d * e * c - a * f),
        (-e, b * f, b * c),
    )


def stand_of(row: Floats, rest: Floats, terrain: Terrain = LEVEL) -> Stand:
    """Return the body and the feet at rest.

    Parameters
    ----------
    row : array, shape (7,) or more
        The posture; a sway is not looked at.
    rest : complex array, shape (legs,)
        Rest footholds in the heading frame [m].
    terrain : Terrain
        How the ground lies.
    """
    x, y, z, roll, pitch, yaw, lift = row[: LIFT + 1].tolist()
    slope, position = terrain.slope, row[:3]
    if slope:
        position = np.array([x, y, z - rise(slope, x, y)])
    return Stand(rest, np.array(rotation_rows(roll, pitch, yaw)), position, lift, slope, terrain.depth * lift)


def swayed(row: Floats, cycles: float, beats: float) -> Floats:
    """Return the posture ``(7,)`` at a moment of the sway.

    With every beat, as often as feet are lifted, the body goes once forward and up and pitches; with every cycle, once
    sideways, rolls and yaws. At which moment of a step is left open.

    Parameters
    ----------
    row : array, shape (13,)
        The posture.
    cycles, beats : float
        How many of each have been walked.
    """
    amplitude = row[LIFT + 1 :]
    if not amplitude.any():
        return row[: LIFT + 1]
    once, often = math.sin(2 * math.pi * cycles), math.sin(2 * math.pi * beats)
    now: Floats = row[: LIFT + 1].copy()
    now[:LIFT] += amplitude * np.array([often, once, often, once, often, once])
    return now


def calm_sway(sway: Floats, frequency: float, beats: int) -> float:
    """Return how much of a sway is slow enough for the joints to follow beside walking.

    Parameters
    ----------
    sway : array, shape (6,)
        Amplitudes: x, y, z [m], roll, pitch, yaw [rad].
    frequency : float
        Cycles a second [1/s].
    beats : int
        How often in a cycle feet are lifted.
    """
    once = (2 * math.pi * frequency) ** 2
    rates = np.array([beats**2, 1, beats**2, 1, beats**2, 1]) * once
    arms = np.array([1.0, 1.0, 1.0, _ARM, _ARM, _ARM])
    bend = float((np.abs(sway) * rates * arms).sum())
    return min(1.0, _SWAY_BEND / max(bend, 1e-12))
