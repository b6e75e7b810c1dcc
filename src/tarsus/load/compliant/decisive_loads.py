"""Loads to size servos by: of vertical forces and compliant statics the higher, joint by joint."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tarsus.load.compliant.result import CompliantLoads
from tarsus.load.loads import JointLoads

__all__ = ["decisive_loads"]

_FRICTION = "loads of each joint: the higher of vertical forces and compliant statics, which presses the feet together"


def decisive_loads(loads: JointLoads, compliant: CompliantLoads | None) -> JointLoads:
    """Return for each joint the loads with the higher peak torque, those of vertical forces or of compliant statics.

    Parameters
    ----------
    loads : JointLoads
        Loads from vertical forces.
    compliant : CompliantLoads or None
        Compliant statics of the same motion; None if it is unknown: then the loads are returned as they are.
    """
    if compliant is None:
        return loads
    higher = compliant.loads.peak > loads.peak
    return replace(
        loads,
        torques=np.where(higher, compliant.torques, loads.torques),
        forces=compliant.forces,
        assumed=(*compliant.assumed, _FRICTION),
    )
