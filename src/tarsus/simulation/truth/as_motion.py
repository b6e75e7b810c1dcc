"""A trace as a motion, for all code that draws motions."""

from __future__ import annotations

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.kinematics.leg import forward_kinematics
from tarsus.simulation.truth.trace import Trace

__all__ = ["CONTACT_FORCE", "trace_motion"]

CONTACT_FORCE = 0.05
"""Vertical force from which on a foot counts as on the ground [N]."""


def trace_motion(trace: Trace, plan: Motion) -> Motion:
    """Return what a simulated robot did as a motion; gait, stroke and heights are those of the plan.

    Parameters
    ----------
    trace : Trace
        The trace.
    plan : Motion
        What it should have done.
    """
    points = np.asarray(trace.body @ forward_kinematics(trace.robot, trace.angles))
    return Motion(
        robot=trace.robot,
        gait=plan.gait,
        time=trace.time,
        body=trace.body,
        feet=points[..., 3, :],
        contacts=trace.foot_forces[..., 2] > CONTACT_FORCE,
        angles=trace.angles,
        reach=np.zeros(trace.angles.shape[:2], dtype=np.int8),
        cycle_time=plan.cycle_time,
        stroke=plan.stroke,
        speed=plan.speed,
        body_height=plan.body_height,
        swing_height=plan.swing_height,
        foot_distance=plan.foot_distance,
        assumed=plan.assumed,
    )
