"""A body over the ground and its feet at rest, and how much is left to its legs.

Points of the ground plane are complex numbers here, x + iy in the heading frame: turning is a product.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from tarsus.kinematics.triangle import Triangle, solve_triangle, to_leg_frame
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

__all__ = [
    "LEVEL_TERRAIN",
    "RAISED_FRACTION",
    "SWING_HEIGHT",
    "Rows",
    "StanceGeometry",
    "TerrainEstimate",
    "ground_rise",
    "joint_margin",
    "rotation_rows",
    "stance_geometry_of",
    "sway_fraction",
    "with_sway",
]

Floats = np.ndarray[Any, Any]

# How far inside every limit the walker keeps [rad], and how near to straight or folded it comes [rad].
_LIMIT_MARGIN = 0.01
_LEAST_BEND = 0.2


class TerrainEstimate(NamedTuple):
    """How the ground lies under a robot, as far as is known.

    Attributes
    ----------
    slope : complex
        How much it rises along x and y of the heading frame [m/m].
    depth : float
        How far below that feet may have to stand, in lifts.
    """

    slope: complex = 0j
    depth: float = 0.0


RAISED_FRACTION = 0.5
"""How much higher than it is expected the ground may be, over how much lower."""

LEVEL_TERRAIN = TerrainEstimate()
"""Ground that is flat, level and where it is expected."""


class StanceGeometry(NamedTuple):
    """A body over the ground and its feet at rest, seen from the heading frame; heights are those over the ground.

    Attributes
    ----------
    rest : complex array, shape (legs,)
        Rest footholds [m].
    rotation : array, shape (3, 3)
        Of the body in the heading frame.
    position : array, shape (3,)
        Of the body's origin [m].
    swing_height : float
        How high a swinging foot rises [m].
    slope : complex
        How much the ground rises along x and y [m/m].
    depth : float
        How far below the ground feet may have to stand [m].
    """

    rest: Floats
    rotation: Floats
    position: Floats
    swing_height: float
    slope: complex = 0j
    depth: float = 0.0

    def solve(self, robot: Robot, x: Floats, y: Floats, z: Floats) -> Triangle:
        """Return the joint angles for feet in the heading frame, each ``(..., legs)`` [m].

        Parameters
        ----------
        robot : Robot
            A single robot.
        x, y, z : array, shape (..., legs)
            The feet [m].
        """
        g, p = robot.geometry, self.position
        in_leg = to_leg_frame(g, *self.to_body(x - p[0], y - p[1], z - p[2]))
        return solve_triangle(np, g, *in_leg, knee=1, sideways=bool(g.side.any()))

    def to_body(self, x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats, Floats]:
        """Return x, y, z in B of vectors in the heading frame, each of any shape.

        Parameters
        ----------
        x, y, z : array, shape (...)
            The vectors; z is how much more they rise than the ground does [m].
        """
        r = self.rotation
        if self.slope:
            z = z + ground_rise(self.slope, x, y)
        in_x, in_y, in_z = (x * r[..., 0, i] + y * r[..., 1, i] + z * r[..., 2, i] for i in range(3))
        return in_x, in_y, in_z


def ground_rise(slope: complex, x: Any, y: Any) -> Any:
    """Return how much the ground rises on the way to places [m].

    Parameters
    ----------
    slope : complex
        How much it rises along x and y [m/m].
    x, y : float or array
        The places [m].
    """
    return slope.real * x + slope.imag * y


def joint_margin(geometry: LegGeometry, solution: Triangle) -> Floats:
    """Return how far the nearest bound is, negative past it ``(..., legs)``; [rad], of lengths over the reach.

    Parameters
    ----------
    geometry : LegGeometry
        The legs.
    solution : Triangle
        Their angles.
    """
    g, s = geometry, solution
    slack = np.minimum(s.coxa - g.coxa_lower, g.coxa_upper - s.coxa)
    slack = np.minimum(slack, np.minimum(s.femur - g.femur_lower, g.femur_upper - s.femur))
    slack = np.minimum(slack, np.minimum(s.tibia - g.tibia_lower, g.tibia_upper - s.tibia)) - _LIMIT_MARGIN
    bend = np.abs(s.tibia)
    slack = np.minimum(slack, np.minimum(bend, np.pi - bend) - _LEAST_BEND)
    across = np.minimum(np.minimum(s.far, s.near), s.beside) / g.farthest2
    return np.asarray(np.minimum(slack, across))


Rows: TypeAlias = tuple[tuple[float, ...], ...]

SWING_HEIGHT = 6
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


def stance_geometry_of(row: Floats, rest: Floats, terrain: TerrainEstimate = LEVEL_TERRAIN) -> StanceGeometry:
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
    x, y, z, roll, pitch, yaw, swing_height = row[: SWING_HEIGHT + 1].tolist()
    slope, position = terrain.slope, row[:3]
    if slope:
        position = np.array([x, y, z - ground_rise(slope, x, y)])
    return StanceGeometry(
        rest, np.array(rotation_rows(roll, pitch, yaw)), position, swing_height, slope, terrain.depth * swing_height
    )


def with_sway(row: Floats, cycles: float, beats: float) -> Floats:
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
    amplitude = row[SWING_HEIGHT + 1 :]
    if not amplitude.any():
        return row[: SWING_HEIGHT + 1]
    once, often = math.sin(2 * math.pi * cycles), math.sin(2 * math.pi * beats)
    now: Floats = row[: SWING_HEIGHT + 1].copy()
    now[:SWING_HEIGHT] += amplitude * np.array([often, once, often, once, often, once])
    return now


def sway_fraction(sway: Floats, frequency: float, beats: int) -> float:
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
