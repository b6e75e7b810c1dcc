"""What a walk asks of the servos, in numbers: what `tarsus loads` and `tarsus servos` print and `--json` returns."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.load.loads import JointLoads
from tarsus.load.sizing import Candidate, ServoSizing
from tarsus.load.supply import SupplyLoad
from tarsus.load.verdict import BURNOUT_FACTOR, JointVerdict, joint_verdicts
from tarsus.robot.robot import JOINTS

__all__ = ["length_advice", "loads_summary", "servos_summary", "worst_of_each"]

# Changes of torque per length that are called none [N m/m].
_NOTHING = 0.05
_STEP = 0.01


def loads_summary(found: JointLoads, drawn: SupplyLoad) -> dict[str, Any]:
    """Return loads, verdicts and currents as plain numbers with units in their keys; what is unknown is None.

    Parameters
    ----------
    found : Loads
        What the joints bear.
    drawn : Supply
        The currents of the same loads.
    """
    document = found.to_dict()
    verdicts = joint_verdicts(found)
    for row, verdict in zip(document["joints"], verdicts, strict=True):
        row["class"] = verdict.class_name
        row["thermal_ratio"] = _number(verdict.thermal_ratio)
        row["text"] = verdict.text()
    return {
        **document,
        "gait": found.motion.gait.name,
        "speed_mm_s": found.motion.speed * 1000,
        "body_height_mm": found.motion.body_height * 1000,
        "stroke_mm": found.motion.stroke * 1000,
        "worst": [f"{v.leg} {v.joint}" for v in worst_of_each(verdicts)],
        "class": min(verdicts, key=_rank).class_name,
        "carried": found.balanced and all(verdict.factor >= BURNOUT_FACTOR for verdict in verdicts),
        "supply": {
            "peak_a": drawn.peak_current,
            "mean_a": drawn.mean_current,
            "battery_min": None if drawn.battery_time is None else _number(drawn.battery_time / 60),
            "stall_current_unknown": list(drawn.unknown),
            "together": list(drawn.peak_legs),
            "warning": drawn.warning,
        },
    }


def _rank(verdict: JointVerdict) -> float:
    """Order by factor; what is unknown comes first."""
    return -math.inf if math.isnan(verdict.factor) else verdict.factor


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def worst_of_each(verdicts: tuple[JointVerdict, ...]) -> list[JointVerdict]:
    """Return for each kind of joint the one with the least factor; among those without a servo, the greatest peak.

    Parameters
    ----------
    verdicts : tuple of JointVerdict
        Of all joints.
    """
    return [min((v for v in verdicts if v.joint == joint), key=lambda v: (_rank(v), -v.peak)) for joint in JOINTS]


def servos_summary(sizing: ServoSizing, found: JointLoads) -> dict[str, Any]:
    """Return which servos would do as plain numbers with units in their keys; what is unknown is None.

    Parameters
    ----------
    sizing : ServoSizing
        What `size_servos` says.
    found : Loads
        Of what.
    """
    return {
        "robot": found.robot.name,
        "payload_kg": found.payload.mass,
        "rule": sizing.rule,
        "safety_factor": sizing.safety_factor,
        "present_do": sizing.ok,
        "balanced": found.balanced,
        "joints": [_joint(verdict, sizing) for verdict in worst_of_each(sizing.verdicts)],
        "candidates": [_candidate(candidate) for candidate in sizing.candidates],
        "mixed": None if sizing.mixed is None else _candidate(sizing.mixed),
        "payload_carried_kg": sizing.payload,
        "payload_before_burning_kg": sizing.maximum_payload,
        "lengths": {
            link: {joint: _number(float(v)) for joint, v in zip(JOINTS, row, strict=True)}
            for link, row in sizing.sensitivity.items()
        },
        "advice": length_advice(sizing),
        "left_out": dict(sizing.excluded),
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
        "does": verdict.is_sufficient(sizing.rule),
        "text": verdict.text(),
        "cause": verdict.cause,
    }


def _candidate(candidate: Candidate) -> dict[str, Any]:
    return {
        "name": candidate.name,
        "servos": {joint: servo.name for joint, servo in candidate.servos.items()},
        "factor": _number(candidate.factor),
        "thermal_ratio": candidate.thermal_ratio,
        "servo_mass_kg": candidate.servo_mass,
        "robot_mass_kg": candidate.robot_mass,
    }


def length_advice(sizing: ServoSizing) -> list[str]:
    """Say in words what 10 mm of each link would change, feet and body where they are.

    Parameters
    ----------
    sizing : ServoSizing
        What `size_servos` says.
    """
    said = []
    for link, row in sizing.sensitivity.items():
        if np.isnan(row).any():
            said.append(f"{link}: its length can't be changed with the feet where they are, or it has none")
            continue
        # The greatest change first, and the way in which it is a relief.
        sign = 1 if float(row[int(np.argmax(np.abs(row)))]) < 0 else -1
        changes = [
            f"{joint} {'less' if sign * change < 0 else 'more'} by {abs(change) * _STEP:.3f} N m"
            for joint, change in zip(JOINTS, row.tolist(), strict=True)
            if abs(change) > _NOTHING
        ]
        longer = "longer" if sign > 0 else "shorter"
        said.append(f"{link} 10 mm {longer}: {', '.join(changes) or 'hardly any change'}")
    return said
