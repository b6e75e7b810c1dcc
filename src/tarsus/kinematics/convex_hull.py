"""The convex hull of a few points in the plane, in plain floats: for a single pose, where array calls cost more."""

from __future__ import annotations

import math
from collections.abc import Sequence

__all__ = ["hull_corners", "origin_margin"]


def hull_corners(points: Sequence[Sequence[float]]) -> list[tuple[float, float]]:
    """Return the corners of the convex hull.

    Parameters
    ----------
    points : sequence of (x, y)
        The points [m].

    Returns
    -------
    list of (x, y)
        Corners counter-clockwise from the one with the least x (and of those with the least y), none of them between
        two others on a line [m].

    Notes
    -----
    Andrew's monotone chain (A. M. Andrew, Information Processing Letters 9, 1979).
    """
    corners = sorted({(x, y) for x, y in points})
    if len(corners) > 2:
        corners = _half_hull(corners)[:-1] + _half_hull(corners[::-1])[:-1]
    return corners


def _half_hull(ordered: list[tuple[float, float]]) -> list[tuple[float, float]]:
    chain: list[tuple[float, float]] = []
    for x, y in ordered:
        while len(chain) > 1:
            (ax, ay), (bx, by) = chain[-2:]
            if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
                break
            chain.pop()
        chain.append((x, y))
    return chain


def origin_margin(points: Sequence[Sequence[float]]) -> tuple[float, float, float]:
    """Return the origin's margin in the convex hull of some points, and the hull's point nearest to it.

    Parameters
    ----------
    points : sequence of (x, y)
        The points [m].

    Returns
    -------
    margin : float
        Distance to the nearest edge where the origin is inside the hull; minus the distance to the hull where it is
        outside; minus infinity without points [m].
    nearest_x, nearest_y : float
        The hull's point nearest to the origin: the origin itself where that is inside [m].
    """
    corners = hull_corners(points)
    if not corners:
        return -math.inf, 0.0, 0.0
    edges = list(zip(corners, corners[1:] + corners[:1], strict=True))
    if len(corners) > 2:
        depth = min((ax * by - ay * bx) / math.hypot(bx - ax, by - ay) for (ax, ay), (bx, by) in edges)
        if depth >= 0:
            return depth, 0.0, 0.0
    distance, x, y = min(_nearest_on_segment(start, end) for start, end in edges)
    return -distance, x, y


def _nearest_on_segment(start: tuple[float, float], end: tuple[float, float]) -> tuple[float, float, float]:
    """Return the distance from the origin to a segment, and the segment's nearest point."""
    (ax, ay), (bx, by) = start, end
    ux, uy = bx - ax, by - ay
    square = ux * ux + uy * uy
    fraction = min(max(-(ax * ux + ay * uy) / square, 0.0), 1.0) if square else 0.0
    x, y = ax + fraction * ux, ay + fraction * uy
    return math.hypot(x, y), x, y
