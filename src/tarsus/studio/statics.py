"""Margin, forces and torques of a single pose, sixty times a second.

What `stability_margin` and `joint_torques` give, by a shorter way where there is one: those are made for batches of
thousands, and what they spend on one pose would be half of a slider's time.
"""

from __future__ import annotations

import math
from typing import Any, TypeAlias

import numpy as np

from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.polygon import support_polygon
from tarsus.kinematics.pose import Pose
from tarsus.load.contact import GRAVITY
from tarsus.load.torque import joint_torques
from tarsus.robot.robot import Robot

__all__ = ["margin_of", "torques_and_forces"]

Floats: TypeAlias = np.ndarray[Any, np.dtype[np.float64]]

# Shares above this are surely those of feet that push, feet this well spread surely not on a line.
_PUSHES = 1e-6
_SPREAD = 1e-6


def margin_of(feet: Floats, contacts: np.ndarray[Any, Any], com: Floats) -> float:
    """Return the static stability margin [m]: what `tarsus.stability_margin` gives.

    Parameters
    ----------
    feet : array, shape (legs, 3)
        The feet in G [m].
    contacts : array of bool, shape (legs,)
        Which of them stand.
    com : array, shape (3,)
        Centre of mass in G [m].
    """
    corners = (support_polygon(feet, contacts) - com[:2]).tolist()
    if not corners:
        return -math.inf
    if len(corners) < 3:
        return -_distance(corners[0], corners[-1])
    edges = list(zip(corners, corners[1:] + corners[:1], strict=True))
    depth = min(_beside(start, end) for start, end in edges)
    return depth if depth >= 0 else -min(_distance(start, end) for start, end in edges)


def _beside(start: list[float], end: list[float]) -> float:
    """Return how far to the left of a line the origin is."""
    (ax, ay), (bx, by) = start, end
    return (ax * by - ay * bx) / math.hypot(bx - ax, by - ay)


def _distance(start: list[float], end: list[float]) -> float:
    """Return how far from a line from one point to another the origin is."""
    (ax, ay), (bx, by) = start, end
    ux, uy = bx - ax, by - ay
    square = ux * ux + uy * uy
    share = min(max(-(ax * ux + ay * uy) / square, 0.0), 1.0) if square else 0.0
    return math.hypot(ax + share * ux, ay + share * uy)


def torques_and_forces(
    robot: Robot, angles: Floats, body: Pose, contacts: np.ndarray[Any, Any], *, feet: Floats, com: Floats
) -> tuple[Floats, Floats]:
    """Return what `tarsus.joint_torques` gives for a robot that stands.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    body : Pose
        Place of B in G.
    contacts : array of bool, shape (legs,)
        Which feet stand.
    feet : array, shape (legs, 3)
        The feet in G [m].
    com : array, shape (3,)
        Centre of mass in G [m].
    """
    shares = _plane_of_shares(feet[contacts, :2] - com[:2])
    if shares is None:
        torques, forces = joint_torques(robot, angles, body, contacts)
    else:
        forces = np.zeros((robot.legs, 3))
        forces[contacts, 2] = shares * float(total_mass(robot)) * -GRAVITY[2]
        torques, _ = joint_torques(robot, angles, body, contacts, forces=forces)
    return np.asarray(torques), np.asarray(forces)


def _plane_of_shares(feet: Floats) -> Floats | None:
    """Return the least squares of shares of a load over the origin, or None where a foot may not push.

    They are a plane over the feet, as in `tarsus.load.load_distribution`, whose way is for the rest: feet that would
    have to pull, and feet on a line.
    """
    middle = feet.mean(0)
    arms = feet - middle
    moments = arms.T @ arms
    if len(feet) < 3 or np.linalg.det(moments) < (_SPREAD * np.trace(moments)) ** 2:
        return None
    shares: Floats = 1 / len(feet) - arms @ np.linalg.solve(moments, middle)
    return shares if shares.min() > _PUSHES else None
