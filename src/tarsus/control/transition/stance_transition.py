"""A planned stance transition, and the parameters of walking that it meets: all that is commanded except the twist."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.limitation import Limitation
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.workspace.cycle_time import CycleTiming
from tarsus.gait.gait import Gait
from tarsus.gait.stance.velocity_limits import VelocityLimits

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["NextGait", "StanceTransition", "WalkParameters"]


@dataclass(frozen=True, kw_only=True)
class WalkParameters:
    """How the robot stands and steps.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    body : tuple of float
        Body pose against level at the body height: x, y, z [m], roll, pitch, yaw [rad].
    body_height, swing_height : float
        Height of the body's origin over the ground, and of a swinging foot over its foothold [m].
    stance_width : float
        Distance that the feet rest farther out than by default [m].
    cycle_time : float or None
        Duration of a cycle [s]; None for the one with the highest top speed.
    sway : tuple of float
        Amplitudes of the body's sway, axes as in `body`.
    correction : tuple of float
        Shift over the feet that bear load, added to `body`.
    excluded : tuple of int
        Legs that are taken out of the gait.
    """

    gait: Gait
    body: tuple[float, ...]
    body_height: float
    swing_height: float
    stance_width: float
    cycle_time: float | None
    sway: tuple[float, ...] = (0.0,) * 6
    correction: tuple[float, ...] = (0.0,) * 6
    excluded: tuple[int, ...] = ()

    @property
    def corrected_body(self) -> tuple[float, ...]:
        """The body pose with its correction."""
        return tuple(a + b for a, b in zip(self.body, self.correction, strict=True))

    def stepping_like(self, others: WalkParameters) -> WalkParameters:
        """Return how to stand like this, and step like others: their gait, cycle time, and legs out of the gait.

        Parameters
        ----------
        others : WalkParameters
            The others.
        """
        return replace(self, gait=others.gait, cycle_time=others.cycle_time, excluded=others.excluded)


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


class NextGait(NamedTuple):
    """A gait that begins once all feet are on the ground.

    Attributes
    ----------
    transition : StanceTransition
        The transition that brings it.
    timing : StepTiming
        Its timing.
    first_leg : int
        The leg that lifts first.
    delays : array, shape (legs,)
        How long each foot stands before it lifts [s].
    """

    transition: StanceTransition
    timing: StepTiming
    first_leg: int
    delays: Float[np.ndarray, "legs"]
