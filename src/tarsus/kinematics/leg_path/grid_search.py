"""Shortest path over a two-dimensional grid (Dijkstra's algorithm)."""

from __future__ import annotations

import heapq
import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["Node", "shortest_path"]

Node = tuple[int, int]
"""Indices of a grid point."""

_NEIGHBOURS = ((-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1))


def shortest_path(
    free: Bool[np.ndarray, "n m"], weights: Float[np.ndarray, "n m"], start: Node, end: Node
) -> list[Node] | None:
    """Return the shortest path over the free points of a grid, diagonals included; None if there is none.

    Parameters
    ----------
    free : array of bool, shape (n, m)
        Points that the path may use.
    weights : array, shape (n, m)
        Weight of the path length at each point.
    start, end : Node
        Ends of the path.

    References
    ----------
    E. W. Dijkstra, Numerische Mathematik 1, 1959.
    """
    lengths, previous = {start: 0.0}, {start: start}
    queue = [(0.0, start)]
    while queue:
        length, node = heapq.heappop(queue)
        if node == end:
            return _backtrack(previous, start, end)
        if length > lengths[node]:
            continue
        for di, dj in _NEIGHBOURS:
            i, j = node[0] + di, node[1] + dj
            if not (0 <= i < free.shape[0] and 0 <= j < free.shape[1] and free[i, j]):
                continue
            longer = length + (di * di + dj * dj) ** 0.5 * (weights[i, j] + weights[node]) / 2
            if longer < lengths.get((i, j), math.inf):
                lengths[i, j], previous[i, j] = longer, node
                heapq.heappush(queue, (longer, (i, j)))
    return None


def _backtrack(previous: dict[Node, Node], start: Node, end: Node) -> list[Node]:
    path = [end]
    while path[-1] != start:
        path.append(previous[path[-1]])
    return path[::-1]
