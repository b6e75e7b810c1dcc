"""Whether a leg reaches its foot; if not, why, by how much, and what is nearest."""

from __future__ import annotations

import enum
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np

from tarsus.arrays import Array, namespace
from tarsus.errors import UnreachableError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.triangle import solve_triangle, to_leg_frame
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["IKSolution", "Reach"]

_MOST_LINES = 12


class Reach(enum.IntEnum):
    """Why a leg can't have its foot where it should be; the first that holds, in this order."""

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
        reach = np.asarray(self.reach)
        failing = np.argwhere(reach != 0)
        if not len(failing):
            return "every leg reaches its foot"
        lines = [self._explain_leg(tuple(int(i) for i in index)) for index in failing[:_MOST_LINES]]
        if len(failing) > _MOST_LINES:
            lines.append(f"... and {len(failing) - _MOST_LINES} more of {reach.size} legs")
        return "\n".join(lines)

    def _explain_leg(self, index: tuple[int, ...]) -> str:
        *batch, leg = index
        where = f"{batch} " if batch else ""
        one = _Leg.of(self, tuple(batch), leg)
        code = Reach(int(np.asarray(self.reach)[index]))
        text = f"{where}{self.robot.leg_names[leg]}: {code.name}: {one.why(code)}"
        if code is Reach.BELOW_GROUND:
            return f"{text}. Raise the body by {one.sunk()[1]:.1f} mm"
        x, y, z = one.nearest * 1000
        miss = math.dist(one.nearest, one.wanted) * 1000
        return f"{text}. Nearest that works: the foot at ({x:.1f}, {y:.1f}, {z:.1f}) mm, {miss:.1f} mm away"


@dataclass(frozen=True, eq=False)
class _Leg:
    """One leg of a solution, as plain numbers: the whole robot's points of that sample, for the messages."""

    robot: Robot
    leg: int
    knee: int
    wanted: np.ndarray[Any, Any]
    nearest: np.ndarray[Any, Any]
    points: np.ndarray[Any, Any]
    in_leg: tuple[np.ndarray[Any, Any], ...]

    @classmethod
    def of(cls, solution: IKSolution, batch: tuple[int, ...], leg: int) -> Self:
        whole = np.asarray(solution.reach).shape[:-1]
        robot = solution.robot.item(batch, of=whole)
        wanted = np.broadcast_to(np.asarray(solution.feet), (*whole, robot.legs, 3))[batch]
        points = forward_kinematics(robot, np.asarray(solution.angles)[batch])
        in_body = wanted
        if solution.body is not None:
            pose = solution.body
            rotation = np.broadcast_to(np.asarray(pose.rotation), (*whole, 3, 3))[batch]
            position = np.broadcast_to(np.asarray(pose.position), (*whole, 3))[batch]
            body = Pose(rotation, position)
            points, in_body = body @ points, body.inverse() @ wanted
        in_leg = to_leg_frame(robot.geometry, in_body[:, 0], in_body[:, 1], in_body[:, 2])
        knee = 1 if solution.knee == "up" else -1
        return cls(robot, leg, knee, wanted[leg], points[leg, 3], points[leg], in_leg)

    def why(self, code: Reach) -> str:
        if code is Reach.BELOW_GROUND:
            point, depth = self.sunk()
            return f"the {point} is {depth:.1f} mm below the ground"
        if code in (Reach.TOO_FAR, Reach.TOO_NEAR):
            return self._why_distance(code)
        return self._why_limit(code)

    def sunk(self) -> tuple[str, float]:
        """Return the lowest of the points that must be above ground, and its depth [mm]."""
        lowest = int(np.argmin(self.points[:3, 2]))
        return ("coxa axis", "femur axis", "knee")[lowest], -float(self.points[lowest, 2]) * 1000

    def _why_distance(self, code: Reach) -> str:
        g = self.robot.geometry
        x, y, z = (float(v[self.leg]) for v in self.in_leg)
        side, beside = abs(float(g.side[self.leg])) * 1000, math.hypot(x, y) * 1000
        if beside < side:
            return (
                f"the foot is {beside:.1f} mm from the coxa axis, and the femur axis' sideways offset keeps it at "
                f"least {side:.1f} mm away: {side - beside:.1f} mm too near"
            )
        r = math.sqrt(max(x * x + y * y - float(g.side2[self.leg]), 0.0)) - float(g.coxa[self.leg])
        distance = math.hypot(r, z) * 1000
        femur, tibia = float(g.femur[self.leg]) * 1000, float(g.tibia[self.leg]) * 1000
        if code is Reach.TOO_FAR:
            return (
                f"the foot is {distance:.1f} mm from the femur axis, and femur and tibia together reach "
                f"{femur + tibia:.1f} mm: {distance - femur - tibia:.1f} mm too far"
            )
        folded = abs(femur - tibia)
        return (
            f"the foot is {distance:.1f} mm from the femur axis, and the folded leg can't come nearer than "
            f"{folded:.1f} mm: {folded - distance:.1f} mm too near"
        )

    def _why_limit(self, code: Reach) -> str:
        joint = int(code) - int(Reach.COXA_LIMIT)
        triangle = solve_triangle(np, self.robot.geometry, *self.in_leg, knee=self.knee)
        angle = math.degrees(float(triangle[joint][self.leg]))
        low, high = (math.degrees(v) for v in self.robot.limits[self.leg, joint])
        if angle > high:
            return (
                f"the {JOINTS[joint]} would have to be at {angle:.1f} deg, its highest angle is {high:.1f}: "
                f"{angle - high:.1f} deg too far"
            )
        return (
            f"the {JOINTS[joint]} would have to be at {angle:.1f} deg, its lowest angle is {low:.1f}: "
            f"{low - angle:.1f} deg too far"
        )
