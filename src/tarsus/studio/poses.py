"""From the state's joints and body to the poses that are shown, and back from a foot that is dragged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.errors import InputError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import RestingPose, resting_pose
from tarsus.kinematics.stance import default_body_height, default_stance
from tarsus.robot.robot import Robot
from tarsus.studio.messages.state import BodyState, JointsState
from tarsus.studio.robots import stance_of
from tarsus.studio.standing import OnFootholds

__all__ = ["Resting", "drag_foothold", "drag_joints", "require_leg", "resting", "standing"]


@dataclass(frozen=True, eq=False)
class Resting:
    """Joint angles and how the robot rests with them.

    Attributes
    ----------
    angles : array, shape (legs, 3)
        Joint angles [rad].
    rest : Rest
        What `resting_pose` says.
    """

    angles: np.ndarray[Any, Any]
    rest: RestingPose


def resting(robot: Robot, joints: JointsState) -> Resting:
    """Return how the robot rests with the view Joints' angles.

    Parameters
    ----------
    robot : Robot
        A single robot.
    joints : JointsState
        The angles; those of the rest stance, or all zero where the robot has none, if left out.

    Raises
    ------
    InputError
        If there are not three angles a leg.
    """
    if joints.angles_deg is None:
        stance = stance_of(robot)
        angles = np.zeros((robot.legs, 3)) if stance is None else stance[1]
    else:
        angles = np.radians(_of_legs("angles_deg", joints.angles_deg, robot))
    return Resting(angles, resting_pose(robot, angles))


def standing(robot: Robot, body: BodyState) -> OnFootholds:
    """Return how the robot stands with the view Body's pose.

    Parameters
    ----------
    robot : Robot
        A single robot.
    body : BodyState
        The pose, and the footholds where they were dragged.

    Raises
    ------
    InputError
        If there are not three coordinates a foot.
    UnreachableError
        If a leg reaches the ground nowhere at that body height, and no footholds are given.
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
    """Return the view Body's state with one foothold elsewhere; none is put below the ground.

    Parameters
    ----------
    robot : Robot
        A single robot.
    body : BodyState
        The state before.
    leg : int
        Whose foothold.
    position_mm : tuple of float
        Where to, in G [mm].

    Raises
    ------
    InputError
        If there is no such leg.
    """
    require_leg(robot, leg)
    feet = np.asarray(standing(robot, body).solution.feet) * 1000
    x, y, z = position_mm
    feet[leg] = x, y, max(z, 0.0)
    return body.model_copy(update={"feet_mm": _numbers(feet)})


def drag_joints(robot: Robot, joints: JointsState, leg: int, position_mm: tuple[float, float, float]) -> JointsState:
    """Return the view Joints' state with one leg's foot where it is dragged to, or as near as it gets.

    The body stays for that moment where it is; how the robot then rests is another question.

    Parameters
    ----------
    robot : Robot
        A single robot.
    joints : JointsState
        The state before.
    leg : int
        Whose foot.
    position_mm : tuple of float
        Where to, in G [mm].

    Raises
    ------
    InputError
        If there is no such leg.
    """
    require_leg(robot, leg)
    now = resting(robot, joints)
    wanted = now.rest.body.inverse() @ (np.asarray(position_mm) / 1000)
    # The other legs are solved for the same point, for nothing: only this one's angles are taken.
    solution = inverse_kinematics(robot, np.broadcast_to(np.asarray(wanted), (robot.legs, 3)))
    angles = now.angles.copy()
    angles[leg] = np.asarray(solution.angles)[leg]
    return JointsState(angles_deg=_numbers(np.degrees(angles)))


def require_leg(robot: Robot, leg: int) -> None:
    """Refuse the number of a leg that the robot does not have.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        The number.

    Raises
    ------
    InputError
        If there is no such leg.
    """
    if leg >= robot.legs:
        raise InputError(f"leg is {leg}; {robot.name} has legs 0 to {robot.legs - 1}")


def _of_legs(name: str, values: tuple[float, ...], robot: Robot) -> np.ndarray[Any, Any]:
    if len(values) != 3 * robot.legs:
        raise InputError(f"{name} has {len(values)} numbers; {robot.legs} legs have {3 * robot.legs}")
    return np.array(values, dtype=np.float64).reshape(robot.legs, 3)


def _numbers(values: np.ndarray[Any, Any]) -> tuple[float, ...]:
    # To a millionth of a mm or deg, so that a link stays short.
    return tuple((np.round(values, 6) + 0.0).ravel().tolist())
