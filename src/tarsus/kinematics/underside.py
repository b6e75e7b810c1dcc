"""The underside of the body, on which a robot lies, and its depth below the floor."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, as_array, namespace
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["FLOOR_TOLERANCE", "belly_depth", "floor_depth", "too_low_text", "underside_points"]

FLOOR_TOLERANCE = 1e-7
"""Depth up to which a body counts as above the floor, for rounding [m]."""


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


def floor_depth(robot: Robot, body: Pose) -> Float[Array, "*batch"]:
    """Return the depth of the body's lowest point below the floor under the feet ``(...)`` [m]; negative above it.

    The centres of the foot balls stand at a height of 0, so that the floor is one foot radius lower; of different
    radii, the least one counts, as in rising. Without a box, the coxa axes stand for the body.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    body : Pose
        Pose of B in G, single or in a batch.
    """
    xp = namespace(robot.body_size, robot.mount_position, robot.foot_radius, body.rotation, body.position)
    up, height = as_array(xp, body.rotation)[..., 2, :], as_array(xp, body.position)[..., 2]
    if robot.body_size is None:
        below = xp.max(-xp.sum(up[..., None, :] * as_array(xp, robot.mount_position), axis=-1), axis=-1)
    else:
        below = xp.sum(xp.abs(up) * as_array(xp, robot.body_size), axis=-1) / 2
    return below - height - xp.min(as_array(xp, robot.foot_radius), axis=-1)


def too_low_text(depth: float, height: float) -> str:
    """Return how far below the ground a body is, and which body height it needs.

    Parameters
    ----------
    depth, height : float
        Depth of its lowest point below the ground; its body height [m].
    """
    # Rounded up, as a body at the height named is to be above the ground.
    needed = math.ceil(round(1e4 * (height + depth), 3)) / 10
    return f"{depth * 1000:.1f} mm below the ground; a body height of at least {needed:.1f} mm is needed"
