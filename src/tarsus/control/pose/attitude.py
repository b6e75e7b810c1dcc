"""How the body stands to a direction: gravity's, or the normal of the ground."""

from __future__ import annotations

import math
from typing import NamedTuple

from tarsus.control.readings import Vector
from tarsus.control.sensing.ground_plane import GroundPlane

__all__ = ["CommandedAttitude", "direction", "rotated", "slope_along", "tilt_onto", "turned"]

_STEEPEST = 0.95  # of a direction's part along the ground: what is steeper is no ground to stand on


class CommandedAttitude(NamedTuple):
    """Where the walker's wish has the body, before any correction.

    Attributes
    ----------
    roll, pitch : float
        Of B in G, of ``Rz(yaw) Ry(pitch) Rx(roll)`` [rad].
    yaw : float
        Of B in G [rad].
    height : float
        Of B's origin over the ground beneath it, along G's z [m].
    """

    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0
    height: float = 0.0


def tilt_onto(up: Vector, commanded: CommandedAttitude) -> tuple[float, float]:
    """Return what to add to roll and pitch so that B stands to a direction as it was commanded to stand to z.

    Parameters
    ----------
    up : (x, y, z)
        The direction, of length 1, in axes with B's yaw and G's vertical.
    commanded : Commanded
        Roll and pitch against z.

    Returns
    -------
    roll, pitch : float
        [rad].
    """
    if up[0] == 0.0 == up[1]:
        return 0.0, 0.0
    level = max(math.cos(commanded.pitch), 1.0 - _STEEPEST)
    sine = min(max(up[1] / level, -_STEEPEST), _STEEPEST)
    ahead = math.atan2(math.sin(commanded.pitch), level * math.sqrt(1.0 - sine * sine))
    return -math.asin(sine), math.atan2(up[0], up[2]) + ahead - commanded.pitch


def turned(x: float, y: float, cos: float, sin: float) -> tuple[float, float]:
    """Return ``Rz(angle) (x, y)`` for the cosine and sine of an angle."""
    return x * cos - y * sin, x * sin + y * cos


def rotated(v: Vector, roll: float, pitch: float) -> Vector:
    """Return ``Ry(pitch) Rx(roll) v``."""
    cos, sin = math.cos(roll), math.sin(roll)
    y, z = v[1] * cos - v[2] * sin, v[1] * sin + v[2] * cos
    cos, sin = math.cos(pitch), math.sin(pitch)
    return v[0] * cos + z * sin, y, z * cos - v[0] * sin


def direction(x: float, y: float) -> Vector:
    """Return the upward direction with these parts along the ground; the steepest allowed, where it is steeper."""
    flat = math.hypot(x, y)
    if flat > _STEEPEST:
        x, y = x * _STEEPEST / flat, y * _STEEPEST / flat
    return x, y, math.sqrt(1.0 - x * x - y * y)


def slope_along(plane: GroundPlane | None, cos: float, sin: float) -> tuple[float, float]:
    """Return the plane's slope along the axes turned by the yaw; none, where the plane is no plane."""
    if plane is None or not math.isfinite(plane.slope_x + plane.slope_y):
        return 0.0, 0.0
    return turned(plane.slope_x, plane.slope_y, cos, -sin)
