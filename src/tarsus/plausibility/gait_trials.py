"""Which gaits a robot can walk with: a short walk is planned for each."""

from __future__ import annotations

from dataclasses import dataclass

from tarsus.errors import InputError, TarsusError, UnreachableError
from tarsus.gait.gait import GAITS, Gait
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.gait.stroke import max_stroke
from tarsus.kinematics.stance import default_stance, default_swing_height
from tarsus.representation import represented
from tarsus.robot.robot import Robot, require_robot

__all__ = ["NO_STROKE", "GaitTrial", "try_gaits"]

NO_STROKE = "the longest stroke is 0: in the rest stance a leg can't be lifted, or two feet are too close"
"""Problem of a gait with which a robot can't walk although its legs reach the ground."""

# Stroke of the walk over the longest stroke, the default of planned walks, and length of the walk in strokes.
_STROKE, _STROKES = 0.6, 3
_RATE = 50.0


@represented()
@dataclass(frozen=True, kw_only=True)
class GaitTrial:
    """A short walk straight ahead, with the robot's default heights.

    Attributes
    ----------
    gait : str
        Name of the gait.
    problems : tuple of str
        Why the walk is not possible; empty if it is.
    longest_stroke : float or None
        Longest possible stroke [m]; None if the legs do not reach the ground.
    least_margin : float or None
        Least stability margin of the walk [m]; None if no walk could be planned.
    """

    gait: str
    problems: tuple[str, ...]
    longest_stroke: float | None = None
    least_margin: float | None = None

    @property
    def possible(self) -> bool:
        """Whether the robot can walk with this gait."""
        return not self.problems


def try_gaits(robot: Robot) -> tuple[GaitTrial, ...]:
    """Plan a short walk straight ahead with every standard gait that exists for the robot's number of legs.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Returns
    -------
    tuple of GaitTrial
        In the order of `GAITS`.

    Raises
    ------
    InputError
        If the robot is a batch of designs.
    """
    require_robot(robot)
    if robot.batch_shape:
        raise InputError(f"gaits are tried for a single robot, not for a batch {robot.batch_shape} of designs")
    gaits = _gaits(robot.legs)
    try:
        default_stance(robot, swing_height=default_swing_height(robot))
    except UnreachableError as error:
        return tuple(GaitTrial(gait=gait.name, problems=(str(error),)) for gait in gaits)
    return tuple(_try(robot, gait) for gait in gaits)


def _gaits(legs: int) -> list[Gait]:
    gaits = []
    for name in GAITS:
        try:
            gaits.append(Gait.named(name, legs=legs))
        except InputError:
            continue
    return gaits


def _try(robot: Robot, gait: Gait) -> GaitTrial:
    longest = max_stroke(robot, gait)
    if longest == 0:
        return GaitTrial(gait=gait.name, problems=(NO_STROKE,), longest_stroke=longest)
    try:
        walk = plan_walk(robot, gait, straight_path(_STROKES * _STROKE * longest), rate=_RATE)
    except TarsusError as error:
        return GaitTrial(gait=gait.name, problems=(str(error),), longest_stroke=longest)
    return GaitTrial(
        gait=gait.name,
        problems=walk.problems,
        longest_stroke=longest,
        least_margin=float(walk.margin.min()),
    )
