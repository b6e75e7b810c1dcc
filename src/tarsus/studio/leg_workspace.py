"""What one leg reaches: outlines on the ground and in the leg's own plane.

Rays are cast from a point that the leg reaches around: on the ground from below the coxa axis, in the leg's plane from
the femur axis. Along each, the widest band of reachable points is found by inverse kinematics, its ends by
halving. So the outline is that of `inverse_kinematics`, joint limits, offsets, tilt and the ground included; left out
is what a leg reaches backwards over its coxa axis, as a walk never does.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from tarsus.gait.branch import branches
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.solution import IKSolution
from tarsus.robot.robot import Robot
from tarsus.studio.messages.pose import WorkspaceMessage
from tarsus.studio.encoding import millimetres, or_null

__all__ = ["Outline", "ground_band", "ground_outline", "plane_outline", "workspace_message"]

Floats: TypeAlias = np.ndarray[Any, np.dtype[np.float64]]
Points: TypeAlias = Callable[[Floats, Floats], Floats]

_RAYS = 72
_ALONG = 40
# A ten-thousandth of a ray's step is less than a micrometre.
_HALVINGS = 14


@dataclass(frozen=True, eq=False)
class Outline:
    """The outline of what a leg reaches in a plane.

    Attributes
    ----------
    near, far : array, shape (k, 3)
        Nearest and farthest points along each ray, in B [m]; no rays where nothing is reached.
    """

    near: Floats
    far: Floats

    @property
    def closed(self) -> Floats:
        """The points in order round the outline ``(2 k, 3)``."""
        return np.concatenate([self.far, self.near[::-1]])


@dataclass(frozen=True, eq=False)
class _Plane:
    """Points of a plane by direction and distance, and which of them the leg reaches."""

    points: Points
    reached: Callable[[Floats], np.ndarray[Any, np.dtype[np.bool_]]]
    length: float

    @property
    def distances(self) -> Floats:
        # At the axis itself every direction is the same point, and none of them is told apart from the others.
        return np.linspace(1e-3 * self.length, self.length, _ALONG)


def ground_outline(robot: Robot, leg: int, body: Pose) -> Outline:
    """Return what a leg reaches on the ground.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Which leg.
    body : Pose
        Place of B in G.
    """
    return _in_body(_cast(_ground(robot, leg, body)), body)


def ground_band(robot: Robot, leg: int, body: Pose) -> tuple[float, float]:
    """Return how near and how far a leg's foot can stand straight out from below its coxa axis [m]; NaN if nowhere.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Which leg.
    body : Pose
        Place of B in G.
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

    def points(turn: Floats, distance: Floats) -> Floats:
        x = middle[0] + distance * np.cos(ahead + turn)
        y = middle[1] + distance * np.sin(ahead + turn)
        return np.stack([x, y, np.zeros_like(x)], axis=-1)

    def reached(feet: Floats) -> np.ndarray[Any, np.dtype[np.bool_]]:
        return _reached(alone, inverse_kinematics(alone, feet[..., None, :], body))

    return _Plane(points, reached, _length(alone))


def plane_outline(robot: Robot, leg: int, coxa: float) -> Outline:
    """Return what a leg reaches in its own plane, the body's ground apart.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Which leg.
    coxa : float
        The coxa angle in whose plane it is [rad]; taken into its limits.
    """
    alone = _alone(robot, leg)
    coxa = float(np.clip(coxa, alone.limits[0, 0, 0], alone.limits[0, 0, 1]))
    axis = np.asarray(forward_kinematics(alone, np.array([[coxa, 0.0, 0.0]])))[0]
    outward = (axis[3] - axis[1]) / np.linalg.norm(axis[3] - axis[1])

    def points(turn: Floats, distance: Floats) -> Floats:
        level = distance * np.cos(turn)
        points: Floats = axis[1] + level[..., None] * outward
        points[..., 2] += distance * np.sin(turn)
        return points

    def reached(feet: Floats) -> np.ndarray[Any, np.dtype[np.bool_]]:
        return _reached(alone, inverse_kinematics(alone, feet[..., None, :]))

    return _cast(_Plane(points, reached, float(alone.femur[0] + alone.tibia[0])))


def _alone(robot: Robot, leg: int) -> Robot:
    """Return the robot with one leg only, massless: inverse kinematics needs no more."""
    own = slice(leg, leg + 1)
    arrays = {
        name: getattr(robot, name)[own]
        for name in ("mount_position", "mount_yaw", "coxa", "femur", "tibia", "femur_axis_offset", "limits")
    }
    return Robot(name=robot.name, leg_names=robot.leg_names[own], **arrays)


def _reached(alone: Robot, solution: IKSolution) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Leave out feet behind the coxa axis: reached with the plane turned away, they are no place to step to."""
    away = branches(alone, solution.angles)[..., 0, 0]
    return np.asarray(solution.ok & ~away)


def _length(alone: Robot) -> float:
    side, up = np.abs(alone.femur_axis_offset[0])
    return float(alone.coxa[0] + side + up + alone.femur[0] + alone.tibia[0])


def _cast(plane: _Plane) -> Outline:
    """Cast rays over the half turn to either side, and again over those directions alone that reach something."""
    turns = np.linspace(-np.pi, np.pi, _RAYS + 1)

    def hits(turns: Floats) -> np.ndarray[Any, Any]:
        return np.asarray(plane.reached(plane.points(turns[:, None], plane.distances)).any(-1))

    run = _widest_run(hits(turns))
    if run is None:
        return Outline(np.empty((0, 3)), np.empty((0, 3)))
    first, last = run

    # Of a whole turn, both ends are the same ray, and there is nothing to halve.
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


def _widest_run(hit: np.ndarray[Any, Any]) -> tuple[int, int] | None:
    """Return the first and last of the longest run of what is true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], hit, [False]]).astype(np.int8)))
    if not edges.size:
        return None
    starts, ends = edges[::2], edges[1::2] - 1
    longest = int(np.argmax(ends - starts))
    return int(starts[longest]), int(ends[longest])


def _bands(plane: _Plane, turns: Floats) -> tuple[Floats, Floats]:
    """Return the ends of the widest band along each ray; where a ray reaches nothing, both are at its beginning."""
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
    """Return what a leg reaches with the body at a place.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Which leg.
    body : Pose
        Place of B in G.
    coxa : float
        The leg's coxa angle [rad].
    id : int
        Of the message that is answered.
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
