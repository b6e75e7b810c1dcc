"""Feet, centre of mass, ground plane and support polygon of one robot, in scalar arithmetic.

Independent of the array code in `tarsus.kinematics`: fast for a single pose, and the guard does not share errors with
what it monitors.
"""

from __future__ import annotations

import math
from math import cos, sin

import numpy as np

from tarsus.robot.robot import Robot

__all__ = ["LegModel", "Point", "plane_normal", "polygon_margin", "project"]

Point = tuple[float, float, float]
"""Coordinates of a point or components of a direction."""

# The fit of a plane is singular if the determinant of the point spread is below this fraction of its squared trace.
_SINGULAR = 1e-9


class LegModel:
    """Forward kinematics and centre of mass of one robot.

    With the femur angle q1 and the tibia angle q2, the foot is ``coxa + femur cos(q1) + tibia cos(q1 + q2)`` outward
    of the coxa axis, and its height is that of the femur axis plus the same sum of sines. The first moment of the leg's
    masses, divided by the mass of the robot, has the same form with constants of its own:
    ``m_out + m_femur cos(q1) + m_tibia cos(q1 + q2)`` outward, and `m_up` plus the same sum of sines upward.

    Parameters
    ----------
    robot : Robot
        A single robot. Without masses the legs count as massless.
    """

    def __init__(self, robot: Robot) -> None:
        masses = np.asarray(robot.link_mass) if robot.has_masses else np.zeros((robot.legs, 3))
        body_mass = np.asarray(robot.body_mass if robot.has_masses else 1.0)
        total = body_mass + masses.sum()
        self._body_com: list[float] = (np.asarray(robot.body_com) * body_mass / total).tolist()
        coxa, femur, tibia, (side, up) = robot.coxa, robot.femur, robot.tibia, robot.femur_axis_offset.T
        masses = masses / total
        (x, y, z), (coxa_mass, femur_mass, tibia_mass) = robot.mount_position.T, masses.T
        coxa_com, femur_com, tibia_com = robot.link_com.T
        mass, outer_mass = masses.sum(axis=1), femur_mass + tibia_mass
        # The coxa link runs straight from the coxa axis to the femur axis; if these coincide, its mass is there.
        length = np.sqrt(coxa * coxa + side * side + up * up)
        moment = coxa_mass * np.where(length > 0, coxa_com / np.where(length > 0, length, 1.0), 0.0) + outer_mass
        moments = (moment * coxa, moment * side, mass * z + moment * up)
        outer_moments = (femur_mass * femur_com + tibia_mass * femur, tibia_mass * tibia_com)
        # The constants of each leg.
        columns = (robot.mount_yaw, x, y, z + up, coxa, femur, tibia, side, mass, *moments, *outer_moments)
        self._legs: list[tuple[float, ...]] = list(zip(*(column.tolist() for column in columns), strict=True))

    def points(self, angles: list[float]) -> tuple[list[Point], Point]:
        """Return the feet and the centre of mass in B [m].

        Parameters
        ----------
        angles : list of float
            Joint angles of all legs in one flat list [rad].
        """
        feet = []
        com_x, com_y, com_z = self._body_com
        i = 0
        for yaw, x, y, z, coxa, femur, tibia, side, mass, m_out, m_side, m_up, m_femur, m_tibia in self._legs:
            heading, femur_angle = yaw + angles[i], angles[i + 1]
            tibia_angle = femur_angle + angles[i + 2]
            c, s, cf, sf = cos(heading), sin(heading), cos(femur_angle), sin(femur_angle)
            ct, st = cos(tibia_angle), sin(tibia_angle)
            i += 3
            r = coxa + femur * cf + tibia * ct
            feet.append((x + r * c - side * s, y + r * s + side * c, z + femur * sf + tibia * st))
            r = m_out + m_femur * cf + m_tibia * ct
            com_x += mass * x + r * c - m_side * s
            com_y += mass * y + r * s + m_side * c
            com_z += m_up + m_femur * sf + m_tibia * st
        return feet, (com_x, com_y, com_z)


def project(points: list[Point], origin: Point, up: Point) -> tuple[list[complex], list[float]]:
    """Return the horizontal places of points, as complex numbers, and their heights, both from an origin [m].

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
    places, heights = [], []
    for x, y, z in points:
        dx, dy, dz = x - ox, y - oy, z - oz
        places.append(complex(ax * dx + ay * dy + az * dz, bx * dx + by * dy + bz * dz))
        heights.append(ux * dx + uy * dy + uz * dz)
    return places, heights


def plane_normal(points: list[Point]) -> Point:
    """Return the upward unit normal of the plane fitted in z by least squares; z if the points span no plane.

    Parameters
    ----------
    points : list of Point
        Points in B [m].
    """
    mx, my, mz = (sum(point[axis] for point in points) / max(len(points), 1) for axis in range(3))
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


def polygon_margin(points: list[complex]) -> float:
    """Return the signed distance of the origin from the edge of the convex hull, positive inside [m].

    Parameters
    ----------
    points : list of complex
        The points, x + iy [m]. Minus infinity without points.
    """
    corners = sorted(points, key=lambda point: (point.real, point.imag))
    if len(corners) > 2:
        corners = [*_half_hull(corners), *_half_hull(corners[::-1])]
    if not corners:
        return -math.inf
    edges = list(zip([corners[-1], *corners], corners, strict=False))
    if len(corners) > 2:
        depth = min((start.conjugate() * (end - start)).imag / abs(end - start) for start, end in edges)
        if depth > 0:
            return depth
    return -min(_segment_distance(start, end - start) for start, end in edges)


def _half_hull(ordered: list[complex]) -> list[complex]:
    """Return one side of the convex hull without its last corner (Andrew's monotone chain)."""
    chain: list[complex] = []
    for point in ordered:
        while len(chain) > 1 and ((chain[-1] - chain[-2]).conjugate() * (point - chain[-2])).imag <= 0:
            chain.pop()
        chain.append(point)
    return chain[:-1]


def _segment_distance(start: complex, way: complex) -> float:
    """Return the distance of the origin from a segment."""
    square = abs(way) ** 2
    fraction = min(max(-(start.conjugate() * way).real / square, 0.0), 1.0) if square > 0 else 0.0
    return abs(start + fraction * way)
