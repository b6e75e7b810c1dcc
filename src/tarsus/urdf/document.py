"""Links and joints from the text of a URDF file, with all numbers checked."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple
from xml.etree import ElementTree as ET

import numpy as np

from tarsus.errors import InputError

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["MOVING", "Joint", "Link", "Shape", "UrdfDocument", "parse_urdf"]

MOVING = ("revolute", "continuous")
"""Types of joints that a leg has."""

_LARGEST = 20_000_000
_LARGEST_NUMBER = 1e12
_DEFAULTS = {"origin": {"xyz": "0 0 0", "rpy": "0 0 0"}, "axis": {"xyz": "1 0 0"}, "mesh": {"scale": "1 1 1"}}


class Shape(NamedTuple):
    """A shape of a link.

    Attributes
    ----------
    kind : str
        ``"box"``, ``"cylinder"``, ``"sphere"`` or ``"mesh"``.
    size : array
        Edges of a box, radius and length of a cylinder, radius of a sphere, scale of a mesh [m].
    T_link_shape : array, shape (4, 4)
        Its pose in the frame of the link.
    file : str
        Name of the file of a mesh.
    collision : bool
        Whether it is a collision shape, not a visual one.
    """

    kind: str
    size: Float[np.ndarray, "k"]
    T_link_shape: Float[np.ndarray, "4 4"]
    file: str
    collision: bool


class Link(NamedTuple):
    """A link.

    Attributes
    ----------
    name : str
        Its name.
    mass : float or None
        Its mass [kg]; None where the file has none.
    com : array, shape (3,)
        Its centre of mass, in its frame [m].
    shapes : tuple of Shape
        Its shapes.
    """

    name: str
    mass: float | None
    com: Float[np.ndarray, "3"]
    shapes: tuple[Shape, ...]


class Joint(NamedTuple):
    """A joint.

    Attributes
    ----------
    name, kind, parent, child : str
        Its name and type, and the links that it joins.
    T_parent_child : array, shape (4, 4)
        Pose of the child link in the frame of the parent, with the joint at zero.
    axis : array, shape (3,)
        Unit vector of its axis, in the frame of the child.
    limits : (float, float) or None
        Lower and upper limit [rad]; None where there are none.
    effort, speed : float or None
        Greatest torque [N m] and speed [rad/s]; None where the file has none.
    mimics : bool
        Whether it follows another joint.
    """

    name: str
    kind: str
    parent: str
    child: str
    T_parent_child: Float[np.ndarray, "4 4"]
    axis: Float[np.ndarray, "3"]
    limits: tuple[float, float] | None
    effort: float | None
    speed: float | None
    mimics: bool


class UrdfDocument(NamedTuple):
    """Links and joints of a URDF file.

    Attributes
    ----------
    name : str
        Name of the robot.
    links : dict of str to Link
        Links by name.
    joints : tuple of Joint
        Joints in the order of the file.
    """

    name: str
    links: dict[str, Link]
    joints: tuple[Joint, ...]


def parse_urdf(text: str, *, where: str) -> UrdfDocument:
    """Return links and joints of a URDF file.

    Parameters
    ----------
    text : str
        The text of the file.
    where : str
        Name of the file in messages.

    Raises
    ------
    InputError
        If it is not a URDF file, or has something else in place of a number.
    """
    if len(text) > _LARGEST:
        raise InputError(f"{where} has {len(text)} characters; at most {_LARGEST} are read")
    # Entities are declared in a DOCTYPE, which no URDF file has: without one there is nothing to expand.
    if re.search(r"<!(DOCTYPE|ENTITY)", text):
        raise InputError(f"{where} has a DOCTYPE; URDF files have none")
    try:
        root = ET.fromstring(text)
    except (ET.ParseError, ValueError) as error:
        raise InputError(f"{where} is not valid XML: {error}") from None
    if root.tag != "robot":
        raise InputError(f"{where} has the root element <{root.tag}>; that of a URDF file is <robot>")
    if any("/wiki/xacro}" in element.tag or "${" in str(element.attrib) for element in root.iter()):
        raise InputError(f"{where} has macros of xacro; expand it first: xacro {where} > robot.urdf")
    reader = _Reader(where)
    if root.find("link") is None:
        raise InputError(f"{where} has no <link>; a robot has a body and the links of its legs")
    links = {link.name: link for link in map(reader.link, root.findall("link"))}
    joints = tuple(reader.joint(element) for element in root.findall("joint"))
    for joint in joints:
        for name in (joint.parent, joint.child):
            if name not in links:
                raise InputError(f"{where}: joint {joint.name!r} joins the link {name!r}, which the file does not have")
    return UrdfDocument(root.get("name") or "robot", links, joints)


class _Reader:
    """Reads elements; the name of the file is for messages."""

    def __init__(self, where: str) -> None:
        self._where = where

    def link(self, element: ET.Element) -> Link:
        name = element.get("name", "")
        inertial, mass, com = element.find("inertial"), None, np.zeros(3)
        if inertial is not None:
            found = inertial.find("mass")
            if found is not None:
                mass = float(self._numbers(found, "value", 1, name)[0])
            com = self._place(inertial, name)[:3, 3]
        if mass is not None and not mass >= 0:
            raise InputError(f"{self._where}: the mass of link {name!r} is {mass:g} kg; it must not be negative")
        shapes = [
            shape
            for kind in ("collision", "visual")
            for one in element.findall(kind)
            if (shape := self._shape(one, name, collision=kind == "collision")) is not None
        ]
        return Link(name, mass, com, tuple(shapes))

    def joint(self, element: ET.Element) -> Joint:
        name, kind = element.get("name", ""), element.get("type", "")
        ends = [(element.find(end), end) for end in ("parent", "child")]
        parent, child = ("" if found is None else found.get("link", "") for found, _ in ends)
        axis = self._numbers(element.find("axis"), "xyz", 3, name, tag="axis")
        length = float(np.linalg.norm(axis))
        if kind in MOVING and not length > 0:
            raise InputError(f"{self._where}: the axis of joint {name!r} has no direction")
        limit, limits, bounds = element.find("limit"), None, dict[str, float]()
        if limit is not None:
            bounds = {key: float(self._numbers(limit, key, 1, name)[0]) for key in limit.attrib}
        if kind == "revolute" and {"lower", "upper"} & set(bounds):
            # The default of either is 0.
            limits = lower, upper = bounds.get("lower", 0.0), bounds.get("upper", 0.0)
            if lower > upper:
                raise InputError(
                    f"{self._where}: the lower limit of joint {name!r}, {lower:g} rad, is above its upper limit, "
                    f"{upper:g} rad"
                )
        return Joint(
            name,
            kind,
            parent,
            child,
            self._place(element, name),
            axis / length if length else axis,
            limits,
            bounds.get("effort"),
            bounds.get("velocity"),
            element.find("mimic") is not None,
        )

    def _shape(self, element: ET.Element, name: str, *, collision: bool) -> Shape | None:
        geometry = element.find("geometry")
        if geometry is None or len(geometry) == 0:
            return None
        shape, place = geometry[0], self._place(element, name)
        if shape.tag == "box":
            return Shape("box", self._numbers(shape, "size", 3, name), place, "", collision)
        if shape.tag in ("cylinder", "sphere"):
            keys = ("radius", "length") if shape.tag == "cylinder" else ("radius",)
            size = np.concatenate([self._numbers(shape, key, 1, name) for key in keys])
            return Shape(shape.tag, size, place, "", collision)
        scale = self._numbers(shape, "scale", 3, name, tag="mesh")
        return Shape("mesh", scale, place, shape.get("filename", ""), collision)

    def _place(self, element: ET.Element, name: str) -> Float[np.ndarray, "4 4"]:
        """Return the transform of an element's origin."""
        origin = element.find("origin")
        place = np.eye(4)
        place[:3, 3] = self._numbers(origin, "xyz", 3, name, tag="origin")
        place[:3, :3] = _rotation(*self._numbers(origin, "rpy", 3, name, tag="origin").tolist())
        return place

    def _numbers(
        self, element: ET.Element | None, key: str, count: int, name: str, *, tag: str = ""
    ) -> Float[np.ndarray, "k"]:
        """Return the numbers of an attribute, or its default."""
        text = None if element is None else element.get(key)
        text = _DEFAULTS.get(tag, {}).get(key, "") if text is None else text
        try:
            values = np.array([float(word) for word in text.split()])
        except ValueError:
            values = np.array([math.nan])
        if values.shape != (count,) or not (np.abs(values) <= _LARGEST_NUMBER).all():
            wanted = f"{'a number' if count == 1 else f'{count} numbers'} up to {_LARGEST_NUMBER:g}"
            raise InputError(f"{self._where}: {key} of {name!r} is {text!r}; expected {wanted}")
        return values


def _rotation(roll: float, pitch: float, yaw: float) -> Float[np.ndarray, "3 3"]:
    """Return ``Rz(yaw) Ry(pitch) Rx(roll)``."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(angle), math.sin(angle)) for angle in (roll, pitch, yaw))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )
