"""How one leg gets from some joint angles to others in the air, with no point of it through the ground.

Femur and tibia are taken over a grid of angles on which knee and foot are above the ground, by the shortest way
(E. W. Dijkstra, Numerische Mathematik 1, 1959), preferring ways on which the foot stays out from under the body; the
coxa turns in between, with the leg drawn up. Corners of the way that are not needed are cut.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np

from tarsus.kinematics.leg import point_parts
from tarsus.kinematics.pose import Pose
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

__all__ = ["LegFreeSpace", "swing_heights"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Spacing of the grid, and of the looks on a straight way between angles [rad].
_GRID = np.deg2rad(7.5)
_LOOK = np.deg2rad(1.5)
# How deep in the ground rounding may have a point, and how high above it the grid's points are [m].
_ROUNDING = 1e-7
_ABOVE = 0.002
# Up to which height a foot is on the ground, and from which it is clear of it [m]; in between it goes up at least so
# much for each length that it goes aside.
_ON_GROUND = 1e-6
_CLEAR = 0.003
_STEEP = 0.5
# How much longer a way seems with the foot behind the coxa axis, under the body.
_BEHIND = 6.0
# From how many of the nearest points of the grid a straight way to an end is tried.
_NEAREST = 40


@dataclass(frozen=True, eq=False)
class LegFreeSpace:
    """Where one leg can be without a point of it in the ground, the body being held still.

    Attributes
    ----------
    geometry : LegGeometry
        The one leg.
    up : array, shape (3,)
        The ground's z in B.
    height : float
        Height of B's origin over the ground [m].
    """

    geometry: LegGeometry
    up: Floats
    height: float

    @classmethod
    def of(cls, robot: Robot, leg: int, body: Pose) -> Self:
        """Take a leg of a robot whose body is at a pose in G."""
        geometry = LegGeometry(*(values[leg] for values in robot.geometry))
        return cls(geometry, body.rotation[2], float(body.position[2]))

    def points(self, angles: Floats) -> Floats:
        """Return knee and foot in B, ``(..., 2, 3)`` [m]."""
        parts = point_parts(np, self.geometry, angles[..., 0], angles[..., 1], angles[..., 2])
        flat = np.stack(np.broadcast_arrays(*parts[6:]), axis=-1)
        points: Floats = flat.reshape(*flat.shape[:-1], 2, 3)
        return points

    def heights(self, angles: Floats) -> Floats:
        """Return the heights of knee and foot over the ground, ``(..., 2)`` [m]."""
        heights: Floats = self.points(angles) @ self.up + self.height
        return heights

    def lowest(self, angles: Floats) -> Floats:
        """Return the height over the ground of the lower of knee and foot, ``(...)`` [m]."""
        lowest: Floats = self.heights(angles).min(-1)
        return lowest

    def is_free(self, start: Floats, end: Floats) -> bool:
        """Return whether the joints can go straight from start to end ``(3,)``, a foot on the ground lifted steeply."""
        looks = 2 + int(np.abs(end - start).max() / _LOOK)
        points = self.points(start + np.linspace(0.0, 1.0, looks)[:, None] * (end - start))
        heights = points @ self.up + self.height
        if heights.min() < -_ROUNDING:
            return False
        return swing_heights(points[:, 1], heights[:, 1]) and swing_heights(points[::-1, 1], heights[::-1, 1])

    def route(self, start: Floats, end: Floats) -> tuple[Floats, ...] | None:
        """Return the angles that the leg goes through, one straight way after the other; None where there is no way.

        Parameters
        ----------
        start, end : array, shape (3,)
            Joint angles [rad].
        """
        if self.is_free(start, end):
            return (end,)
        for femur, tibia in (end[1:], self._drawn_up(start[0]), self._drawn_up(end[0])):
            before, after = np.array([start[0], femur, tibia]), np.array([end[0], femur, tibia])
            if not self.is_free(before, after):
                continue
            first, last = self._across(start, before), self._across(after, end)
            if first is not None and last is not None:
                return self._cut((start, *first, after, *last))
        return None

    @cached_property
    def _axes(self) -> tuple[Floats, Floats]:
        g = self.geometry
        femur, tibia = (
            np.linspace(low, high, 2 + int((high - low) / _GRID))
            for low, high in ((g.femur_lower, g.femur_upper), (g.tibia_lower, g.tibia_upper))
        )
        return femur, tibia

    def _grid(self, coxa: float) -> Floats:
        femur, tibia = np.meshgrid(*self._axes, indexing="ij")
        return np.stack([np.full_like(femur, coxa), femur, tibia], axis=-1)

    def _drawn_up(self, coxa: float) -> Floats:
        """Return the femur and tibia with which the leg's lowest point is highest."""
        grid = self._grid(coxa)
        best: Floats = grid.reshape(-1, 3)[np.argmax(self.lowest(grid))][1:]
        return best

    def _across(self, start: Floats, end: Floats) -> tuple[Floats, ...] | None:
        """Return the way with the coxa still; empty where start and end are one."""
        if (start == end).all():
            return ()
        if self.is_free(start, end):
            return (end,)
        grid = self._grid(float(start[0]))
        free = self.lowest(grid) > _ABOVE
        first, last = self._nearest(grid, free, start), self._nearest(grid, free, end)
        if first is None or last is None:
            return None
        way = _shortest(free, self._costs(grid), first, last)
        return None if way is None else (*(grid[node] for node in way), end)

    def _nearest(self, grid: Floats, free: Any, angles: Floats) -> tuple[int, int] | None:
        """Return the nearest free point of the grid to which there is a straight way."""
        away = np.where(free, np.abs(grid - angles).sum(-1), np.inf)
        for index in np.argsort(away, axis=None)[:_NEAREST]:
            i, j = divmod(int(index), away.shape[1])
            if np.isfinite(away[i, j]) and self.is_free(grid[i, j], angles):
                return i, j
        return None

    def _costs(self, grid: Floats) -> Floats:
        """Return how long a way seems at every point of the grid."""
        g = self.geometry
        out = g.coxa + g.femur * np.cos(grid[..., 1]) + g.tibia * np.cos(grid[..., 1] + grid[..., 2])
        return np.where(out < 0, _BEHIND, 1.0)

    def _cut(self, way: tuple[Floats, ...]) -> tuple[Floats, ...]:
        """Leave out what lies between two points that have a straight way between them."""
        kept, at = [], 0
        while at < len(way) - 1:
            ahead = next(k for k in range(len(way) - 1, at, -1) if k == at + 1 or self._may_cut(way[at : k + 1]))
            kept.append(way[ahead])
            at = ahead
        return tuple(kept)

    def _may_cut(self, way: tuple[Floats, ...]) -> bool:
        """Return whether the straight way is free, and not under the body where the other is not."""
        straight = way[0] + np.linspace(0, 1, 16)[:, None] * (way[-1] - way[0])
        return self.is_free(way[0], way[-1]) and self._costs(straight).max() <= self._costs(np.array(way)).max()


def swing_heights(foot: Floats, heights: Floats) -> bool:
    """Return whether a foot that starts on the ground leaves it steeply: one that grazes it is dragged.

    Parameters
    ----------
    foot : array, shape (n, 3)
        Where it is, one moment after the other [m].
    heights : array, shape (n,)
        Its height over the ground [m].
    """
    if heights[0] > _ON_GROUND:
        return True
    low = heights < _CLEAR
    low = low[: int(np.argmin(low)) or None]
    gone2 = ((foot[: low.size] - foot[0]) ** 2).sum(-1)
    up = heights[: low.size] - heights[0]
    return bool((up >= _STEEP * np.sqrt(np.maximum(gone2 - up * up, 0.0)) - _ROUNDING).all())


def _shortest(free: Any, costs: Floats, start: tuple[int, int], end: tuple[int, int]) -> list[tuple[int, int]] | None:
    """Return the shortest way over the free points of a grid, its neighbours across corners included."""
    best, before = {start: 0.0}, {start: start}
    queue = [(0.0, start)]
    while queue:
        length, node = heapq.heappop(queue)
        if node == end:
            way = [end]
            while way[-1] != start:
                way.append(before[way[-1]])
            return way[::-1]
        if length > best[node]:
            continue
        for di, dj in ((-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1)):
            i, j = node[0] + di, node[1] + dj
            if not (0 <= i < free.shape[0] and 0 <= j < free.shape[1] and free[i, j]):
                continue
            longer = length + (di * di + dj * dj) ** 0.5 * (costs[i, j] + costs[node]) / 2
            if longer < best.get((i, j), np.inf):
                best[i, j], before[i, j] = longer, node
                heapq.heappush(queue, (longer, (i, j)))
    return None
