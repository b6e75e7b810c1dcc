"""How long a stroke the robot's legs allow, in any direction."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tarsus.arrays import Array
from tarsus.gait.branch import branches
from tarsus.gait.cycle import cycle_feet
from tarsus.gait.excursion import MOMENTS_OF_SWING, extreme_excursions, walk_excursions
from tarsus.gait.gait import Gait
from tarsus.gait.path import BodyPath
from tarsus.gait.setup import Setup
from tarsus.gait.spacing import passing_distance
from tarsus.kinematics.solution import IKSolution
from tarsus.robot.robot import Robot

__all__ = ["longest_stroke", "max_stroke", "steady_solution", "stroke_verdict", "unit_twist"]

Floats = np.ndarray[Any, Any]

# Steps of the farthest thinkable stroke in which the first that fails is looked for; strokes tried at once.
_COARSE = 32
_AT_ONCE = 8
# What the moments that are looked at may miss between them.
_SAFETY = 0.998
# How much nearer to each other than in cruise feet come in start and stop, in strokes: measured, 0.02 at most.
_NEARER = 0.05


def unit_twist(rest: Array, direction: float | Sequence[float]) -> np.ndarray[Any, Any]:
    """Return the twist per metre of stroke in a direction: a heading [rad], or (forward, left, yaw) in any measure."""
    if np.ndim(direction) == 0:
        heading = float(direction)  # type: ignore[arg-type]
        direction = (math.cos(heading), math.sin(heading), 0.0) if math.isfinite(heading) else (heading, 0.0, 0.0)
    path = BodyPath(tuple(direction))  # type: ignore[arg-type]
    largest = max(map(abs, path.displacement))
    path = BodyPath(tuple(v / largest for v in path.displacement))  # type: ignore[arg-type]
    return np.asarray(path.displacement) / float(path.travel(rest).max())


def steady_solution(setup: Setup, twist: Array, phases: Array) -> IKSolution:
    """Return the angles ``(..., m, legs, 3)`` at phases ``(m,)`` of a steady cycle; `twist` is that of a stance."""
    feet, _ = cycle_feet(
        setup.gait, setup.rest, np.asarray(twist), swing_height=np.asarray(setup.swing_height), phases=phases
    )
    return setup.solve(feet)


def stroke_verdict(setup: Setup, twist: Array) -> tuple[np.ndarray[Any, Any], IKSolution]:
    """Return whether every leg reaches its feet in every walk with such strokes, without a jump.

    Parameters
    ----------
    setup : Setup
        Robot and gait.
    twist : array, shape (..., 3)
        What the body moves in one stance time: forward [m], left [m], yaw [rad].

    Returns
    -------
    works : array of bool, shape (..., legs)
        Whether the leg does.
    solution : IKSolution
        At the moments of `extreme_excursions`.
    """
    excursions = extreme_excursions(setup.gait.duty_factor, curved=bool(np.any(twist[..., 2])))
    solution = setup.solve(excursions.feet(setup.rest, twist, setup.swing_height))
    at_rest = branches(setup.robot, setup.solve(setup.rest).angles)
    same = (branches(setup.robot, solution.angles) == at_rest).all(-1)
    return ((np.asarray(solution.reach) == 0) & same).all(-2), solution


def longest_stroke(setup: Setup, direction: float | Sequence[float]) -> float:
    """Return the longest stroke in a direction (see `max_stroke`).

    Parameters
    ----------
    setup : Setup
        Robot and gait.
    direction : float or (forward, left, yaw)
        A heading [rad] or a twist.
    """
    twist = unit_twist(setup.rest, direction)

    def reached(strokes: Floats) -> Floats:
        return np.asarray(stroke_verdict(setup, strokes[:, None] * twist)[0].all(-1))

    # A point of the leg's plane is at most the leg's length away on either side.
    farthest = 2 * float((setup.robot.coxa + setup.robot.femur + setup.robot.tibia).max())
    return _SAFETY * _feet_apart(setup, twist, _before_failure(reached, farthest, tolerance=1e-6))


def _feet_apart(setup: Setup, twist: Array, longest: float) -> float:
    """Return the stroke, at most `longest`, up to which the feet keep their distance."""

    def in_cruise(strokes: Floats) -> Floats:
        phases = np.linspace(0, 1, math.ceil(MOMENTS_OF_SWING / (1 - setup.gait.duty_factor)) + 1)
        feet, _ = cycle_feet(
            setup.gait, setup.rest, strokes[:, None] * twist, swing_height=setup.swing_height, phases=phases
        )
        return np.asarray(passing_distance(feet)[0].min(-1))

    def surely(strokes: Floats) -> Floats:
        return np.asarray(in_cruise(strokes) >= setup.foot_distance + _NEARER * strokes)

    tolerance = 2e-4 * longest
    if surely(np.linspace(0, longest, 13)).all():
        return longest
    low = _before_failure(surely, longest, tolerance=tolerance)
    high = _before_failure(lambda strokes: in_cruise(strokes) >= setup.foot_distance, longest, tolerance=tolerance)
    # Between the two, start and stop decide.
    for stroke in np.linspace(low, high, _AT_ONCE + 1)[1:]:
        feet = walk_excursions(setup.gait).feet(setup.rest, stroke * twist, setup.swing_height)
        if (passing_distance(feet)[0] < setup.foot_distance).any():
            break
        low = float(stroke)
    return low


def _before_failure(works: Callable[[Floats], Floats], highest: float, *, tolerance: float) -> float:
    """Return the greatest number up to which it works: up in steps to the first failure, then ever finer before it."""
    step = highest / _COARSE
    for first in range(0, _COARSE + 1, _AT_ONCE):
        tried = works(np.arange(first, first + _AT_ONCE) * step)
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
        tried = works(low + np.arange(1, _AT_ONCE + 1) * step)
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
    """Return the longest stroke that every leg can make in a direction, joint limits included.

    Every walk in that direction works with it, and with every shorter stroke, however long the walk is: steady steps,
    swings and lift included, and those of start and stop, which hang over farther. The first stroke counts that takes
    a foot out of reach, makes a leg jump from one way to reach its foot to another, or brings two feet too near to
    each other.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait
        Its gait.
    direction : float or (forward, left, yaw)
        A heading from the body's front, counter-clockwise [rad]; or a twist, of which only the direction counts
        (``(0, 0, 1)`` turns on the spot). The stroke is that of the foot that goes farthest.
    body_height : float, optional
        Height of the body's origin [m]; the robot's own where left out.
    swing_height : float, optional
        Lift of the swinging feet [m]; the robot's own where left out.
    body_tilt : (roll, pitch)
        The body's tilt [rad].
    foot_distance : float, optional
        Least distance between two feet [m]; two foot radii and 10 mm where left out.

    Returns
    -------
    float
        The longest stroke [m], given two thousandths short; 0 where not even stepping on the spot works.

    Raises
    ------
    InputError
        If an argument is not finite or out of its range, the robot is a batch, or the gait is for another number of
        legs.
    UnreachableError
        If a leg reaches the ground nowhere at that body height.
    """
    setup = Setup.of(
        robot,
        gait,
        body_height=body_height,
        swing_height=swing_height,
        body_tilt=body_tilt,
        foot_distance=foot_distance,
    )
    return longest_stroke(setup, direction)
