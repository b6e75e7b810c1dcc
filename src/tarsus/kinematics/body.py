"""Coxa frames, and how far the body can move while the feet stay on their footholds."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, namespace, stack_last
from tarsus.errors import InputError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.solution import IKSolution
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["coxa_frames", "reachable_fraction"]

# Steps in which a motion is sampled; rounds, each of which subdivides the step in which a foot becomes unreachable.
_STEPS = 32
_ROUNDS = 8


def coxa_frames(robot: Robot) -> Pose:
    """Return the pose of every leg's coxa frame C in the body frame: ``T_body_coxa``.

    C has its origin on the coxa axis, x outward along the leg's mounting yaw, z up. ``coxa_frames(robot) @ points``
    transforms one point of each leg from its coxa frame to B, ``coxa_frames(robot).inverse() @ points`` back (sources
    000, 001 and 004 do so with the coordinates of the attachment points).

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.

    Returns
    -------
    Pose
        With batch axes ``(..., legs)`` [m].
    """
    require_robot(robot)
    g = robot.geometry
    xp = namespace(g.coxa)
    zero, one = xp.zeros_like(g.cos_yaw), xp.ones_like(g.cos_yaw)
    flat = stack_last(xp, (g.cos_yaw, -g.sin_yaw, zero, g.sin_yaw, g.cos_yaw, zero, zero, zero, one))
    rotation = xp.reshape(flat, (*flat.shape[:-1], 3, 3))
    return Pose(rotation, stack_last(xp, (g.mount_x, g.mount_y, g.mount_z)))


def reachable_fraction(
    robot: Robot,
    feet: Float[Array, "legs 3"],
    start: Pose,
    goal: Pose,
    *,
    also: Callable[[IKSolution], Bool[np.ndarray, "n"]] | None = None,
) -> float:
    """Return the fraction of a motion between two body poses during which all feet reach their footholds.

    Position, roll, pitch and yaw are interpolated linearly, each angle in the direction of the smaller change.

    Parameters
    ----------
    robot : Robot
        A single robot.
    feet : array, shape (legs, 3)
        Footholds in G [m].
    start, goal : Pose
        Poses of B in G; single poses.
    also : callable, optional
        A further condition: from the solutions at ``n`` poses, whether each is possible ``(n,)``.

    Returns
    -------
    float
        0 where the start is not possible, 1 where the whole motion is.

    Raises
    ------
    InputError
        If the robot or a pose is a batch, or the feet have the wrong shape or are not finite.
    """
    require_robot(robot)
    if robot.batch_shape or start.batch_shape or goal.batch_shape or np.ndim(feet) != 2:
        raise InputError("reachable_fraction takes a single robot, feet of shape (legs, 3) and single poses")
    rpy, position = np.asarray(start.rpy), np.asarray(start.position)
    turn, move = np.asarray(goal.rpy) - rpy, np.asarray(goal.position) - position
    turn -= 2 * np.pi * np.round(turn / (2 * np.pi))

    def reached(fractions: np.ndarray) -> Array:
        roll, pitch, yaw = rpy[:, None] + turn[:, None] * fractions
        body = Pose.from_rpy(roll, pitch, yaw, position + fractions[:, None] * move)
        solution = inverse_kinematics(robot, feet, body)
        return np.asarray(solution.ok if also is None else solution.ok & also(solution))

    low, high = 0.0, 1.0
    for _ in range(_ROUNDS):
        fractions = np.linspace(low, high, _STEPS + 1)
        ok = reached(fractions)
        if ok.all():
            return high
        first = int(np.argmin(ok))
        if not first:
            return low
        low, high = float(fractions[first - 1]), float(fractions[first])
    return low
