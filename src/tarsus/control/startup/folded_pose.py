"""The folded pose: legs drawn in beside the body, so that its belly can rest on the ground."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from tarsus.arrays import Array
from tarsus.errors import InputError
from tarsus.kinematics.leg import forward_kinematics, point_parts
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

__all__ = ["belly_depth", "folded_pose", "legs_apart", "rest_points"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Spacing of the angles that are looked at, and how far from a limit they keep where the range lets them [rad].
_GRID = np.deg2rad(2.5)
_FROM_LIMIT = np.deg2rad(2.5)
# How far from body, ground and the next leg a folded leg keeps, besides its foot's radius [m].
_GAP = 0.005
# How many of the best folded poses are tried, at most, until legs are clear of each other.
_TRIES = 200


def rest_points(robot: Robot) -> Floats:
    """Return the points of the body that can rest on the ground, ``(n, 3)`` in B [m].

    The lower corners of its box, and the coxa axes; without a box, the coxa axes alone. As in `resting_pose`, but for
    the femur axes, which turn with their coxae.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    mounts = robot.mount_position
    if robot.body_size is None:
        return np.array(mounts)
    signs = np.array([[-1, -1, -1], [-1, 1, -1], [1, -1, -1], [1, 1, -1]])
    return np.concatenate([robot.body_size / 2 * signs, mounts])


def belly_depth(robot: Robot) -> float:
    """Return how far the body's underside is below B's origin [m], femur axes included.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    axes = robot.mount_position[:, 2] + np.minimum(robot.femur_axis_offset[:, 1], 0.0)
    lowest = np.append(rest_points(robot)[:, 2], axes)
    return -float(lowest.min())


def folded_pose(robot: Robot) -> Floats:
    """Return joint angles with which the legs are drawn in and the belly can rest on the ground.

    Coxae straight out (or as near to that as their limits allow). Of all femurs and tibiae with which knee and foot are
    above the plane of the belly, outside the body's box, and the legs clear of each other: those whose greatest
    distance from the coxa axis and greatest height over the ground have the least sum of squares. Where the limits
    keep a foot below the belly's plane, as little as they can.

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
    if robot.batch_shape:
        raise InputError(f"folded_pose takes a single robot, not a batch {robot.batch_shape} of designs")
    return _folded(robot)


@lru_cache(maxsize=16)
def _folded(robot: Robot) -> Floats:
    """Return the folded pose; kept, for whoever plans asks for it often."""
    choices = [_drawn_in(robot, leg) for leg in range(robot.legs)]
    enough = 2 * float(robot.foot_radius.max()) + _GAP
    best, clearest = np.zeros((robot.legs, 3)), -1.0
    for rank in range(min(_TRIES, *(len(leg) for leg in choices))):
        angles = np.array([leg[rank] for leg in choices])
        apart = legs_apart(robot, angles)
        if apart > clearest:
            best, clearest = angles, apart
        if apart >= enough:
            break
    best.setflags(write=False)
    return best


def legs_apart(robot: Robot, angles: Array) -> float:
    """Return the least distance between points of two legs' femurs and tibiae [m].

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    """
    points = forward_kinematics(robot, angles)
    share = np.linspace(0, 1, 9)[:, None, None, None]
    links = points[None, :, 1:3] + share * (points[None, :, 2:4] - points[None, :, 1:3])
    along = np.moveaxis(links, 1, 0).reshape(robot.legs, -1, 3)
    first, second = np.triu_indices(robot.legs, k=1)
    apart = along[first][:, :, None] - along[second][:, None]
    return float(np.sqrt((apart * apart).sum(-1).min()))


def _drawn_in(robot: Robot, leg: int) -> Floats:
    """Return the folded poses of a leg, ``(n, 3)``, the most drawn in first."""
    (low, _), *others = robot.limits[leg]
    coxa = np.clip(0.0, low, robot.limits[leg, 0, 1])
    axes = [_within(*limits) for limits in others]
    femur, tibia = (axis.ravel() for axis in np.meshgrid(*axes, indexing="ij"))
    angles = np.stack([np.full_like(femur, coxa), femur, tibia], axis=-1)
    g = LegGeometry(*(values[leg] for values in robot.geometry))
    points = np.stack(np.broadcast_arrays(*point_parts(np, g, *angles.T)), axis=-1).reshape(-1, 4, 3)
    lowest = points[:, 2:, 2].min(-1) + belly_depth(robot) - float(robot.foot_radius[leg]) - _GAP
    out = np.linalg.norm(points[:, 2:, :2] - robot.mount_position[leg, :2], axis=-1)
    ahead = g.femur * np.cos(femur) + g.tibia * np.cos(femur + tibia)
    clear = (ahead >= 0) & _outside(robot, points)
    if clear.any():
        angles, lowest, out, points = angles[clear], lowest[clear], out[clear], points[clear]
    deep = np.minimum(lowest, 0.0)
    above = deep >= deep.max() - 1e-9
    high = points[:, 2:, 2].max(-1) + belly_depth(robot)
    cost = out.max(-1) ** 2 + high**2
    order: Floats = angles[above][np.argsort(cost[above], kind="stable")]
    return order


def _within(low: float, high: float) -> Floats:
    """Return angles between the limits, not at them where the range is wide enough."""
    inset = min(_FROM_LIMIT, (high - low) / 4)
    return np.linspace(low + inset, high - inset, 2 + int((high - low) / _GRID))


def _outside(robot: Robot, points: Floats) -> Any:
    """Return for each ``(n, 4, 3)`` leg whether its tibia is outside the body's box."""
    if robot.body_size is None:
        return np.ones(len(points), dtype=bool)
    share = np.linspace(0, 1, 9)[:, None, None]
    tibia = points[None, :, 2] + share * (points[None, :, 3] - points[None, :, 2])
    return (np.abs(tibia) > robot.body_size / 2 + _GAP).any(-1).all(0)
