"""Initial state of a plan: how the robot rests with the measured joint angles."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, read_only
from tarsus.control.startup.builder import GROUND_TOLERANCE, SequenceBuilder, body_contacts
from tarsus.errors import InputError, TarsusError
from tarsus.gait.foot_plane import FootPlane, fitted_plane
from tarsus.gait.walk_setup import require_number
from tarsus.kinematics.leg import checked_angles, forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.rotation import levelling_rotation
from tarsus.kinematics.stance import default_swing_height
from tarsus.kinematics.underside import belly_depth
from tarsus.robot.joint_limits import joint_limits
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["lying_state", "measured_state", "over_feet", "resting_state", "uneven_state"]

# Default joint speed of motion sequences, as a share of the servo's no-load speed.
_SERVO_SPEED_SHARE = 0.5
# Greatest tilt of the body; with a greater one, the robot counts as fallen over [rad].
_MAX_TILT = math.radians(60)
# Tilt below which the body counts as level [rad].
_LEVEL_TOLERANCE = 1e-7
# Least thickness of a body in `over_feet` [m].
_THINNEST = 1e-3


def over_feet(robot: Robot) -> Robot:
    """Return the robot with a thinner body, for plans in which the feet are points and their plane is the ground.

    The feet of a plan are the centres of the foot balls, which stand one radius `r` above the ground. To keep the true
    clearance of the body, its underside is raised by `r`: its box, centred on B's origin, becomes thinner by ``2 r``.
    Of different radii, the least one counts. A body without a box has no known thickness, and is not changed.

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


def measured_state(
    robot: Robot,
    angles: Float[Array, "legs 3"],
    joint_speed: Float[Array, "..."] | None = None,
    joint_acceleration: Float[Array, "..."] | None = None,
    *,
    swing_height: float | None = None,
    margin: float = 0.0,
) -> SequenceBuilder:
    """Return a builder for the robot of `over_feet`, of which only the joint angles are known yet.

    Its body is at the origin of G, and nothing bears load.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Measured joint angles, possibly slightly beyond their limits [rad].
    joint_speed, joint_acceleration : float or array, shape (3,) or (legs, 3), optional
        Greatest joint speed [rad/s] and acceleration [rad/s^2] of the plan; by default half the servo's no-load speed,
        reached within 0.05 s.
    swing_height, margin : float, float
        Swing height and least stability margin of the builder [m]; by default the robot's own swing height.

    Raises
    ------
    InputError
        If the robot is a batch, the angles have the wrong shape, or a number is not finite or out of range.
    """
    require_robot(robot)
    _, measured = checked_angles(robot, angles)
    if batch := robot.batch_shape or measured.shape[:-2]:
        raise InputError(f"motion sequences are planned for a single robot in a single pose, not for a batch {batch}")
    swing_height = float(default_swing_height(robot)) if swing_height is None else swing_height
    return SequenceBuilder(
        robot=over_feet(robot),
        joint_limits=joint_limits(robot, joint_speed, joint_acceleration, share=_SERVO_SPEED_SHARE),
        angles=read_only(measured.copy()),
        body=Pose(),
        contacts=np.zeros(robot.legs, dtype=bool),
        supports=np.zeros((0, 3)),
        swing_height=require_number("swing_height", swing_height, zero=True),
        margin=require_number("margin", margin, zero=True),
    )


def resting_state(state: SequenceBuilder) -> SequenceBuilder:
    """Return a builder with the robot at rest on flat ground with its measured joint angles.

    Parameters
    ----------
    state : SequenceBuilder
        From `measured_state`.

    Raises
    ------
    TarsusError
        If the robot has fallen over.
    """
    robot, rest = state.robot, resting_pose(state.robot, state.angles)
    tilt = math.acos(min(max(float(rest.body.rotation[2, 2]), -1.0), 1.0))
    if not rest.stable or tilt > _MAX_TILT:
        raise TarsusError(
            f"with these joint angles {robot.name} {rest.describe()}, with its body tilted by "
            f"{math.degrees(tilt):.0f} deg; at most {math.degrees(_MAX_TILT):.0f} deg can be levelled: place the "
            "robot on its belly"
        )
    down = np.asarray(rest.leg_points_down)
    points = rest.body @ forward_kinematics(robot, state.angles)
    supports = np.concatenate([points[:, :3][down[:, :3]], body_contacts(robot, rest.body)])
    contacts, margin = down[:, 3].copy(), float(rest.margin)
    state = replace(state, body=rest.body, contacts=contacts, supports=supports, initial_margin=margin)
    lies = tilt < _LEVEL_TOLERANCE and abs(state.height - belly_depth(robot)) < GROUND_TOLERANCE
    return state.lie_down() if lies else state


def uneven_state(state: SequenceBuilder, loaded: Bool[np.ndarray, "legs"]) -> SequenceBuilder:
    """Return a builder with the robot standing on feet that are known to bear load, on ground of any height.

    The plane fitted to these feet is taken to be level, and the lowest of all feet to be on the ground.

    Parameters
    ----------
    state : SequenceBuilder
        From `measured_state`.
    loaded : array of bool, shape (legs,)
        Which feet bear load, at least three.
    """
    feet = state.feet
    x, y, z = feet[loaded].T
    plane = fitted_plane((x + 1j * y).tolist(), z.tolist(), FootPlane(), 1.0)
    up = np.array([-plane.slope_x, -plane.slope_y, 1.0])
    rotation = levelling_rotation(up / np.linalg.norm(up))
    body = Pose(rotation, np.array([0.0, 0.0, -float((feet @ rotation[2]).min())]))
    return replace(state, body=body, contacts=loaded)


def lying_state(state: SequenceBuilder, *, purpose: str) -> SequenceBuilder:
    """Return a builder with the robot at rest, lying on its belly.

    Parameters
    ----------
    state, purpose : SequenceBuilder, str
        From `measured_state`; what requires the robot to lie, for the error message.

    Raises
    ------
    TarsusError
        If the robot does not lie on its belly.
    """
    state = resting_state(state)
    if not state.belly:
        excess = (state.height - belly_depth(state.robot)) * 1000
        raise TarsusError(
            f"{state.robot.name} {resting_pose(state.robot, state.angles).describe()}; its body is {excess:.1f} mm "
            f"higher than with its belly on the ground; {purpose} requires it to lie on its belly: use sit_down first"
        )
    return state
