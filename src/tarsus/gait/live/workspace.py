"""Where each foot may be while the robot walks: a convex polygon about its rest foothold.

Points of the ground plane are complex numbers here, x + iy in the heading frame: turning is a product.

From the rest foothold, rays in all directions end where the leg can't follow: out of its reach or its limits, near to
straight or folded (where a joint would have to turn fast for a slow foot), with its knee in the ground, or past the
middle of the way to the next foot. Each end lies on a line across the boundary there; what is on the inner side of all
lines is the polygon. Where its edge still runs out of what the leg can do, between the rays, sides are drawn in.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Any, NamedTuple, TypeAlias, TypeVar

import numpy as np

from tarsus.gait.live.polygon import NORMALS, polygon_ends
from tarsus.kinematics.ground import BodyPlace, surely_above
from tarsus.kinematics.leg import point_parts
from tarsus.kinematics.triangle import Triangle, solve_triangle, to_leg_frame
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

__all__ = ["NORMALS", "Parts", "Stand", "all_parts", "joint_slack", "workspace"]

Floats = np.ndarray[Any, Any]

_T = TypeVar("_T")
Parts: TypeAlias = Generator[None, None, _T]
"""A piece of work in parts: what a control loop can't wait for at once, it does one part of a tick."""


def all_parts(work: Parts[_T]) -> _T:
    """Do a piece of work at once.

    Parameters
    ----------
    work : generator
        The parts.
    """
    while True:
        try:
            next(work)
        except StopIteration as done:
            result: _T = done.value
            return result


_RAYS, _SIDES, _RINGS, _FINE = 24, len(NORMALS), 8, 5
_DIRECTIONS = np.exp(2j * np.pi * np.arange(_RAYS) / _RAYS)
# How often the sides are drawn in at the most, which points of each are looked at, and which parts of the way to them.
_TRIMS = 6
_ALONG = np.array([1, 2, 3])[:, None] / 3
_WAY_OUT = np.array([0.3, 0.6, 0.8, 0.92, 1.0])[:, None, None]
# What is drawn in more than it need be, so that the next corners are within.
_EXTRA, _SAME = 0.01, 1e-9

# How much of the way each side is a foot may be at half the lift and at the whole, shares of the ring's radius.
_HEIGHTS = (0.0, 0.5, 1.0)
_NARROWER = (1.0, 0.9, 0.4)
# A joint may turn this much faster for the same speed of the foot than it does at the rest foothold.
_FASTER = 4.0
# How far inside every limit the walker keeps [rad], and how near to straight or folded it comes [rad].
_LIMIT_MARGIN = 0.01
_LEAST_BEND = 0.2
# What the rays' ends keep from where the leg fails [m].
_KEEP = 0.0015


class Stand(NamedTuple):
    """A body over the ground and its feet at rest, seen from the heading frame.

    Attributes
    ----------
    rest : complex array, shape (legs,)
        Rest footholds [m].
    rotation : array, shape (3, 3)
        Of the body in the heading frame.
    position : array, shape (3,)
        Of the body's origin [m].
    lift : float
        How high a swinging foot rises [m].
    """

    rest: Floats
    rotation: Floats
    position: Floats
    lift: float

    def solve(self, robot: Robot, x: Floats, y: Floats, z: Floats) -> Triangle:
        """Return the joint angles for feet in the heading frame, each ``(..., legs)`` [m].

        Parameters
        ----------
        robot : Robot
            A single robot.
        x, y, z : array, shape (..., legs)
            The feet [m].
        """
        g, r, p = robot.geometry, self.rotation, self.position
        x, y, z = x - p[0], y - p[1], z - p[2]
        in_body = tuple(x * r[0, i] + y * r[1, i] + z * r[2, i] for i in range(3))
        return solve_triangle(np, g, *to_leg_frame(g, *in_body), knee=1, sideways=bool(g.side.any()))


def joint_slack(geometry: LegGeometry, solution: Triangle) -> Floats:
    """Return how far the nearest bound is, negative past it ``(..., legs)``; [rad], of lengths over the reach.

    Parameters
    ----------
    geometry : LegGeometry
        The legs.
    solution : Triangle
        Their angles.
    """
    g, s = geometry, solution
    slack = np.minimum(s.coxa - g.coxa_lower, g.coxa_upper - s.coxa)
    slack = np.minimum(slack, np.minimum(s.femur - g.femur_lower, g.femur_upper - s.femur))
    slack = np.minimum(slack, np.minimum(s.tibia - g.tibia_lower, g.tibia_upper - s.tibia)) - _LIMIT_MARGIN
    bend = np.abs(s.tibia)
    slack = np.minimum(slack, np.minimum(bend, np.pi - bend) - _LEAST_BEND)
    for across in (s.far, s.near, s.beside):
        slack = np.minimum(slack, across / g.farthest2)
    return np.asarray(slack)


def workspace(robot: Robot, stand: Stand, *, foot_distance: float) -> Parts[Floats]:
    """Work out the sides of each foot's polygon in one stand, in parts of less than a millisecond.

    Parameters
    ----------
    robot : Robot
        A single robot.
    stand : Stand
        The body and the rest footholds.
    foot_distance : float
        Least distance between two feet [m].

    Returns
    -------
    array, shape (legs, 16)
        How far out each side is along `NORMALS`, from the heading frame's origin [m]. Where a foot can't even be
        at its rest foothold, a side lies short of it.
    """
    step = float((robot.geometry.femur + robot.geometry.tibia).max()) / _RINGS
    rays = np.arange(_RINGS + 1)[:, None, None] * step
    coarse = _first_zero(rays, (yield from _slack(robot, stand, rays * _DIRECTIONS[:, None])), share=0.0)
    # Between the last ring that works and the first that fails, once more.
    rays = coarse + np.arange(_FINE + 1)[:, None, None] * (step / _FINE)
    reach = _first_zero(rays, (yield from _slack(robot, stand, rays * _DIRECTIONS[:, None])), share=1.0) - _KEEP
    bounds = _sides(stand.rest, np.minimum(reach, _halfway(stand.rest, _DIRECTIONS[:, None], foot_distance)))
    for _ in range(_TRIMS):
        edge = _edge(bounds, stand.rest)
        part = _halfway(stand.rest, edge, foot_distance)
        if ((yield from _slack(robot, stand, edge)) < 0).any():
            slack = yield from _slack(robot, stand, _WAY_OUT * edge)
            part = np.minimum(part, _first_zero(_WAY_OUT, slack, share=1.0))
        short = part < 1 - _SAME
        if not short.any():
            break
        bounds = _drawn_in(bounds, stand.rest, edge, np.where(short, part - _EXTRA, np.inf))
    return bounds


def _slack(robot: Robot, stand: Stand, out: Floats) -> Parts[Floats]:
    """Return the least slack at all heights at places seen from the rest footholds, ``(..., legs)``."""
    slack = np.full(out.shape, np.inf)
    for height, share in zip(_HEIGHTS, _NARROWER, strict=True):
        points = stand.rest + share * out
        solution = stand.solve(robot, points.real, points.imag, np.full(points.shape, height * stand.lift))
        slack = np.minimum(slack, joint_slack(robot.geometry, solution))
        slack = np.minimum(slack, _above_ground(robot.geometry, stand, solution) - _KEEP)
        slack = np.minimum(slack, _FASTER - _turning(robot.geometry, solution) / _turning_at_rest(robot, stand))
        if out.ndim > 2:
            yield
    yield
    return slack


def _above_ground(g: LegGeometry, stand: Stand, s: Triangle) -> Floats:
    """Return how high each leg's femur axis or knee is, whichever is lower ``(..., legs)`` [m]."""
    body = BodyPlace(tuple(map(tuple, stand.rotation)), tuple(stand.position))
    if surely_above(g, s.femur, body):
        return np.asarray(np.inf)
    parts = point_parts(np, g, s.coxa, s.femur, s.tibia)
    return np.asarray(np.minimum(body.height(*parts[3:6]), body.height(*parts[6:9])))


def _turning_at_rest(robot: Robot, stand: Stand) -> Floats:
    x, y = stand.rest.real, stand.rest.imag
    return _turning(robot.geometry, stand.solve(robot, x, y, np.zeros(len(stand.rest))))


def _turning(g: LegGeometry, s: Triangle) -> Floats:
    """Return how fast the joints turn at most, over the foot's speed ``(..., legs)`` [rad/m]."""
    # The leg's Jacobian in its plane has the determinant femur tibia sin(tibia angle), and the squares of its elements
    # add up to those of the distances from foot to femur axis and to knee.
    distance2 = g.farthest2 - s.far
    across = g.femur * g.tibia * np.abs(np.sin(s.tibia))
    out = g.coxa + g.femur * np.cos(s.femur) + g.tibia * np.cos(s.femur + s.tibia)
    in_plane = np.sqrt(distance2 + g.tibia * g.tibia) / np.maximum(across, 1e-9)
    return np.asarray(np.maximum(in_plane, 1 / np.maximum(out, 1e-9)))


def _first_zero(radii: Floats, slack: Floats, *, share: float) -> Floats:
    """Return along each ray ``(rays, legs)`` where the slack gets negative, or the last point where it isn't yet."""
    fails = slack < 0
    first = np.where(fails.any(axis=0), fails.argmax(axis=0), len(slack) - 1)[None]
    last = np.maximum(first - 1, 0)
    after, before = (np.take_along_axis(slack, index, axis=0)[0] for index in (first, last))
    part = np.where(after < 0, before / np.where(before > after, before - after, 1.0), 1.0)
    radii = np.broadcast_to(radii, slack.shape)
    start, end = (np.take_along_axis(radii, index, axis=0)[0] for index in (last, first))
    return np.asarray(np.where(before < 0, -_KEEP, start + (end - start) * share * np.clip(part, 0, 1)))


def _halfway(rest: Floats, out: Floats, foot_distance: float) -> Floats:
    """Return by how much `out` ``(n, legs)`` may be stretched, until a foot is on its neighbour's half of the way."""
    way = rest[None, :] - rest[:, None]
    length = np.abs(way) + np.where(np.eye(len(rest), dtype=bool), 1e9, 0.0)
    along = (out.conj()[..., None] * (way / length)).real
    room = np.maximum((length - foot_distance) / 2, 0.0)
    return np.asarray(np.where(along > 1e-6, room / np.maximum(along, 1e-6), np.inf).min(axis=-1))


def _sides(rest: Floats, reach: Floats) -> Floats:
    """Return the polygons' sides from where the rays end ``(rays, legs)``."""
    reach = np.maximum(reach, -_KEEP)
    ends = reach * _DIRECTIONS[:, None]
    tangent = np.roll(ends, -1, axis=0) - np.roll(ends, 1, axis=0)
    size = np.abs(tangent)
    normal = np.where(size > 0, -1j * tangent / np.where(size > 0, size, 1.0), _DIRECTIONS[:, None])
    # In a dent so deep that the boundary runs along the ray, the ray's own direction.
    slanted = (normal.conj() * _DIRECTIONS[:, None]).real < 0.3
    normal = np.where(slanted, _DIRECTIONS[:, None], normal)
    side = np.round(np.angle(normal) * _SIDES / (2 * np.pi)).astype(int) % _SIDES
    bounds = np.full((len(rest), _SIDES), reach.max())
    legs = np.broadcast_to(np.arange(len(rest)), side.shape)
    np.minimum.at(bounds, (legs, side), (NORMALS[side].conj() * ends).real)
    return np.asarray(bounds + (NORMALS.conj() * rest[:, None]).real)


def _edge(bounds: Floats, rest: Floats) -> Floats:
    """Return points of the polygons' edges ``(3 * 16, legs)``, seen from the rest footholds, side by side."""
    start, end = (ends.T[:, None] for ends in polygon_ends(bounds, rest))
    return np.asarray(start + _ALONG * (end - start)).reshape(-1, len(rest))


def _drawn_in(bounds: Floats, rest: Floats, edge: Floats, part: Floats) -> Floats:
    """Return the sides drawn in to a part of the way out to points of `_edge`; not where that is infinite."""
    normals = np.repeat(NORMALS, len(_ALONG))[:, None]
    inner = (normals.conj() * (rest + np.clip(part, 0.0, 1.0) * edge)).real
    inner = np.where(np.isfinite(part), inner, np.inf).reshape(_SIDES, len(_ALONG), -1).min(axis=1)
    return np.asarray(np.minimum(bounds, inner.T))
