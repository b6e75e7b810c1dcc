"""Inverse kinematics: joint angles for given feet, with a reach code for every leg."""

from __future__ import annotations

from typing import Literal

import numpy as np

from tarsus.arrays import Array, as_floats, namespace, require_finite, require_shape
from tarsus.errors import InputError
from tarsus.kinematics.batch_solver import solve_legs
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.solution import IKSolution
from tarsus.robot.robot import Robot

__all__ = ["inverse_kinematics"]


def inverse_kinematics(
    robot: Robot, feet: Array, body: Pose | None = None, *, knee: Literal["up", "down"] = "up"
) -> IKSolution:
    """Return the joint angles that put the feet where they should be, and which of them can't be there.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    feet : array, shape (..., legs, 3)
        Where the feet should be: in the ground frame G where `body` is given, else in the body frame B [m].
    body : Pose, optional
        The body's place in G. Left out, nothing is below ground.
    knee : {"up", "down"}
        Which of the two solutions: the tibia bent down or up from the femur, so that the knee is above or below
        the line from the femur axis to a foot in front of it. A leg whose limits allow only the other one takes that.

    Returns
    -------
    IKSolution
        Angles, reach codes, and what explains them. Where a foot can't be reached, the angles are those of the
        nearest point that the leg reaches within its limits, with that knee. A foot that the leg can't reach with
        its plane turned towards it, but can with the plane turned away (a foot behind the coxa axis), is reached so.

    Raises
    ------
    InputError
        If the feet have another shape, or are not finite; or if `knee` is neither of its two values.
    """
    if knee not in ("up", "down"):
        raise InputError(f"knee is {knee!r}; it can be 'up' or 'down'")
    xp = namespace(feet, robot.geometry.coxa, *(() if body is None else (body.rotation, body.position)))
    p = as_floats(xp, feet, name="feet")
    require_shape("feet", p, (robot.legs, 3))
    require_finite("feet", p)
    angles, reach = solve_legs(robot, p, body, knee=1 if knee == "up" else -1)
    return IKSolution(robot=robot, feet=_locked_copy(p), body=body, knee=knee, angles=angles, reach=reach)


def _locked_copy(feet: Array) -> Array:
    """Return a locked copy of what the caller may write to."""
    if isinstance(feet, np.ndarray):
        feet = feet.copy()
        feet.setflags(write=False)
    return feet
