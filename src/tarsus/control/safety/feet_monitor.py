"""The feet that are said to be down: balance over them, the ground's plane under them, and whether they drag.

Written in plain numbers for one robot, from the equations of forward kinematics, apart from the project's array code:
for a watcher that must be quick, and must not share the mistakes of what it watches.
"""

from __future__ import annotations

import math
from itertools import combinations
from typing import NamedTuple

import numpy as np

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.inputs import Rows
from tarsus.control.safety.interventions import Violation
from tarsus.robot.robot import Robot

__all__ = ["FeetMonitor", "plane_normal", "polygon_margin"]

Point = tuple[float, float, float]


class _Leg(NamedTuple):
    """What a leg's foot and its share of the centre of mass follow from.

    Foot: ``r = coxa + femur cos(q1) + tibia cos(q1 + q2)`` outward, `z` alike with sines from `up`. Moment of the
    leg's masses over the robot's mass: ``base + knee cos(q1) + end cos(q1 + q2)`` outward, from `base_height`
    upward alike.
    """

    yaw: float
    x: float
    y: float
    z: float
    coxa: float
    femur: float
    tibia: float
    side: float
    mass: float
    base: float
    across: float
    base_height: float
    knee: float
    end: float


class FeetMonitor:
    """Watches the feet from tick to tick.

    Attributes
    ----------
    down : list of bool or None
        Which feet were down when the angles last passed; None where that was not said.
    up : tuple of float
        Direction of up in B then.
    """

    def __init__(self, robot: Robot, bounds: GuardBounds) -> None:
        self._legs = _legs_of(robot)
        self._pairs = tuple(combinations(range(robot.legs), 2))
        self._unknown: list[float | None] = [None] * len(self._pairs)
        self._apart = self._apart_now = self._unknown
        self._margin, self._drag, self._ground = bounds.margin, bounds.drag, bounds.ground
        self._slope = math.tan(bounds.slope)
        # Without masses the links count as massless, as in `centre_of_mass`.
        share = float(robot.body_mass / _total(robot)) if robot.has_masses else 1.0
        self._com = tuple(float(share * c) for c in np.asarray(robot.body_com))
        self.down: list[bool] | None = None
        self.up: Point = (0.0, 0.0, 1.0)
        self._down_now: list[bool] | None = None
        self._up_now = self.up

    def faults(self, angles: list[float], down: list[bool] | None, rows: Rows | None) -> list[Violation]:
        """Return what is wrong with the feet for joint angles.

        Parameters
        ----------
        angles : list of float
            Joint angles, one after the other [rad].
        down : list of bool or None
            Which feet are said to be down; None where that is not said, and nothing can be checked.
        rows : rows of a rotation matrix, or None
            The rotation of B in G; None where the plane of the feet is to be taken for level.
        """
        self._down_now = down
        if down is None:
            self._apart_now = self._unknown
            self._up_now = self.up if rows is None else (rows[2][0], rows[2][1], rows[2][2])
            return []
        feet, com = self.points(angles)
        standing = [foot for foot, is_down in zip(feet, down, strict=True) if is_down]
        up = plane_normal(standing) if rows is None else (rows[2][0], rows[2][1], rows[2][2])
        self._up_now = up
        faults = self._dragging(feet, down)
        across, ahead, heights = _seen_from_above(standing, com, up)
        margin = polygon_margin(across, ahead)
        if not margin >= self._margin:
            faults.append(Violation("stability", -1, -1, margin, self._margin))
        if len(standing) > 1:
            faults += self._off_ground(down, across, ahead, heights)
        return faults

    def passed(self) -> None:
        """Take note that what was looked at last is what is sent."""
        self.down, self.up, self._apart = self._down_now, self._up_now, self._apart_now

    def forget(self) -> None:
        """Take the distances between the feet anew."""
        self._apart = self._unknown

    def points(self, angles: list[float]) -> tuple[list[Point], Point]:
        """Return the feet and the centre of mass in B [m]."""
        feet = []
        com_x, com_y, com_z = self._com
        cos, sin = math.cos, math.sin
        i = 0
        for yaw, x, y, z, coxa, femur, tibia, side, mass, base, across, base_height, knee, end in self._legs:
            heading, slope = yaw + angles[i], angles[i + 1]
            lean = slope + angles[i + 2]
            c, s, cf, sf, ct, st = cos(heading), sin(heading), cos(slope), sin(slope), cos(lean), sin(lean)
            i += 3
            r = coxa + femur * cf + tibia * ct
            feet.append((x + r * c - side * s, y + r * s + side * c, z + femur * sf + tibia * st))
            r = base + knee * cf + end * ct
            com_x += mass * x + r * c - across * s
            com_y += mass * y + r * s + across * c
            com_z += base_height + knee * sf + end * st
        return feet, (com_x, com_y, com_z)

    def _dragging(self, feet: list[Point], down: list[bool]) -> list[Violation]:
        """Return the pair whose distance has changed too much since both came down."""
        apart: list[float | None] = []
        faults = []
        for (i, j), before in zip(self._pairs, self._apart, strict=True):
            if not (down[i] and down[j]):
                apart.append(None)
                continue
            now = math.dist(feet[i], feet[j])
            apart.append(now if before is None else before)
            if before is not None and abs(now - before) > self._drag:
                faults.append(Violation("drag", j, -1, abs(now - before), self._drag))
        self._apart_now = apart
        return faults

    def _off_ground(
        self, down: list[bool], across: list[float], ahead: list[float], heights: list[float]
    ) -> list[Violation]:
        """Return the feet that are too far above or below the mean height of those that are down."""
        count = len(heights)
        x, y, mean = sum(across) / count, sum(ahead) / count, sum(heights) / count
        faults = []
        legs = (leg for leg, is_down in enumerate(down) if is_down)
        for leg, u, v, height in zip(legs, across, ahead, heights, strict=True):
            off = abs(height - mean)
            if off > self._ground:
                bound = self._ground + self._slope * math.hypot(u - x, v - y)
                if off > bound:
                    faults.append(Violation("ground", leg, -1, off, bound))
        return faults


def _seen_from_above(points: list[Point], origin: Point, up: Point) -> tuple[list[float], list[float], list[float]]:
    """Return the points' two level coordinates and their heights from an origin, for a direction of up."""
    ux, uy, uz = up
    # A level axis: across up and x, or up and y where up is nearly x.
    ax, ay, az = (-uy * ux, 1 - uy * uy, -uy * uz) if abs(uy) < 0.8 else (1 - ux * ux, -ux * uy, -ux * uz)
    size = math.sqrt(ax * ax + ay * ay + az * az)
    ax, ay, az = ax / size, ay / size, az / size
    bx, by, bz = ay * uz - az * uy, az * ux - ax * uz, ax * uy - ay * ux
    ox, oy, oz = origin
    across, ahead, heights = [], [], []
    for x, y, z in points:
        dx, dy, dz = x - ox, y - oy, z - oz
        across.append(ax * dx + ay * dy + az * dz)
        ahead.append(bx * dx + by * dy + bz * dz)
        heights.append(ux * dx + uy * dy + uz * dz)
    return across, ahead, heights


def plane_normal(points: list[Point]) -> Point:
    """Return the upward unit normal of the plane that fits some points best in z; B's own z where they span none.

    Parameters
    ----------
    points : list of points
        In B [m].
    """
    count = len(points)
    if count < 3:
        return (0.0, 0.0, 1.0)
    mx, my, mz = (sum(point[axis] for point in points) / count for axis in range(3))
    xx = xy = yy = xz = yz = 0.0
    for x, y, z in points:
        dx, dy, dz = x - mx, y - my, z - mz
        xx, xy, yy, xz, yz = xx + dx * dx, xy + dx * dy, yy + dy * dy, xz + dx * dz, yz + dy * dz
    spread = xx * yy - xy * xy
    # Of points on a line it is told by rounding alone.
    if spread <= 1e-9 * (xx + yy) * (xx + yy):
        return (0.0, 0.0, 1.0)
    a, b = (xz * yy - yz * xy) / spread, (yz * xx - xz * xy) / spread
    size = math.sqrt(a * a + b * b + 1)
    return (-a / size, -b / size, 1 / size)


def polygon_margin(x: list[float], y: list[float]) -> float:
    """Return how far inside the convex hull of points the origin lies, as `stability_margin` counts it [m].

    Parameters
    ----------
    x, y : list of float
        The points [m].
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
    return -min(_distance(a, b) for a, b in edges)


def _half_hull(ordered: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return one side of the convex hull but for its last corner (Andrew's monotone chain)."""
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


def _distance(start: tuple[float, float], end: tuple[float, float]) -> float:
    """Return the distance from the origin to a segment."""
    (x, y), (dx, dy) = start, (end[0] - start[0], end[1] - start[1])
    square = dx * dx + dy * dy
    share = min(max(-(x * dx + y * dy) / square, 0.0), 1.0) if square > 0 else 0.0
    return math.hypot(x + share * dx, y + share * dy)


def _total(robot: Robot) -> float:
    return float(robot.body_mass + np.asarray(robot.link_mass).sum())


def _legs_of(robot: Robot) -> tuple[_Leg, ...]:
    """Return the constants of every leg."""
    massless = not robot.has_masses
    total = 1.0 if massless else _total(robot)
    legs = []
    for leg in range(robot.legs):
        coxa, femur, tibia = (float(lengths[leg]) for lengths in (robot.coxa, robot.femur, robot.tibia))
        side, up = map(float, robot.femur_axis_offset[leg])
        x, y, z = map(float, robot.mount_position[leg])
        weights = np.zeros(3) if massless else np.asarray(robot.link_mass[leg]) / total
        first, second, third = map(float, weights)
        at_coxa, at_femur, at_tibia = map(float, robot.link_com[leg])
        outer = second + third
        # The coxa link runs straight from coxa axis to femur axis; where these coincide, its mass is there.
        length = math.sqrt(coxa * coxa + side * side + up * up)
        share = first * at_coxa / length + outer if length > 0 else outer
        legs.append(
            _Leg(
                yaw=float(robot.mount_yaw[leg]),
                x=x,
                y=y,
                z=z + up,
                coxa=coxa,
                femur=femur,
                tibia=tibia,
                side=side,
                mass=first + outer,
                base=share * coxa,
                across=share * side,
                base_height=(first + outer) * z + share * up,
                knee=second * at_femur + third * femur,
                end=third * at_tibia,
            )
        )
    return tuple(legs)
