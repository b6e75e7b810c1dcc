"""Poses of the views Joints and Body, and changes of the state when a foot is dragged."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.mass import MassWeights
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_body_height, default_stance
from tarsus.robot.robot import Robot
from tarsus.studio.messages.state import BodyState, JointsState
from tarsus.studio.robots import stance_of
from tarsus.studio.standing import OnFootholds, Resting

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["drag_foothold", "drag_joints", "require_leg", "resting", "standing"]


def resting(robot: Robot, joints: JointsState, *, masses: MassWeights | None = None) -> Resting:
    """Return the resting pose for the angles of the view Joints.

    Parameters
    ----------
    robot : Robot
        A single robot.
    joints : JointsState
        The angles; left out, those of the default stance, or zero where the robot has none.
    masses : MassWeights, optional
        Its masses, where they are known already.

    Raises
    ------
    InputError
        If there are not three angles per leg.
    """
    if joints.angles_deg is None:
        stance = stance_of(robot)
        angles = np.zeros((robot.legs, 3)) if stance is None else stance[1]
    else:
        angles = np.radians(_of_legs("angles_deg", joints.angles_deg, robot))
    return Resting.of(robot, MassWeights.of(robot) if masses is None else masses, angles)


def standing(robot: Robot, body: BodyState) -> OnFootholds:
    """Return the standing robot with the body pose of the view Body.

    Parameters
    ----------
    robot : Robot
        A single robot.
    body : BodyState
        Body pose, and footholds where they were dragged.

    Raises
    ------
    InputError
        If there are not three coordinates per foot.
    UnreachableError
        If a leg does not reach the ground at that body height, and no footholds are given.
    """
    height = default_body_height(robot) if body.body_height_mm is None else body.body_height_mm / 1000
    if body.feet_mm is None:
        feet = np.asarray(default_stance(robot, height)) + np.array([0.0, 0.0, height])
    else:
        feet = _of_legs("feet_mm", body.feet_mm, robot) / 1000
    start = Pose.from_rpy(position=(0.0, 0.0, height))
    roll, pitch, yaw = np.radians([body.roll_deg, body.pitch_deg, body.yaw_deg])
    place = np.array([body.x_mm, body.y_mm, body.z_mm]) / 1000 + np.asarray(start.position)
    pose = Pose.from_rpy(roll, pitch, yaw, place)
    return OnFootholds(solution=inverse_kinematics(robot, feet, pose, knee=body.knee), start=start)


def drag_foothold(robot: Robot, body: BodyState, leg: int, position_mm: tuple[float, float, float]) -> BodyState:
    """Return the state of the view Body with one foothold moved; none is below the ground.

    Parameters
    ----------
    robot : Robot
        A single robot.
    body : BodyState
        The present state.
    leg : int
        Index of the leg.
    position_mm : tuple of float
        New position in G [mm].

    Raises
    ------
    InputError
        If the leg does not exist.
    """
    require_leg(robot, leg)
    feet = np.asarray(standing(robot, body).solution.feet) * 1000
    x, y, z = position_mm
    feet[leg] = x, y, max(z, 0.0)
    return body.model_copy(update={"feet_mm": _numbers(feet)})


def drag_joints(robot: Robot, joints: JointsState, leg: int, position_mm: tuple[float, float, float]) -> JointsState:
    """Return the state of the view Joints with one foot moved to a position, or as near to it as possible.

    The body pose is that before the change; the resting pose follows from the new angles.

    Parameters
    ----------
    robot : Robot
        A single robot.
    joints : JointsState
        The present state.
    leg : int
        Index of the leg.
    position_mm : tuple of float
        New position in G [mm].

    Raises
    ------
    InputError
        If the leg does not exist.
    """
    require_leg(robot, leg)
    now = resting(robot, joints)
    target = now.rest.body.inverse() @ (np.asarray(position_mm) / 1000)
    # All legs are solved for the same point, but only the angles of this one are used.
    solution = inverse_kinematics(robot, np.broadcast_to(np.asarray(target), (robot.legs, 3)))
    angles = now.angles.copy()
    angles[leg] = np.asarray(solution.angles)[leg]
    return JointsState(angles_deg=_numbers(np.degrees(angles)))


def require_leg(robot: Robot, leg: int) -> None:
    """Raise an error if the robot does not have a leg.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Index of the leg.

    Raises
    ------
    InputError
        If the leg does not exist.
    """
    if leg >= robot.legs:
        raise InputError(f"leg is {leg}; {robot.name} has legs 0 to {robot.legs - 1}")


def _of_legs(name: str, values: tuple[float, ...], robot: Robot) -> Float[np.ndarray, "legs 3"]:
    if len(values) != 3 * robot.legs:
        raise InputError(f"{name} has {len(values)} numbers; {robot.legs} legs need {3 * robot.legs}")
    return np.array(values, dtype=np.float64).reshape(robot.legs, 3)


def _numbers(values: Float[np.ndarray, "legs 3"]) -> tuple[float, ...]:
    # Rounded to 1e-6 mm or deg, for short links.
    return tuple((np.round(values, 6) + 0.0).ravel().tolist())
