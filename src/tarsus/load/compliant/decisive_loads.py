"""Loads by which servos are sized: for each joint the higher of those of vertical forces and compliant statics."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tarsus.load.compliant.result import CompliantLoads
from tarsus.load.loads import JointLoads

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["decisive_loads"]

_FRICTION = "loads of each joint: the higher of vertical forces and compliant statics, which presses the feet together"


@dataclass(frozen=True, eq=False, kw_only=True)
class _DecisiveLoads(JointLoads):
    """For each joint the torques of the case with the higher peak; `rms`, which heats servos, is the higher of both."""

    vertical: JointLoads
    pressed: JointLoads

    @cached_property
    def rms(self) -> Float[np.ndarray, "legs 3"]:
        return np.asarray(np.maximum(self.vertical.rms, self.pressed.rms))

    def cause(self, leg: int, joint: int) -> str:
        higher = self.pressed.peak[leg, joint] > self.vertical.peak[leg, joint]
        return (self.pressed if higher else self.vertical).cause(leg, joint)


def decisive_loads(loads: JointLoads, compliant: CompliantLoads | None) -> JointLoads:
    """Return for each joint the loads with the higher peak torque, those of vertical forces or of compliant statics.

    The root mean square torque of a joint is the higher of both cases, regardless of which has the higher peak. The
    contact forces are those of compliant statics.

    Parameters
    ----------
    loads : JointLoads
        Loads from vertical forces.
    compliant : CompliantLoads or None
        Compliant statics of the same motion; None if unknown: `loads` is then returned unchanged.
    """
    if compliant is None:
        return loads
    higher = compliant.loads.peak > loads.peak
    values = {field.name: getattr(loads, field.name) for field in fields(loads)}
    values |= {
        "torques": np.where(higher, compliant.torques, loads.torques),
        "forces": compliant.forces,
        "assumed": (*compliant.assumed, _FRICTION),
    }
    return _DecisiveLoads(**values, vertical=loads, pressed=compliant.loads)
