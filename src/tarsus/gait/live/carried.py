"""How far a robot's centre of mass goes along when its body is shifted over standing feet."""

from __future__ import annotations

import numpy as np

from tarsus.arrays import Array
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

__all__ = ["carried_share"]

_STEP = 1e-3  # [m]


def carried_share(robot: Robot, feet: Array) -> float:
    """Return the share of the body's shift over the ground that the centre of mass makes.

    The body's mass goes all the way, the links' less the nearer they are to their feet. By central differences over
    a millimetre; the mean of forward and sideways.

    Parameters
    ----------
    robot : Robot
        One robot; where its file gives no masses, the links count as massless and the share is 1.
    feet : array, shape (legs, 3)
        Where the feet stand, in B before the shift [m].

    Returns
    -------
    float
        Between the body's share of the whole mass and 1, in any stance that is not close to a leg's limits.

    Raises
    ------
    InputError
        If the shape is wrong, or a value is not finite.
    """
    steps = _STEP * np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
    shifted = Pose(position=steps)
    angles = inverse_kinematics(robot, np.asarray(feet, dtype=float) - steps[:, None, :]).angles
    centres = shifted @ centre_of_mass(robot, angles)
    return float((centres[0, 0] - centres[1, 0] + centres[2, 1] - centres[3, 1]) / (4 * _STEP))
