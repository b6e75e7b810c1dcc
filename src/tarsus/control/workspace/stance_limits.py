"""Velocity limits that hold in the stances of a walk, found in stages of less than a tick each."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.workspace.foot_workspace import foot_workspace
from tarsus.gait.body_shift import shift_at
from tarsus.gait.foot_polygons import NORMALS_CONJUGATE
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stability import StabilityCheck, safe_fraction, support_sets
from tarsus.gait.stance.stance_geometry import StanceGeometry
from tarsus.gait.stance.stance_shift import stance_shift, support_phases
from tarsus.gait.stance.velocity_limits import VelocityLimits
from tarsus.incremental import Incremental
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["shifted_limits", "velocity_limits"]

# Phases of a body shift at which the reach of the legs is examined: over a cycle, the shift points in all directions.
_SHIFT_PHASES = np.arange(8) / 8


def velocity_limits(
    robot: Robot, gait: Gait, stances: Sequence[StanceGeometry], *, foot_distance: float, excluded: tuple[int, ...] = ()
) -> Incremental[VelocityLimits]:
    """Find the limits that hold in all of some stances.

    Parameters
    ----------
    robot, gait : Robot, Gait
        A single robot; a gait without a body shift.
    stances : sequence of StanceGeometry
        At least one; the limits refer to the rest footholds of the last, in which the robot stays.
    foot_distance : float
        Least distance between two feet [m].
    excluded : tuple of int
        Legs that do not step: their feet are not bounded here, but their positions may shift the centre of mass.
    """
    found, check, sets = list[VelocityLimits](), None, support_sets(gait, excluded)
    for stance in stances:
        sides = yield from foot_workspace(robot, stance, foot_distance=foot_distance)
        # Prepared in this stage of the computation, which has little else to do.
        check = check or StabilityCheck(robot, sets, excluded)
        centre, shift = check.centre_of_mass(stance, sides)
        yield
        fraction = safe_fraction(sets, sides, stance.rest, centre, margin=check.least_margin, shift=shift)
        found.append(_limits_in(check, stance, sides, fraction))
        yield
    return dataclasses.replace(reduce(VelocityLimits.intersection, found), rest=stances[-1].rest)


def shifted_limits(
    robot: Robot, gait: Gait, stance: StanceGeometry, *, foot_distance: float
) -> Incremental[VelocityLimits]:
    """Find a body shift for a stance, and the limits that hold with it.

    Parameters
    ----------
    robot, gait : Robot, Gait
        A single robot; a gait with a body shift.
    stance, foot_distance : StanceGeometry, float
        The body, without its shift, and the rest footholds; least distance between two feet [m].
    """
    sides = yield from foot_workspace(robot, stance, foot_distance=foot_distance)
    everywhere = StabilityCheck(robot, np.ones((1, robot.legs), dtype=bool))
    limits = _limits_in(everywhere, stance, sides, 1.0)
    centre, _ = everywhere.centre_of_mass(stance, sides)
    yield
    coefficients = stance_shift(gait, stance, centre, max(float(limits.margins.min()), 0.0))
    yield
    for displacement in shift_at(coefficients, _SHIFT_PHASES).tolist():
        stand = _displaced(stance, displacement)
        sides = yield from foot_workspace(robot, stand, foot_distance=foot_distance)
        limits = limits.intersection(_limits_in(everywhere, stand, sides, 1.0))
        yield
    # Elongated polygons would have to shrink more for stability, and in their short directions too.
    around = (NORMALS_CONJUGATE * stance.rest[:, None]).real + max(float(limits.margins.min()), 0.0)
    sides, fraction = np.minimum(limits.bounds, around), 1.0
    for phase, down in zip(*support_phases(gait), strict=True):
        check, stand = StabilityCheck(robot, down[None]), _displaced(stance, complex(shift_at(coefficients, phase)))
        centre, shift = check.centre_of_mass(stand, sides)
        safe = safe_fraction(down[None], sides, stand.rest, centre, margin=check.least_margin, shift=shift)
        fraction = min(fraction, safe)
        yield
    return dataclasses.replace(_limits_in(everywhere, stance, sides, fraction), shift=coefficients)


def _displaced(stance: StanceGeometry, displacement: complex) -> StanceGeometry:
    """Return the stance with the body displaced in the ground plane."""
    return stance._replace(position=stance.position + np.array([displacement.real, displacement.imag, 0.0]))


def _limits_in(
    check: StabilityCheck, stance: StanceGeometry, sides: Float[np.ndarray, "legs 16"], fraction: float
) -> VelocityLimits:
    """Return the limits in one stance, with polygons shrunk to the fraction at which the robot stays stable."""
    at_rest = (NORMALS_CONJUGATE * stance.rest[:, None]).real
    free = sides - at_rest
    free = np.where(free > 0, free * fraction, free)
    # With the centre of mass outside a support polygon at rest, no step is safe: there is no room around a foothold.
    free = free if fraction > 0 else np.minimum(free, -1e-3)
    bounds = at_rest + free
    bounds[check.excluded], free[check.excluded] = np.inf, np.inf
    return VelocityLimits(bounds, free, stance.rest, fraction > 0)
