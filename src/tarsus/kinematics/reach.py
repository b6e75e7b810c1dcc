"""Whether a leg reaches its foot; if not, why, by how much, and what is nearest."""

from __future__ import annotations

import enum
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from tarsus.arrays import Array, namespace
from tarsus.errors import UnreachableError
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

__all__ = ["IKSolution", "Reach"]

_MOST_LINES = 12


class Reach(enum.IntEnum):
    """Why a leg can't have its foot where it should be.

    Of several reasons: a coxa axis below the ground comes first, then the distance, then the limit of the innermost
    joint, then a femur axis or knee below the ground.
    """

    OK = 0
    TOO_FAR = 1
    TOO_NEAR = 2
    COXA_LIMIT = 3
    FEMUR_LIMIT = 4
    TIBIA_LIMIT = 5
    BELOW_GROUND = 6


@dataclass(frozen=True, eq=False, kw_only=True)
class IKSolution:
    """Joint angles for wanted feet, and a verdict on every leg.

    Attributes
    ----------
    robot : Robot
        The robot, or a batch of designs.
    feet : array, shape (..., legs, 3)
        Where the feet should be, in G where `body` is given, else in B [m].
    body : Pose or None
        The body's place in G.
    knee : str
        ``"up"`` or ``"down"``.
    angles : array, shape (..., legs, 3)
        Joint angles [rad]; of the nearest reachable point where the foot can't be reached.
    reach : array of int8, shape (..., legs)
        Codes of `Reach`; 0 is OK.
    """

    robot: Robot
    feet: Array
    body: Pose | None
    knee: str
    angles: Array
    reach: Array

    @cached_property
    def ok(self) -> Array:
        """Whether every leg reaches its foot ``(...)``."""
        return namespace(self.reach).all(self.reach == 0, axis=-1)

    def require(self) -> Self:
        """Return the solution itself.

        Raises
        ------
        UnreachableError
            If a leg can't reach its foot; the message is `explain`'s.
        """
        if not bool(np.all(np.asarray(self.reach) == 0)):
            raise UnreachableError(self.explain())
        return self

    def explain(self) -> str:
        """Return a line for every leg that can't reach: which, why, by how much, and the nearest that works."""
        from tarsus.kinematics.explain import explain_leg  # which solves again, and so comes after this module

        reach = np.asarray(self.reach)
        failing = np.argwhere(reach != 0)
        if not len(failing):
            return "every leg reaches its foot"
        lines = [explain_leg(self, tuple(int(i) for i in index)) for index in failing[:_MOST_LINES]]
        if len(failing) > _MOST_LINES:
            lines.append(f"... and {len(failing) - _MOST_LINES} more of {reach.size} legs")
        return "\n".join(lines)
