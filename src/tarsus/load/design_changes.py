"""Putting other servos, a payload or other link lengths into a robot, and working its loads out anew."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from tarsus.errors import InputError, MissingDataError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.load.loads import JointLoads, joint_loads
from tarsus.load.payload import Payload
from tarsus.load.verdict import SAFETY_FACTOR, Rule, joint_verdicts, require_rule
from tarsus.robot.robot import JOINTS, Robot
from tarsus.robot.servo import Servo

__all__ = ["largest_payload", "length_sensitivity", "why_masses_stay", "with_lengths", "with_servos"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

_HEAVIEST = 1e3
_TO_THE_GRAM = 1e-4
_BODY = -1


def with_servos(robot: Robot, servos: Mapping[str, Servo]) -> Robot:
    """Return the robot with other servos, their masses in the place of the old ones'.

    A joint's servo is taken to sit in the part inside of the joint (body, coxa, femur) if that weighs as much, else in
    the part outside; where a link's centre of mass is stays. Where that can't be told, all masses stay as they are:
    `why_masses_stay`.

    Parameters
    ----------
    robot : Robot
        A single robot; its masses must be known.
    servos : mapping
        Servos by the name of the joint, ``"coxa"``, ``"femur"``, ``"tibia"``; a joint left out keeps its own.

    Raises
    ------
    MissingDataError
        If the masses of the robot, or of a new servo, are unknown.
    InputError
        If there is no such joint.
    """
    robot.require_masses()
    for name, servo in servos.items():
        if name not in JOINTS:
            raise InputError(f"there is no joint {name!r}; there are {', '.join(JOINTS)}")
        if servo.mass is None:
            raise MissingDataError(f"the mass of {servo.name} is unknown; give its mass_g")
    rows = tuple(tuple(servos.get(n, s) for n, s in zip(JOINTS, leg, strict=True)) for leg in robot.servos)
    if why_masses_stay(robot) is not None:
        return robot.replace(servos=rows)
    body, links = float(robot.body_mass), np.array(robot.link_mass)
    for leg, places in enumerate(_places(robot)):
        for joint, part in enumerate(places):
            new, old = rows[leg][joint], robot.servos[leg][joint]
            change = _mass(new) - _mass(old)
            if part == _BODY:
                body += change
            else:
                links[leg, part] = max(0.0, links[leg, part] + change)  # rounding must not make a mass negative
    return robot.replace(body_mass=body, link_mass=links, servos=rows)


def why_masses_stay(robot: Robot) -> str | None:
    """Say why the masses of a robot can't be told apart from those of its servos; None where they can.

    Parameters
    ----------
    robot : Robot
        A single robot; its masses must be known.
    """
    for leg, row in enumerate(robot.servos):
        for joint, servo in enumerate(row):
            if servo is None:
                return f"no servo is named for the {JOINTS[joint]} of {robot.leg_codes[leg]}"
            if servo.mass is None:
                return f"the mass of the present servo {servo.name} is unknown (mass_g)"
    for leg, places in enumerate(_places(robot)):
        if len(places) < len(JOINTS):
            return f"leg {robot.leg_codes[leg]} weighs less than its present servos"
    return None


def _places(robot: Robot) -> list[list[int]]:
    """Return for each leg in which part each joint's servo sits; fewer than three where they find no place."""
    found = []
    for leg, row in enumerate(robot.servos):
        free = [float(robot.body_mass) / robot.legs, *np.asarray(robot.link_mass)[leg].tolist()]
        places = []
        for joint, servo in enumerate(row):
            part = next((part for part in (joint, joint + 1) if free[part] >= _mass(servo)), None)
            if part is None:
                break
            free[part] -= _mass(servo)
            places.append(part - 1)
        found.append(places)
    return found


def _mass(servo: Servo | None) -> float:
    return 0.0 if servo is None or servo.mass is None else servo.mass


def largest_payload(base: JointLoads, *, safety_factor: float = SAFETY_FACTOR, rule: Rule = "factor") -> float:
    """Return the heaviest payload that the present servos carry through the same motion.

    Parameters
    ----------
    base : Loads
        The loads as they are; a heavier payload is put where theirs is. Speeds don't count here.
    safety_factor : float
        What stall torque over peak torque must remain.
    rule : {"factor", "continuous"}
        What must be kept, as for `size_servos`.

    Returns
    -------
    float
        Mass [kg], to a tenth of a gram, at most 1000; 0 where not even the bare robot is carried, or kept in balance.

    Raises
    ------
    MissingDataError
        If a servo is unknown.
    InputError
        If the factor is not positive and finite, or there is no such rule.
    """
    require_rule(rule)
    if np.isnan(base.stall_torque).any():
        raise MissingDataError(
            f"robot {base.robot.name!r}: its payload is limited by its servos, and the file names none for some joints"
        )

    def carried(mass: float) -> bool:
        found = joint_loads(base.robot, base.motion, payload=Payload(mass, base.payload.position), **base.conditions)
        verdicts = joint_verdicts(found, safety_factor=safety_factor)
        return found.balanced and all(verdict.keeps(rule) for verdict in verdicts)

    if not carried(0.0):
        return 0.0
    low, high = 0.0, 0.5
    while high < _HEAVIEST and carried(high):
        low, high = high, min(2 * high, _HEAVIEST)
    while high - low > _TO_THE_GRAM:
        middle = (low + high) / 2
        low, high = (middle, high) if carried(middle) else (low, middle)
    return low


def with_lengths(robot: Robot, **lengths: float) -> Robot:
    """Return the robot with links longer or shorter by a factor; each link keeps its mass, its centre in proportion.

    Parameters
    ----------
    robot : Robot
        The robot.
    **lengths : float
        Factors by link: ``femur=1.1``.

    Raises
    ------
    InputError
        If there is no such link.
    """
    changes: dict[str, Any] = {}
    com = np.array(robot.link_com)
    for name, factor in lengths.items():
        if name not in JOINTS:
            raise InputError(f"there is no link {name!r}; there are {', '.join(JOINTS)}")
        changes[name] = np.asarray(getattr(robot, name)) * factor
        com[..., JOINTS.index(name)] *= factor
    return robot.replace(link_com=com, **changes)


def length_sensitivity(base: JointLoads, *, step: float = 0.01) -> dict[str, Floats]:
    """Return how each joint kind's peak torque changes with the length of each link, feet and body where they are.

    Central differences over two calculations of the whole motion with the same footholds and the same body.

    Parameters
    ----------
    base : Loads
        The loads as they are.
    step : float
        Change of length, as a share.

    Returns
    -------
    dict
        By link, ``(3,)``: change of the peak torque of coxa, femur and tibia, of the leg that bears most, with the
        link's length [N m/m]. NaN where a foot can't be reached with the changed link, or the link has no length.
    """
    found = {}
    for link in JOINTS:
        length = float(np.mean(np.asarray(getattr(base.robot, link))))
        less, more = (_peak_with(base, link, factor) for factor in (1 - step, 1 + step))
        found[link] = (more - less) / (2 * step * length) if length else np.full(3, np.nan)
    return found


def _peak_with(base: JointLoads, link: str, factor: float) -> Floats:
    """Return the peak torques of the joint kinds with one link longer by a factor."""
    motion, changed = base.motion, with_lengths(base.robot, **{link: factor})
    solution = inverse_kinematics(changed, motion.feet, motion.body)
    if not bool(np.all(solution.ok)):
        return np.full(3, np.nan)
    moved = replace(motion, robot=changed, angles=solution.angles, reach=solution.reach)
    return np.asarray(joint_loads(changed, moved, payload=base.payload, **base.conditions).peak.max(0))
