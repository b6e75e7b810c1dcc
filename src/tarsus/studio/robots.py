"""The choice of a robot, and its description for the browser."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError, UnknownNameError, UnreachableError
from tarsus.gait.gait import GAITS, Gait
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_body_height, default_stance, default_swing_height
from tarsus.report.robot_check import longest_stroke, missing_values
from tarsus.report.robot_summary import dimensions
from tarsus.robot.file import list_robots, load_robot, robot_from_dict, robot_from_text, robot_to_dict
from tarsus.robot.robot import Robot
from tarsus.studio.encoding import degrees, millimetres, or_null
from tarsus.studio.messages.pose import Dimension, RobotMessage
from tarsus.studio.messages.state import RobotChoice

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = [
    "MOST_LEGS",
    "choice_of_document",
    "choice_of_preset",
    "choice_of_text",
    "gaits_of",
    "robot_message",
    "robot_of",
    "stance_of",
]

MOST_LEGS = 12
"""Greatest number of legs in the studio, as the cost of a walk grows with its square; the command line has no limit."""

# Greatest size of a robot file as JSON [characters]: undo keeps 100 of them per visitor. Twelve legs with individual
# keys take a tenth of it.
_LARGEST = 65_536


def choice_of_preset(name: str) -> RobotChoice:
    """Return the choice of a preset.

    Parameters
    ----------
    name : str
        One of `list_robots`; paths of files are not accepted.

    Raises
    ------
    UnknownNameError
        If the preset does not exist.
    """
    if name not in list_robots():
        raise UnknownNameError.of("robot", name[:200], list_robots())
    return RobotChoice(preset=name)


def choice_of_text(text: str, *, where: str) -> RobotChoice:
    """Return the choice of a robot by the text of its file.

    Parameters
    ----------
    text : str
        TOML.
    where : str
        Name of the source in error messages.

    Raises
    ------
    RobotFileError
        If the file is not valid.
    """
    return choice_of_document(robot_to_dict(robot_from_text(text, where=where)))


def choice_of_document(document: dict[str, Any]) -> RobotChoice:
    """Return the choice of a robot by the keys of its file; those of a preset are that preset.

    Parameters
    ----------
    document : dict
        Keys of a robot file; `robot_of` validates them.
    """
    name = document.get("name")
    if isinstance(name, str) and name in list_robots() and robot_to_dict(load_robot(name)) == document:
        return RobotChoice(preset=name)
    return RobotChoice(preset=None, document=document)


def robot_of(choice: RobotChoice) -> Robot:
    """Return the robot.

    Parameters
    ----------
    choice : RobotChoice
        Name of a preset, or a document.

    Raises
    ------
    RobotFileError, UnknownNameError
        If the preset does not exist, or the document is not valid.
    InputError
        If the document is too large, the robot has too many legs, or neither is given.
    """
    if choice.document is not None:
        size = len(json.dumps(choice.document))
        if size > _LARGEST:
            raise InputError(f"the robot's document has {size} characters as JSON; the limit is {_LARGEST}")
        robot = robot_from_dict(choice.document, where="the robot")
    elif choice.preset is not None:
        robot = load_robot(str(choice_of_preset(choice.preset).preset))
    else:
        raise InputError("neither preset nor document is given")
    if robot.legs > MOST_LEGS:
        raise InputError(f"robot {robot.name!r} has {robot.legs} legs; the studio accepts at most {MOST_LEGS}")
    return robot


def stance_of(robot: Robot) -> tuple[Float[np.ndarray, "legs 3"], Float[np.ndarray, "legs 3"]] | None:
    """Return footholds in G and joint angles of the default stance, or None if the robot can't stand.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    height = default_body_height(robot)
    try:
        feet = np.asarray(default_stance(robot, height)) + np.array([0.0, 0.0, height])
    except UnreachableError:
        return None
    return feet, np.asarray(inverse_kinematics(robot, feet, Pose.from_rpy(position=(0.0, 0.0, height))).angles)


def gaits_of(robot: Robot) -> list[str]:
    """Return the names of the gaits for the number of legs of a robot.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    return [name for name in GAITS if _has_gait(name, robot.legs)]


def _has_gait(name: str, legs: int) -> bool:
    try:
        Gait.named(name, legs=legs)
    except InputError:
        return False
    return True


def robot_message(robot: Robot, choice: RobotChoice, *, id: int) -> RobotMessage:
    """Return the description of a robot.

    Parameters
    ----------
    robot : Robot
        A single robot.
    choice : RobotChoice
        Selection of the robot.
    id : int
        Id of the message that is answered.
    """
    stance, (longest, problems) = stance_of(robot), longest_stroke(robot)
    servos = [servo for row in robot.servos for servo in row]
    return RobotMessage(
        type="robot",
        id=id,
        name=robot.name,
        preset=choice.preset if choice.document is None else None,
        leg_names=list(robot.leg_names),
        leg_codes=list(robot.leg_codes),
        mount_mm=millimetres(robot.mount_position),
        mount_yaw_deg=degrees(robot.mount_yaw),
        coxa_mm=millimetres(robot.coxa),
        femur_mm=millimetres(robot.femur),
        tibia_mm=millimetres(robot.tibia),
        femur_axis_offset_mm=millimetres(robot.femur_axis_offset),
        limits_deg=degrees(robot.limits),
        foot_radius_mm=millimetres(robot.foot_radius),
        body_size_mm=None if robot.body_size is None else millimetres(robot.body_size),
        mass_kg=float(total_mass(robot)) if robot.has_masses else None,
        servos=[None if servo is None else servo.name for servo in servos],
        stall_torque_nm=[None if servo is None else or_null(servo.stall_torque) for servo in servos],
        body_height_mm=default_body_height(robot) * 1000,
        swing_height_mm=default_swing_height(robot) * 1000,
        gait=robot.gait.name,
        gaits=gaits_of(robot),
        stance_mm=None if stance is None else millimetres(stance[0]),
        stance_angles_deg=None if stance is None else degrees(stance[1]),
        longest_stroke_mm=longest,
        document=robot_to_dict(robot),
        dimensions=[_dimension(row) for row in dimensions(robot)],
        missing=list(missing_values(robot)),
        problems=problems,
    )


def _dimension(row: dict[str, Any]) -> Dimension:
    return Dimension(**{key: row[key] for key in ("key", "value", "source", "confidence", "note")})
