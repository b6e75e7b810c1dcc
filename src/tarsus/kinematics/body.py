"""The frames: leg, body, ground; and how far the body can be moved with the feet still."""

from __future__ import annotations

import numpy as np

from tarsus.arrays import Array, namespace, stack_last
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

__all__ = ["coxa_frames", "reachable_share"]

_HALVINGS = 40


def coxa_frames(robot: Robot) -> Pose:
    """Return the place of every leg's coxa frame C in the body frame: ``T_body_coxa``.

    C has its origin on the coxa axis, x outward along the leg's mounting yaw, z up. ``coxa_frames(robot) @ feet``
    carries one point of each leg's own frame into B, ``coxa_frames(robot).inverse() @ feet`` back (sources 000, 001
    and 004 each do this with the attachment points' coordinates).

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.

    Returns
    -------
    Pose
        With batch axes ``(..., legs)`` [m].
    """
    g = robot.geometry
    xp = namespace(g.coxa)
    zero, one = xp.zeros_like(g.cos_yaw), xp.ones_like(g.cos_yaw)
    flat = stack_last(xp, (g.cos_yaw, -g.sin_yaw, zero, g.sin_yaw, g.cos_yaw, zero, zero, zero, one))
    rotation = xp.reshape(flat, (*flat.shape[:-1], 3, 3))
    return Pose(rotation, stack_last(xp, (g.mount_x, g.mount_y, g.mount_z)))


def reachable_share(robot: Robot, feet: Array, start: Pose, goal: Pose) -> float:
    """Return how much of the way from one body pose to another all feet can stay where they stand.

    Position, roll, pitch and yaw change in proportion.

    Parameters
    ----------
    robot : Robot
        A single robot.
    feet : array, shape (legs, 3)
        Where the feet stand in G [m].
    start, goal : Pose
        The body's places in G; single poses.

    Returns
    -------
    float
        0 where the start itself can't be reached, 1 where the goal can.
    """
    if not bool(inverse_kinematics(robot, feet, start).ok):
        return 0.0
    ends = (np.asarray(start.rpy), np.asarray(goal.rpy), np.asarray(start.position), np.asarray(goal.position))

    def reached(shares: Array) -> Array:
        share = np.asarray(shares)[:, None]
        rpy, position = ends[0] + share * (ends[1] - ends[0]), ends[2] + share * (ends[3] - ends[2])
        return inverse_kinematics(robot, feet, Pose.from_rpy(rpy[:, 0], rpy[:, 1], rpy[:, 2], position)).ok

    low, high = 0.0, 1.0
    for _ in range(_HALVINGS // 5):
        shares = np.linspace(low, high, 33)
        ok = reached(shares)
        if ok.all():
            return float(high)
        first = int(np.argmin(ok))
        low, high = float(shares[first - 1]), float(shares[first])
    return low
