"""Initial state of a plan: how the robot rests with the measured joint angles."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, read_only
from tarsus.control.startup.builder import GROUND_TOLERANCE, SequenceBuilder, body_contacts
from tarsus.errors import InputError, TarsusError
from tarsus.gait.foot_plane import FootPlane, fitted_plane
from tarsus.kinematics.leg import checked_angles, forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.rotation import levelling_rotation
from tarsus.kinematics.underside import belly_depth
from tarsus.robot.joint_limits import JointLimits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["SERVO_SPEED_SHARE", "initial_state", "lying_state", "over_feet", "uneven_state"]

SERVO_SPEED_SHARE = 0.5
"""Default joint speed of motion sequences, as a share of the servo's no-load speed."""

# With a greater tilt, the robot has fallen over.
_MAX_TILT = math.radians(60)
# Tilt below which the body counts as level [rad].
_LEVEL_TOLERANCE = 1e-7
# Least thickness of a body as seen from the plane of the feet [m].
_THINNEST = 1e-3


def over_feet(robot: Robot) -> Robot:
    """Return the robot as seen from the plane of its feet: with points as feet, and a body that is thinner by as much.

    Foot balls of radius `r` on the ground have their centres `r` above it: while they stand, the ground is `r` nearer
    to the underside of the body than the plane of the feet is. Feet of different radii count with the least one. The
    thickness of a body without a box is not known, and stays.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    radius = float(np.min(robot.foot_radius))
    if radius == 0 or robot.body_size is None:
        return robot
    length, width, height = np.asarray(robot.body_size).tolist()
    return robot.replace(body_size=np.array([length, width, max(height - 2 * radius, _THINNEST)]))


def initial_state(robot: Robot, angles: Float[Array, "legs 3"], joint_limits: JointLimits) -> SequenceBuilder:
    """Return a builder with the robot at rest in its measured joint angles.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Measured joint angles, possibly slightly beyond their limits [rad].
    joint_limits : JointLimits
        Joint speeds and accelerations of the plan.

    Raises
    ------
    InputError
        If the angles have the wrong shape or are not finite.
    TarsusError
        If the robot has fallen over.
    """
    measured = _single_pose(robot, angles)
    rest = resting_pose(robot, measured)
    tilt = math.acos(min(max(float(rest.body.rotation[2, 2]), -1.0), 1.0))
    if not rest.stable or tilt > _MAX_TILT:
        raise TarsusError(
            f"with these joint angles {robot.name} {rest.describe()}, with its body tilted by "
            f"{math.degrees(tilt):.0f} deg; at most {math.degrees(_MAX_TILT):.0f} deg can be levelled: place the "
            "robot on its belly"
        )
    down = np.asarray(rest.leg_points_down)
    points = rest.body @ forward_kinematics(robot, measured)
    builder = SequenceBuilder(
        robot=robot,
        joint_limits=joint_limits,
        angles=measured,
        body=rest.body,
        contacts=down[:, 3].copy(),
        supports=np.concatenate([points[:, :3][down[:, :3]], body_contacts(robot, rest.body)]),
        initial_margin=float(rest.margin),
    )
    lies = tilt < _LEVEL_TOLERANCE and abs(builder.height - belly_depth(robot)) < GROUND_TOLERANCE
    return builder.lie_down() if lies else builder


def uneven_state(
    robot: Robot, angles: Float[Array, "legs 3"], joint_limits: JointLimits, loaded: Bool[np.ndarray, "legs"]
) -> SequenceBuilder:
    """Return a builder with the robot standing on feet that are known to bear load, on ground of any height.

    The plane of these feet is level, and the lowest of all feet on the ground.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    joint_limits, loaded : JointLimits, array of bool, shape (legs,)
        Joint speeds and accelerations of the plan; which feet bear load, at least three.

    Raises
    ------
    InputError
        If the angles have the wrong shape or are not finite.
    """
    measured = _single_pose(robot, angles)
    feet = forward_kinematics(robot, measured)[:, 3]
    x, y, z = feet[loaded].T
    plane = fitted_plane((x + 1j * y).tolist(), z.tolist(), FootPlane(), 1.0)
    up = np.array([-plane.slope_x, -plane.slope_y, 1.0])
    rotation = levelling_rotation(up / np.linalg.norm(up))
    body = Pose(rotation, np.array([0.0, 0.0, -float((feet @ rotation[2]).min())]))
    return SequenceBuilder(
        robot=robot, joint_limits=joint_limits, angles=measured, body=body, contacts=loaded, supports=np.zeros((0, 3))
    )


def lying_state(
    robot: Robot, angles: Float[Array, "legs 3"], joint_limits: JointLimits, *, purpose: str
) -> SequenceBuilder:
    """Return a builder with the robot at rest, lying on its belly.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Measured joint angles [rad].
    joint_limits, purpose : JointLimits, str
        Joint speeds and accelerations of the plan; what requires the robot to lie, for the error message.

    Raises
    ------
    InputError
        If the robot is a batch, or the angles have the wrong shape or are not finite.
    TarsusError
        If the robot does not lie on its belly.
    """
    builder = initial_state(robot, angles, joint_limits)
    if not builder.belly:
        excess = (builder.height - belly_depth(robot)) * 1000
        raise TarsusError(
            f"{robot.name} {resting_pose(robot, builder.angles).describe()}; its body is {excess:.1f} mm higher than "
            f"with its belly on the ground; {purpose} requires it to lie on its belly: use sit_down first"
        )
    return builder


def _single_pose(robot: Robot, angles: Float[Array, "legs 3"]) -> Float[np.ndarray, "legs 3"]:
    """Return the joint angles, refusing those of a batch."""
    _, measured = checked_angles(robot, angles)
    if robot.batch_shape or measured.ndim != 2:
        raise InputError("motion sequences are planned for a single robot in a single pose, not for a batch")
    return read_only(measured.copy())
