"""The folded pose: legs retracted beside the body, so that the belly can rest on the ground."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.arrays import Array
from tarsus.errors import InputError
from tarsus.kinematics.leg import forward_kinematics, point_parts
from tarsus.kinematics.underside import belly_depth
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["folded_pose", "leg_clearance"]


# Spacing of the joint angles that are evaluated, and their distance from the limits where the range permits it [rad].
_GRID = np.deg2rad(2.5)
_LIMIT_INSET = np.deg2rad(2.5)
# Clearance of a folded leg from the body, the ground and the next leg, besides its foot radius [m].
_CLEARANCE = 0.005
# Number of the best poses to try until the legs are clear of each other.
_TRIES = 200
# Number of points on a link at which clearances are evaluated.
_LINK_POINTS = 9


def folded_pose(robot: Robot) -> Float[np.ndarray, "legs 3"]:
    """Return joint angles with which the legs are retracted and the belly can rest on the ground.

    The coxae are straight out, as far as their limits allow. Among the femur and tibia angles that keep knee and foot
    above the plane of the belly, the tibia outside the body's box and the legs clear of each other, those are chosen
    that minimise the sum of squares of the greatest distance from the coxa axis and the greatest height over the
    ground. If the limits keep a foot below the plane of the belly, its depth is minimised first.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Returns
    -------
    array, shape (legs, 3)
        Joint angles within the limits, read-only [rad].

    Raises
    ------
    InputError
        If the robot is a batch of designs.
    """
    require_robot(robot)
    if robot.batch_shape:
        raise InputError(f"folded_pose takes a single robot, not a batch {robot.batch_shape} of designs")
    return _folded_pose(robot)


@lru_cache(maxsize=16)
def _folded_pose(robot: Robot) -> Float[np.ndarray, "..."]:
    choices = [_leg_choices(robot, leg) for leg in range(robot.legs)]
    enough = 2 * float(robot.foot_radius.max()) + _CLEARANCE
    best, best_clearance = np.zeros((robot.legs, 3)), -1.0
    for rank in range(min(_TRIES, *(len(leg) for leg in choices))):
        angles = np.array([leg[rank] for leg in choices])
        clearance = leg_clearance(robot, angles)
        if clearance > best_clearance:
            best, best_clearance = angles, clearance
        if clearance >= enough:
            break
    best.setflags(write=False)
    return best


def leg_clearance(robot: Robot, angles: Float[Array, "legs 3"]) -> float:
    """Return the least distance between femurs and tibiae of different legs [m].

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    """
    points = forward_kinematics(robot, angles)
    fractions = np.linspace(0, 1, _LINK_POINTS)[:, None, None, None]
    links = points[None, :, 1:3] + fractions * (points[None, :, 2:4] - points[None, :, 1:3])
    samples = np.moveaxis(links, 1, 0).reshape(robot.legs, -1, 3)
    first, second = np.triu_indices(robot.legs, k=1)
    offsets = samples[first][:, :, None] - samples[second][:, None]
    return float(np.sqrt((offsets * offsets).sum(-1).min()))


def _leg_choices(robot: Robot, leg: int) -> Float[np.ndarray, "n 3"]:
    """Return the folded joint angles of a leg, shape (n, 3) [rad], the most retracted first."""
    (low, high), *limits = robot.limits[leg]
    coxa = np.clip(0.0, low, high)
    femur, tibia = (axis.ravel() for axis in np.meshgrid(*(_angle_grid(*pair) for pair in limits), indexing="ij"))
    angles = np.stack([np.full_like(femur, coxa), femur, tibia], axis=-1)
    g = LegGeometry(*(values[leg] for values in robot.geometry))
    points = np.stack(np.broadcast_arrays(*point_parts(np, g, *angles.T)), axis=-1).reshape(-1, 4, 3)
    lowest = points[:, 2:, 2].min(-1) + belly_depth(robot) - float(robot.foot_radius[leg]) - _CLEARANCE
    distance = np.linalg.norm(points[:, 2:, :2] - robot.mount_position[leg, :2], axis=-1)
    reach = g.femur * np.cos(femur) + g.tibia * np.cos(femur + tibia)
    clear = (reach >= 0) & _outside_body(robot, points)
    if clear.any():
        angles, lowest, distance, points = angles[clear], lowest[clear], distance[clear], points[clear]
    depth = np.minimum(lowest, 0.0)
    above = depth >= depth.max() - 1e-9
    highest = points[:, 2:, 2].max(-1) + belly_depth(robot)
    cost = distance.max(-1) ** 2 + highest**2
    choices: np.ndarray = angles[above][np.argsort(cost[above], kind="stable")]
    return choices


def _angle_grid(low: float, high: float) -> Float[np.ndarray, "n"]:
    """Return joint angles between the limits, inset where the range permits it."""
    inset = min(_LIMIT_INSET, (high - low) / 4)
    return np.linspace(low + inset, high - inset, 2 + int((high - low) / _GRID))


def _outside_body(robot: Robot, points: Float[np.ndarray, "*#batch legs 4 3"]) -> Any:
    """Return for each set of leg points ``(n, 4, 3)`` whether the tibia is outside the body's box."""
    if robot.body_size is None:
        return np.ones(len(points), dtype=bool)
    fractions = np.linspace(0, 1, _LINK_POINTS)[:, None, None]
    tibia = points[None, :, 2] + fractions * (points[None, :, 3] - points[None, :, 2])
    return (np.abs(tibia) > robot.body_size / 2 + _CLEARANCE).any(-1).all(0)
