"""Attitude of the body relative to a direction: that of gravity, or the normal of the ground."""

from __future__ import annotations

import math
from typing import NamedTuple

from tarsus.control.readings import Vector
from tarsus.control.sensing.ground_plane import GroundPlane

__all__ = ["CommandedAttitude", "rotate_roll_pitch", "rotate_z", "slope_along", "tilt_onto", "upward_direction"]

# Greatest horizontal component of a unit direction; a robot cannot stand on anything steeper.
_STEEPEST = 0.95


class CommandedAttitude(NamedTuple):
    """Commanded attitude and height of the body, before any correction.

    Attributes
    ----------
    roll, pitch : float
        Roll and pitch of B in G, of ``Rz(yaw) Ry(pitch) Rx(roll)`` [rad].
    yaw : float
        Yaw of B in G [rad].
    height : float
        Height of B's origin over the ground, along G's z [m].
    """

    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0
    height: float = 0.0


def tilt_onto(up: Vector, commanded: CommandedAttitude) -> tuple[float, float]:
    """Return the change of roll and pitch that gives B the commanded attitude relative to a direction.

    Parameters
    ----------
    up : (x, y, z)
        Unit vector of the direction, in axes with B's yaw and G's vertical.
    commanded : CommandedAttitude
        Commanded roll and pitch, relative to z.

    Returns
    -------
    roll, pitch : float
        Changes [rad].
    """
    if up[0] == 0.0 == up[1]:
        return 0.0, 0.0
    level = max(math.cos(commanded.pitch), 1.0 - _STEEPEST)
    sine = min(max(up[1] / level, -_STEEPEST), _STEEPEST)
    ahead = math.atan2(math.sin(commanded.pitch), level * math.sqrt(1.0 - sine * sine))
    return -math.asin(sine), math.atan2(up[0], up[2]) + ahead - commanded.pitch


def rotate_z(x: float, y: float, cos: float, sin: float) -> tuple[float, float]:
    """Return ``Rz(angle) (x, y)`` for the cosine and sine of an angle."""
    return x * cos - y * sin, x * sin + y * cos


def rotate_roll_pitch(v: Vector, roll: float, pitch: float) -> Vector:
    """Return ``Ry(pitch) Rx(roll) v``."""
    cos, sin = math.cos(roll), math.sin(roll)
    y, z = v[1] * cos - v[2] * sin, v[1] * sin + v[2] * cos
    cos, sin = math.cos(pitch), math.sin(pitch)
    return v[0] * cos + z * sin, y, z * cos - v[0] * sin


def upward_direction(x: float, y: float) -> Vector:
    """Return the upward unit vector with these horizontal components, limited to the steepest allowed."""
    horizontal = math.hypot(x, y)
    if horizontal > _STEEPEST:
        x, y = x * _STEEPEST / horizontal, y * _STEEPEST / horizontal
    return x, y, math.sqrt(1.0 - x * x - y * y)


def slope_along(plane: GroundPlane | None, cos: float, sin: float) -> tuple[float, float]:
    """Return the plane's slope along axes rotated by a yaw; 0 without a plane or with a slope that is not finite."""
    if plane is None or not math.isfinite(plane.slope_x + plane.slope_y):
        return 0.0, 0.0
    return rotate_z(plane.slope_x, plane.slope_y, cos, -sin)
