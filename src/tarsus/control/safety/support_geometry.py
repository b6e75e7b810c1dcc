"""Ground plane and support polygon of a few points, in scalar arithmetic.

Independent of the array code in `tarsus.kinematics`: fast for single points, and the guard does not share errors with
what it monitors.
"""

from __future__ import annotations

import math

__all__ = ["Point", "plane_normal", "polygon_margin", "project"]

Point = tuple[float, float, float]
"""Coordinates of a point or components of a direction."""

# The fit of a plane is singular if the determinant of the point spread is below this fraction of its squared trace.
_SINGULAR = 1e-9


def project(points: list[Point], origin: Point, up: Point) -> tuple[list[float], list[float], list[float]]:
    """Return the two horizontal coordinates and the heights of points relative to an origin [m].

    Parameters
    ----------
    points, origin, up : list of Point, Point, Point
        The points [m]; the origin [m]; unit vector of the upward direction.
    """
    ux, uy, uz = up
    # A horizontal axis: the projection of y, or of x where y is nearly vertical.
    ax, ay, az = (-uy * ux, 1 - uy * uy, -uy * uz) if abs(uy) < 0.8 else (1 - ux * ux, -ux * uy, -ux * uz)
    size = math.sqrt(ax * ax + ay * ay + az * az)
    ax, ay, az = ax / size, ay / size, az / size
    bx, by, bz = ay * uz - az * uy, az * ux - ax * uz, ax * uy - ay * ux
    ox, oy, oz = origin
    first, second, heights = [], [], []
    for x, y, z in points:
        dx, dy, dz = x - ox, y - oy, z - oz
        first.append(ax * dx + ay * dy + az * dz)
        second.append(bx * dx + by * dy + bz * dz)
        heights.append(ux * dx + uy * dy + uz * dz)
    return first, second, heights


def plane_normal(points: list[Point]) -> Point:
    """Return the upward unit normal of the plane fitted in z by least squares; z if the points span no plane.

    Parameters
    ----------
    points : list of Point
        Points in B [m].
    """
    count = len(points)
    if count < 3:
        return (0.0, 0.0, 1.0)
    mx, my, mz = (sum(point[axis] for point in points) / count for axis in range(3))
    xx = xy = yy = xz = yz = 0.0
    for x, y, z in points:
        dx, dy, dz = x - mx, y - my, z - mz
        xx, xy, yy, xz, yz = xx + dx * dx, xy + dx * dy, yy + dy * dy, xz + dx * dz, yz + dy * dz
    determinant = xx * yy - xy * xy
    if determinant <= _SINGULAR * (xx + yy) * (xx + yy):
        return (0.0, 0.0, 1.0)
    a, b = (xz * yy - yz * xy) / determinant, (yz * xx - xz * xy) / determinant
    size = math.sqrt(a * a + b * b + 1)
    return (-a / size, -b / size, 1 / size)


def polygon_margin(x: list[float], y: list[float]) -> float:
    """Return the signed distance of the origin from the edge of the convex hull, positive inside [m].

    Parameters
    ----------
    x, y : list of float
        Coordinates of the points [m]. Minus infinity without points.
    """
    corners = sorted(zip(x, y, strict=True))
    if len(corners) > 2:
        corners = [*_half_hull(corners), *_half_hull(corners[::-1])]
    if not corners:
        return -math.inf
    edges = list(zip([corners[-1], *corners], corners, strict=False))
    if len(corners) > 2:
        depth = min((ax * (by - ay) - ay * (bx - ax)) / math.hypot(bx - ax, by - ay) for (ax, ay), (bx, by) in edges)
        if depth > 0:
            return depth
    return -min(_segment_distance(a, b) for a, b in edges)


def _half_hull(ordered: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return one side of the convex hull without its last corner (Andrew's monotone chain)."""
    chain: list[tuple[float, float]] = []
    for x, y in ordered:
        while len(chain) > 1:
            (ax, ay), (bx, by) = chain[-2], chain[-1]
            if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
                break
            chain.pop()
        chain.append((x, y))
    chain.pop()
    return chain


def _segment_distance(start: tuple[float, float], end: tuple[float, float]) -> float:
    """Return the distance of the origin from a segment."""
    (x, y), (dx, dy) = start, (end[0] - start[0], end[1] - start[1])
    square = dx * dx + dy * dy
    fraction = min(max(-(x * dx + y * dy) / square, 0.0), 1.0) if square > 0 else 0.0
    return math.hypot(x + fraction * dx, y + fraction * dy)
