"""Explains why legs can't reach their targets, by how much, and which point or body height is possible."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple, Self

import numpy as np

from tarsus.arrays import Array
from tarsus.kinematics.batch_solver import solve_legs
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.nearest import tibia_bend
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import Reach
from tarsus.kinematics.triangle import solve_triangle, to_leg_frame
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["BODY_FRAME", "GROUND_FRAME", "explain_legs"]

BODY_FRAME, GROUND_FRAME = "the body frame B", "the ground frame G"
"""Names of the frames in which targets are given."""

_STEP = 1e-4  # resolution of the body height returned [m]
_TRIES = 64  # most coarse steps in the search for the least rise of the body
_POINTS = 2  # most legs in a sentence that states their points
# Attributes of a robot with an axis of legs.
_OF_LEGS = (
    *("mount_position", "mount_yaw", "coxa", "femur", "tibia", "femur_axis_offset"),
    *("limits", "foot_radius", "link_com", "link_mass"),
)


def explain_legs(
    robot: Robot,
    feet: Float[Array, "*#batch legs 3"],
    body: Pose | None,
    knee: Literal["up", "down"],
    angles: Float[Array, "*#batch legs 3"],
    reach: Int[Array, "*#batch legs"],
    *,
    batch: tuple[int, ...],
    legs: Sequence[int],
    frame: str,
) -> list[tuple[str, int]]:
    """Return sentences on legs that fail: which, why, by how much, and the nearest point or body height possible.

    Legs that fail for the same reason by the same amount share a sentence.

    Parameters
    ----------
    robot, feet, body, knee, angles, reach
        As in `IKSolution`.
    batch : tuple of int
        Index of the sample in the batch.
    legs : sequence of int
        The legs, which fail in that sample.
    frame : str
        Name of the frame of the targets.

    Returns
    -------
    list of (str, int)
        Each sentence with the number of its legs.
    """
    groups: dict[tuple[str, ...], list[_Failure]] = {}
    for leg in legs:
        failure = _Leg.of(robot, feet, body, knee, angles, reach, batch=batch, leg=leg).failure(
            Reach(int(np.asarray(reach)[(*batch, leg)]))
        )
        groups.setdefault((failure.why, failure.remedy, failure.miss), []).append(failure)
    where = f"{list(batch)} " if batch else ""
    return [(where + _sentence(group, robot.legs, frame), len(group)) for group in groups.values()]


class _Failure(NamedTuple):
    """Why a leg fails, as texts; `nearest` and `miss` are empty where raising the body is the remedy."""

    leg: str
    target: str
    why: str
    nearest: str
    miss: str
    remedy: str


def _sentence(failures: list[_Failure], legs: int, frame: str) -> str:
    """Return one sentence on legs that fail alike; points are printed for one or two legs."""
    first, one = failures[0], len(failures) == 1
    names = _list([failure.leg for failure in failures])
    who = f"{names} can't reach {'its target' if one else 'their targets'}"
    if legs == len(failures) > _POINTS:
        who = "no leg can reach its target"
    if first.remedy:
        return f"{who}: {first.why}. {first.remedy}"
    if len(failures) > _POINTS:
        return f"{who}: {first.why}. The nearest reachable points are {first.miss} mm away"
    targets, nearest = _list([f.target for f in failures]), _list([f.nearest for f in failures])
    what, where = ("target is", "point") if one else ("targets are", "points")
    return (
        f"{who}: {first.why}. In {frame} the {what} {targets} mm, the nearest reachable {where} {nearest} mm, "
        f"{first.miss} mm away"
    )


def _list(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


@dataclass(frozen=True, eq=False)
class _Leg:
    """One leg of a solution as plain numbers; points in the frame in which the feet were given."""

    robot: Robot
    knee: int
    target: Float[np.ndarray, "3"]
    body: Pose | None
    points: Float[np.ndarray, "points batch"]
    in_leg: tuple[float, float, float]

    @classmethod
    def of(
        cls,
        robot: Robot,
        feet: Float[Array, "*#batch legs 3"],
        body: Pose | None,
        knee: str,
        angles: Float[Array, "*#batch legs 3"],
        reach: Int[Array, "*#batch legs"],
        *,
        batch: tuple[int, ...],
        leg: int,
    ) -> Self:
        whole = np.asarray(reach).shape[:-1]
        robot = _one_leg(robot.item(batch, of=whole), leg)
        target = np.broadcast_to(np.asarray(feet), np.shape(angles))[batch][[leg]]
        points = forward_kinematics(robot, np.asarray(angles)[batch][[leg]])
        pose, in_body = None, target
        if body is not None:
            rotation = np.broadcast_to(np.asarray(body.rotation), (*whole, 3, 3))[batch]
            position = np.broadcast_to(np.asarray(body.position), (*whole, 3))[batch]
            pose = Pose(rotation, position)
            points, in_body = pose @ points, pose.inverse() @ target
        x, y, z = to_leg_frame(robot.geometry, in_body[:, 0], in_body[:, 1], in_body[:, 2])
        branch = 1 if knee == "up" else -1
        return cls(robot, branch, target[0], pose, points[0], (float(x[0]), float(y[0]), float(z[0])))

    def why(self, code: Reach) -> str:
        """Return the reason, with the number and its bound."""
        if code is Reach.BELOW_GROUND:
            lowest = int(np.argmin(self.points[:3, 2]))
            point, depth = ("coxa axis", "femur axis", "knee")[lowest], -float(self.points[lowest, 2])
            return f"the {point} would be {depth * 1000:.1f} mm below the ground"
        if code in (Reach.TOO_FAR, Reach.TOO_NEAR):
            return self._why_distance(code)
        return self._why_limit(code)

    def failure(self, code: Reach) -> _Failure:
        """Return why the leg fails, and the nearest point that is reachable or the body height that is possible."""
        name, target, why = self.robot.leg_names[0], _point(self.target), self.why(code)
        if code is Reach.BELOW_GROUND and self.body is not None:
            return _Failure(name, target, why, "", "", self._raise_body(self.body))
        miss = math.dist(self.points[3], self.target) * 1000
        return _Failure(name, target, why, _point(self.points[3]), f"{miss:.1f}", "")

    def _raise_body(self, body: Pose) -> str:
        """Return by how much the body must be raised, with the feet unchanged, for the leg to be above the ground."""
        g = self.robot.geometry
        # All points of the leg except the foot are within this distance of the coxa axis.
        span = g.coxa + np.abs(g.side) + np.abs(g.up) + g.femur
        most = math.ceil((float(span[0]) - float(self.points[0, 2])) / _STEP) + 1
        coarse = math.ceil(most / _TRIES)
        end = self._first_above(body, np.arange(coarse, most + coarse, coarse))[0]
        rise, code = self._first_above(body, np.arange(end - coarse + 1, end + 1))
        distance = f"{rise * _STEP * 1000:.1f} mm"
        if code is Reach.OK:
            return f"Raise the body by {distance}"
        return f"Raised by {distance}, the body is high enough, but the foot is out of reach: {code.text}"

    def _first_above(self, body: Pose, steps: Int[np.ndarray, "..."]) -> tuple[int, Reach]:
        """Return the least rise, in steps, at which the leg is above the ground, and its reach code there."""
        higher = Pose(body.rotation, body.position + steps[:, None] * np.array([0.0, 0.0, _STEP]))
        reach = solve_legs(self.robot, self.target[None], higher, knee=self.knee)[1][:, 0]
        first = int(np.argmax(reach != Reach.BELOW_GROUND))
        return int(steps[first]), Reach(int(reach[first]))

    def _why_distance(self, code: Reach) -> str:
        g = self.robot.geometry
        x, y, z = self.in_leg
        side, radius = abs(float(g.side[0])) * 1000, math.hypot(x, y) * 1000
        if radius < side:
            return (
                f"the target is {radius:.1f} mm from the coxa axis, less than the sideways offset of the femur axis, "
                f"{side:.1f} mm: {side - radius:.1f} mm too near"
            )
        r = math.sqrt(max(x * x + y * y - float(g.side2[0]), 0.0)) - float(g.coxa[0])
        distance = math.hypot(r, z) * 1000
        femur, tibia = float(g.femur[0]) * 1000, float(g.tibia[0]) * 1000
        if code is Reach.TOO_FAR:
            return (
                f"the target is {distance:.1f} mm from the femur axis, and femur and tibia are "
                f"{femur + tibia:.1f} mm long: {distance - femur - tibia:.1f} mm too far"
            )
        folded = abs(femur - tibia)
        return (
            f"the target is {distance:.1f} mm from the femur axis, and the folded leg reaches no nearer than "
            f"{folded:.1f} mm: {folded - distance:.1f} mm too near"
        )

    def _why_limit(self, code: Reach) -> str:
        joint = int(code) - int(Reach.COXA_LIMIT)
        # The branch that the limits allow.
        g = self.robot.geometry
        knee = -int(tibia_bend(np, g, knee=self.knee)[0])
        triangle = solve_triangle(np, g, *np.array(self.in_leg)[:, None], knee=knee)
        angle = math.degrees(float(triangle[joint][0]))
        low, high = (math.degrees(v) for v in self.robot.limits[0, joint])
        above, below = (angle - high) % 360.0, (low - angle) % 360.0
        if above < below:
            return (
                f"the {JOINTS[joint]} angle would be {high + above:.1f} deg, {above:.1f} deg above its upper limit of "
                f"{high:.1f} deg"
            )
        return (
            f"the {JOINTS[joint]} angle would be {low - below:.1f} deg, {below:.1f} deg below its lower limit of "
            f"{low:.1f} deg"
        )


def _point(point: Float[np.ndarray, "3"]) -> str:
    """Return a point in millimetres as text."""
    x, y, z = np.round(point * 1000, 1) + 0.0  # no -0.0
    return f"({x:.1f}, {y:.1f}, {z:.1f})"


def _one_leg(robot: Robot, leg: int) -> Robot:
    """Return the robot with one leg only."""
    own = slice(leg, leg + 1)
    arrays = {name: getattr(robot, name)[own] for name in _OF_LEGS if getattr(robot, name) is not None}
    return robot.replace(leg_names=robot.leg_names[own], servos=robot.servos[own], **arrays)
