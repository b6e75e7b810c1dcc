"""A robot as a URDF file, which ROS, Pinocchio, MuJoCo and others read; no meshes, no other file."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

import numpy as np

from tarsus.errors import InputError
from tarsus.robot.joint_limits import UNKNOWN_SPEED
from tarsus.robot.robot import JOINTS, Robot, require_robot
from tarsus.simulation.inertia import RigidBody, body_inertia, link_inertia, link_step

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["to_urdf"]

# Effort in the file of a joint whose servo is unknown [N m], as URDF has no value for that.
_UNKNOWN_TORQUE = 100.0
# Thickness of a body of unknown size, radius of the links' cylinders, and edge of the box that stands for a foot of
# unknown radius [m]: without a shape it would sink into the ground, and a ball's radius would be read back as its own.
_PLATE, _LINK_RADIUS, _FOOT_EDGE = 0.002, 0.006, 0.002
# Greatest fraction of the tibia's mass that goes to the foot, a separate link: Bullet takes a link without inertia to
# have 1 kg.
_FOOT_SHARE = 0.01
_ABOUT = """
 Made by Tarsus. Frames and angles are those of its conventions: B in the body, x forward, y to the left, z up; coxae
 turn about z, femurs and tibias about -y. Inertias are those of uniform boxes. {unknown}
"""
# Options for MuJoCo, with which the feet and the body stay separate bodies.
_MUJOCO = {"fusestatic": "false", "discardvisual": "false", "strippath": "false"}


def to_urdf(robot: Robot) -> str:
    """Return a robot as a URDF document.

    Links are named ``body`` and by leg and link (``front_left_femur``), joints like the link that they move; each foot
    is a link of its own at the end of the tibia (``front_left_foot``), fixed by a joint, with a hundredth of the
    tibia's mass, or less where the tibia's centre of mass lies far from the foot. The shape that touches the ground
    belongs to the tibia: the ball of the foot, or a box of 2 mm where its radius is unknown.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.

    Raises
    ------
    MissingDataError
        If the mass of the body or of a link is unknown.
    InputError
        If the robot is a batch, or two legs would have links of the same name, as ``front left`` and ``front_left``.
    """
    require_robot(robot)
    if robot.batch_shape:
        raise InputError(f"robot {robot.name!r} is a batch of designs {robot.batch_shape}; expected one robot")
    robot.require_masses()
    _require_unique_names(robot)
    root = ET.Element("robot", name=robot.name)
    known = all(servo is not None for row in robot.servos for servo in row)
    unknown = "" if known else f"Unknown servos have an effort of {_UNKNOWN_TORQUE:g} N m."
    root.append(ET.Comment(_ABOUT.format(unknown=unknown)))
    ET.SubElement(ET.SubElement(root, "mujoco"), "compiler", _MUJOCO)
    _add_body(root, robot)
    for leg in range(robot.legs):
        _add_leg(root, robot, leg)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _add_body(root: ET.Element, robot: Robot) -> None:
    link = ET.SubElement(root, "link", name="body")
    _add_inertia(link, body_inertia(robot))
    mounts = np.asarray(robot.mount_position)
    if robot.body_size is None:
        low, high = mounts.min(axis=0), mounts.max(axis=0)
        centre, size = (low + high) / 2, np.append((high - low)[:2], _PLATE)
    else:
        centre, size = np.zeros(3), np.asarray(robot.body_size)
    for kind in ("visual", "collision"):
        _add_shape(link, kind, "box", {"size": _text(size)}, centre)


def _add_leg(root: ET.Element, robot: Robot, leg: int) -> None:
    parent, position, yaw = "body", np.asarray(robot.mount_position[leg]), float(robot.mount_yaw[leg])
    tibia, ball = _divided(link_inertia(robot, leg, 2), link_step(robot, leg, 2))
    solids = (link_inertia(robot, leg, 0), link_inertia(robot, leg, 1), tibia)
    for joint, name in enumerate(JOINTS):
        link = _name(robot, leg, name)
        _add_link(root, robot, leg, joint, solids[joint])
        found = ET.SubElement(root, "joint", name=link, type="revolute")
        _add_origin(found, position, (0.0, 0.0, yaw))
        ET.SubElement(found, "parent", link=parent)
        ET.SubElement(found, "child", link=link)
        ET.SubElement(found, "axis", xyz="0 0 1" if joint == 0 else "0 -1 0")
        ET.SubElement(found, "limit", _limits(robot, leg, joint))
        parent, position, yaw = link, link_step(robot, leg, joint), 0.0
    foot = _name(robot, leg, "foot")
    _add_inertia(ET.SubElement(root, "link", name=foot), ball)
    fixed = ET.SubElement(root, "joint", name=foot, type="fixed")
    _add_origin(fixed, position)
    ET.SubElement(fixed, "parent", link=parent)
    ET.SubElement(fixed, "child", link=foot)


def _require_unique_names(robot: Robot) -> None:
    first: dict[str, str] = {}
    for leg, name in enumerate(robot.leg_names):
        link = _name(robot, leg, JOINTS[0])
        if link in first:
            raise InputError(
                f"robot {robot.name!r}: the legs {first[link]!r} and {name!r} would both have the link {link} in URDF, "
                "where spaces become underscores; rename one of them"
            )
        first[link] = name


def _name(robot: Robot, leg: int, part: str) -> str:
    return "_".join([*robot.leg_names[leg].split(), part])


def _divided(tibia: RigidBody, foot: Float[np.ndarray, "3"]) -> tuple[RigidBody, RigidBody]:
    """Return the tibia without its foot, and the foot, which together have the tibia's mass, centre and inertia."""
    along, across, _ = tibia.moments
    # A mass far from the centre would take more inertia than there is: the rest exists while across >= along / 2.
    spare, lever2 = across - along / 2, np.sum((foot - tibia.centre) ** 2) + _LINK_RADIUS**2
    share = min(_FOOT_SHARE, spare / (spare + tibia.mass * lever2)) if spare else _FOOT_SHARE
    mass, small = (1 - share) * tibia.mass, share * tibia.mass
    centre = (tibia.centre - share * foot) / (1 - share)
    ball = 0.4 * small * _LINK_RADIUS**2
    across += tibia.mass * np.sum((tibia.centre - centre) ** 2) - small * np.sum((foot - centre) ** 2) - ball
    divided = RigidBody(mass, centre, (along - ball, across, across), tibia.axis)
    return divided, RigidBody(small, np.zeros(3), (ball, ball, ball), np.zeros(3))


def _add_link(root: ET.Element, robot: Robot, leg: int, joint: int, solid: RigidBody) -> None:
    link, step = ET.SubElement(root, "link", name=_name(robot, leg, JOINTS[joint])), link_step(robot, leg, joint)
    _add_inertia(link, solid)
    length = float(np.linalg.norm(step))
    if length > 0:
        # A cylinder lies along z.
        turn = (0.0, math.atan2(math.hypot(step[0], step[1]), step[2]), math.atan2(step[1], step[0]))
        shape = {"radius": f"{_LINK_RADIUS:g}", "length": _text([length])}
        _add_shape(link, "visual", "cylinder", shape, step / 2, turn)
    radius = float(np.broadcast_to(np.asarray(robot.foot_radius), (robot.legs,))[leg])
    if joint == 2:
        known = radius > 0
        about = {"radius": _text([radius])} if known else {"size": _text([_FOOT_EDGE] * 3)}
        for kind in ("visual", "collision"):
            _add_shape(link, kind, "sphere" if known else "box", about, step)


def _limits(robot: Robot, leg: int, joint: int) -> dict[str, str]:
    servo = robot.servos[leg][joint]
    low, high = np.asarray(robot.limits[leg, joint]).tolist()
    speed = UNKNOWN_SPEED if servo is None or servo.no_load_speed is None else servo.no_load_speed
    effort = _UNKNOWN_TORQUE if servo is None else servo.stall_torque
    return {"lower": _text([low]), "upper": _text([high]), "effort": _text([effort]), "velocity": _text([speed])}


def _add_inertia(link: ET.Element, solid: RigidBody) -> None:
    inertial, matrix = ET.SubElement(link, "inertial"), solid.matrix
    _add_origin(inertial, solid.centre)
    ET.SubElement(inertial, "mass", value=_text([solid.mass]))
    places = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    ET.SubElement(inertial, "inertia", {name: _text([matrix[place]]) for name, place in places.items()})


def _add_shape(
    link: ET.Element,
    kind: str,
    shape: str,
    about: dict[str, str],
    position: Float[np.ndarray, "3"],
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> None:
    element = ET.SubElement(link, kind)
    _add_origin(element, position, turn)
    ET.SubElement(ET.SubElement(element, "geometry"), shape, about)


def _add_origin(
    element: ET.Element, position: Float[np.ndarray, "3"], turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> None:
    ET.SubElement(element, "origin", xyz=_text(position), rpy=_text(turn))


def _text(values: Sequence[float] | Float[np.ndarray, "n"]) -> str:
    """Return numbers with all their digits."""
    return " ".join(f"{float(value) + 0.0!r}" for value in values)
