"""Inverse-kinematics branch of each leg: a leg that changes branch within a motion jumps."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["branches"]


def branches(robot: Robot, angles: Float[Array, "*#batch legs 3"]) -> Bool[np.ndarray, "*batch legs 2"]:
    """Return the branch of the inverse kinematics of each leg.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].

    Returns
    -------
    array of bool, shape (..., legs, 2)
        Whether the foot is behind the coxa axis (the leg's plane faces away from it), and whether the tibia is bent
        upwards.
    """
    femur, tibia = np.asarray(angles)[..., 1], np.asarray(angles)[..., 2]
    reach = robot.coxa + robot.femur * np.cos(femur) + robot.tibia * np.cos(femur + tibia)
    return np.stack([reach < 0, tibia > 0], axis=-1)
