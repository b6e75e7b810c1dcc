"""Whether an angle solution is within the leg's reach and limits, and what rounding may add to them."""

from __future__ import annotations

from tarsus.arrays import Array, Namespace
from tarsus.kinematics.reach import Reach
from tarsus.kinematics.triangle import Triangle
from tarsus.robot.geometry import LegGeometry

__all__ = ["ANGLE_TOLERANCE", "LENGTH_TOLERANCE", "all_within", "mark", "reach_codes"]

LENGTH_TOLERANCE = 1e-13
"""What rounding may add to a distance [m]: a foot this much out of the leg's reach is within it."""

ANGLE_TOLERANCE = 1e-9
"""What rounding may add to an angle [rad]: a joint this much beyond its limit is within it."""


def reach_codes(xp: Namespace, geometry: LegGeometry, solution: Triangle) -> Array:
    """Return the reach code of every leg."""
    g = geometry
    codes = xp.zeros(solution.coxa.shape, dtype=xp.int8)
    limits = (
        (solution.tibia, g.tibia_lower, g.tibia_upper, Reach.TIBIA_LIMIT),
        (solution.femur, g.femur_lower, g.femur_upper, Reach.FEMUR_LIMIT),
        (solution.coxa, g.coxa_lower, g.coxa_upper, Reach.COXA_LIMIT),
    )
    for angle, lower, upper, code in limits:
        broken = (angle < lower - ANGLE_TOLERANCE) | (angle > upper + ANGLE_TOLERANCE)
        codes = mark(xp, codes, broken, code)
    # A distance off by the tolerance is a square off by twice the tolerance times that distance.
    slack = 2 * LENGTH_TOLERANCE
    codes = mark(xp, codes, solution.near < -slack * xp.abs(g.femur - g.tibia), Reach.TOO_NEAR)
    codes = mark(xp, codes, solution.far < -slack * (g.femur + g.tibia), Reach.TOO_FAR)
    # Beside the leg's plane there is no triangle that could be too long.
    return mark(xp, codes, solution.beside < -slack * xp.abs(g.side), Reach.TOO_NEAR)


def mark(xp: Namespace, codes: Array, broken: Array, code: Reach) -> Array:
    """Return the codes with those of the broken legs replaced."""
    return xp.where(broken, xp.asarray(int(code), dtype=xp.int8), codes)


def all_within(geometry: LegGeometry, solution: Triangle) -> bool:
    """Return whether every NumPy leg is within reach and limits: the common case, told in a few passes."""
    g, s = geometry, solution
    # Not in place: designs that differ in their limits alone make each of these wider than the one before.
    broken = (s.far < 0) | (s.near < 0) | (s.beside < 0)
    broken = broken | (s.coxa < g.coxa_lower) | (s.coxa > g.coxa_upper)
    broken = broken | (s.femur < g.femur_lower) | (s.femur > g.femur_upper)
    broken = broken | (s.tibia < g.tibia_lower) | (s.tibia > g.tibia_upper)
    return not broken.any()
