"""Solid of the body to draw: its box, or a plate spanned by the coxa axes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.kinematics.polygon import support_polygon
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Solid", "body_outline", "body_solid"]


# Thickness of the plate of a body without a box, relative to its length.
_THICKNESS = 0.06


@dataclass(frozen=True, eq=False)
class Solid:
    """A convex prism.

    Attributes
    ----------
    corners : array, shape (2 n, 3)
        Corners in B [m]: the bottom counter-clockwise seen from above, then the top in the same order.
    faces : tuple of tuple of int
        Corner indices of each face, counter-clockwise seen from outside: bottom, top, sides.
    """

    corners: Float[np.ndarray, "_ 3"]
    faces: tuple[tuple[int, ...], ...]


def body_outline(robot: Robot) -> Float[np.ndarray, "n 3"]:
    """Return the outline of the body from above ``(n, 3)``, counter-clockwise, at the height of B's origin [m].

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    if robot.body_size is not None:
        x, y, _ = np.asarray(robot.body_size) / 2
        corners = np.array([[-x, -y], [x, -y], [x, y], [-x, y]])
    else:
        mounts = np.asarray(robot.mount_position)
        corners = np.asarray(support_polygon(mounts, np.ones(len(mounts), dtype=bool)))
    return np.column_stack([corners, np.zeros(len(corners))])


def body_solid(robot: Robot) -> Solid:
    """Return the solid of the body: the box of the robot file, or a thin plate with the coxa axes as corners.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    outline = body_outline(robot)
    n = len(outline)
    if robot.body_size is not None:
        middle, half = 0.0, float(np.asarray(robot.body_size)[2]) / 2
    else:
        middle = float(np.asarray(robot.mount_position)[:, 2].mean())
        half = _THICKNESS * float(np.ptp(outline[:, :2], axis=0).max()) / 2
    up = np.array([0.0, 0.0, 1.0])
    corners = np.concatenate([outline + (middle - half) * up, outline + (middle + half) * up])
    sides = tuple((i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n))
    return Solid(corners, (tuple(range(n - 1, -1, -1)), tuple(range(n, 2 * n)), *sides))
