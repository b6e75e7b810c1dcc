"""Loads of a robot with other servos, another payload or other link lengths."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError, MissingDataError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.load.loads import JointLoads, joint_loads
from tarsus.load.payload import Payload
from tarsus.load.verdict import SAFETY_FACTOR, Rule, joint_verdicts, require_rule
from tarsus.robot.robot import JOINTS, Robot
from tarsus.robot.servo import Servo

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["largest_payload", "length_sensitivity", "why_masses_stay", "with_lengths", "with_servos"]

_HEAVIEST_PAYLOAD = 1e3  # [kg]
_PAYLOAD_TOLERANCE = 1e-4  # [kg]
_BODY = -1


def with_servos(robot: Robot, servos: Mapping[str, Servo]) -> Robot:
    """Return the robot with other servos, their masses replacing those of the old ones.

    The servo of a joint is assumed to sit in the part on the joint's inner side (body, coxa, femur) if that part is
    heavy enough, else in the part on its outer side. The centres of mass of the links stay. If servo masses can't be
    separated from those of the parts, all masses stay: `why_masses_stay`.

    Parameters
    ----------
    robot : Robot
        A single robot; its masses must be known.
    servos : mapping
        Servo by joint name (``"coxa"``, ``"femur"``, ``"tibia"``); joints not given keep their servo.

    Raises
    ------
    MissingDataError
        If the masses of the robot, or of a new servo, are unknown.
    InputError
        If a joint name is unknown.
    """
    robot.require_masses()
    for name, servo in servos.items():
        if name not in JOINTS:
            raise InputError(f"unknown joint {name!r}; the joints are {', '.join(JOINTS)}")
        if servo.mass is None:
            raise MissingDataError(f"the mass of servo {servo.name} is unknown; set its mass_g")
    rows = tuple(tuple(servos.get(n, s) for n, s in zip(JOINTS, leg, strict=True)) for leg in robot.servos)
    if why_masses_stay(robot) is not None:
        return robot.replace(servos=rows)
    body, links = float(np.asarray(robot.body_mass)), np.array(robot.link_mass)
    for leg, parts in enumerate(_servo_parts(robot)):
        for joint, part in enumerate(parts):
            new, old = rows[leg][joint], robot.servos[leg][joint]
            change = _mass(new) - _mass(old)
            if part == _BODY:
                body += change
            else:
                links[leg, part] = max(0.0, links[leg, part] + change)  # rounding must not make a mass negative
    return robot.replace(body_mass=body, link_mass=links, servos=rows)


def why_masses_stay(robot: Robot) -> str | None:
    """Return why servo masses can't be separated from a robot's part masses, or None if they can.

    Parameters
    ----------
    robot : Robot
        A single robot; its masses must be known.
    """
    for leg, row in enumerate(robot.servos):
        for joint, servo in enumerate(row):
            if servo is None:
                return f"the robot file names no servo for the {JOINTS[joint]} of {robot.leg_codes[leg]}"
            if servo.mass is None:
                return f"the mass of the current servo {servo.name} is unknown (mass_g)"
    for leg, parts in enumerate(_servo_parts(robot)):
        if len(parts) < len(JOINTS):
            return f"leg {robot.leg_codes[leg]} is lighter than its current servos"
    return None


def _servo_parts(robot: Robot) -> list[list[int]]:
    """Return for each leg the part that holds each joint's servo; fewer than three if the parts are too light."""
    assignment = []
    for leg, row in enumerate(robot.servos):
        free = [float(np.asarray(robot.body_mass)) / robot.legs, *np.asarray(robot.link_mass)[leg].tolist()]
        parts = []
        for joint, servo in enumerate(row):
            part = next((part for part in (joint, joint + 1) if free[part] >= _mass(servo)), None)
            if part is None:
                break
            free[part] -= _mass(servo)
            parts.append(part - 1)
        assignment.append(parts)
    return assignment


def _mass(servo: Servo | None) -> float:
    return 0.0 if servo is None or servo.mass is None else servo.mass


def largest_payload(
    base: JointLoads,
    *,
    safety_factor: float = SAFETY_FACTOR,
    rule: Rule = "factor",
    friction: Float[np.ndarray, "n legs 3"] | None = None,
) -> float:
    """Return the heaviest payload that the robot's servos carry through the same motion.

    Parameters
    ----------
    base : JointLoads
        The current loads; a heavier payload is placed where theirs is. Joint speeds are not considered.
    safety_factor : float
        Required stall torque over peak torque.
    rule : {"factor", "continuous"}
        Sizing rule, as for `size_servos`.
    friction : array, shape (n, legs, 3), optional
        Torques that friction between the feet adds, in proportion to the weight [N m].

    Returns
    -------
    float
        Mass [kg], to 0.1 g, at most 1000; 0 if not even the robot alone is carried, or it tips.

    Raises
    ------
    MissingDataError
        If a servo is unknown.
    InputError
        If the factor is not positive and finite.
    UnknownNameError
        If the rule is unknown.
    """
    require_rule(rule)
    if np.isnan(base.stall_torque).any():
        raise MissingDataError(
            f"robot {base.robot.name!r}: the largest payload depends on the torque of its servos, unknown for some"
        )

    def carried(mass: float) -> bool:
        loads = joint_loads(base.robot, base.motion, payload=Payload(mass, base.payload.position), **base.conditions)
        if friction is not None:
            loads = replace(loads, torques=loads.torques + friction * (loads.weight / base.weight))
        verdicts = joint_verdicts(loads, safety_factor=safety_factor)
        return loads.balanced and all(verdict.satisfies(rule) for verdict in verdicts)

    if not carried(0.0):
        return 0.0
    low, high = 0.0, 0.5
    while high < _HEAVIEST_PAYLOAD and carried(high):
        low, high = high, min(2 * high, _HEAVIEST_PAYLOAD)
    while high - low > _PAYLOAD_TOLERANCE:
        middle = (low + high) / 2
        low, high = (middle, high) if carried(middle) else (low, middle)
    return low


def with_lengths(robot: Robot, **lengths: float) -> Robot:
    """Return the robot with link lengths scaled; each link keeps its mass, and its centre of mass scales along.

    Parameters
    ----------
    robot : Robot
        The robot.
    **lengths : float
        Scale factors by link, such as ``femur=1.1``.

    Raises
    ------
    InputError
        If a link name is unknown.
    """
    changes: dict[str, Any] = {}
    com = np.array(robot.link_com)
    for name, factor in lengths.items():
        if name not in JOINTS:
            raise InputError(f"unknown link {name!r}; the links are {', '.join(JOINTS)}")
        changes[name] = np.asarray(getattr(robot, name)) * factor
        com[..., JOINTS.index(name)] *= factor
    return robot.replace(link_com=com, **changes)


def length_sensitivity(base: JointLoads, *, step: float = 0.01) -> dict[str, Float[np.ndarray, "... 3"]]:
    """Return the derivative of the peak torques with respect to each link length, for fixed feet and body poses.

    Central differences over two computations of the whole motion with the same footholds and body poses.

    Parameters
    ----------
    base : JointLoads
        The current loads.
    step : float
        Relative change of length.

    Returns
    -------
    dict
        By link, ``(3,)``: change of the largest peak torque of coxa, femur and tibia with the link's length [N m/m].
        NaN if a foot is out of reach with the changed link, or the link has no length.
    """
    sensitivity = {}
    for link in JOINTS:
        length = float(np.mean(np.asarray(getattr(base.robot, link))))
        shorter, longer = (_peak_with(base, link, factor) for factor in (1 - step, 1 + step))
        sensitivity[link] = (longer - shorter) / (2 * step * length) if length else np.full(3, np.nan)
    return sensitivity


def _peak_with(base: JointLoads, link: str, factor: float) -> Float[np.ndarray, "... 3"]:
    """Return the largest peak torques of coxa, femur and tibia with one link scaled."""
    motion, changed = base.motion, with_lengths(base.robot, **{link: factor})
    solution = inverse_kinematics(changed, motion.feet, motion.body)
    if not bool(np.all(solution.ok)):
        return np.full(3, np.nan)
    moved = replace(motion, robot=changed, angles=solution.angles, reach=solution.reach)
    return np.asarray(joint_loads(changed, moved, payload=base.payload, **base.conditions).peak.max(0))
