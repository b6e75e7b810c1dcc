"""Servo sizing: a verdict on the robot's servos, and suitable servos of the catalogue."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from tarsus.kinematics.mass import total_mass
from tarsus.load.compliant.decisive_loads import decisive_loads
from tarsus.load.compliant.result import CompliantLoads
from tarsus.load.design_changes import largest_payload, length_sensitivity, why_masses_stay, with_servos
from tarsus.load.loads import JointLoads, joint_loads
from tarsus.load.verdict import (
    BURNOUT_FACTOR,
    SAFETY_FACTOR,
    JointVerdict,
    Rule,
    joint_verdicts,
    require_rule,
    sufficient_joints,
)
from tarsus.representation import represented
from tarsus.robot.catalogue import servo_catalogue
from tarsus.robot.robot import JOINTS, Robot, require_robot
from tarsus.robot.servo import Servo

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Candidate", "ServoSizing", "size_servos"]

_COXA_CAUTION = (
    "friction between the feet, slopes and obstacles are not included: the coxa servos may need more torque than shown"
)
_SAME_FRICTION = (
    "other servos: what friction between the feet adds is that of the robot's own servos, in proportion to the weight"
)


@represented()
@dataclass(frozen=True, kw_only=True)
class Candidate:
    """Servos of the catalogue that carry the robot, with their own masses included.

    Attributes
    ----------
    servos : mapping
        Servo by joint: the same for all three, or one for each.
    factor : float
        Smallest stall torque over peak torque of all joints.
    thermal_ratio : float
        Largest root mean square torque over the continuous limit of all joints.
    servo_mass : float
        Mass of all servos [kg].
    robot_mass : float
        Mass of the robot with these servos, without payload [kg].
    bus : str
        Bus that all of the servos run on; of several, the names with commas between them.
    supply : float or None
        Supply voltage at which they suffice [V]; None if unknown.
    """

    servos: Mapping[str, Servo]
    factor: float
    thermal_ratio: float
    servo_mass: float
    robot_mass: float
    bus: str
    supply: float | None

    @property
    def name(self) -> str:
        """Name of the servo, or names of the coxa, femur and tibia servos."""
        names = [self.servos[joint].name for joint in JOINTS]
        return names[0] if len(set(names)) == 1 else " / ".join(names)


@represented("safety_factor", "rule", "payload", "maximum_payload", "candidates", "sets", "verdicts", "assumed")
@dataclass(frozen=True, kw_only=True)
class ServoSizing:
    """Result of sizing the servos of a robot for a motion.

    Attributes
    ----------
    verdicts : tuple of JointVerdict
        Verdicts on the robot's servos, leg by leg.
    candidates : tuple of Candidate
        Servos of the catalogue that suffice in all joints, the lightest first.
    sets : tuple of Candidate
        For each bus, the lightest sufficient servo for each of coxa, femur and tibia at one supply voltage, the
        lightest set first; without the sets of one servo that `candidates` contains.
    excluded : mapping
        Servos of the catalogue that could not be evaluated, and the reasons.
    payload : float or None
        Heaviest payload with which the robot's servos satisfy the rule [kg]; None if a servo is unknown.
    maximum_payload : float or None
        Heaviest payload at a safety factor of 1.5, below which servos stall or burn [kg]; None if a servo is unknown.
    sensitivity : mapping
        By link, change of the peak torque of coxa, femur and tibia with its length [N m/m]: `length_sensitivity`.
    safety_factor : float
        Required stall torque over peak torque.
    rule : str
        ``"factor"`` or ``"continuous"``, the continuous load limit of the manufacturer.
    assumed : tuple of str
        Assumptions made.
    """

    verdicts: tuple[JointVerdict, ...]
    candidates: tuple[Candidate, ...]
    sets: tuple[Candidate, ...]
    excluded: Mapping[str, str]
    payload: float | None
    maximum_payload: float | None
    sensitivity: Mapping[str, Float[np.ndarray, "... 3"]]
    safety_factor: float
    rule: Rule
    assumed: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether the robot's servos suffice."""
        return all(verdict.is_sufficient(self.rule) for verdict in self.verdicts)

    @property
    def mixed(self) -> Candidate | None:
        """The lightest of `sets`; None if there is none."""
        return self.sets[0] if self.sets else None

    @property
    def worst(self) -> JointVerdict:
        """The joint with the smallest safety factor; joints without a servo come first."""
        return min(self.verdicts, key=lambda v: -math.inf if math.isnan(v.factor) else v.factor)


def size_servos(
    robot: Robot,
    loads: JointLoads,
    *,
    safety_factor: float = SAFETY_FACTOR,
    rule: Rule = "factor",
    compliant: CompliantLoads | None = None,
) -> ServoSizing:
    """Judge a robot's servos, and find sufficient ones in the catalogue.

    Parameters
    ----------
    robot : Robot
        A single robot with masses; its servos are judged.
    loads : JointLoads
        Joint loads of the decisive motion; computed again if they are of another robot.
    safety_factor : float
        Required stall torque over peak torque; source 004 recommends 3.
    rule : {"factor", "continuous"}
        Sizing rule: the safety factor, or the manufacturer's continuous load limit (root mean square torque at most 1/5
        of the stall torque, peak torque below it). The servo must be fast enough in either case.
    compliant : CompliantLoads, optional
        Compliant statics of the same robot and motion. Each joint is sized by the higher of both loads; without it, the
        coxa servos are sized as if the feet did not press against each other.

    Raises
    ------
    InputError
        If the factor is not positive and finite.
    UnknownNameError
        If the rule is unknown.
    MissingDataError
        If the robot's masses are unknown.
    """
    require_robot(robot)
    require_rule(rule)
    robot.require_masses()
    base = loads if loads.robot == robot else _reloaded(loads, robot)
    decisive = decisive_loads(base, compliant)
    friction = decisive.torques - base.torques
    evaluation = _Evaluation(base, friction, safety_factor, rule)
    verdicts = joint_verdicts(decisive, safety_factor=safety_factor)
    candidates, excluded = evaluation.candidates()
    known = not np.isnan(base.stall_torque).any()
    return ServoSizing(
        verdicts=verdicts,
        candidates=candidates,
        sets=evaluation.sets(candidates, excluded),
        excluded=excluded,
        payload=largest_payload(base, safety_factor=safety_factor, rule=rule, friction=friction) if known else None,
        maximum_payload=largest_payload(base, safety_factor=BURNOUT_FACTOR, friction=friction) if known else None,
        sensitivity=length_sensitivity(base),
        safety_factor=safety_factor,
        rule=rule,
        assumed=(
            *decisive.assumed,
            _COXA_CAUTION if compliant is None else _SAME_FRICTION,
            _servo_placement(robot),
        ),
    )


def _reloaded(base: JointLoads, robot: Robot) -> JointLoads:
    return joint_loads(robot, base.motion, payload=base.payload, **base.conditions)


def _servo_placement(robot: Robot) -> str:
    reason = why_masses_stay(robot)
    if reason is None:
        return (
            "a servo is part of the link on the inner side of its joint if that is heavy enough, else of the outer link"
        )
    return f"{reason}: the masses of the robot file are used unchanged for every servo"


@dataclass(frozen=True)
class _Evaluation:
    """Evaluates servos in the robot, recomputing its loads with their masses; `friction` is added to the torques."""

    base: JointLoads
    friction: Float[np.ndarray, "n legs 3"]
    safety_factor: float
    rule: Rule

    def loads_for(self, servos: Mapping[str, Servo], supply: float | None) -> JointLoads:
        """Return the loads with other servos, their masses included."""
        conditions = {**self.base.conditions, "supply": supply}
        robot = with_servos(self.base.robot, servos)
        loads = joint_loads(robot, self.base.motion, payload=self.base.payload, **conditions)
        return replace(loads, torques=loads.torques + self.friction * (loads.weight / self.base.weight))

    def verdicts(self, loads: JointLoads) -> tuple[JointVerdict, ...]:
        return joint_verdicts(loads, safety_factor=self.safety_factor)

    def candidate(self, servos: Mapping[str, Servo], loads: JointLoads) -> Candidate:
        verdicts = self.verdicts(loads)
        return Candidate(
            servos=MappingProxyType(dict(servos)),
            factor=min(v.factor for v in verdicts),
            thermal_ratio=max(v.thermal_ratio for v in verdicts),
            servo_mass=sum(loads.robot.legs * (servos[joint].mass or 0.0) for joint in JOINTS),
            robot_mass=float(total_mass(loads.robot)),
            bus=", ".join(sorted(frozenset.intersection(*(servo.buses for servo in servos.values())))),
            supply=servos[JOINTS[0]].torque_at if loads.supply is None else loads.supply,
        )

    def insufficient(self, loads: JointLoads) -> set[str]:
        """Return the joints (coxa, femur, tibia) whose servo is insufficient in some leg."""
        sufficient = sufficient_joints(loads, safety_factor=self.safety_factor, rule=self.rule)
        return {JOINTS[joint] for joint in np.flatnonzero(~sufficient.all(axis=0)).tolist()}

    def candidates(self) -> tuple[tuple[Candidate, ...], dict[str, str]]:
        """Evaluate each servo of the catalogue in all joints; return the sufficient ones and the excluded ones."""
        suitable: list[Candidate] = []
        excluded: dict[str, str] = {}
        for name, servo in servo_catalogue().items():
            reason = self._exclusion_reason(servo)
            if reason is not None:
                excluded[name] = reason
                continue
            servos = dict.fromkeys(JOINTS, servo)
            loads = self.loads_for(servos, self.base.supply)
            if not self.insufficient(loads):
                suitable.append(self.candidate(servos, loads))
        return tuple(sorted(suitable, key=_candidate_order)), excluded

    def _exclusion_reason(self, servo: Servo) -> str | None:
        volts = self.base.supply
        if servo.no_load_speed is None:
            return "the no-load speed is unknown"
        if servo.mass is None:
            return "the mass is unknown"
        if volts is not None and servo.supply is not None and not servo.supply[0] <= volts <= servo.supply[1]:
            return f"the rated supply is {servo.supply[0]:g} to {servo.supply[1]:g} V, the supply is {volts:g} V"
        return None

    def sets(self, candidates: tuple[Candidate, ...], excluded: Mapping[str, str]) -> tuple[Candidate, ...]:
        """Return the lightest sufficient set of each bus; those of one servo only if `candidates` lacks it."""
        servos = sorted((s for name, s in servo_catalogue().items() if name not in excluded), key=_mass_order)
        uniform = {candidate.name for candidate in candidates}
        lightest = []
        for bus in sorted(frozenset[str]().union(*(servo.buses for servo in servos))):
            on_bus = [servo for servo in servos if bus in servo.buses]
            found = [self.set_at(supply, on_bus) for supply in self.supplies(on_bus)]
            best = min((each for each in found if each is not None), key=_candidate_order, default=None)
            if best is not None and best.name not in uniform:
                lightest.append(best)
        # Servos that run on two buses make the same set on both.
        return tuple(sorted({each.name: each for each in lightest}.values(), key=_candidate_order))

    def supplies(self, servos: list[Servo]) -> list[float]:
        """Return the supply voltages to evaluate: the one given, or those of the ratings."""
        if self.base.supply is not None:
            return [self.base.supply]
        return sorted({servo.torque_at for servo in servos if servo.torque_at is not None})

    def set_at(self, supply: float, servos: list[Servo]) -> Candidate | None:
        """Choose the lightest sufficient servo for each of coxa, femur and tibia at a supply voltage.

        All joints start with the lightest servo. An insufficient one is replaced by the next heavier one that suffices
        for the current loads, and the loads are recomputed, until all suffice. As heavier servos only increase the
        loads, no chosen servo is heavier than necessary.
        """
        usable = [s for s in servos if s.supply is None or s.supply[0] <= supply <= s.supply[1]]
        remaining = {joint: iter(usable) for joint in JOINTS}
        chosen = {joint: next(each, None) for joint, each in remaining.items()}
        while None not in chosen.values():
            fitted = {joint: servo for joint, servo in chosen.items() if servo is not None}
            loads = self.loads_for(fitted, supply)
            insufficient = self.insufficient(loads)
            if not insufficient:
                return self.candidate(fitted, loads)
            for joint in insufficient:
                chosen[joint] = next(
                    (s for s in remaining[joint] if joint not in self.insufficient(_with_servo(loads, s))), None
                )
        return None


def _candidate_order(candidate: Candidate) -> tuple[float, str]:
    return candidate.servo_mass, candidate.name


def _with_servo(loads: JointLoads, servo: Servo) -> JointLoads:
    """Return the same loads with another servo in all joints, its mass not included."""
    return replace(loads, robot=loads.robot.replace(servos=((servo,) * len(JOINTS),) * loads.robot.legs))


def _mass_order(servo: Servo) -> tuple[float, str]:
    return servo.mass or 0.0, servo.name
