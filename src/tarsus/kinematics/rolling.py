"""Rolling of the spherical feet on level ground while the tibiae tilt over them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["rolling_displacements", "tibia_rotations"]


def tibia_rotations(
    robot: Robot, angles: Float[np.ndarray, "*batch legs 3"], body: Pose
) -> Float[np.ndarray, "*batch legs 3 3"]:
    """Return the orientation of every tibia in the ground frame.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    body : Pose
        Poses of B in G, with batch axes ``(...)``.

    Returns
    -------
    array, shape (..., legs, 3, 3)
        Columns: along the tibia from the knee to the foot, the axis of femur and tibia, their cross product, in G.
    """
    g = robot.geometry
    yaw = np.arctan2(np.asarray(g.sin_yaw), np.asarray(g.cos_yaw)) + angles[..., 0]
    pitch = angles[..., 1] + angles[..., 2]
    c, s, cp, sp = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch)
    zero = np.zeros_like(yaw)
    columns = ((c * cp, s * cp, sp), (-s, c, zero), (-c * sp, -s * sp, cp))
    in_body = np.stack([np.stack(column, axis=-1) for column in columns], axis=-1)
    return np.asarray(np.asarray(body.rotation)[..., None, :, :] @ in_body)


def rolling_displacements(
    robot: Robot, angles: Float[np.ndarray, "n legs 3"], body: Pose
) -> Float[np.ndarray, "_ legs 3"]:
    """Return by how much each foot's centre moves from sample to sample where it rolls without slip.

    A ball of radius `r` that rolls on level ground moves by ``r theta x z`` when it turns by a small rotation vector
    `theta`: the point of the ball on the ground is at rest. Its spin about the vertical moves nothing.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (n, legs, 3)
        Joint angles at successive samples [rad].
    body : Pose
        Poses of B in G, with batch axes ``(n,)``.

    Returns
    -------
    array, shape (n - 1, legs, 3)
        Displacements in G [m]; z is 0.

    Notes
    -----
    The rotation vector is taken from the skew-symmetric part of the relative rotation: sin(theta) for theta, less than
    1e-4 off for changes of up to 1 deg from sample to sample.
    """
    rotation = tibia_rotations(robot, angles, body)
    change = rotation[1:] @ np.swapaxes(rotation[:-1], -1, -2)
    turn_x, turn_y = (change[..., 2, 1] - change[..., 1, 2]) / 2, (change[..., 0, 2] - change[..., 2, 0]) / 2
    radius = np.asarray(robot.foot_radius)
    return np.stack([radius * turn_y, -radius * turn_x, np.zeros_like(turn_x)], axis=-1)
