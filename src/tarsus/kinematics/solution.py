"""The result of inverse kinematics: joint angles, reach codes, and an explanation of each leg that fails."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal, Self

import numpy as np

from tarsus.arrays import Array, is_traced, namespace
from tarsus.errors import InputError, UnreachableError
from tarsus.kinematics.explain import BODY_FRAME, GROUND_FRAME, explain_legs
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import Reach
from tarsus.representation import Rows, represented
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Int

__all__ = ["IKSolution"]

_MOST_LINES = 12


@represented("robot", "ok", "knee", "angles", "reach")
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

    def _rows(self) -> Rows:
        """Return angles and reach of each leg of a single robot in a single pose."""
        if is_traced(self.angles) or np.ndim(self.angles) != 2:
            return ()
        angles, reach = np.degrees(np.asarray(self.angles)).round(1) + 0.0, np.asarray(self.reach)
        return [
            {"leg": name}
            | {f"{joint} [deg]": f"{angle:.1f}" for joint, angle in zip(JOINTS, angles[leg], strict=True)}
            | {"reach": Reach(int(reach[leg])).name}
            for leg, name in enumerate(self.robot.leg_names)
        ]

    def require(self) -> Self:
        """Return the solution itself.

        Raises
        ------
        UnreachableError
            If a leg does not reach its foot; the message is that of `explain`.
        InputError
            If the solution is traced by JAX.
        """
        self._require_values("require")
        if not bool(np.all(np.asarray(self.reach) == 0)):
            raise UnreachableError(self.explain())
        return self

    def explain(self, *, frame: str | None = None) -> str:
        """Return sentences on the legs that fail: which, why, by how much, and the nearest point that is reachable.

        Legs that fail for the same reason by the same amount share a sentence.

        Parameters
        ----------
        frame : str, optional
            Name of the frame in which the feet were given. Default: the ground frame G where `body` is given, else the
            body frame B.

        Raises
        ------
        InputError
            If the solution is traced by JAX.
        """
        self._require_values("explain")
        reach = np.asarray(self.reach)
        failing = np.argwhere(reach != 0)
        if not len(failing):
            return "every leg reaches its target"
        # All legs of a sample may share a sentence.
        enough = failing[: _MOST_LINES * reach.shape[-1], :-1].tolist()
        samples = list(dict.fromkeys(map(tuple, enough)))[:_MOST_LINES]
        sentences = [sentence for sample in samples for sentence in self._sentences(sample, frame)]
        lines = [line for line, _ in sentences[:_MOST_LINES]]
        explained = sum(legs for _, legs in sentences[:_MOST_LINES])
        if len(failing) > explained:
            lines.append(f"... and {len(failing) - explained} more of {reach.size} legs")
        return "\n".join(lines)

    def explain_leg(self, index: tuple[int, ...], *, frame: str | None = None) -> str:
        """Return the sentence on one leg that fails.

        Parameters
        ----------
        index : tuple of int
            Index of the leg in `reach`.
        frame : str, optional
            As for `explain`.

        Raises
        ------
        InputError
            If the solution is traced by JAX.
        """
        self._require_values("explain_leg")
        return self._sentences(index[:-1], frame, legs=[index[-1]])[0][0]

    def _require_values(self, name: str) -> None:
        if is_traced(self.reach):
            raise InputError(f"{name} can't be traced: it depends on which legs fail; call it outside jit")

    def _sentences(
        self, batch: tuple[int, ...], frame: str | None, *, legs: Sequence[int] | None = None
    ) -> list[tuple[str, int]]:
        """Return the sentences on a sample of the batch, with the numbers of their legs."""
        if legs is None:
            legs = np.flatnonzero(np.asarray(self.reach)[batch]).tolist()
        default = BODY_FRAME if self.body is None else GROUND_FRAME
        solution = (self.robot, self.feet, self.body, self.knee, self.angles, self.reach)
        return explain_legs(*solution, batch=batch, legs=legs, frame=frame or default)
