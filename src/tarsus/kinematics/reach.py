"""Reach codes: whether a leg reaches its foot within its joint limits, and if not, why."""

from __future__ import annotations

import enum
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, Namespace
from tarsus.kinematics.triangle import Triangle
from tarsus.robot.geometry import LegGeometry

if TYPE_CHECKING:
    from jaxtyping import Bool, Int

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

    @property
    def text(self) -> str:
        """Name of the code in words."""
        return self.name.replace("_", " ").lower() if self else "OK"


def reach_codes(xp: Namespace, geometry: LegGeometry, solution: Triangle) -> Int[Array, "*batch legs"]:
    """Return the reach code of every leg ``(..., legs)``."""
    g = geometry
    codes = xp.zeros(solution.coxa.shape, dtype=xp.int8)
    limits = (
        (solution.tibia, g.tibia_lower, g.tibia_upper, Reach.TIBIA_LIMIT),
        (solution.femur, g.femur_lower, g.femur_upper, Reach.FEMUR_LIMIT),
        (solution.coxa, g.coxa_lower, g.coxa_upper, Reach.COXA_LIMIT),
    )
    for angle, lower, upper, code in limits:
        violated = (angle < lower - ANGLE_TOLERANCE) | (angle > upper + ANGLE_TOLERANCE)
        codes = mark(xp, codes, violated, code)
    # An error in a distance changes its square by twice the error times the distance.
    tolerance = 2 * LENGTH_TOLERANCE
    codes = mark(xp, codes, solution.near < -tolerance * xp.abs(g.femur - g.tibia), Reach.TOO_NEAR)
    codes = mark(xp, codes, solution.far < -tolerance * (g.femur + g.tibia), Reach.TOO_FAR)
    # Where the leg's plane can't contain the foot, its distance from the femur axis is meaningless.
    return mark(xp, codes, solution.beside < -tolerance * xp.abs(g.side), Reach.TOO_NEAR)


def mark(xp: Namespace, codes: Int[Array, "..."], failing: Bool[Array, "..."], code: Reach) -> Int[Array, "..."]:
    """Return the codes ``(..., legs)`` with those of the failing legs replaced."""
    return xp.where(failing, xp.asarray(int(code), dtype=xp.int8), codes)


def all_within(geometry: LegGeometry, solution: Triangle) -> bool:
    """Return whether every NumPy leg is within reach and limits: the common case, in a few passes."""
    g, s = geometry, solution
    # Not in place: for designs that differ in their limits, each of these may have a larger shape than the last.
    failing = (s.far < 0) | (s.near < 0) | (s.beside < 0)
    failing = failing | (s.coxa < g.coxa_lower) | (s.coxa > g.coxa_upper)
    failing = failing | (s.femur < g.femur_lower) | (s.femur > g.femur_upper)
    failing = failing | (s.tibia < g.tibia_lower) | (s.tibia > g.tibia_upper)
    return not np.count_nonzero(failing)
