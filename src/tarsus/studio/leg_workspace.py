"""Workspace of a leg: outlines on the ground and in the plane of the leg.

Rays are cast from the coxa axis on the ground, and from the femur axis in the plane of the leg. Along each ray, inverse
kinematics finds the widest interval of reachable points, and bisection its ends. So joint limits, offsets, tilt and the
ground are included. Points that a leg reaches backwards over its coxa axis are excluded, as walks do not use them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tarsus.gait.branch import branches
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.solution import IKSolution
from tarsus.robot.robot import Robot
from tarsus.studio.encoding import millimetres, or_null
from tarsus.studio.messages.pose import WorkspaceMessage

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["Outline", "ground_band", "ground_outline", "plane_outline", "workspace_message"]

Points: TypeAlias = Callable[[np.ndarray, np.ndarray], np.ndarray]

_RAYS = 72
_ALONG = 40
# Number of bisections: they reduce the distance between samples of a ray (some mm) to less than a micrometre.
_HALVINGS = 14


@dataclass(frozen=True, eq=False)
class Outline:
    """Outline of the workspace of a leg in a plane.

    Attributes
    ----------
    near, far : array, shape (k, 3)
        Nearest and farthest reachable points along each ray, in B [m]; no rays where no point is reachable.
    """

    near: Float[np.ndarray, "k 3"]
    far: Float[np.ndarray, "k 3"]

    @property
    def closed(self) -> Float[np.ndarray, "..."]:
        """The points in order along the outline ``(2 k, 3)``."""
        return np.concatenate([self.far, self.near[::-1]])


@dataclass(frozen=True, eq=False)
class _Plane:
    """A plane with polar coordinates: its points by direction and distance, and which of them are reachable."""

    points: Points
    reached: Callable[[np.ndarray], np.ndarray]
    length: float

    @property
    def distances(self) -> Float[np.ndarray, "..."]:
        # Distance 0 is the same point in every direction.
        return np.linspace(1e-3 * self.length, self.length, _ALONG)


def ground_outline(robot: Robot, leg: int, body: Pose) -> Outline:
    """Return the outline of the workspace of a leg on the ground.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Index of the leg.
    body : Pose
        Pose of B in G.
    """
    return _in_body(_cast(_ground(robot, leg, body)), body)


def ground_band(robot: Robot, leg: int, body: Pose) -> tuple[float, float]:
    """Return the reachable distances straight outward on the ground from the coxa axis [m]; NaN if there are none.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Index of the leg.
    body : Pose
        Pose of B in G.
    """
    ground = _ground(robot, leg, body)
    ahead = np.zeros(1)
    if not ground.reached(ground.points(ahead[:, None], ground.distances)).any():
        return np.nan, np.nan
    near, far = _bands(ground, ahead)
    return float(near[0]), float(far[0])


def _in_body(outline: Outline, body: Pose) -> Outline:
    back = body.inverse()
    return Outline(np.asarray(back @ outline.near), np.asarray(back @ outline.far))


def _ground(robot: Robot, leg: int, body: Pose) -> _Plane:
    alone, outward = _alone(robot, leg), float(robot.mount_yaw[leg])
    forward = np.asarray(body.rotation)[:2, :2] @ np.array([np.cos(outward), np.sin(outward)])
    middle = np.asarray(body @ np.asarray(robot.mount_position)[leg])[:2]
    ahead = np.arctan2(forward[1], forward[0])

    def points(turn: np.ndarray, distance: np.ndarray) -> np.ndarray:
        x = middle[0] + distance * np.cos(ahead + turn)
        y = middle[1] + distance * np.sin(ahead + turn)
        return np.stack([x, y, np.zeros_like(x)], axis=-1)

    def reached(feet: np.ndarray) -> np.ndarray:
        return _reached(alone, inverse_kinematics(alone, feet[..., None, :], body))

    return _Plane(points, reached, _length(alone))


def plane_outline(robot: Robot, leg: int, coxa: float) -> Outline:
    """Return the outline of the workspace of a leg in its own plane, without the ground.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Index of the leg.
    coxa : float
        Coxa angle of the plane [rad]; clamped to its limits.
    """
    alone = _alone(robot, leg)
    coxa = float(np.clip(coxa, alone.limits[0, 0, 0], alone.limits[0, 0, 1]))
    axis = np.asarray(forward_kinematics(alone, np.array([[coxa, 0.0, 0.0]])))[0]
    outward = (axis[3] - axis[1]) / np.linalg.norm(axis[3] - axis[1])

    def points(turn: np.ndarray, distance: np.ndarray) -> np.ndarray:
        level = distance * np.cos(turn)
        points: np.ndarray = axis[1] + level[..., None] * outward
        points[..., 2] += distance * np.sin(turn)
        return points

    def reached(feet: np.ndarray) -> np.ndarray:
        return _reached(alone, inverse_kinematics(alone, feet[..., None, :]))

    return _cast(_Plane(points, reached, float(alone.femur[0] + alone.tibia[0])))


def _alone(robot: Robot, leg: int) -> Robot:
    """Return the robot with one leg only and without masses, as inverse kinematics needs neither."""
    own = slice(leg, leg + 1)
    arrays = {
        name: getattr(robot, name)[own]
        for name in ("mount_position", "mount_yaw", "coxa", "femur", "tibia", "femur_axis_offset", "limits")
    }
    return Robot(name=robot.name, leg_names=robot.leg_names[own], **arrays)


def _reached(alone: Robot, solution: IKSolution) -> Bool[np.ndarray, "..."]:
    """Exclude points behind the coxa axis, which are no footholds."""
    away = branches(alone, solution.angles)[..., 0, 0]
    return np.asarray(solution.ok & ~away)


def _length(alone: Robot) -> float:
    side, up = np.abs(alone.femur_axis_offset[0])
    return float(alone.coxa[0] + side + up + alone.femur[0] + alone.tibia[0])


def _cast(plane: _Plane) -> Outline:
    """Cast rays in all directions, and again in the range of directions with reachable points."""
    turns = np.linspace(-np.pi, np.pi, _RAYS + 1)

    def hits(turns: np.ndarray) -> np.ndarray:
        return np.asarray(plane.reached(plane.points(turns[:, None], plane.distances)).any(-1))

    run = _widest_run(hits(turns))
    if run is None:
        return Outline(np.empty((0, 3)), np.empty((0, 3)))
    first, last = run

    # For a full circle both ends are the same ray, and bisection changes nothing.
    inside = turns[[first, last]]
    outside = turns[[max(first - 1, 0), min(last + 1, _RAYS)]]
    for _ in range(_HALVINGS):
        middle = (inside + outside) / 2
        works = hits(middle)
        inside, outside = np.where(works, middle, inside), np.where(works, outside, middle)
    start, end = inside.tolist()
    turns = np.linspace(start, end, _RAYS + 1)
    near, far = _bands(plane, turns)
    return Outline(plane.points(turns, near), plane.points(turns, far))


def _widest_run(hit: Bool[np.ndarray, "n"]) -> tuple[int, int] | None:
    """Return the first and last index of the longest run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], hit, [False]]).astype(np.int8)))
    if not edges.size:
        return None
    starts, ends = edges[::2], edges[1::2] - 1
    longest = int(np.argmax(ends - starts))
    return int(starts[longest]), int(ends[longest])


def _bands(plane: _Plane, turns: Float[np.ndarray, "..."]) -> tuple[Float[np.ndarray, "..."], Float[np.ndarray, "..."]]:
    """Return the ends of the widest reachable interval of each ray; both 0 where no point is reachable."""
    distances = plane.distances
    ok = plane.reached(plane.points(turns[:, None], distances))
    inside, outside = np.empty((2, len(turns))), np.empty((2, len(turns)))
    step, last = distances[1] - distances[0], len(distances) - 1
    for ray in range(len(turns)):
        run = _widest_run(ok[ray]) or (0, 0)
        inside[:, ray] = distances[run[0]] if run[0] else 0.0, distances[run[1]]
        outside[0, ray] = inside[0, ray] - (step if run[0] > 0 else 0.0)
        outside[1, ray] = inside[1, ray] + (step if run[1] < last else 0.0)
    for _ in range(_HALVINGS):
        middle = (inside + outside) / 2
        works = plane.reached(plane.points(turns, middle))
        inside, outside = np.where(works, middle, inside), np.where(works, outside, middle)
    return inside[0], inside[1]


def workspace_message(robot: Robot, leg: int, body: Pose, coxa: float, *, id: int) -> WorkspaceMessage:
    """Return the workspace of a leg for a body pose.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Index of the leg.
    body : Pose
        Pose of B in G.
    coxa : float
        Coxa angle of the leg [rad].
    id : int
        Id of the message that is answered.
    """
    nearest, farthest = ground_band(robot, leg, body)
    return WorkspaceMessage(
        type="workspace",
        id=id,
        leg=leg,
        ground_mm=millimetres(ground_outline(robot, leg, body).closed),
        plane_mm=millimetres(plane_outline(robot, leg, coxa).closed),
        nearest_mm=or_null(nearest * 1000),
        farthest_mm=or_null(farthest * 1000),
    )
