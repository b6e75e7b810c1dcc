"""Where each foot may be while the robot walks: a convex polygon about its rest foothold.

Points of the ground plane are complex numbers here, x + iy in the heading frame: turning is a product.

From the rest foothold, rays in all directions end where the leg can't follow: out of its reach or its limits, near to
straight or folded (where a joint would have to turn fast for a slow foot), with its knee in the ground, or past the
middle of the way to the next foot. Each end lies on a line across the boundary there; what is on the inner side of all
lines is the polygon. Where its edge still runs out of what the leg can do, between the rays, sides are drawn in.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.control.incremental import Incremental
from tarsus.control.workspace.leg_margin import RESERVED_MARGIN, LegMargin
from tarsus.control.workspace.polygon import NORMALS, NORMALS_CONJUGATE, polygon_ends
from tarsus.control.workspace.stance_geometry import StanceGeometry
from tarsus.robot.robot import Robot

__all__ = ["foot_workspace", "rest_margin"]

Floats = np.ndarray[Any, Any]

_RAYS, _SIDES, _RINGS, _FINE = 24, len(NORMALS), 8, 5
# How many rings, and how many places on the edge, are looked at in one part.
_INNER, _PLACES = 5, 600
_DIRECTIONS = np.exp(2j * np.pi * np.arange(_RAYS) / _RAYS)
# How often the sides are drawn in at the most, which points of each are looked at, and which parts of the way to them.
_TRIMS = 6
_ALONG = np.array([1, 2, 3])[:, None] / 3
_WAY_OUT = np.array([0.3, 0.6, 0.8, 0.92, 1.0])[:, None, None]
# What is drawn in more than it need be, so that the next corners are within.
_EXTRA, _SAME = 0.01, 1e-9


def foot_workspace(robot: Robot, stand: StanceGeometry, *, foot_distance: float) -> Incremental[Floats]:
    """Work out the sides of each foot's polygon in one stand, in parts of like cost.

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
    slack, halfway = LegMargin(robot, stand), _Halfway(stand.rest, foot_distance)
    rays = np.arange(_RINGS + 1)[:, None, None] * _ring(robot)
    inner = slack(rays[:_INNER] * _DIRECTIONS[:, None])
    yield
    outer = slack(rays[_INNER:] * _DIRECTIONS[:, None])
    coarse = _first_zero(rays, np.concatenate([inner, outer]), share=0.0)
    yield
    # Between the last ring that works and the first that fails, once more.
    rays = coarse + np.arange(_FINE + 1)[:, None, None] * (_ring(robot) / _FINE)
    reach = _first_zero(rays, slack(rays * _DIRECTIONS[:, None]), share=1.0) - RESERVED_MARGIN
    bounds = _sides(stand.rest, np.minimum(reach, halfway(_DIRECTIONS[:, None])))
    yield
    looked, places = 0, len(_ALONG) * _SIDES * robot.legs
    for _ in range(_TRIMS):
        edge = _edge(bounds, stand.rest)
        part = halfway(edge)
        looked += places
        if (slack(edge) < 0).any():
            yield
            part = np.minimum(part, _first_zero(_WAY_OUT, slack(_WAY_OUT * edge), share=1.0))
            looked = _PLACES
        short = part < 1 - _SAME
        if not short.any():
            break
        bounds = _drawn_in(bounds, stand.rest, edge, np.where(short, part - _EXTRA, np.inf))
        if looked + places > _PLACES:
            yield
            looked = 0
    if looked + places > _PLACES:
        yield
    return bounds


def rest_margin(robot: Robot, stand: StanceGeometry, *, knees: bool = True) -> Floats:
    """Return how far a foot may go from its rest foothold at least, until its leg can't follow, or a little way.

    Parameters
    ----------
    robot : Robot
        A single robot.
    stand : Stand
        The body and the rest footholds.
    knees : bool
        Whether the ground is in the way of femur axes and knees.

    Returns
    -------
    array, shape (legs,)
        Where it is negative, a side of the `foot_workspace` lies short of the rest foothold [m].
    """
    rays = np.arange(2)[:, None, None] * (_ring(robot) / _FINE)
    out = np.concatenate([[0j], rays[1, 0] * _DIRECTIONS])[:, None]
    slack = LegMargin(robot, stand, knees=knees)(out)
    ends = np.stack([np.broadcast_to(slack[0], slack[1:].shape), slack[1:]])
    return np.asarray(_first_zero(rays, ends, share=1.0).min(axis=0)) - RESERVED_MARGIN


def _ring(robot: Robot) -> float:
    """Return how far the rings are from each other at which rays are looked at [m]."""
    return float((robot.geometry.femur + robot.geometry.tibia).max()) / _RINGS


def _first_zero(radii: Floats, slack: Floats, *, share: float) -> Floats:
    """Return along each ray ``(rays, legs)`` where the slack gets negative, or the last point where it isn't yet."""
    fails = slack < 0
    first = np.where(fails.any(axis=0), fails.argmax(axis=0), len(slack) - 1)[None]
    last = np.maximum(first - 1, 0)
    after, before = (np.take_along_axis(slack, index, axis=0)[0] for index in (first, last))
    part = np.where(after < 0, before / np.where(before > after, before - after, 1.0), 1.0)
    radii = np.broadcast_to(radii, slack.shape)
    start, end = (np.take_along_axis(radii, index, axis=0)[0] for index in (last, first))
    return np.asarray(np.where(before < 0, -RESERVED_MARGIN, start + (end - start) * share * np.clip(part, 0, 1)))


class _Halfway:
    """How far it is to the neighbours' halves of the ways between rest footholds."""

    def __init__(self, rest: Floats, foot_distance: float) -> None:
        way = rest[None, :] - rest[:, None]
        length = np.abs(way) + np.where(np.eye(len(rest), dtype=bool), 1e9, 0.0)
        self._direction = way / length
        self._room = np.maximum((length - foot_distance) / 2, 0.0)

    def __call__(self, out: Floats) -> Floats:
        """Return by how much `out` ``(n, legs)`` may be stretched until a foot is on a neighbour's half."""
        along = (out.conj()[..., None] * self._direction).real
        return np.asarray(np.where(along > 1e-6, self._room / np.maximum(along, 1e-6), np.inf).min(axis=-1))


def _sides(rest: Floats, reach: Floats) -> Floats:
    """Return the polygons' sides from where the rays end ``(rays, legs)``."""
    reach = np.maximum(reach, -RESERVED_MARGIN)
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
    np.minimum.at(bounds, (legs, side), (NORMALS_CONJUGATE[side] * ends).real)
    return np.asarray(bounds + (NORMALS_CONJUGATE * rest[:, None]).real)


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
