"""Parameters of walking, all that is commanded except the twist; the stance that they ask for; a transition to it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.workspace.cycle_time import CycleTiming
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT, StanceGeometry, stance_geometry_of
from tarsus.gait.stance.velocity_limits import VelocityLimits, stance_overhang
from tarsus.kinematics.stance import stance_or_nan
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["StanceTarget", "StanceTransition", "WalkParameters", "target_stance"]

# Fractions of a change of height that are tried where the whole change leaves a foot without a foothold.
_FRACTIONS = np.arange(7, 0, -1) / 8
# Differences below this are rounding [m, rad].
_TOLERANCE = 1e-6


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
        Distance by which the feet rest farther out than by default [m].
    cycle_time : float or None
        Duration of a cycle [s]; None for the one with the highest top speed.
    body : tuple of float
        Body pose relative to a level body at the body height: x, y, z [m], roll, pitch, yaw [rad].
    sway : tuple of float
        Amplitudes of the body's sway, axes as in `body`.
    unloaded : tuple of int
        Legs that are to bear no load: the feet of the others stand where they support the robot without these.
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
    unloaded: tuple[int, ...] = ()
    excluded: tuple[int, ...] = ()

    def shortfalls(self, posture: Float[np.ndarray, "7"], cause: Cause, *, stance_width: float) -> list[Limitation]:
        """Return a limitation for each parameter that a posture does not meet.

        Parameters
        ----------
        posture, cause : array, shape (7,), and Cause
            The posture that is met; why the parameters are not met.
        stance_width : float
            The stance width that is met [m]; it is reported only where everything else is met.
        """
        gap = np.array([*self.body, self.swing_height]) - posture
        gap[2] += self.body_height
        found = []
        # Body height and body pose both command the height of the body's origin: a gap greater than the pose's part
        # counts as one of the body height.
        if _TOLERANCE + abs(self.body[2]) < abs(gap[2]):
            asked = self.body_height
            found.append(cause.limitation(LimitationKind.BODY_HEIGHT, asked=asked, granted=asked - float(gap[2])))
            gap[2] = 0.0
        if abs(gap[SWING_HEIGHT]) > _TOLERANCE:
            asked = self.swing_height
            found.append(cause.limitation(LimitationKind.SWING_HEIGHT, asked=asked, granted=asked - float(gap[-1])))
        missing = [axis for axis in range(SWING_HEIGHT) if abs(gap[axis]) > _TOLERANCE]
        if missing:
            # Where only axes commanded to be 0 are missing, nothing of the pose counts as met.
            met = [1 - abs(float(gap[axis]) / self.body[axis]) for axis in missing if self.body[axis]]
            found.append(cause.limitation(LimitationKind.BODY, asked=1.0, granted=max(min(met, default=0.0), 0.0)))
        width = self.stance_width
        if not found and abs(width - stance_width) > _TOLERANCE:
            found.append(cause.limitation(LimitationKind.STANCE_WIDTH, asked=width, granted=stance_width))
        return found

    def rejected(self, now: WalkParameters, posture: Float[np.ndarray, "7"] | None, cause: Cause) -> list[Limitation]:
        """Return the limitations of parameters that are rejected as a whole.

        Parameters
        ----------
        now : WalkParameters
            The parameters in force.
        posture : array, shape (7,), or None
            The posture that is in force; None where it would have stayed.
        cause : Cause
            Why they are rejected.
        """
        found: list[Limitation] = []
        if self.gait != now.gait:
            found.append(cause.limitation(LimitationKind.GAIT))
        if self.excluded != now.excluded:
            found.append(cause.limitation(LimitationKind.FOOT_TARGET, asked=1.0, granted=0.0))
        if self.cycle_time != now.cycle_time and self.cycle_time is not None:
            found.append(cause.limitation(LimitationKind.CYCLE_TIME, asked=self.cycle_time))
        if posture is None:
            return found
        if self.sway != now.sway:
            found.append(cause.limitation(LimitationKind.SWAY, asked=1.0, granted=0.0))
        return found + self.shortfalls(posture, cause, stance_width=now.stance_width)

    def stepping_like(self, others: WalkParameters) -> WalkParameters:
        """Return these parameters with the steps of others: their gait, cycle time, and legs out of the gait."""
        return replace(self, gait=others.gait, cycle_time=others.cycle_time, excluded=others.excluded)


class StanceTarget(NamedTuple):
    """A posture and the rest footholds under it, or several of both.

    Attributes
    ----------
    posture : array, shape (7,) or (n, 7)
        The posture.
    rest : complex array, shape (legs,) or (n, legs)
        The rest footholds in the heading frame [m].
    """

    posture: Float[np.ndarray, "*batch 7"]
    rest: Complex[np.ndarray, "*batch legs"]

    @classmethod
    def of(
        cls,
        robot: Robot,
        parameters: WalkParameters,
        feet: Float[np.ndarray, "legs 3"],
        turns: Complex[np.ndarray, "legs"] | complex = 1.0,
    ) -> StanceTarget:
        """Return the posture and the rest footholds that parameters ask for.

        Parameters
        ----------
        robot, parameters : Robot, WalkParameters
            A single robot; what is commanded.
        feet : array, shape (legs, 3)
            The default footholds at these heights, in B [m].
        turns : complex array, shape (legs,), or complex
            Factors of the ways from coxa axes to footholds, by which these turn about the axes.
        """
        posture = np.array([*parameters.body, parameters.swing_height])
        posture[2] += parameters.body_height
        mount, rest = robot.geometry.mount_x + 1j * robot.geometry.mount_y, feet[:, 0] + 1j * feet[:, 1]
        outward = (rest - mount) / np.maximum(np.abs(rest - mount), 1e-9)
        return cls(posture, mount + (rest + parameters.stance_width * outward - mount) * turns)

    def towards(self, other: StanceTarget, fraction: float | Float[np.ndarray, "n 1"]) -> StanceTarget:
        """Return the stance at a fraction, or the stances at some, of the path to another: 0 for this one, 1 for it."""
        return StanceTarget(*(here + fraction * (there - here) for here, there in zip(self, other, strict=True)))

    @property
    def stand(self) -> StanceGeometry:
        """Geometry of the body with the feet at their rest footholds."""
        return stance_geometry_of(self.posture, self.rest)


def target_stance(
    robot: Robot, parameters: WalkParameters, present: StanceTarget, turns: Complex[np.ndarray, "legs"]
) -> StanceTarget | None:
    """Return the posture and rest footholds asked for, or those at the nearest height that has footholds.

    None where no height between the present and the commanded one has footholds.

    Parameters
    ----------
    robot, parameters, present : Robot, WalkParameters, StanceTarget
        A single robot; what is commanded; the present stance.
    turns : complex array, shape (legs,)
        Factors of the ways from coxa axes to rest footholds, by which these turn about the axes.
    """
    body_height = float(present.posture[2]) - parameters.body[2]
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
            return StanceTarget.of(robot, nearest, feet[first], turns)
    return None


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
        Whether it meets as much of the parameters as is feasible; if not, a further transition follows.
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
        """How long each foot stands as its gait starts with all feet down [s]; a row for each leg that lifts first."""
        duty_factor, offsets = self.parameters.gait.duty_factor, np.asarray(self.parameters.gait.offsets)
        over = (stance_overhang(duty_factor) - 0.5) * duty_factor
        return np.asarray(((offsets - offsets[:, None]) % 1 + over) * self.cycle_timing.cycle_time)
