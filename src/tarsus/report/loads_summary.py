"""Numbers of joint loads and servo sizing, as printed by `tarsus loads` and `tarsus servos`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tarsus.load.compliant.decisive_loads import decisive_loads
from tarsus.load.compliant.result import CompliantLoads
from tarsus.load.loads import JointLoads
from tarsus.load.sizing import Candidate, ServoSizing
from tarsus.load.supply import SupplyLoad
from tarsus.load.verdict import BURNOUT_FACTOR, JointVerdict, joint_verdicts
from tarsus.load.walk_changes import WalkChange
from tarsus.robot.estimates import estimated_keys
from tarsus.robot.robot import JOINTS

__all__ = ["length_advice", "loads_summary", "servos_summary", "worst_of_each"]

# Changes of torque per change of link length up to this are not reported [N m/m].
_NEGLIGIBLE = 0.05
_STEP = 0.01


def loads_summary(
    loads: JointLoads, supply: SupplyLoad, compliant: CompliantLoads | None = None, missing: str = ""
) -> dict[str, Any]:
    """Return loads, verdicts and currents as plain numbers with units in the keys; None if unknown.

    Parameters
    ----------
    loads : JointLoads
        Joint loads.
    supply : SupplyLoad
        Supply current of the same loads.
    compliant : CompliantLoads, optional
        Compliant statics of the same motion; with it, classes and verdicts are those of the higher loads.
    missing : str
        Why there are no compliant statics.
    """
    document = loads.to_dict()
    decisive = decisive_loads(loads, compliant)
    verdicts = joint_verdicts(decisive)
    pressed = [None] * len(verdicts) if compliant is None else list(joint_verdicts(compliant.loads))
    times = decisive.motion.time[decisive.peak_sample].ravel().tolist()
    for row, verdict, other, time in zip(document["joints"], verdicts, pressed, times, strict=True):
        row["peak_cause"], row["peak_at_s"] = verdict.cause, time
        row["compliant_peak_nm"] = None if other is None else other.peak
        row["compliant_rms_nm"] = None if other is None else other.rms
        row["factor"], row["utilisation"] = _number(verdict.factor), _number(verdict.utilisation)
        row["class"] = verdict.class_name
        row["thermal_ratio"] = _number(verdict.thermal_ratio)
        row["text"] = verdict.text()
    return {
        **document,
        "gait": loads.motion.gait.name,
        "estimated": list(estimated_keys(loads.robot)),
        "speed_mm_s": loads.motion.speed * 1000,
        "body_height_mm": loads.motion.body_height * 1000,
        "stroke_mm": loads.motion.stroke * 1000,
        "worst": [f"{v.leg} {v.joint}" for v in worst_of_each(verdicts)],
        "class": min(verdicts, key=_rank).class_name,
        "carried": loads.balanced and all(verdict.factor >= BURNOUT_FACTOR for verdict in verdicts),
        "possible": loads.motion.ok,
        "problems": list(loads.motion.problems),
        "compliant": None if compliant is None else _compliant(compliant),
        "compliant_missing": missing,
        "assumed": list(decisive.assumed),
        "supply": {
            "peak_a": supply.peak_current,
            "mean_a": supply.mean_current,
            "battery_min": None if supply.battery_time is None else _number(supply.battery_time / 60),
            "stall_current_unknown": list(supply.unknown),
            "peak_legs": list(supply.peak_legs),
            "warning": supply.warning,
        },
    }


def _compliant(compliant: CompliantLoads) -> dict[str, Any]:
    """Return the results of compliant statics beyond the loads of the joints."""
    saturated = compliant.saturated.any((1, 2)).mean()
    return {
        "carried": compliant.ok,
        "problems": list(compliant.problems),
        "slip_mm": dict(zip(compliant.loads.robot.leg_codes, (1000 * compliant.slip[-1]).tolist(), strict=True)),
        "saturated_fraction": float(saturated),
        "friction": compliant.contact.friction,
    }


def _rank(verdict: JointVerdict) -> float:
    """Return the factor as a sort key, with unknown factors first."""
    return -math.inf if math.isnan(verdict.factor) else verdict.factor


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def worst_of_each(verdicts: tuple[JointVerdict, ...]) -> list[JointVerdict]:
    """Return the verdict with the smallest factor for each of coxa, femur and tibia.

    Without a servo, it is the one with the largest peak torque.

    Parameters
    ----------
    verdicts : tuple of JointVerdict
        Verdicts on all joints.
    """
    return [min((v for v in verdicts if v.joint == joint), key=lambda v: (_rank(v), -v.peak)) for joint in JOINTS]


def servos_summary(sizing: ServoSizing, loads: JointLoads, changes: Sequence[WalkChange] = ()) -> dict[str, Any]:
    """Return a servo sizing as plain numbers with units in the keys; None if unknown.

    Parameters
    ----------
    sizing : ServoSizing
        Result of `size_servos`.
    loads : JointLoads
        Joint loads of the sizing.
    changes : sequence of WalkChange
        Changes of the walk that would relieve the robot's servos, from `walk_changes`.
    """
    return {
        "robot": loads.robot.name,
        "payload_kg": loads.payload.mass,
        "rule": sizing.rule,
        "safety_factor": sizing.safety_factor,
        "sufficient": sizing.ok,
        "balanced": loads.balanced,
        "estimated": list(estimated_keys(loads.robot)),
        "joints": [_joint(verdict, sizing) for verdict in worst_of_each(sizing.verdicts)],
        "changes": [
            {"text": change.text, "factor": change.factor, "thermal_ratio": change.thermal_ratio} for change in changes
        ],
        "candidates": [_candidate(candidate) for candidate in sizing.candidates],
        "sets": [_candidate(candidate) for candidate in sizing.sets],
        "mixed": None if sizing.mixed is None else _candidate(sizing.mixed),
        "largest_payload_kg": sizing.payload,
        "maximum_payload_kg": sizing.maximum_payload,
        "lengths": {
            link: {joint: _number(float(v)) for joint, v in zip(JOINTS, row, strict=True)}
            for link, row in sizing.sensitivity.items()
        },
        "advice": length_advice(sizing),
        "excluded": dict(sizing.excluded),
        "assumed": list(sizing.assumed),
    }


def _joint(verdict: JointVerdict, sizing: ServoSizing) -> dict[str, Any]:
    return {
        "joint": verdict.joint,
        "leg": verdict.leg,
        "servo": None if verdict.servo is None else verdict.servo.name,
        "peak_nm": verdict.peak,
        "rms_nm": verdict.rms,
        "peak_speed_rad_s": verdict.peak_speed,
        "factor": _number(verdict.factor),
        "thermal_ratio": _number(verdict.thermal_ratio),
        "class": verdict.class_name,
        "sufficient": verdict.is_sufficient(sizing.rule),
        "text": verdict.text(),
        "cause": verdict.cause,
    }


def _candidate(candidate: Candidate) -> dict[str, Any]:
    return {
        "name": candidate.name,
        "servos": {joint: servo.name for joint, servo in candidate.servos.items()},
        "factor": _number(candidate.factor),
        "thermal_ratio": candidate.thermal_ratio,
        "bus": candidate.bus,
        "supply_v": candidate.supply,
        "servo_mass_kg": candidate.servo_mass,
        "robot_mass_kg": candidate.robot_mass,
    }


def length_advice(sizing: ServoSizing) -> list[str]:
    """Describe the effect of 10 mm of each link length on the peak torques, for fixed feet and body poses.

    Parameters
    ----------
    sizing : ServoSizing
        Result of `size_servos`.
    """
    advice = []
    for link, row in sizing.sensitivity.items():
        if np.isnan(row).any():
            advice.append(f"{link}: no result, as a foot is out of reach with another length, or the length is 0")
            continue
        # Longer or shorter: the direction that reduces the torque of the joint with the largest change.
        sign = 1 if float(row[int(np.argmax(np.abs(row)))]) < 0 else -1
        changes = [
            f"{joint} {sign * change * _STEP:+.3f} N m"
            for joint, change in zip(JOINTS, row.tolist(), strict=True)
            if abs(change) > _NEGLIGIBLE
        ]
        longer = "longer" if sign > 0 else "shorter"
        advice.append(f"{link} 10 mm {longer}: {', '.join(changes) or 'negligible change'}")
    return advice
