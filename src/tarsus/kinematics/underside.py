"""The underside of the body, on which a robot lies."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["belly_depth", "underside_points"]


def underside_points(robot: Robot) -> Float[np.ndarray, "n 3"]:
    """Return the points of the body that can rest on the ground.

    These are the lower corners of its box and the coxa axes; without a box, the coxa axes alone. The femur axes, which
    `resting_pose` also considers, are not included because they move with the coxae.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Returns
    -------
    array, shape (n, 3)
        Points in B [m].
    """
    mounts = robot.mount_position
    if robot.body_size is None:
        return np.array(mounts)
    signs = np.array([[-1, -1, -1], [-1, 1, -1], [1, -1, -1], [1, 1, -1]])
    return np.concatenate([robot.body_size / 2 * signs, mounts])


def belly_depth(robot: Robot) -> float:
    """Return the depth of the body's lowest point below the origin of B, femur axes included [m].

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    axes = robot.mount_position[:, 2] + np.minimum(robot.femur_axis_offset[:, 1], 0.0)
    lowest = np.append(underside_points(robot)[:, 2], axes)
    return -float(lowest.min())
