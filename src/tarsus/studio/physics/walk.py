"""The planned walk in physics, as a message."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.kinematics.mass import centre_of_mass
from tarsus.report.simulation_summary import simulation_summary, simulation_verdict
from tarsus.robot.robot import JOINTS
from tarsus.simulation.truth.as_motion import trace_motion
from tarsus.simulation.truth.comparison import Truth
from tarsus.studio.encoding import degrees, millimetres, or_null, plain, rows_of_flags
from tarsus.studio.messages.physics import SimulatedJoint, SimulatedMessage
from tarsus.studio.walks import fewer_for_more_legs

__all__ = ["COMMAND_RATE", "MOST_SIMULATED", "check_length", "simulated_message"]

COMMAND_RATE = 100.0
"""Rate at which the servos are commanded, and at which the simulated walk is sent [1/s]."""


MOST_SIMULATED = 3000
"""Greatest number of samples of a simulated walk for six legs; simulating them takes two seconds."""


def check_length(motion: Motion) -> None:
    """Check that a walk is not too long to be simulated for a visitor.

    Parameters
    ----------
    motion : Motion
        The walk, at `COMMAND_RATE`.

    Raises
    ------
    InputError
        If it is too long.
    """
    most = fewer_for_more_legs(MOST_SIMULATED, motion.robot)
    if len(motion.time) > most:
        raise InputError(
            f"the walk takes {motion.duration:.1f} s; the studio simulates at most {most / COMMAND_RATE:g} s for "
            f"{motion.robot.legs} legs: use a shorter walk, or the command line"
        )


def simulated_message(found: Truth, *, id: int) -> SimulatedMessage:
    """Return a walk in physics with its summary; the samples end with those of the plan.

    Parameters
    ----------
    found : Truth
        The plan, and what became of it in physics.
    id : int
        Id of the message that is answered.
    """
    trace, count = found.trace, len(found.motion.time)
    motion = trace_motion(trace, found.motion)
    com = np.asarray(motion.body @ np.asarray(centre_of_mass(trace.robot, trace.angles))[:, None, :])[:count, 0]
    rpy = np.array(trace.body.rpy)[:count]
    rpy[:, 2] = np.unwrap(rpy[:, 2])
    tilt = np.sum(trace.body.rotation[:count, :, 2] * trace.commanded_body.rotation[:count, :, 2], axis=-1)
    summary = simulation_summary(found.outcome, (found.planned_peak, found.planned_rms))
    return SimulatedMessage(
        type="simulated",
        id=id,
        rate_hz=(count - 1) / found.motion.duration,
        count=count,
        position_mm=millimetres(trace.body.position[:count]),
        rpy_deg=degrees(rpy),
        angles_deg=degrees(trace.angles[:count]),
        contacts=rows_of_flags(motion.contacts[:count]),
        margin_mm=[or_null(value) for value in np.round(motion.margin[:count] * 1000, 2).tolist()],
        com_mm=millimetres(com[:, :2]),
        forces_n=plain(trace.foot_forces[:count]),
        slip_mm_s=millimetres(trace.slip_speeds[:count]),
        saturated=rows_of_flags(trace.saturated[:count].reshape(count, -1)),
        tilt_deg=degrees(np.arccos(np.clip(tilt, -1.0, 1.0))),
        ok=summary["ok"],
        verdict=simulation_verdict(summary).splitlines()[0],
        problems=[*summary["problems"], *_saturations(summary["joints"])],
        way_ratio=summary["way_ratio"],
        turn_ratio=summary["turn_ratio"],
        deviation_mm=summary["deviation_mm"],
        sag_mm=summary["sag_mm"],
        slip_mm=summary["slip_mm"],
        joints=[_joint(joint, summary["joints"][joint]) for joint in JOINTS],
        energy_j=summary["energy_j"],
        fell_at_s=summary["fell_at_s"],
        assumed=list(found.assumed),
    )


def _joint(joint: str, found: dict[str, Any]) -> SimulatedJoint:
    return SimulatedJoint(joint=joint, **found)  # type: ignore[arg-type] # one of the three


def _saturations(joints: dict[str, Any]) -> list[str]:
    return [
        f"{joint} servos at their maximum torque for up to {100 * found['saturated_fraction']:.1f} % of the time"
        for joint, found in joints.items()
        if found["saturated_fraction"]
    ]
