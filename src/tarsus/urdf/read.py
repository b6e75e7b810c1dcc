"""A robot from a URDF file, with remarks on what the file lacks and what does not fit a robot file."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.rotation import rotation_about
from tarsus.representation import represented
from tarsus.robot.leg_words import end_in_name, side_in_name
from tarsus.robot.ring import ring
from tarsus.robot.robot import JOINTS, Robot, Source
from tarsus.robot.units import from_milli, radians, to_decimal
from tarsus.urdf.document import UrdfDocument, parse_urdf
from tarsus.urdf.foot import Foot, foot_of
from tarsus.urdf.leg import FittedLeg, centre_of, fitted_leg, mass_of
from tarsus.urdf.tree import Chain, Tree, legs_of

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["DIRECTIONS", "ImportedRobot", "robot_from_urdf", "urdf_robot"]

DIRECTIONS = {"x": 0.0, "y": 90.0, "-x": 180.0, "-y": -90.0}
"""Axes of the file that may point forward, and their direction in the file [deg]."""

# Boxes up to this thickness are no body: they stand for one of unknown height [m].
_PLATE = 0.005
_SAMPLES, _SEED = 200, 0
# Distance of the origin from the middle of the coxa axes above which it is worth a remark [m].
_OFF_CENTRE = 0.02
# Decimals to which lengths in mm are rounded, a tenth of a nanometre; angles in degrees get one more, 1.7e-10 rad.
_DIGITS = 7
_SIX = ("front", "middle", "rear")
_FOUR = ("front", "rear")


@represented("robot", "remarks", "deviation")
@dataclass(frozen=True, kw_only=True, eq=False)
class ImportedRobot:
    """A robot from a URDF file.

    Attributes
    ----------
    robot : Robot
        The robot.
    joints : tuple of tuple of str
        Names of the joints in the file, ``joints[leg][joint]``.
    signs, zeros : array, shape (legs, 3)
        The joint angle of the robot is ``sign * angle in the file + zero`` [rad].
    deviation : float
        Greatest distance between the foot points of the robot and of the file, at 200 random poses within the limits
        [m].
    remarks : tuple of str
        What the file lacks, what was assumed and what does not fit, a line each.
    """

    robot: Robot
    joints: tuple[tuple[str, ...], ...]
    signs: Float[np.ndarray, "legs 3"]
    zeros: Float[np.ndarray, "legs 3"]
    deviation: float
    remarks: tuple[str, ...]


def robot_from_urdf(
    path: str | os.PathLike[str],
    *,
    forward: str = "x",
    centre: bool = False,
    foot: tuple[float, float, float] | None = None,
    name: str | None = None,
) -> ImportedRobot:
    """Read a URDF file.

    Parameters
    ----------
    path : path
        The file.
    forward : str
        Which axis of the body's link points forward: ``"x"``, ``"-x"``, ``"y"`` or ``"-y"``.
    centre : bool
        Whether B's origin is moved to the middle of the coxa joints.
    foot : (float, float, float), optional
        Foot point in the frame of each leg's last link, for a file that does not say where the feet are [m].
    name : str, optional
        Name of the robot; that of the file where left out.

    Raises
    ------
    InputError
        If it can't be read, is not a URDF file, or its robot does not have legs as in robot files.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not text in UTF-8"
        raise InputError(f"{os.fspath(path)} can't be read: {reason}") from None
    file = Path(path)
    return urdf_robot(text, where=str(path), folder=file.parent, forward=forward, centre=centre, foot=foot, name=name)


def urdf_robot(
    text: str,
    *,
    where: str = "the URDF file",
    folder: Path | None = None,
    forward: str = "x",
    centre: bool = False,
    foot: tuple[float, float, float] | None = None,
    name: str | None = None,
) -> ImportedRobot:
    """Return the robot of a URDF document.

    The legs are found by how links hang together, whatever their names and frames: chains of three revolute joints from
    one link. B is the frame of that link, turned so that x points forward; with `centre` its origin is moved.

    Parameters
    ----------
    text : str
        The document.
    where : str
        What to call it in messages.
    folder : Path, optional
        Folder of its meshes.
    forward, centre, foot, name
        As for `robot_from_urdf`.

    Raises
    ------
    InputError
        If it is not a URDF file, or its robot does not have legs as in robot files.
    """
    if forward not in DIRECTIONS:
        raise InputError(f"forward is {forward!r}; it must be one of {', '.join(DIRECTIONS)}")
    document = parse_urdf(text, where=where)
    tree = legs_of(document, where=where)
    T_robot_body = _turn(-math.radians(DIRECTIONS[forward]))
    feet = [_foot(chain, foot, folder=folder, where=where) for chain in tree.legs]
    middle = np.mean([(T_robot_body @ chain.parts[0].links[0].T_body_link)[:3, 3] for chain in tree.legs], axis=0)
    if centre:
        T_robot_body[:3, 3] -= middle
        middle = np.zeros(3)
    legs = [fitted_leg(chain, foot, T_robot_body, middle) for chain, foot in zip(tree.legs, feet, strict=True)]
    order = _order(legs)
    legs, feet, chains = [legs[i] for i in order], [feet[i] for i in order], [tree.legs[i] for i in order]
    names = _leg_names(legs)
    robot, remarks = _robot(document, tree, legs, names, T_robot_body, where, name)
    remarks += _remarks(tree, legs, feet, names, forward)
    away = float(np.hypot(*middle[:2]))
    if away > _OFF_CENTRE:
        remarks.append(
            f"the origin lies {1000 * away:.0f} mm beside the middle of the coxa axes, about which robots turn; "
            "--centre moves it there"
        )
    signs, zeros = np.array([leg.signs for leg in legs]), np.array([leg.zeros for leg in legs])
    return ImportedRobot(
        robot=robot,
        joints=tuple(leg.joints for leg in legs),
        signs=signs,
        zeros=zeros,
        deviation=_deviation(robot, chains, feet, signs, zeros, T_robot_body),
        remarks=tuple(remarks),
    )


def _turn(angle: float) -> Float[np.ndarray, "4 4"]:
    """Return a rotation about z; exact for quarter turns."""
    place, (c, s) = np.eye(4), (round(math.cos(angle), 12), round(math.sin(angle), 12))
    place[:2, :2] = [[c, -s], [s, c]]
    return place


def _lengths(values: Any) -> Float[np.ndarray, "..."]:
    """Return lengths [m], rounded to short decimals in mm, which removes the noise of the computation."""
    milli = np.round(np.asarray(values, dtype=float) * 1000, _DIGITS) + 0.0
    return _each(lambda value: from_milli(to_decimal(value)), milli)


def _angles(values: Any) -> Float[np.ndarray, "..."]:
    """Return angles [rad], rounded to short decimals in degrees."""
    degrees = np.round(np.degrees(np.asarray(values, dtype=float)), _DIGITS + 1) + 0.0
    return _each(lambda value: radians(to_decimal(value)), degrees)


def _each(convert: Callable[[float], float], values: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
    return np.array([convert(value) for value in values.ravel().tolist()]).reshape(values.shape)


def _foot(chain: Chain, given: tuple[float, float, float] | None, *, folder: Path | None, where: str) -> Foot:
    """Return the foot of a leg: the given point, or else the one that the file has."""
    place = chain.parts[-1].links[0].T_body_link
    if given is not None:
        return Foot(place[:3, :3] @ np.array(given) + place[:3, 3], 0.0, "the given point")
    found = foot_of(chain.parts[-1], place[:3, 3], folder=folder)
    if found is None:
        raise InputError(
            f"{where}: the foot behind joint {chain.joints[-1].name!r} is unknown: nothing is fixed on its link, which "
            "has no shape or STL file that can be read; put its meshes beside the file, or give the foot point in the "
            "frame of that link (--foot)"
        )
    return found


def _order(legs: list[FittedLeg]) -> list[int]:
    """Return the order of the legs in a robot file, from the rounded values that it will contain."""
    mounts, yaw = _lengths([leg.mount for leg in legs]), _angles([leg.yaw for leg in legs])
    return ring(mounts[:, 0] + 1j * mounts[:, 1], np.exp(1j * yaw))


def _leg_names(legs: list[FittedLeg]) -> tuple[str, ...]:
    """Return the names of legs in the ring's order."""
    ends = {4: _FOUR, 6: _SIX}.get(len(legs))
    if ends is None:
        return tuple(f"leg {number}" for number in range(1, len(legs) + 1))
    return tuple([f"{end} left" for end in ends] + [f"{end} right" for end in reversed(ends)])


def _robot(
    document: UrdfDocument,
    tree: Tree,
    legs: list[FittedLeg],
    names: tuple[str, ...],
    T_robot_body: Float[np.ndarray, "4 4"],
    where: str,
    name: str | None,
) -> tuple[Robot, list[str]]:
    """Return the robot, and remarks on its body."""
    size, said = _body_size(tree, T_robot_body)
    body_mass, centre = mass_of(tree.body), centre_of(tree.body)
    masses = [leg.masses for leg in legs]
    known = [mass for mass in masses if mass is not None]
    if not body_mass:
        said.append("the mass of the body is missing")
    if len(known) < len(legs):
        said.append("masses of links are missing")
    lengths = _lengths([leg.lengths for leg in legs])
    robot = Robot(
        name=name or document.name,
        leg_names=names,
        mount_position=_lengths([leg.mount for leg in legs]),
        mount_yaw=_angles([leg.yaw for leg in legs]),
        coxa=lengths[:, 0],
        femur=lengths[:, 1],
        tibia=lengths[:, 2],
        femur_axis_offset=_lengths([leg.offset for leg in legs]),
        limits=_angles([leg.limits for leg in legs]),
        foot_radius=_lengths([leg.foot_radius for leg in legs]),
        link_com=_lengths([leg.centres for leg in legs]),
        link_mass=np.array(known) if len(known) == len(legs) else None,
        body_mass=np.array(body_mass) if body_mass else None,
        body_com=_lengths(np.zeros(3) if centre is None else T_robot_body[:3, :3] @ centre + T_robot_body[:3, 3]),
        body_size=size,
        sources=(Source(of=("legs", "leg", "body"), source=f"{Path(where).name}, a URDF file", confidence="B"),),
    )
    return robot, said


def _body_size(tree: Tree, T_robot_body: Float[np.ndarray, "4 4"]) -> tuple[Float[np.ndarray, "3"] | None, list[str]]:
    """Return the size of the body's box, if the file has one, and remarks."""
    boxes = [
        (placed, shape)
        for placed in tree.body.links
        for shape in placed.link.shapes
        if shape.kind == "box" and shape.size.min() > _PLATE
    ]
    if not boxes:
        return None, ["the size of the body is missing"]
    placed, shape = max(boxes, key=lambda each: float(np.prod(each[1].size)))
    place = T_robot_body @ placed.T_body_link @ shape.T_link_shape
    size = np.abs(place[:3, :3]) @ shape.size
    away = float(np.linalg.norm(place[:3, 3]))
    if away < 1e-6:
        return _lengths(size), []
    return _lengths(size), [
        f"the box of the body is {1000 * away:.1f} mm off its origin; in a robot file it is centred there"
    ]


def _remarks(tree: Tree, legs: list[FittedLeg], feet: list[Foot], names: tuple[str, ...], forward: str) -> list[str]:
    """Return remarks on legs (equal ones together), joints without a place in robot files, servos, and names."""
    by_text: dict[str, list[str]] = {}
    for leg, foot, name in zip(legs, feet, names, strict=True):
        radius = [] if foot.radius else ["the radius of the foot is missing"]
        for text in (*leg.remarks, *radius):
            by_text.setdefault(text, []).append(name)
    lines = [f"{'all legs' if len(of) == len(legs) else ', '.join(of)}: {text}" for text, of in by_text.items()]
    held = [name for chain in tree.legs for name in chain.held]
    if held:
        lines.append(f"joints beyond the third of a leg, held at zero: {', '.join(held)}")
    if tree.ignored:
        lines.append(f"joints that belong to no leg, held at zero: {', '.join(tree.ignored)}")
    mimics = [joint.name for chain in tree.legs for joint in chain.joints if joint.mimics]
    if mimics:
        lines.append(f"joints that follow others in the file, and are free here: {', '.join(mimics)}")
    efforts = _servo_figures(tree)
    lines.append(f"servos are missing{f'; {efforts}' if efforts else ''}")
    lines += _contradictions(legs, names, forward)
    return lines


def _servo_figures(tree: Tree) -> str:
    """Return the torques and speeds of the file, which may be those of its servos, where all legs agree."""
    figures = []
    for number, joint in enumerate(JOINTS):
        found = {(chain.joints[number].effort, chain.joints[number].speed) for chain in tree.legs}
        if len(found) == 1:
            effort, speed = found.pop()
            if effort and speed:
                figures.append(f"{joint} {effort:g} N m, {speed:.3g} rad/s")
    return f"limits of the file: {'; '.join(figures)}" if figures else ""


def _contradictions(legs: list[FittedLeg], names: tuple[str, ...], forward: str) -> list[str]:
    """Return a remark where names of joints say that another direction is forward."""
    wrong = []
    for leg, name in zip(legs, names, strict=True):
        words = " ".join(leg.joints).replace("_", " ")
        side, end = (in_words(words) or _in_codes(words, marks) for in_words, marks in _MARKS)
        if side * side_in_name(name) < 0 or end * end_in_name(name) < 0:
            wrong.append(f"{leg.joints[0]!r} is the {name} leg")
    if not wrong:
        return []
    return [f"names of joints contradict {forward} as forward: {', '.join(wrong)}; try another --forward"]


def _in_codes(words: str, marks: str) -> int:
    """Return 1 where codes such as LF or R2 have the first letter of `marks`, -1 where they have another, else 0."""
    codes = re.findall(r"\b(?:[lr][fmbh\d]|[fmbh][lr])\b", words.lower())
    found = {sign for code in codes for mark, sign in ((marks[0], 1), (marks[1:], -1)) if set(code) & set(mark)}
    return found.pop() if len(found) == 1 else 0


# Words and letters for left and right, and for front and rear.
_MARKS = ((side_in_name, "lr"), (end_in_name, "fbh"))


def _deviation(
    robot: Robot,
    chains: list[Chain],
    feet: list[Foot],
    signs: Float[np.ndarray, "legs 3"],
    zeros: Float[np.ndarray, "legs 3"],
    T_robot_body: Float[np.ndarray, "4 4"],
) -> float:
    """Return the greatest distance between the foot points of robot and file at random poses [m]."""
    limits = np.asarray(robot.limits)
    random = np.random.default_rng(_SEED).random((_SAMPLES, robot.legs, 3))
    angles = limits[..., 0] + random * (limits[..., 1] - limits[..., 0])
    points = np.asarray(forward_kinematics(robot, angles))[:, :, 3]
    worst = 0.0
    for leg, (chain, foot) in enumerate(zip(chains, feet, strict=True)):
        given = (angles[:, leg] - zeros[leg]) * signs[leg]
        for sample, point in zip(given, points[:, leg], strict=True):
            there = T_robot_body @ _moved(chain, foot, sample)
            worst = max(worst, float(np.linalg.norm(there[:3] - point)))
    return worst


def _moved(chain: Chain, foot: Foot, angles: Float[np.ndarray, "3"]) -> Float[np.ndarray, "4"]:
    """Return the foot point of the file for its joint angles, in the frame of the body's link."""
    point = np.append(foot.point, 1.0)
    for joint, part, angle in reversed(list(zip(chain.joints, chain.parts, angles.tolist(), strict=True))):
        place = part.links[0].T_body_link
        turned = np.eye(4)
        turned[:3, :3] = rotation_about(joint.axis, np.array(angle))
        point = place @ turned @ np.linalg.inv(place) @ point
    return point
