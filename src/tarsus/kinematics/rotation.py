"""Rotations about an axis, and those that make a direction vertical."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["axis_and_angle", "levelling_rotation", "rotation_about"]

# Sine of the angle of a rotation below which its axis is undefined, due to rounding.
_LEAST_SINE = 1e-12


def rotation_about(
    axis: Float[np.ndarray, "3"], angles: Float[np.ndarray, "*batch"]
) -> Float[np.ndarray, "*batch 3 3"]:
    """Return rotations about an axis, by Rodrigues' formula.

    Parameters
    ----------
    axis : array, shape (3,)
        A unit vector.
    angles : array, shape (...)
        Angles [rad].
    """
    x, y, z = axis.tolist()
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sine, versine = np.sin(angles)[..., None, None], 1 - np.cos(angles)[..., None, None]
    return np.asarray(np.eye(3) + sine * cross + versine * (cross @ cross))


def axis_and_angle(rotation: Float[np.ndarray, "3 3"]) -> tuple[Float[np.ndarray, "3"], float]:
    """Return the axis of a rotation by less than half a turn, and the angle about it [rad]; both 0 without a rotation.

    Parameters
    ----------
    rotation : array, shape (3, 3)
        A rotation matrix.
    """
    r = rotation
    axis = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / 2
    sine = float(np.linalg.norm(axis))
    if sine < _LEAST_SINE:
        return np.zeros(3), 0.0
    return axis / sine, float(np.arctan2(sine, (np.trace(r) - 1) / 2))


def levelling_rotation(up: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """Return the smallest rotation that turns a unit vector into z.

    Parameters
    ----------
    up : array, shape (3,)
        The vector.
    """
    x, y, z = up
    sideways = -x * y / (1 + z)
    return np.array([[z + y * y / (1 + z), sideways, -x], [sideways, z + x * x / (1 + z), -y], up])
