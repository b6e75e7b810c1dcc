"""URDF files of robots in frames of all kinds, written without Tarsus' own export."""

from __future__ import annotations

from dataclasses import dataclass, field
from xml.etree import ElementTree as ET

import numpy as np
from scipy.spatial.transform import Rotation

from tarsus.kinematics.leg import forward_kinematics
from tarsus.robot.robot import Robot

__all__ = ["Framed", "framed_urdf", "stl"]

# At zero angles of the file the legs are bent by about this much [rad].
BENT = np.array([0.0, 0.3, -1.4])


@dataclass
class Framed:
    """A URDF file, and what its angles are."""

    text: str
    joints: list[list[str]] = field(default_factory=list)
    signs: list[np.ndarray] = field(default_factory=list)
    zeros: list[np.ndarray] = field(default_factory=list)


def _text(values) -> str:
    return " ".join(repr(float(value)) for value in np.atleast_1d(values))


def _origin(element, T) -> None:
    rpy = Rotation.from_matrix(T[:3, :3]).as_euler("xyz")
    ET.SubElement(element, "origin", xyz=_text(T[:3, 3]), rpy=_text(rpy))


def _place(rotation, position) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation, position
    return T


def _link(root, name, T_body_link, mass, com) -> ET.Element:
    link = ET.SubElement(root, "link", name=name)
    inertial = ET.SubElement(link, "inertial")
    _origin(inertial, _place(np.eye(3), np.linalg.inv(T_body_link)[:3] @ np.append(com, 1)))
    ET.SubElement(inertial, "mass", value=_text(mass))
    ET.SubElement(inertial, "inertia", ixx="1e-4", iyy="1e-4", izz="1e-4", ixy="0", ixz="0", iyz="0")
    return link


def _joint(root, name, kind, parent, child, T_parent_child) -> ET.Element:
    joint = ET.SubElement(root, "joint", name=name, type=kind)
    _origin(joint, T_parent_child)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    return joint


def framed_urdf(robot: Robot, *, seed: int, foot: str = "fixed", slide: float = 0.0) -> Framed:
    """Return a robot's URDF file with random frames of links, zero poses and signs of joints, and order of legs.

    ``foot`` is how the file has the foot point: "fixed" for a link, "sphere", "cylinder", "box" or "mesh" for a shape
    of the last link. Origins of femur and tibia joints lie up to ``slide`` along their axes [m].
    """
    random = np.random.default_rng(seed)
    root = ET.Element("robot", name=f"robot {seed}")
    T_root_body = _place(Rotation.random(rng=random).as_matrix(), random.normal(size=3))
    ET.SubElement(root, "link", name="base_footprint")
    _link(root, "chassis", np.eye(4), robot.body_mass, robot.body_com)
    _joint(root, "chassis_joint", "fixed", "base_footprint", "chassis", T_root_body)
    made = Framed("", *([None] * robot.legs for _ in range(3)))
    for leg in random.permutation(robot.legs).tolist():
        zero = BENT + random.uniform(-0.3, 0.3, 3)
        signs = random.choice([-1.0, 1.0], 3)
        angles = np.zeros((robot.legs, 3))
        angles[leg] = zero
        points = np.asarray(forward_kinematics(robot, angles))[leg]
        heading = float(robot.mount_yaw[leg]) + zero[0]
        left = np.array([-np.sin(heading), np.cos(heading), 0.0])
        axes = np.array([[0, 0, 1], -left, -left])
        parent, T_body_parent = "chassis", np.eye(4)
        names = [f"{word}{leg}" for word in ("alpha", "beta", "gamma")]
        for joint in range(3):
            at = points[joint] + (joint > 0) * slide * random.uniform(-1, 1) * left
            T_body_link = _place(Rotation.random(rng=random).as_matrix(), at)
            # Along the link, as robot files have it; that of the coxa ends at the femur axis.
            step = points[joint + 1] - points[joint]
            com = points[joint] + robot.link_com[leg, joint] * step / np.linalg.norm(step)
            link = _link(root, f"{names[joint]}_link", T_body_link, robot.link_mass[leg, joint], com)
            element = _joint(
                root, names[joint], "revolute", parent, link.get("name"), np.linalg.inv(T_body_parent) @ T_body_link
            )
            ET.SubElement(element, "axis", xyz=_text(T_body_link[:3, :3].T @ axes[joint] * signs[joint] * 3.0))
            limits = np.sort((np.asarray(robot.limits)[leg, joint] - zero[joint]) * signs[joint])
            ET.SubElement(element, "limit", lower=_text(limits[0]), upper=_text(limits[1]), effort="1.5", velocity="5")
            parent, T_body_parent = link.get("name"), T_body_link
        _add_foot(root, link, foot, leg, T_body_parent, points, float(robot.foot_radius[leg]))
        made.joints[leg], made.signs[leg], made.zeros[leg] = names, signs, zero
    made.text = ET.tostring(root, encoding="unicode")
    return made


def _add_foot(root, link, kind, leg, T_body_link, points, radius) -> None:
    T_link_body = np.linalg.inv(T_body_link)
    T_body_foot = _place(np.eye(3), points[3])
    if kind == "fixed":
        ET.SubElement(root, "link", name=f"toe_{leg}")
        _joint(root, f"toe_joint_{leg}", "fixed", link.get("name"), f"toe_{leg}", T_link_body @ T_body_foot)
        return
    shape = ET.SubElement(link, "collision")
    if kind == "sphere":
        _origin(shape, T_link_body @ T_body_foot)
        ET.SubElement(ET.SubElement(shape, "geometry"), "sphere", radius=_text(radius))
    elif kind in ("cylinder", "box"):
        along = points[3] - points[2]
        turn = Rotation.align_vectors(along[None], [[0.0, 0.0, 1.0]])[0].as_matrix()
        _origin(shape, T_link_body @ _place(turn, (points[2] + points[3]) / 2))
        length = float(np.linalg.norm(along))
        about = (
            {"radius": "0.005", "length": _text(length)}
            if kind == "cylinder"
            else {"size": _text([0.01, 0.01, length])}
        )
        ET.SubElement(ET.SubElement(shape, "geometry"), kind, about)
    else:
        _origin(shape, T_link_body @ _place(np.eye(3), points[2]))
        name = f"package://some_robot/meshes/tibia_{leg}.stl"
        ET.SubElement(ET.SubElement(shape, "geometry"), "mesh", filename=name, scale="0.001 0.001 0.001")


def stl(vertices) -> bytes:
    """Return a binary STL file with these corners of triangles, (n, 3, 3)."""
    rows = np.zeros(len(vertices), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]))
    rows["corners"] = vertices
    return bytes(80) + len(rows).to_bytes(4, "little") + rows.tobytes()
