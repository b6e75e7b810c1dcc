"""Messages on joint loads and servo sizing."""

from __future__ import annotations

import math
from typing import Any

from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.load.loads import JointLoads, joint_loads
from tarsus.load.payload import Payload
from tarsus.load.sizing import size_servos
from tarsus.load.supply import supply_load
from tarsus.load.verdict import joint_verdicts
from tarsus.report.loads_summary import loads_summary, servos_summary
from tarsus.studio.encoding import or_null, plain
from tarsus.studio.messages.motion import Candidate, JointLoad, LoadsMessage, ServosMessage
from tarsus.studio.messages.state import LoadOptions
from tarsus.studio.walks import fewer_for_more_legs

__all__ = ["loads_message", "loads_of", "servos_message"]

_MOST_SIZED = 3000
_VERTICAL = (
    "contact forces are vertical; tarsus loads adds those with which feet press against each other through friction, "
    "which load mainly the coxae"
)


def loads_of(motion: Motion, options: LoadOptions) -> JointLoads:
    """Return the loads of all joints over a walk.

    Parameters
    ----------
    motion : Motion
        The walk.
    options : LoadOptions
        Payload, supply voltage, and whether inertia is included.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If a value is out of range.
    """
    x, y, z = (value / 1000 for value in options.payload_at_mm)
    return joint_loads(
        motion.robot,
        motion,
        payload=Payload(options.payload_kg, (x, y, z)),
        supply=options.supply_v,
        inertial=options.inertial,
    )


def loads_message(found: JointLoads, options: LoadOptions, *, id: int) -> LoadsMessage:
    """Return the loads with the verdicts on the servos.

    Parameters
    ----------
    found : JointLoads
        Loads of the joints.
    options : LoadOptions
        Battery and safety factor.
    id : int
        Id of the message that is answered.

    Raises
    ------
    InputError
        If a value is out of range.
    """
    drawn = supply_load(found, capacity=options.capacity_ah)
    summary = loads_summary(found, drawn)
    currents = summary["supply"]
    texts = [verdict.text() for verdict in joint_verdicts(found, safety_factor=_factor(options))]
    return LoadsMessage(
        type="loads",
        id=id,
        torques_nm=plain(found.torques),
        forces_n=plain(found.forces),
        joints=[_joint(row, text) for row, text in zip(summary["joints"], texts, strict=True)],
        worst=summary["worst"],
        grade=summary["class"],
        carried=summary["carried"],
        balanced=summary["balanced"],
        weight_n=summary["weight_n"],
        distance_m=summary["distance_m"],
        energy_j=summary["energy_j"],
        cost_of_transport=summary["cost_of_transport"],
        peak_current_a=currents["peak_a"],
        mean_current_a=currents["mean_a"],
        battery_min=currents["battery_min"],
        supply_warning=currents["warning"],
        assumed=[*summary["assumed"], _VERTICAL],
    )


def _factor(options: LoadOptions) -> float:
    if not options.safety_factor > 0:
        raise InputError("safety_factor is 0; it must be greater than 0")
    return options.safety_factor


def _joint(row: dict[str, Any], text: str) -> JointLoad:
    return JointLoad(
        leg=row["leg"],
        joint=row["joint"],
        servo=row["servo"],
        peak_nm=row["peak_nm"],
        peak_at_s=row["peak_at_s"],
        peak_cause=row["peak_cause"],
        rms_nm=row["rms_nm"],
        peak_speed_deg_s=math.degrees(row["peak_speed_rad_s"]),
        peak_power_w=row["peak_power_w"],
        stall_nm=row["stall_nm"],
        factor=row["factor"],
        utilisation=row["utilisation"],
        thermal_ratio=row["thermal_ratio"],
        grade=row["class"],
        text=text,
    )


def servos_message(found: JointLoads, options: LoadOptions, *, id: int) -> ServosMessage:
    """Return the suitable servos.

    Parameters
    ----------
    found : JointLoads
        Loads of the joints.
    options : LoadOptions
        Safety factor and rule.
    id : int
        Id of the message that is answered.

    Raises
    ------
    InputError
        If the walk has too many samples, or the safety factor is 0.
    """
    most = fewer_for_more_legs(_MOST_SIZED, found.robot)
    if len(found.motion.time) > most:
        raise InputError(
            f"the walk has {len(found.motion.time)} samples; servo sizing evaluates every servo of the catalogue and "
            f"accepts at most {most}: use a lower rate or a shorter walk"
        )
    sizing = size_servos(found.robot, found, safety_factor=_factor(options), rule=options.rule)
    summary = servos_summary(sizing, found)
    mixed = summary["mixed"]
    return ServosMessage(
        type="servos",
        id=id,
        sufficient=summary["sufficient"],
        balanced=summary["balanced"],
        worst=[f"{row['leg']} {row['joint']}: {row['text']}" for row in summary["joints"]],
        candidates=[_candidate(candidate) for candidate in summary["candidates"]],
        mixed=None if mixed is None else _candidate(mixed),
        payload_kg=summary["largest_payload_kg"],
        maximum_payload_kg=summary["maximum_payload_kg"],
        advice=summary["advice"],
        left_out=summary["excluded"],
        assumed=summary["assumed"],
    )


def _candidate(row: dict[str, Any]) -> Candidate:
    return Candidate(
        name=row["name"],
        **row["servos"],
        factor=row["factor"],
        thermal_ratio=or_null(row["thermal_ratio"]),
        servo_mass_kg=row["servo_mass_kg"],
        robot_mass_kg=row["robot_mass_kg"],
    )
