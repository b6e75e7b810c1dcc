"""Parameters of walking, all that is commanded except the twist; the stance that they ask for; a transition to it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.limitation import Limitation
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.workspace.cycle_time import CycleTiming
from tarsus.errors import UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT, StanceGeometry, stance_geometry_of
from tarsus.gait.stance.velocity_limits import VelocityLimits, stance_overhang
from tarsus.kinematics.stance import stance_or_nan
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["StanceTarget", "StanceTransition", "WalkParameters", "target_stance"]

# Fractions of a change of height that are tried where the whole of it has no foothold.
_FRACTIONS = np.arange(7, 0, -1) / 8


@dataclass(frozen=True, kw_only=True)
class WalkParameters:
    """How the robot stands and steps.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    body_height, swing_height : float
        Height of the body's origin over the ground, and of a swinging foot over its foothold [m].
    stance_width : float
        Distance that the feet rest farther out than by default [m].
    cycle_time : float or None
        Duration of a cycle [s]; None for the one with the highest top speed.
    body : tuple of float
        Body pose against level at the body height: x, y, z [m], roll, pitch, yaw [rad].
    sway : tuple of float
        Amplitudes of the body's sway, axes as in `body`.
    correction : tuple of float
        Shift over the feet that bear load, added to `body`.
    excluded : tuple of int
        Legs that are taken out of the gait.
    """

    gait: Gait
    body_height: float
    swing_height: float
    stance_width: float
    cycle_time: float | None
    body: tuple[float, ...] = (0.0,) * 6
    sway: tuple[float, ...] = (0.0,) * 6
    correction: tuple[float, ...] = (0.0,) * 6
    excluded: tuple[int, ...] = ()

    @property
    def corrected_body(self) -> tuple[float, ...]:
        """The body pose with its correction."""
        return tuple(a + b for a, b in zip(self.body, self.correction, strict=True))

    def stepping_like(self, others: WalkParameters) -> WalkParameters:
        """Return how to stand like this, and step like others: their gait, cycle time, and legs out of the gait."""
        return replace(self, gait=others.gait, cycle_time=others.cycle_time, excluded=others.excluded)


class StanceTarget(NamedTuple):
    """A posture and the rest footholds under it.

    Attributes
    ----------
    posture : array, shape (7,)
        The posture.
    rest : complex array, shape (legs,)
        The rest footholds in the heading frame [m].
    """

    posture: Float[np.ndarray, "7"]
    rest: Complex[np.ndarray, "legs"]

    @classmethod
    def of(cls, robot: Robot, parameters: WalkParameters, feet: Float[np.ndarray, "legs 3"]) -> StanceTarget:
        """Return the posture and the rest footholds that parameters ask for.

        Parameters
        ----------
        robot, parameters : Robot, WalkParameters
            A single robot; what is commanded.
        feet : array, shape (legs, 3)
            The default footholds at these heights, in B [m].
        """
        posture = np.array([*parameters.corrected_body, parameters.swing_height])
        posture[2] += parameters.body_height
        mount, rest = robot.geometry.mount_x + 1j * robot.geometry.mount_y, feet[:, 0] + 1j * feet[:, 1]
        outward = (rest - mount) / np.maximum(np.abs(rest - mount), 1e-9)
        return cls(posture, rest + parameters.stance_width * outward)

    def towards(self, other: StanceTarget, fraction: float) -> StanceTarget:
        """Return the stance at a fraction of the straight path to another: 0 for this one, 1 for the other."""
        return StanceTarget(*(here + fraction * (there - here) for here, there in zip(self, other, strict=True)))

    @property
    def stand(self) -> StanceGeometry:
        """The body and the feet at rest."""
        return stance_geometry_of(self.posture, self.rest)


def target_stance(robot: Robot, parameters: WalkParameters, present: StanceTarget) -> StanceTarget:
    """Return posture and rest footholds; for a height without a foothold, of the nearest height that has them.

    Parameters
    ----------
    robot, parameters, present : Robot, WalkParameters, StanceTarget
        A single robot; what is commanded; the present stance.

    Raises
    ------
    UnreachableError
        If no height between the present and the commanded one has footholds.
    """
    body_height = float(present.posture[2]) - parameters.corrected_body[2]
    swing_height = float(present.posture[SWING_HEIGHT])
    for fractions in (np.ones(1), _FRACTIONS):
        body_heights = body_height + fractions * (parameters.body_height - body_height)
        swing_heights = swing_height + fractions * (parameters.swing_height - swing_height)
        feet = stance_or_nan(robot, body_heights, swing_height=swing_heights)
        works = ~np.isnan(feet).any(axis=(-2, -1))
        if works.any():
            first = int(works.argmax())
            body_height, swing_height = float(body_heights[first]), float(swing_heights[first])
            nearest = replace(parameters, body_height=body_height, swing_height=swing_height)
            return StanceTarget.of(robot, nearest, feet[first])
    raise UnreachableError(f"no leg reaches the ground at body height {parameters.body_height * 1000:.1f} mm")


@dataclass(frozen=True, eq=False, kw_only=True)
class StanceTransition:
    """The transition to a stance that meets commanded parameters, or comes closer to them.

    First the feet step to new rest footholds, then the body moves over them.

    Attributes
    ----------
    parameters : WalkParameters
        What is commanded.
    posture : array, shape (7,)
        The posture to reach.
    rest : complex array, shape (legs,)
        The rest footholds to step to, in the heading frame [m].
    cycle_timing : CycleTiming
        Cycle time and strokes in the new stance.
    stepping_limits, path_limits, final_limits : VelocityLimits
        The limits while the feet step to their new rest footholds, while the body moves, and in the new stance.
    complete : bool
        Whether it meets as much of that as is feasible; if not, a further transition follows.
    keeps_posture : bool
        Whether only the steps change.
    limitations : tuple of Limitation
        What of the commanded parameters is not feasible.
    """

    parameters: WalkParameters
    posture: Float[np.ndarray, "7"]
    rest: Complex[np.ndarray, "legs"]
    cycle_timing: CycleTiming
    stepping_limits: VelocityLimits
    path_limits: VelocityLimits
    final_limits: VelocityLimits
    complete: bool = True
    keeps_posture: bool = False
    limitations: tuple[Limitation, ...] = ()

    @cached_property
    def timing(self) -> StepTiming:
        """Its gait and step frequency."""
        return StepTiming(self.parameters.gait, 1 / self.cycle_timing.cycle_time)

    @cached_property
    def lift_delays(self) -> Float[np.ndarray, "legs legs"]:
        """How long each foot stands as its gait starts with all feet down, by the leg that lifts first: rows [s]."""
        duty_factor, offsets = self.parameters.gait.duty_factor, np.asarray(self.parameters.gait.offsets)
        over = (stance_overhang(duty_factor) - 0.5) * duty_factor
        return np.asarray(((offsets - offsets[:, None]) % 1 + over) * self.cycle_timing.cycle_time)
