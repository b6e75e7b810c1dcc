"""Stages of finding the limits in a stance: generators that yield where their work continues in the next tick."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.incremental import Incremental
from tarsus.control.workspace.body_shift import displaced, shift_extremes, stance_shift, support_phases
from tarsus.control.workspace.cycle_time import CycleTiming, CycleTimingSearch
from tarsus.control.workspace.foot_workspace import PASSES, FootWorkspaceSearch
from tarsus.control.workspace.polygon import NORMALS_CONJUGATE
from tarsus.control.workspace.stability import StabilityCheck
from tarsus.control.workspace.stance_geometry import StanceGeometry
from tarsus.control.workspace.velocity_limits import VelocityLimits, stance_limits
from tarsus.gait.body_shift import shift_at
from tarsus.gait.gait import Gait
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["cycle_timing", "foot_workspace", "shifted_limits", "velocity_limits"]


# How many points on the polygons' edges, and how many blocks of motions, are examined in one tick.
_POINTS, _BLOCKS = 600, 3


def foot_workspace(
    robot: Robot, stance: StanceGeometry, *, foot_distance: float
) -> Incremental[Float[np.ndarray, "legs 16"]]:
    """Find the sides of each foot's polygon in one stance.

    Parameters
    ----------
    robot : Robot
        A single robot.
    stance : StanceGeometry
        The body and the rest footholds.
    foot_distance : float
        Least distance between two feet [m].

    Returns
    -------
    array, shape (legs, 16)
        The sides, as of `FootWorkspaceSearch`.
    """
    search = FootWorkspaceSearch(robot, stance, foot_distance=foot_distance)
    search.sample_inner()
    yield
    search.sample_outer()
    yield
    search.refine()
    yield
    examined = 0
    for _ in range(PASSES):
        examined += search.edge_points
        if search.test_edge():
            yield
            search.sample_edge()
            examined = _POINTS
        if not search.move_inwards():
            break
        if examined + search.edge_points > _POINTS:
            yield
            examined = 0
    if examined + search.edge_points > _POINTS:
        yield
    return search.bounds


def velocity_limits(
    robot: Robot,
    stances: Sequence[StanceGeometry],
    sets: Bool[np.ndarray, "n legs"],
    *,
    foot_distance: float,
    excluded: tuple[int, ...] = (),
) -> Incremental[VelocityLimits]:
    """Find the limits that hold in each of some stances.

    Parameters
    ----------
    robot : Robot
        A single robot.
    stances : sequence of StanceGeometry
        At least one; the last is the one that stays.
    sets : array of bool, shape (n, legs)
        Feet that are in stance together.
    foot_distance : float
        Least distance between two feet [m].
    excluded : tuple of int
        Legs that do not step: their position is not bounded here, but may shift the centre of mass.
    """
    check = StabilityCheck(robot, sets, excluded)
    limits: VelocityLimits | None = None
    for stance in stances:
        sides = yield from foot_workspace(robot, stance, foot_distance=foot_distance)
        centre, shift = check.centre_of_mass(stance, sides)
        yield
        found = stance_limits(check, stance, sides, check.safe_fraction(stance, sides, centre, shift))
        limits = found if limits is None else limits.intersection(found)
        yield
    assert limits is not None  # there is at least one stance
    return dataclasses.replace(limits, rest=stances[-1].rest)


def shifted_limits(
    robot: Robot, gait: Gait, stance: StanceGeometry, *, foot_distance: float
) -> Incremental[VelocityLimits]:
    """Find a body shift for a stance, and the limits that hold with it.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait
        A gait with a body shift.
    stance : StanceGeometry
        The body, without its shift, and the rest footholds.
    foot_distance : float
        Least distance between two feet [m].
    """
    everywhere = StabilityCheck(robot, np.ones((1, robot.legs), dtype=bool))
    sides = yield from foot_workspace(robot, stance, foot_distance=foot_distance)
    limits = stance_limits(everywhere, stance, sides, 1.0)
    centre, _ = everywhere.centre_of_mass(stance, sides)
    yield
    coefficients = stance_shift(gait, stance, centre, max(float(limits.margins.min()), 0.0))
    yield
    for displacement in shift_extremes(coefficients).tolist():
        stand = displaced(stance, displacement)
        sides = yield from foot_workspace(robot, stand, foot_distance=foot_distance)
        limits = limits.intersection(stance_limits(everywhere, stand, sides, 1.0))
        yield
    # Longer polygons would have to shrink more for stability, in their short directions too.
    around = (NORMALS_CONJUGATE * stance.rest[:, None]).real + max(float(limits.margins.min()), 0.0)
    sides, fraction = np.minimum(limits.bounds, around), 1.0
    for phase, down in zip(*support_phases(gait), strict=True):
        check, stand = StabilityCheck(robot, down[None]), displaced(stance, complex(shift_at(coefficients, phase)))
        fraction = min(fraction, check.safe_fraction(stand, sides, *check.centre_of_mass(stand, sides)))
        yield
    return dataclasses.replace(stance_limits(everywhere, stance, sides, fraction), shift=coefficients)


def cycle_timing(
    robot: Robot,
    gait: Gait,
    stance: StanceGeometry,
    limits: VelocityLimits,
    *,
    speed: Float[np.ndarray, "..."],
    acceleration: Float[np.ndarray, "..."],
    cycle_time: float | None = None,
) -> Incremental[CycleTiming]:
    """Find the cycle time that the joints can follow.

    Parameters
    ----------
    robot, gait, stance, limits, speed, acceleration
        As for `CycleTimingSearch`.
    cycle_time : float, optional
        Commanded duration of a cycle [s]; left out, the one of the fastest walk.
    """
    search = CycleTimingSearch(robot, gait, stance, limits, speed=speed, acceleration=acceleration)
    for block in range(search.blocks):
        search.examine(block)
        # The first and the last stage also contain other work.
        if block % _BLOCKS == 0:
            yield
    return search.timing(cycle_time)
