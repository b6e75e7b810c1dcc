"""Whether a leg keeps to one of the ways in which it can reach a foot: going over to another is a jump."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.arrays import Array
from tarsus.robot.robot import Robot

__all__ = ["branches"]


def branches(robot: Robot, angles: Array) -> np.ndarray[Any, Any]:
    """Return by which solution of the inverse kinematics each leg stands.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].

    Returns
    -------
    array of bool, shape (..., legs, 2)
        Whether the foot is behind the coxa axis (reached with the leg's plane turned away), and whether the knee is
        bent upwards.
    """
    femur, tibia = np.asarray(angles)[..., 1], np.asarray(angles)[..., 2]
    out = robot.coxa + robot.femur * np.cos(femur) + robot.tibia * np.cos(femur + tibia)
    return np.stack([out < 0, tibia > 0], axis=-1)
