"""Paths of one leg through the air in joint space, with no point of the leg below the ground.

Femur and tibia follow a shortest path (E. W. Dijkstra, Numerische Mathematik 1, 1959) over a grid of angles with knee
and foot above the ground; paths with the foot under the body are weighted as longer. The coxa turns in between, with
the leg raised. Then points of the path that are not needed are removed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tarsus.kinematics.leg import point_parts
from tarsus.kinematics.leg_path.grid_search import Node, shortest_path
from tarsus.kinematics.leg_path.lift_off import DEPTH_TOLERANCE, lifts_off
from tarsus.kinematics.pose import Pose
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["LegFreeSpace", "Path"]

Path = tuple[np.ndarray, ...]
"""Corners of a path in joint space, without its start."""

# Spacing of the grid, and of the points at which a straight path is evaluated [rad].
_GRID = np.deg2rad(7.5)
_CHECK_STEP = np.deg2rad(1.5)
# Least height of the grid points over the ground [m].
_MIN_HEIGHT = 0.002
# Weight of a path with the foot behind the coxa axis, under the body.
_BEHIND_WEIGHT = 6.0
# Number of the nearest grid points to try for a straight path to an end.
_NEAREST = 40


@dataclass(frozen=True, eq=False)
class LegFreeSpace:
    """Joint angles of one leg with no point below the ground, for a stationary body.

    Attributes
    ----------
    geometry : LegGeometry
        Geometry of the leg.
    up : array, shape (3,)
        Upward direction in B.
    height : float
        Body height [m].
    """

    geometry: LegGeometry
    up: Float[np.ndarray, "3"]
    height: float

    @classmethod
    def of(cls, robot: Robot, leg: int, body: Pose) -> Self:
        """Return the free space of a leg.

        Parameters
        ----------
        robot : Robot
            A single robot.
        leg : int
            Index of the leg.
        body : Pose
            Pose of B in G.
        """
        geometry = LegGeometry(*(values[leg] for values in robot.geometry))
        return cls(geometry, body.rotation[2], float(body.position[2]))

    def points(self, angles: Float[np.ndarray, "*#batch 3"]) -> Float[np.ndarray, "*batch 2 3"]:
        """Return knee and foot in B.

        Parameters
        ----------
        angles : array, shape (..., 3)
            Joint angles of the leg [rad].

        Returns
        -------
        array, shape (..., 2, 3)
            Knee and foot [m].
        """
        parts = point_parts(np, self.geometry, angles[..., 0], angles[..., 1], angles[..., 2])
        flat = np.stack(np.broadcast_arrays(*parts[6:]), axis=-1)
        points: np.ndarray = flat.reshape(*flat.shape[:-1], 2, 3)
        return points

    def heights(self, angles: Float[np.ndarray, "*#batch 3"]) -> Float[np.ndarray, "*batch 2"]:
        """Return the heights of knee and foot over the ground.

        Parameters
        ----------
        angles : array, shape (..., 3)
            Joint angles of the leg [rad].

        Returns
        -------
        array, shape (..., 2)
            Heights of knee and foot [m].
        """
        heights: np.ndarray = self.points(angles) @ self.up + self.height
        return heights

    def is_free(self, start: Float[np.ndarray, "3"], end: Float[np.ndarray, "3"]) -> bool:
        """Return whether a straight path is free, and a foot on the ground at either end leaves it steeply.

        Parameters
        ----------
        start, end : array, shape (3,)
            Joint angles [rad].
        """
        count = 2 + int(np.abs(end - start).max() / _CHECK_STEP)
        points = self.points(start + np.linspace(0.0, 1.0, count)[:, None] * (end - start))
        heights = points @ self.up + self.height
        if heights.min() < -DEPTH_TOLERANCE:
            return False
        return lifts_off(points[:, 1], heights[:, 1]) and lifts_off(points[::-1, 1], heights[::-1, 1])

    def find_path(self, start: Float[np.ndarray, "3"], end: Float[np.ndarray, "3"]) -> Path | None:
        """Return the corners of a free path without its start; None if there is none.

        Parameters
        ----------
        start, end : array, shape (3,)
            Joint angles [rad].
        """
        if self.is_free(start, end):
            return (end,)
        for femur, tibia in (end[1:], self._raised(start[0]), self._raised(end[0])):
            before, after = np.array([start[0], femur, tibia]), np.array([end[0], femur, tibia])
            if not self.is_free(before, after):
                continue
            first, last = self._path_in_plane(start, before), self._path_in_plane(after, end)
            if first is not None and last is not None:
                return self._shortcut((start, *first, after, *last))
        return None

    @cached_property
    def _axes(self) -> tuple[Float[np.ndarray, "n"], Float[np.ndarray, "..."]]:
        g = self.geometry
        femur, tibia = (
            np.linspace(low, high, 2 + int((high - low) / _GRID))
            for low, high in ((g.femur_lower, g.femur_upper), (g.tibia_lower, g.tibia_upper))
        )
        return femur, tibia

    def _grid(self, coxa: float) -> Float[np.ndarray, "m n 3"]:
        femur, tibia = np.meshgrid(*self._axes, indexing="ij")
        return np.stack([np.full_like(femur, coxa), femur, tibia], axis=-1)

    def _raised(self, coxa: float) -> Float[np.ndarray, "n"]:
        """Return the femur and tibia angles with which the lowest point of the leg is highest."""
        grid = self._grid(coxa)
        best: np.ndarray = grid.reshape(-1, 3)[np.argmax(self.heights(grid).min(-1))][1:]
        return best

    def _path_in_plane(self, start: Float[np.ndarray, "3"], end: Float[np.ndarray, "3"]) -> Path | None:
        """Return a free path with the coxa stationary; empty if start and end are equal, None if there is none."""
        if (start == end).all():
            return ()
        if self.is_free(start, end):
            return (end,)
        grid = self._grid(float(start[0]))
        free = self.heights(grid).min(-1) > _MIN_HEIGHT
        first, last = self._nearest(grid, free, start), self._nearest(grid, free, end)
        if first is None or last is None:
            return None
        nodes = shortest_path(free, self._weights(grid), first, last)
        return None if nodes is None else (*(grid[node] for node in nodes), end)

    def _nearest(
        self, grid: Float[np.ndarray, "m n 3"], free: Any, angles: Float[np.ndarray, "*#batch 3"]
    ) -> Node | None:
        """Return the nearest free grid point with a free straight path to some angles."""
        distance = np.where(free, np.abs(grid - angles).sum(-1), np.inf)
        for index in np.argsort(distance, axis=None)[:_NEAREST]:
            i, j = divmod(int(index), distance.shape[1])
            if np.isfinite(distance[i, j]) and self.is_free(grid[i, j], angles):
                return i, j
        return None

    def _weights(self, angles: Float[np.ndarray, "*#batch 3"]) -> Float[np.ndarray, "*batch"]:
        """Return the weight of the path length at joint angles."""
        g = self.geometry
        reach = g.coxa + g.femur * np.cos(angles[..., 1]) + g.tibia * np.cos(angles[..., 1] + angles[..., 2])
        return np.where(reach < 0, _BEHIND_WEIGHT, 1.0)

    def _shortcut(self, path: Path) -> Path:
        """Remove the points between two corners that a free straight path connects."""
        kept, at = [], 0
        while at < len(path) - 1:
            last = len(path) - 1
            following = next(k for k in range(last, at, -1) if k == at + 1 or self._may_cut(path[at : k + 1]))
            kept.append(path[following])
            at = following
        return tuple(kept)

    def _may_cut(self, path: Path) -> bool:
        """Return whether the straight path is free, and not under the body unless the path is."""
        straight = path[0] + np.linspace(0, 1, 16)[:, None] * (path[-1] - path[0])
        return self.is_free(path[0], path[-1]) and self._weights(straight).max() <= self._weights(np.array(path)).max()
