"""A planned stance transition."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.limitation import Limitation
from tarsus.control.transition.parameters import WalkParameters
from tarsus.control.workspace.cycle_time import CycleTiming
from tarsus.gait.stance.velocity_limits import VelocityLimits

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["StanceTransition"]


@dataclass(frozen=True, eq=False, kw_only=True)
class StanceTransition:
    """The transition to a stance that meets commanded parameters, or comes closer to them.

    First the feet step to new rest footholds, then the body moves over them.

    Attributes
    ----------
    parameters : WalkParameters
        What is commanded.
    complete : bool
        Whether it meets as much of that as is feasible; if not, a further transition follows.
    keeps_posture : bool
        Whether only the steps change.
    posture : array, shape (7,)
        The posture to reach.
    rest : complex array, shape (legs,)
        The rest footholds to step to, in the heading frame [m].
    cycle_timing : CycleTiming
        Cycle time and strokes in the new stance.
    stepping_limits, path_limits, final_limits : VelocityLimits
        The limits while the feet step to their new rest footholds, while the body moves, and in the new stance.
    limitations : tuple of Limitation
        What of the commanded parameters is not feasible.
    """

    parameters: WalkParameters
    complete: bool
    keeps_posture: bool
    posture: Float[np.ndarray, "7"]
    rest: Complex[np.ndarray, "legs"]
    cycle_timing: CycleTiming
    stepping_limits: VelocityLimits
    path_limits: VelocityLimits
    final_limits: VelocityLimits
    limitations: tuple[Limitation, ...]
