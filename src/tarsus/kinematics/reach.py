"""Reach codes: whether a leg reaches its foot within its joint limits, and if not, why."""

from __future__ import annotations

import enum

from tarsus.arrays import Array, Namespace
from tarsus.kinematics.triangle import Triangle
from tarsus.robot.geometry import LegGeometry

__all__ = ["ANGLE_TOLERANCE", "LENGTH_TOLERANCE", "Reach", "all_within", "mark", "reach_codes"]

LENGTH_TOLERANCE = 1e-13
"""Tolerance for rounding of a distance [m]: a foot no farther than this out of reach counts as reached."""

ANGLE_TOLERANCE = 1e-9
"""Tolerance for rounding of an angle [rad]: a joint no farther than this beyond its limit counts as within it."""


class Reach(enum.IntEnum):
    """Whether a leg reaches its foot, and if not, why.

    Of several reasons, the first in this order: coxa axis below the ground, distance, limit of the innermost joint,
    femur axis or knee below the ground.
    """

    OK = 0
    TOO_FAR = 1
    TOO_NEAR = 2
    COXA_LIMIT = 3
    FEMUR_LIMIT = 4
    TIBIA_LIMIT = 5
    BELOW_GROUND = 6


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
