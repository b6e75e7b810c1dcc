"""Offset of body and joints from their commands: translation, rotation vector and joint angles in one vector.

Translation and rotation vector are those of the body in G: the achieved rotation is the commanded one, followed by that
of the rotation vector.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["moved", "rotated", "turned"]

# Flat indices into a rotation matrix: elements at the second less those at the first are twice a small rotation vector.
_LATER, _EARLIER = np.array([5, 6, 1]), np.array([7, 2, 3])


def moved(offset: Float[np.ndarray, "unknowns"], step: Float[np.ndarray, "unknowns"]) -> Float[np.ndarray, "unknowns"]:
    """Return the offset after a small step of body and joints, ``(6 + 3 legs,)``.

    Parameters
    ----------
    offset : array, shape (6 + 3 legs,)
        The offset before.
    step : array, shape (6 + 3 legs,)
        Translation and rotation of the body in G, changes of the joint angles [m, rad].
    """
    after: np.ndarray = offset + step
    (x, y, z), (a, b, c) = offset[3:6].tolist(), step[3:6].tolist()
    # Rotation vector of two successive rotations, to first order in the second.
    after[3:6] += ((b * z - c * y) / 2, (c * x - a * z) / 2, (a * y - b * x) / 2)
    return after


def rotated(rotation: Float[np.ndarray, "3 3"], turn: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """Return a rotation followed by that of a rotation vector, ``(3, 3)``.

    Parameters
    ----------
    rotation : array, shape (3, 3)
        The rotation.
    turn : array, shape (3,)
        Rotation vector in G [rad].
    """
    x, y, z = turn.tolist()
    angle = math.hypot(x, y, z) or 1.0
    a, half = math.sin(angle) / angle, math.sin(angle / 2) / angle
    b = 2.0 * half * half
    xy, yz, zx = b * x * y, b * y * z, b * z * x
    small = np.array(
        [
            [1.0 - b * (y * y + z * z), xy - a * z, zx + a * y],
            [xy + a * z, 1.0 - b * (z * z + x * x), yz - a * x],
            [zx - a * y, yz + a * x, 1.0 - b * (x * x + y * y)],
        ]
    )
    after: np.ndarray = small.dot(rotation)
    return after


def turned(rotation: Float[np.ndarray, "3 3"], before: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3"]:
    """Return the small rotation vector that leads from one rotation to another, ``(3,)`` [rad].

    Parameters
    ----------
    rotation, before : array, shape (3, 3)
        The rotations.
    """
    turn = rotation.dot(before.T)
    vector: np.ndarray = (turn.take(_EARLIER) - turn.take(_LATER)) / 2.0
    return vector
