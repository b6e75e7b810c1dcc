"""How long a stroke the robot's legs allow, in any direction."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tarsus.arrays import Array
from tarsus.errors import InputError
from tarsus.gait.cycle import cycle_feet, tilted_body
from tarsus.gait.gait import Gait
from tarsus.gait.path import Path, carry, exponential
from tarsus.gait.swing import swing
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.reach import IKSolution
from tarsus.kinematics.stance import default_clearance, default_stance
from tarsus.robot.robot import Robot

__all__ = ["default_foot_distance", "default_lift", "feet_distance", "max_stroke", "steady_solution"]

_PHASES = 48
_STROKES = 17
_REFINEMENTS = 6


def default_lift(robot: Robot) -> float:
    """Return how high a swinging foot is lifted unless told otherwise [m].

    The robot file's `lift_mm`; where it has none, a quarter of the clearance.

    Parameters
    ----------
    robot : Robot
        The robot.
    """
    return robot.gait.lift if robot.gait.lift is not None else abs(default_clearance(robot)) / 4


def default_foot_distance(robot: Robot) -> float:
    """Return the least distance between the centres of two feet that a walk must keep: two radii and 10 mm [m].

    Parameters
    ----------
    robot : Robot
        The robot.
    """
    return 2 * float(np.max(np.asarray(robot.foot_radius))) + 0.010


def feet_distance(feet: Array) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return the least distance between any two feet, and which two.

    Parameters
    ----------
    feet : array, shape (..., legs, 3)
        The feet [m].

    Returns
    -------
    distance : array, shape (...)
        Between the two nearest feet [m].
    pair : array of int, shape (..., 2)
        Which legs they belong to.
    """
    feet = np.asarray(feet)
    first, second = np.triu_indices(feet.shape[-2], k=1)
    apart = feet[..., first, :] - feet[..., second, :]
    distance2 = (apart * apart).sum(-1)
    nearest = distance2.argmin(-1)
    pair = np.stack([first[nearest], second[nearest]], axis=-1)
    return np.sqrt(distance2.min(-1)), pair


def unit_twist(rest: Array, direction: float | Sequence[float]) -> np.ndarray[Any, Any]:
    """Return the twist per metre of stroke in a direction: a heading [rad], or (forward, left, yaw) in any measure."""
    if isinstance(direction, int | float | np.floating | np.integer):
        direction = (math.cos(direction), math.sin(direction), 0.0)
    path = Path(tuple(direction))  # type: ignore[arg-type]
    return np.asarray(path.displacement) / float(path.travel(rest).max())


def edge_steps(rest: Array, twist: Array, *, lift: float, shares: Array) -> np.ndarray[Any, Any]:
    """Return the feet in the first and the last step of a walk: ``(..., 2 m, legs, 3)`` for `m` shares of the step.

    The body stands; the first step goes from rest to half a stroke ahead, the last from half a stroke behind to rest.
    """
    rest, shares = np.asarray(rest), np.asarray(shares)[:, None]
    displacement = [twist[..., i] for i in range(3)]
    ahead = carry(exponential(displacement, np.asarray(0.5)), rest)
    behind = carry(exponential(displacement, np.asarray(-0.5)), rest)
    first = swing(rest, ahead[..., None, :, :], shares, np.asarray(lift))
    last = swing(behind[..., None, :, :], rest, shares, np.asarray(lift))
    return np.concatenate([first, last], axis=-3)


def steady_solution(
    robot: Robot,
    gait: Gait,
    twist: Array,
    *,
    clearance: float,
    lift: float,
    body_tilt: Sequence[float] = (0.0, 0.0),
    phases: Array,
    ends: bool = False,
) -> tuple[np.ndarray[Any, Any], IKSolution]:
    """Return the feet and joint angles over one cycle of steady walking.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait
        Its gait.
    twist : array, shape (..., 3)
        What the body moves in one stance time: forward [m], left [m], yaw [rad].
    clearance, lift : float
        Height of the body's origin, and lift of the swinging feet [m].
    body_tilt : sequence of float
        Roll and pitch of the body [rad].
    phases : array, shape (m,)
        Moments of the cycle, in cycles.
    ends : bool
        Whether ``2 m`` moments of a first and a last step follow.

    Returns
    -------
    feet : array, shape (..., m, legs, 3)
        In the body's heading frame on the ground [m].
    solution : IKSolution
        Angles ``(..., m, legs, 3)`` and reach codes.
    """
    rest = default_stance(robot, clearance, lift=lift) + np.array([0.0, 0.0, clearance])
    feet, _ = cycle_feet(gait, rest, np.asarray(twist), lift=np.asarray(lift), phases=phases)
    if ends:
        edges = edge_steps(rest, np.asarray(twist), lift=lift, shares=phases)
        feet = np.concatenate([feet, edges], axis=-3)
    body = tilted_body(np.zeros(3), clearance=np.asarray(clearance), body_tilt=body_tilt)
    return feet, inverse_kinematics(robot, feet, body)


def max_stroke(
    robot: Robot,
    gait: Gait,
    direction: float | Sequence[float] = 0.0,
    clearance: float | None = None,
    *,
    lift: float | None = None,
    body_tilt: Sequence[float] = (0.0, 0.0),
    foot_distance: float | None = None,
) -> float:
    """Return the longest stroke that every leg can make in a direction, joint limits included.

    Whole cycles of steady walking are tried, swings and lift included, and the first and last step of a walk, which
    lift the foot elsewhere: from no stroke up to the first that takes a foot out of reach, or two feet too near to
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
    clearance : float, optional
        Height of the body's origin [m]; the robot's own where left out.
    lift : float, optional
        Lift of the swinging feet [m]; the robot's own where left out.
    body_tilt : (roll, pitch)
        The body's tilt [rad].
    foot_distance : float, optional
        Least distance between two feet [m]; `default_foot_distance` where left out.

    Returns
    -------
    float
        The longest stroke [m], to a hundredth of a millimetre, never too long; 0 where not even standing works.

    Raises
    ------
    InputError
        If the robot is a batch, or the gait is for another number of legs.
    UnreachableError
        If a leg reaches the ground nowhere at that clearance.
    """
    if robot.batch_shape:
        raise InputError(f"max_stroke takes a single robot, not a batch {robot.batch_shape}")
    gait.require_legs(robot.legs)
    clearance = default_clearance(robot) if clearance is None else clearance
    lift = default_lift(robot) if lift is None else lift
    apart = default_foot_distance(robot) if foot_distance is None else foot_distance
    twist = unit_twist(default_stance(robot, clearance, lift=lift), direction)
    phases = np.arange(_PHASES) / _PHASES
    # A point of the leg's plane is at most the leg's length away on either side.
    low, high = 0.0, 2 * float((robot.coxa + robot.femur + robot.tibia).max())
    for _ in range(_REFINEMENTS):
        strokes = np.linspace(low, high, _STROKES)
        feet, solution = steady_solution(
            robot,
            gait,
            strokes[:, None] * twist,
            clearance=clearance,
            lift=lift,
            body_tilt=body_tilt,
            phases=phases,
            ends=True,
        )
        fine = solution.ok.all(-1) & (feet_distance(feet)[0] >= apart).all(-1)
        if fine.all():
            return high
        first = int(np.argmin(fine))
        if first == 0:
            return low
        low, high = float(strokes[first - 1]), float(strokes[first])
    return low
