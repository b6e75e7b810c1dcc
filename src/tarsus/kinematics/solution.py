"""The result of inverse kinematics: joint angles, reach codes, and an explanation of each leg that fails."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, Self

import numpy as np

from tarsus.arrays import Array, namespace
from tarsus.errors import UnreachableError
from tarsus.kinematics.explain import explain_leg
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Int

__all__ = ["IKSolution"]

_MOST_LINES = 12


@dataclass(frozen=True, eq=False, kw_only=True)
class IKSolution:
    """Joint angles for given feet, with a reach code for every leg.

    Attributes
    ----------
    robot : Robot
        The robot, or a batch of designs.
    feet : array, shape (..., legs, 3)
        The feet given, in G where `body` is given, else in B [m].
    body : Pose or None
        Pose of B in G.
    knee : {"up", "down"}
        Knee branch.
    angles : array, shape (..., legs, 3)
        Joint angles [rad]; of the nearest reachable point where the foot can't be reached.
    reach : array of int8, shape (..., legs)
        Codes of `Reach`; 0 is OK.
    """

    robot: Robot
    feet: Float[Array, "*#batch legs 3"]
    body: Pose | None
    knee: Literal["up", "down"]
    angles: Float[Array, "*#batch legs 3"]
    reach: Int[Array, "*#batch legs"]

    @cached_property
    def ok(self) -> Bool[Array, "*batch"]:
        """Whether all legs reach their feet ``(...)``."""
        return namespace(self.reach).all(self.reach == 0, axis=-1)

    def require(self) -> Self:
        """Return the solution itself.

        Raises
        ------
        UnreachableError
            If a leg does not reach its foot; the message is that of `explain`.
        """
        if not bool(np.all(np.asarray(self.reach) == 0)):
            raise UnreachableError(self.explain())
        return self

    def explain(self) -> str:
        """Return a line for every leg that fails: which, why, by how much, and the nearest foot that is reachable."""
        reach = np.asarray(self.reach)
        failing = np.argwhere(reach != 0)
        if not len(failing):
            return "every leg reaches its foot"
        lines = [self.explain_leg(tuple(int(i) for i in index)) for index in failing[:_MOST_LINES]]
        if len(failing) > _MOST_LINES:
            lines.append(f"... and {len(failing) - _MOST_LINES} more of {reach.size} legs")
        return "\n".join(lines)

    def explain_leg(self, index: tuple[int, ...]) -> str:
        """Return the line on one leg that fails.

        Parameters
        ----------
        index : tuple of int
            Index of the leg in `reach`.
        """
        return explain_leg(self.robot, self.feet, self.body, self.knee, self.angles, self.reach, index=index)
