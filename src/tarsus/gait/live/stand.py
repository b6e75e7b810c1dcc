"""A body over the ground and its feet at rest, and how much is left to its legs.

Points of the ground plane are complex numbers here, x + iy in the heading frame: turning is a product.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tarsus.kinematics.triangle import Triangle, solve_triangle, to_leg_frame
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

__all__ = ["HIGHER", "LEVEL", "Stand", "Terrain", "joint_slack", "rise"]

Floats = np.ndarray[Any, Any]

# How far inside every limit the walker keeps [rad], and how near to straight or folded it comes [rad].
_LIMIT_MARGIN = 0.01
_LEAST_BEND = 0.2


class Terrain(NamedTuple):
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


HIGHER = 0.5
"""How much higher than it is expected the ground may be, over how much lower."""

LEVEL = Terrain()
"""Ground that is flat, level and where it is expected."""


class Stand(NamedTuple):
    """A body over the ground and its feet at rest, seen from the heading frame; heights are those over the ground.

    Attributes
    ----------
    rest : complex array, shape (legs,)
        Rest footholds [m].
    rotation : array, shape (3, 3)
        Of the body in the heading frame.
    position : array, shape (3,)
        Of the body's origin [m].
    lift : float
        How high a swinging foot rises [m].
    slope : complex
        How much the ground rises along x and y [m/m].
    depth : float
        How far below the ground feet may have to stand [m].
    """

    rest: Floats
    rotation: Floats
    position: Floats
    lift: float
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
        in_leg = to_leg_frame(g, *self.turned_into_body(x - p[0], y - p[1], z - p[2]))
        return solve_triangle(np, g, *in_leg, knee=1, sideways=bool(g.side.any()))

    def turned_into_body(self, x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats, Floats]:
        """Return x, y, z in B of vectors in the heading frame, each of any shape.

        Parameters
        ----------
        x, y, z : array, shape (...)
            The vectors; z is how much more they rise than the ground does [m].
        """
        r = self.rotation
        if self.slope:
            z = z + rise(self.slope, x, y)
        in_x, in_y, in_z = (x * r[..., 0, i] + y * r[..., 1, i] + z * r[..., 2, i] for i in range(3))
        return in_x, in_y, in_z


def rise(slope: complex, x: Any, y: Any) -> Any:
    """Return how much the ground rises on the way to places [m].

    Parameters
    ----------
    slope : complex
        How much it rises along x and y [m/m].
    x, y : float or array
        The places [m].
    """
    return slope.real * x + slope.imag * y


def joint_slack(geometry: LegGeometry, solution: Triangle) -> Floats:
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
