"""Longest stroke that the legs allow in a direction."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array
from tarsus.gait.body_shift import shift_at
from tarsus.gait.branch import branches
from tarsus.gait.cycle import cycle_feet
from tarsus.gait.excursion import SWING_SAMPLES, extreme_excursions, walk_excursions
from tarsus.gait.gait import Gait
from tarsus.gait.path import BodyPath
from tarsus.gait.shifted_walk import shifted_feasibility, shifted_pose, walk_shift
from tarsus.gait.spacing import passing_distance
from tarsus.gait.walk_setup import HEADING_FRAME, WalkSetup
from tarsus.kinematics.solution import IKSolution
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["first_failure", "leg_feasibility", "longest_stroke", "max_stroke", "steady_solution", "unit_twist"]


# Coarse steps in the search for the first infeasible stroke; number of strokes computed together.
_COARSE = 32
_AT_ONCE = 8
# Tolerance of the longest stroke with a body shift: coarse, as the shift is fitted anew to each stroke tried [m].
_SHIFT_TOLERANCE = 2e-3
# Factor by which the longest stroke is reduced, for maxima between the samples.
_SAFETY = 0.998
# Allowance for a smaller distance between feet during start and stop, in strokes: at most 0.02 is needed (measured).
_START_AND_STOP = 0.05


def unit_twist(rest: Float[Array, "legs 3"], direction: float | Sequence[float]) -> Float[np.ndarray, "3"]:
    """Return the displacement in a stance ``(3,)`` per metre of stroke, for a heading [rad] or a twist of any size."""
    if np.ndim(direction) == 0:
        heading = float(direction)  # type: ignore[arg-type]
        direction = (math.cos(heading), math.sin(heading), 0.0) if math.isfinite(heading) else (heading, 0.0, 0.0)
    path = BodyPath(tuple(direction))  # type: ignore[arg-type]
    largest = max(map(abs, path.displacement))
    path = BodyPath(tuple(v / largest for v in path.displacement))  # type: ignore[arg-type]
    return np.asarray(path.displacement) / float(path.travel(rest).max())


def steady_solution(setup: WalkSetup, twist: Float[Array, "*#batch 3"], phases: Float[Array, "m"]) -> IKSolution:
    """Return the inverse kinematics ``(..., m)`` at phases ``(m,)`` of a steady cycle; `twist` is per stance time."""
    feet, _ = cycle_feet(
        setup.gait, setup.rest, np.asarray(twist), swing_height=np.asarray(setup.swing_height), phases=phases
    )
    if not setup.gait.body_shift:
        return setup.solve(feet)
    return setup.solve(feet, shifted_pose(np.zeros(3), shift_at(walk_shift(setup, twist), np.asarray(phases))))


def first_failure(solution: IKSolution) -> str:
    """Return the sentence on the first sample of a steady cycle in which a leg fails, without its index."""
    return solution.explain(frame=HEADING_FRAME).splitlines()[0].partition("] ")[2]


def leg_feasibility(
    setup: WalkSetup, twist: Float[Array, "*#batch 3"]
) -> tuple[Bool[np.ndarray, "*batch legs"], IKSolution]:
    """Return which legs reach their feet without a jump in every walk with that stroke.

    Parameters
    ----------
    setup : WalkSetup
        Robot and gait.
    twist : array, shape (..., 3)
        Displacement of the body in one stance time: forward [m], left [m], yaw [rad].

    Returns
    -------
    feasible : array of bool, shape (..., legs)
        Whether each leg does.
    solution : IKSolution
        Inverse kinematics of the feet of `extreme_excursions`; with a body shift, of `walk_excursions`.
    """
    if setup.gait.body_shift:
        return shifted_feasibility(setup, twist)
    excursions = extreme_excursions(setup.gait.duty_factor, curved=bool(np.any(twist[..., 2])))
    solution = setup.solve(excursions.feet(setup.rest, twist, setup.swing_height))
    at_rest = branches(setup.robot, setup.solve(setup.rest).angles)
    same = (branches(setup.robot, solution.angles) == at_rest).all(-1)
    return ((np.asarray(solution.reach) == 0) & same).all(-2), solution


def longest_stroke(setup: WalkSetup, direction: float | Sequence[float]) -> float:
    """Return the longest stroke in a direction (see `max_stroke`).

    Parameters
    ----------
    setup : WalkSetup
        Robot and gait.
    direction : float or (forward, left, yaw)
        A heading [rad] or a twist.
    """
    twist = unit_twist(setup.rest, direction)

    def reached(strokes: np.ndarray) -> np.ndarray:
        return np.asarray(leg_feasibility(setup, strokes[:, None] * twist)[0].all(-1))

    # A foot moves at most from one side of the coxa axis to the other.
    longest = 2 * float((setup.robot.coxa + setup.robot.femur + setup.robot.tibia).max())
    tolerance = _SHIFT_TOLERANCE if setup.gait.body_shift else 1e-6
    return _SAFETY * _keep_distance(setup, twist, _before_failure(reached, longest, tolerance=tolerance))


def _keep_distance(setup: WalkSetup, twist: Float[Array, "*#batch 3"], longest: float) -> float:
    """Return the longest stroke, at most `longest`, with which the feet keep their distance."""

    def while_cruising(strokes: np.ndarray) -> np.ndarray:
        phases = np.linspace(0, 1, math.ceil(SWING_SAMPLES / (1 - setup.gait.duty_factor)) + 1)
        feet, _ = cycle_feet(
            setup.gait, setup.rest, strokes[:, None] * twist, swing_height=setup.swing_height, phases=phases
        )
        return np.asarray(passing_distance(feet)[0].min(-1))

    def certain(strokes: np.ndarray) -> np.ndarray:
        return np.asarray(while_cruising(strokes) >= setup.foot_distance + _START_AND_STOP * strokes)

    tolerance = 2e-4 * longest
    if certain(np.linspace(0, longest, 13)).all():
        return longest
    low = _before_failure(certain, longest, tolerance=tolerance)
    high = _before_failure(lambda strokes: while_cruising(strokes) >= setup.foot_distance, longest, tolerance=tolerance)
    # Between the two, the distance during start and stop decides.
    for stroke in np.linspace(low, high, _AT_ONCE + 1)[1:]:
        feet = walk_excursions(setup.gait).feet(setup.rest, stroke * twist, setup.swing_height)
        if (passing_distance(feet)[0] < setup.foot_distance).any():
            break
        low = float(stroke)
    return low


def _before_failure(feasible: Callable[[np.ndarray], np.ndarray], highest: float, *, tolerance: float) -> float:
    """Return the greatest feasible number below the first infeasible one: coarse steps, then finer ones."""
    step = highest / _COARSE
    for first in range(0, _COARSE + 1, _AT_ONCE):
        tried = feasible(np.arange(first, first + _AT_ONCE) * step)
        if not tried.all():
            break
    else:
        return highest
    failure = first + int(np.argmin(tried))
    if failure == 0:
        return 0.0
    low = (failure - 1) * step
    while step > tolerance:
        step /= _AT_ONCE + 1
        tried = feasible(low + np.arange(1, _AT_ONCE + 1) * step)
        low += step * (_AT_ONCE if tried.all() else int(np.argmin(tried)))
    return min(low, highest)


def max_stroke(
    robot: Robot,
    gait: Gait,
    direction: float | Sequence[float] = 0.0,
    body_height: float | None = None,
    *,
    swing_height: float | None = None,
    body_tilt: Sequence[float] = (0.0, 0.0),
    foot_distance: float | None = None,
) -> float:
    """Return the longest stroke that all legs can make in a direction, within their joint limits.

    Walks of any length in that direction are possible with this stroke and all shorter ones: stances and swings of
    steady walking, and those of start and stop, whose excursions are larger. The limit is the first stroke at which a
    foot is out of reach, a leg changes its inverse-kinematics branch, or two feet come too close to each other; with a
    body shift, also the first at which the stability margin is less than half of the one planned.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait
        The gait.
    direction : float or (forward, left, yaw)
        A heading relative to the body's front, counter-clockwise [rad]; or a twist of any size (``(0, 0, 1)`` turns on
        the spot). The stroke is that of the outermost foot.
    body_height : float, optional
        Height of the body's origin above the ground [m]. Default: the robot's.
    swing_height : float, optional
        Swing height [m]. Default: the robot's.
    body_tilt : (roll, pitch)
        Tilt of the body relative to the ground [rad].
    foot_distance : float, optional
        Least distance between two feet [m]. Default: two foot radii and 10 mm.

    Returns
    -------
    float
        The longest stroke less 0.2 % [m]; 0 where stepping on the spot is impossible.

    Raises
    ------
    InputError
        If an argument is not finite or out of range, the robot is a batch, or the gait is for another number of legs.
    UnreachableError
        If a leg does not reach the ground at that body height.
    """
    setup = WalkSetup.of(
        robot,
        gait,
        body_height=body_height,
        swing_height=swing_height,
        body_tilt=body_tilt,
        foot_distance=foot_distance,
    )
    return longest_stroke(setup, direction)
