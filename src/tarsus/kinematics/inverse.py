"""Inverse kinematics: joint angles for given feet, with a reach code for every leg."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from tarsus.arrays import Array, as_floats, namespace, read_only, require_finite, require_shape
from tarsus.errors import InputError
from tarsus.kinematics.batch_solver import solve_legs
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.solution import IKSolution
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["inverse_kinematics"]


def inverse_kinematics(
    robot: Robot, feet: Float[Array, "*#batch legs 3"], body: Pose | None = None, *, knee: Literal["up", "down"] = "up"
) -> IKSolution:
    """Return the joint angles for given feet, and which feet are out of reach.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    feet : array, shape (..., legs, 3)
        Feet: in the ground frame G where `body` is given, else in the body frame B [m].
    body : Pose, optional
        Pose of B in G. Without it, no point counts as below the ground.
    knee : {"up", "down"}
        Knee branch: the tibia bent down or up relative to the femur, so that the knee is above or below the line from
        the femur axis to a foot in front of it. A leg whose limits allow only the other branch uses that one.

    Returns
    -------
    IKSolution
        Angles and reach codes, read-only where they are NumPy arrays, and their explanation. For a foot out of reach,
        the angles are those of the nearest point reachable within the joint limits in that knee branch. A foot that is
        reachable only with the leg's plane facing away from it (a foot behind the coxa axis) is reached that way.

    Raises
    ------
    InputError
        If the feet have the wrong shape or are not finite, or `knee` has another value.
    """
    require_robot(robot)
    if knee not in ("up", "down"):
        raise InputError(f"knee is {knee!r}; it can be 'up' or 'down'")
    xp = namespace(feet, robot.geometry.coxa, *(() if body is None else (body.rotation, body.position)))
    p = as_floats(xp, feet, name="feet")
    require_shape("feet", p, (robot.legs, 3))
    require_finite("feet", p)
    angles, reach = solve_legs(robot, p, body, knee=1 if knee == "up" else -1)
    if isinstance(p, np.ndarray):
        p = p.copy()  # The caller may write to the feet.
        for array in (p, angles, reach):
            read_only(array)
    return IKSolution(robot=robot, feet=p, body=body, knee=knee, angles=angles, reach=reach)
