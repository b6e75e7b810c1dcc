"""Which servos carry a robot: a verdict on those it has, and the catalogue's that would do."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from tarsus.kinematics.mass import total_mass
from tarsus.load.design_changes import largest_payload, length_sensitivity, why_masses_stay, with_servos
from tarsus.load.loads import JointLoads, joint_loads
from tarsus.load.verdict import (
    BURNS_BELOW,
    SAFETY_FACTOR,
    JointVerdict,
    Rule,
    joint_verdicts,
    require_rule,
)
from tarsus.robot.catalogue import servo_catalogue
from tarsus.robot.robot import JOINTS, Robot
from tarsus.robot.servo import Servo

__all__ = ["Candidate", "ServoSizing", "size_servos"]


_COXA_CAUTION = (
    "the coxa joints bear no friction between the feet, no slope and no obstacle: their servos may well need more"
)


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """Servos that would carry the robot, their own masses counted.

    Attributes
    ----------
    servos : mapping
        Servo by joint: the same for all three, or chosen for each.
    factor : float
        Least stall torque over peak torque of all joints.
    thermal_ratio : float
        Largest lasting load of all joints, over 1/5 of the stall torque.
    servo_mass : float
        What all its servos weigh together [kg].
    robot_mass : float
        What the robot then weighs, payload apart [kg].
    """

    servos: Mapping[str, Servo]
    factor: float
    thermal_ratio: float
    servo_mass: float
    robot_mass: float

    @property
    def name(self) -> str:
        """The servo's name, or those of coxa, femur and tibia."""
        names = [self.servos[joint].name for joint in JOINTS]
        return names[0] if len(set(names)) == 1 else " / ".join(names)


@dataclass(frozen=True, kw_only=True)
class ServoSizing:
    """Which servos carry a robot through a motion.

    Attributes
    ----------
    verdicts : tuple of JointVerdict
        On the servos that it has, leg by leg.
    candidates : tuple of Candidate
        Servos of the catalogue that would do in all joints, the lightest first.
    mixed : Candidate or None
        The lightest servo for each kind of joint, settled with their masses; None where there is none.
    left_out : mapping
        Servos of the catalogue that could not be tried, and why.
    payload : float or None
        Heaviest payload that the present servos carry and keep the rule [kg]; None where one is unknown.
    utmost_payload : float or None
        Heaviest payload at which they neither stall nor burn: factor 1.5 [kg]; None where one is unknown.
    sensitivity : mapping
        By link, change of the peak torque of coxa, femur and tibia with its length [N m/m]: `length_sensitivity`.
    safety_factor : float
        Stall torque over peak torque that is asked for.
    rule : str
        ``"factor"``, or ``"continuous"`` for the maker's rule.
    assumed : tuple of str
        What was not given and had to be assumed.
    """

    verdicts: tuple[JointVerdict, ...]
    candidates: tuple[Candidate, ...]
    mixed: Candidate | None
    left_out: Mapping[str, str]
    payload: float | None
    utmost_payload: float | None
    sensitivity: Mapping[str, np.ndarray[Any, Any]]
    safety_factor: float
    rule: Rule
    assumed: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether the servos that the robot has do."""
        return all(verdict.does(self.rule) for verdict in self.verdicts)

    @property
    def worst(self) -> JointVerdict:
        """The joint with the least stall torque over peak torque; joints without a servo come first."""
        return min(self.verdicts, key=lambda v: -math.inf if math.isnan(v.factor) else v.factor)


def size_servos(
    robot: Robot, joint_loads: JointLoads, *, safety_factor: float = SAFETY_FACTOR, rule: Rule = "factor"
) -> ServoSizing:
    """Judge a robot's servos, and find those of the catalogue that would do.

    Parameters
    ----------
    robot : Robot
        A single robot with masses; its servos are those judged.
    loads : Loads
        What the joints bear in the motion that counts; worked out anew where it is of another robot.
    safety_factor : float
        Stall torque over peak torque that is asked for; 3 is source 004's.
    rule : {"factor", "continuous"}
        What a servo must keep: the safety factor, or the maker's rule of a lasting load of at most 1/5 of its stall
        torque, its peaks below the stall torque. Fast enough it must be in either case.

    Raises
    ------
    InputError
        If the factor is not positive and finite.
    UnknownNameError
        If there is no such rule.
    MissingDataError
        If the robot's masses are unknown.
    """
    require_rule(rule)
    robot.require_masses()
    base = joint_loads if joint_loads.robot == robot else _again(joint_loads, robot)
    judge = _Judge(base, safety_factor, rule)
    verdicts = joint_verdicts(base, safety_factor=safety_factor)
    candidates, left_out = judge.candidates()
    known = all(verdict.servo is not None for verdict in verdicts)
    return ServoSizing(
        verdicts=verdicts,
        candidates=candidates,
        mixed=judge.mixed(left_out),
        left_out=left_out,
        payload=largest_payload(base, safety_factor=safety_factor, rule=rule) if known else None,
        utmost_payload=largest_payload(base, safety_factor=BURNS_BELOW) if known else None,
        sensitivity=length_sensitivity(base),
        safety_factor=safety_factor,
        rule=rule,
        assumed=(*base.assumed, _COXA_CAUTION, _where_servos_sit(robot)),
    )


def _again(base: JointLoads, robot: Robot) -> JointLoads:
    return joint_loads(robot, base.motion, payload=base.payload, **base.conditions)


def _where_servos_sit(robot: Robot) -> str:
    reason = why_masses_stay(robot)
    if reason is None:
        return "a servo sits in the part inside of its joint where that weighs as much, else in the part outside"
    return (
        f"{reason}: the masses in the robot file stay as they are whichever servo is tried, and hold for servos as "
        "heavy as those that the robot was weighed with"
    )


@dataclass(frozen=True)
class _Judge:
    """Tries servos in the robot, each time with its loads worked out anew."""

    base: JointLoads
    safety_factor: float
    rule: Rule

    def fit(self, servos: Mapping[str, Servo]) -> JointLoads:
        """Return the loads with other servos, their masses counted."""
        return _again(self.base, with_servos(self.base.robot, servos))

    def verdicts(self, found: JointLoads) -> tuple[JointVerdict, ...]:
        return joint_verdicts(found, safety_factor=self.safety_factor)

    def candidate(self, servos: Mapping[str, Servo], found: JointLoads) -> Candidate:
        verdicts = self.verdicts(found)
        return Candidate(
            servos=MappingProxyType(dict(servos)),
            factor=min(v.factor for v in verdicts),
            thermal_ratio=max(v.thermal_ratio for v in verdicts),
            servo_mass=sum(found.robot.legs * (servos[joint].mass or 0.0) for joint in JOINTS),
            robot_mass=float(total_mass(found.robot)),
        )

    def lacking(self, found: JointLoads) -> set[str]:
        """Return the kinds of joint of which some don't do."""
        return {verdict.joint for verdict in self.verdicts(found) if not verdict.does(self.rule)}

    def candidates(self) -> tuple[tuple[Candidate, ...], dict[str, str]]:
        """Try each servo of the catalogue in all joints."""
        fit, left_out = [], {}
        for name, servo in servo_catalogue().items():
            reason = self._why_not_tried(servo)
            if reason is not None:
                left_out[name] = reason
                continue
            alike = dict.fromkeys(JOINTS, servo)
            found = self.fit(alike)
            if not self.lacking(found):
                fit.append(self.candidate(alike, found))
        return tuple(sorted(fit, key=lambda c: (c.servo_mass, c.name))), left_out

    def _why_not_tried(self, servo: Servo) -> str | None:
        volts = self.base.supply
        if servo.no_load_speed is None:
            return "its speed is unknown"
        if servo.mass is None:
            return "its mass is unknown"
        if volts is not None and servo.supply is not None and not servo.supply[0] <= volts <= servo.supply[1]:
            return f"it is made for {servo.supply[0]:g} to {servo.supply[1]:g} V, the supply is {volts:g} V"
        return None

    def mixed(self, left_out: Mapping[str, str]) -> Candidate | None:
        """Choose the lightest servo for each kind of joint.

        All joints begin with the lightest of all. Whatever doesn't do is exchanged for the next heavier that does
        with the loads as they then are, and the loads are worked out anew, until all do: as heavier servos only add to
        the loads, none is heavier than it must be.
        """
        by_mass = sorted((s for name, s in servo_catalogue().items() if name not in left_out), key=_lighter_first)
        chosen = {joint: iter(by_mass) for joint in JOINTS}
        servos = {joint: next(rest, None) for joint, rest in chosen.items()}
        while None not in servos.values():
            fitted = {joint: servo for joint, servo in servos.items() if servo is not None}
            found = self.fit(fitted)
            lacking = self.lacking(found)
            if not lacking:
                return self.candidate(fitted, found)
            for joint in lacking:
                servos[joint] = next(
                    (s for s in chosen[joint] if joint not in self.lacking(_judged_with(found, s))), None
                )
        return None


def _judged_with(found: JointLoads, servo: Servo) -> JointLoads:
    """Return the same loads on another servo, its mass not counted."""
    return replace(found, robot=found.robot.replace(servos=((servo,) * len(JOINTS),) * found.robot.legs))


def _lighter_first(servo: Servo) -> tuple[float, str]:
    return servo.mass or 0.0, servo.name
