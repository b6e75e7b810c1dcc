"""A leg of a URDF file in the frames of robot files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.errors import InputError
from tarsus.robot.robot import JOINTS
from tarsus.urdf.foot import Foot
from tarsus.urdf.tree import Chain, Part

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["FittedLeg", "fitted_leg", "mass_of"]

# Greatest angle between a joint's axis and its direction in the model [rad]; beyond it, the leg is of another kind.
_MOST_TILTED = math.radians(20)
# Angle and length above which a deviation is worth a remark [rad, m]; shorter lengths count as 0.
_ANGLE, _LENGTH = math.radians(0.01), 1e-4
_HALF_TURN = math.pi


class FittedLeg(NamedTuple):
    """A leg as a robot file has it.

    Attributes
    ----------
    mount : array, shape (3,)
        Position of the coxa axis in B [m].
    yaw : float
        Direction of the leg about z at zero [rad].
    lengths : array, shape (3,)
        Lengths of coxa, femur and tibia [m].
    offset : array, shape (2,)
        Offset of the femur axis, sideways and vertical [m].
    limits : array, shape (3, 2)
        Limits of the joints [rad].
    masses : array, shape (3,), or None
        Masses of the links [kg]; None where one is unknown.
    centres : array, shape (3,)
        Distances of the centres of mass from the inner joints, along the links [m].
    foot_radius : float
        Radius of the foot's ball; 0 where it is unknown [m].
    joints : tuple of str
        Names of the joints in the file.
    signs, zeros : array, shape (3,)
        The joint angle of the robot file is ``sign * angle in the file + zero`` [rad].
    remarks : tuple of str
        What is missing, and what does not fit the model.
    """

    mount: Float[np.ndarray, "3"]
    yaw: float
    lengths: Float[np.ndarray, "3"]
    offset: Float[np.ndarray, "2"]
    limits: Float[np.ndarray, "3 2"]
    masses: Float[np.ndarray, "3"] | None
    centres: Float[np.ndarray, "3"]
    foot_radius: float
    joints: tuple[str, ...]
    signs: Float[np.ndarray, "3"]
    zeros: Float[np.ndarray, "3"]
    remarks: tuple[str, ...]


def axes_of(
    chain: Chain, T_robot_body: Float[np.ndarray, "4 4"]
) -> tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, "3 3"]]:
    """Return a point and the direction of each joint axis in B, ``(3, 3)`` each, with all joints at zero [m].

    Parameters
    ----------
    chain : Chain
        The leg.
    T_robot_body : array, shape (4, 4)
        Place of the body's link in B.
    """
    places = [T_robot_body @ part.links[0].T_body_link for part in chain.parts]
    points = np.array([place[:3, 3] for place in places])
    directions = [place[:3, :3] @ joint.axis for place, joint in zip(places, chain.joints, strict=True)]
    return points, np.array(directions)


def fitted_leg(
    chain: Chain, foot: Foot, T_robot_body: Float[np.ndarray, "4 4"], middle: Float[np.ndarray, "3"]
) -> FittedLeg:
    """Return a leg in the frames of robot files.

    Parameters
    ----------
    chain : Chain
        The leg.
    foot : Foot
        Its foot.
    T_robot_body : array, shape (4, 4)
        Place of the body's link in B.
    middle : array, shape (3,)
        Mean of the coxa joints' positions in B [m]: legs point away from it.

    Raises
    ------
    InputError
        If its axes are not those of coxa, femur and tibia, or femur or tibia has no length.
    """
    points, directions = axes_of(chain, T_robot_body)
    tip = T_robot_body[:3, :3] @ foot.point + T_robot_body[:3, 3]
    up = np.array([0.0, 0.0, 1.0])
    remarks = [_tilted(chain, 0, directions[0], up, "the coxa axis", "the vertical")]
    across = directions[1] - (directions[1] @ up) * up
    remarks.append(_tilted(chain, 1, directions[1], across, "the femur axis", "the horizontal"))
    across /= np.linalg.norm(across)
    remarks.append(_tilted(chain, 2, directions[2], across, "the tibia axis", "the femur axis"))
    outward = np.cross(across, up)
    # The leg points from the coxa axis to the foot; with the foot on that axis, away from the middle of the robot.
    reach = (tip - points[0]) @ outward
    if abs(reach) < _LENGTH:
        reach = (points[0] - middle) @ outward
    outward = outward if reach >= 0 else -outward
    left = np.cross(up, outward)
    frame = np.array([outward, left, up])
    (axis, knee, end), origin = (frame @ (at - points[0]) for at in (points[1], points[2], tip)), points[0]
    femur, tibia = knee - axis, end - knee
    lengths = np.array([axis[0], math.hypot(femur[0], femur[2]), math.hypot(tibia[0], tibia[2])])
    for joint in (1, 2):
        if lengths[joint] < _LENGTH:
            raise InputError(f"the {JOINTS[joint]} of joint {chain.joints[joint].name!r} has no length")
    femur_zero = math.atan2(femur[2], femur[0])
    tibia_zero = _wrapped(math.atan2(tibia[2], tibia[0]) - femur_zero)
    zeros = np.array([0.0, femur_zero, tibia_zero])
    signs = np.sign([directions[0] @ up, -directions[1] @ left, -directions[2] @ left])
    remarks += [
        _beside(abs(point[1] - end[1]), what)
        for point, what in ((axis, "the origin of the femur joint"), (knee, "the knee"))
    ]
    limits, said = _limits(chain, signs, zeros)
    steps = (np.array([axis[0], end[1], axis[2]]), femur, tibia)
    places = (points[0], points[1], points[2])
    centres, off_line = zip(
        *(
            _centre(part, T_robot_body, frame, place, step, JOINTS[joint])
            for joint, (part, place, step) in enumerate(zip(chain.parts, places, steps, strict=True))
        ),
        strict=True,
    )
    masses = [mass_of(part) for part in chain.parts]
    known = all(mass is not None for mass in masses)
    return FittedLeg(
        mount=origin,
        yaw=math.atan2(outward[1], outward[0]),
        lengths=lengths,
        offset=np.array([end[1], axis[2]]),
        limits=limits,
        masses=np.array(masses) if known else None,
        centres=np.array(centres),
        foot_radius=foot.radius,
        joints=tuple(joint.name for joint in chain.joints),
        signs=signs,
        zeros=zeros,
        remarks=tuple(line for line in (*remarks, *said, *off_line) if line),
    )


def mass_of(part: Part) -> float | None:
    """Return the mass of links that are fixed to one another, or None if no link has one.

    Parameters
    ----------
    part : Part
        The links.
    """
    masses = [placed.link.mass for placed in part.links if placed.link.mass is not None]
    return sum(masses) if masses else None


def _tilted(
    chain: Chain, joint: int, direction: Float[np.ndarray, "3"], wanted: Float[np.ndarray, "3"], axis: str, of: str
) -> str:
    """Return a remark on an axis that is inclined to its direction in the model; empty if it is not."""
    length = float(np.linalg.norm(wanted))
    along = abs(float(direction @ wanted)) / length if length else 0.0
    angle = math.acos(min(1.0, along))
    name = chain.joints[joint].name
    if angle > _MOST_TILTED:
        raise InputError(
            f"joint {name!r}: {axis} is inclined by {math.degrees(angle):.1f} deg to {of}; legs have a vertical coxa "
            f"axis and parallel, level axes of femur and tibia, within {math.degrees(_MOST_TILTED):g} deg"
        )
    return f"{axis} is inclined by {math.degrees(angle):.2f} deg to {of}" if angle > _ANGLE else ""


def _beside(distance: float, what: str) -> str:
    """Return a remark on a joint's origin beside the leg's plane, which only pictures show; empty if it is within."""
    return f"{what} lies {1000 * distance:.1f} mm beside the plane of the foot" if distance > _LENGTH else ""


def _limits(
    chain: Chain, signs: Float[np.ndarray, "3"], zeros: Float[np.ndarray, "3"]
) -> tuple[Float[np.ndarray, "3 2"], list[str]]:
    """Return the limits in the angles of robot files, and remarks."""
    found, said = np.empty((3, 2)), []
    for joint, (sign, zero) in enumerate(zip(signs.tolist(), zeros.tolist(), strict=True)):
        given = chain.joints[joint].limits
        if given is None:
            found[joint] = -_HALF_TURN, _HALF_TURN
            said.append(f"the {JOINTS[joint]} has no limits: -180 to 180 deg assumed")
            continue
        low, high = sorted(sign * limit + zero for limit in given)
        # Whole turns change no pose; they are removed so that as little of the range as possible is beyond half a turn.
        turns = 2 * _HALF_TURN * round((low + high) / 2 / (2 * _HALF_TURN))
        low, high = low - turns, high - turns
        found[joint] = max(low, -_HALF_TURN), min(high, _HALF_TURN)
        if (low, high) != tuple(found[joint]):
            said.append(
                f"the limits of the {JOINTS[joint]}, {math.degrees(low):.1f} to {math.degrees(high):.1f} deg, are cut "
                "at 180 deg"
            )
    return found, said


def _centre(
    part: Part,
    T_robot_body: Float[np.ndarray, "4 4"],
    frame: Float[np.ndarray, "3 3"],
    place: Float[np.ndarray, "3"],
    step: Float[np.ndarray, "3"],
    name: str,
) -> tuple[float, str]:
    """Return the distance of a centre of mass along its link, and a remark where it lies beside the link."""
    length = float(np.linalg.norm(step))
    centre = centre_of(part)
    if centre is None or length < _LENGTH:
        return 0.0, ""
    at = frame @ (T_robot_body[:3, :3] @ centre + T_robot_body[:3, 3] - place)
    along = float(at @ step) / length
    beside = float(np.linalg.norm(at - along * step / length))
    remark = f"the centre of mass of the {name} lies {1000 * beside:.1f} mm beside its line"
    return along, remark if beside > _LENGTH else ""


def centre_of(part: Part) -> Float[np.ndarray, "3"] | None:
    """Return the centre of mass of links fixed to one another, in the frame of the body's link [m]; None without mass.

    Parameters
    ----------
    part : Part
        The links.
    """
    total, moment = mass_of(part), np.zeros(3)
    for placed in part.links:
        place = placed.T_body_link
        moment += (placed.link.mass or 0.0) * (place[:3, :3] @ placed.link.com + place[:3, 3])
    return moment / total if total else None


def _wrapped(angle: float) -> float:
    """Return an angle between -pi and pi."""
    return math.remainder(angle, 2 * math.pi)
