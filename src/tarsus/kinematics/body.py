"""The frames: leg, body, ground; and how far the body can be moved with the feet still."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.arrays import Array, namespace, stack_last
from tarsus.errors import InputError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

__all__ = ["coxa_frames", "reachable_fraction"]

# The way is looked at in 32 steps, then the step where a foot first stays behind in 32 again, and so on.
_STEPS = 32
_ROUNDS = 8


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


def reachable_fraction(robot: Robot, feet: Array, start: Pose, goal: Pose) -> float:
    """Return how much of the way from one body pose to another all feet can stay where they stand.

    Position, roll, pitch and yaw change in proportion, each angle the shorter way round.

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
        0 where the start itself can't be reached, 1 where the whole way can.

    Raises
    ------
    InputError
        If robot or poses are batches, or the feet have another shape, or are not finite.
    """
    if robot.batch_shape or start.batch_shape or goal.batch_shape or np.ndim(feet) != 2:
        raise InputError("reachable_fraction takes a single robot, one foot a leg, and single poses")
    rpy, position = np.asarray(start.rpy), np.asarray(start.position)
    turn, move = np.asarray(goal.rpy) - rpy, np.asarray(goal.position) - position
    turn -= 2 * np.pi * np.round(turn / (2 * np.pi))

    def reached(shares: np.ndarray[Any, Any]) -> Array:
        roll, pitch, yaw = rpy[:, None] + turn[:, None] * shares
        body = Pose.from_rpy(roll, pitch, yaw, position + shares[:, None] * move)
        return np.asarray(inverse_kinematics(robot, feet, body).ok)

    low, high = 0.0, 1.0
    for _ in range(_ROUNDS):
        shares = np.linspace(low, high, _STEPS + 1)
        ok = reached(shares)
        if ok.all():
            return high
        first = int(np.argmin(ok))
        if not first:
            return low
        low, high = float(shares[first - 1]), float(shares[first])
    return low
