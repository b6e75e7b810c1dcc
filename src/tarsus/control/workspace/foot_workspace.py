"""Foot workspace: a convex polygon around each rest foothold in which the leg can place its foot.

Points of the ground plane are complex numbers, x + iy in the heading frame: a rotation is a product.

Rays from the rest foothold end where the leg fails: beyond its reach or joint limits, near a straight or folded knee
(where a joint would have to turn fast for a slow foot), with the knee in the ground, or beyond the middle between two
feet. The ray ends define tangents to the boundary; the polygon is the intersection of the half planes within these.
Where its edges still leave the feasible region between two rays, sides are moved inwards.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.limitation import Cause
from tarsus.gait.foot_polygons import NORMALS, NORMALS_CONJUGATE, polygon_ends
from tarsus.gait.stance.leg_margin import RESERVED_MARGIN, LegMargin
from tarsus.gait.stance.stance_geometry import StanceGeometry
from tarsus.incremental import Incremental
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["foot_workspace", "reach_cause", "rest_margin"]

# Numbers of rays, of sides of a polygon, of rings at which rays are tested for a first time, of inner rings among them,
# tested in a stage of their own, and of the steps between two rings at which the end of a ray is then searched.
_RAYS, _SIDES, _RINGS, _INNER, _FINE = 24, len(NORMALS), 8, 5, 5
_DIRECTIONS = np.exp(2j * np.pi * np.arange(_RAYS) / _RAYS)[:, None]
# Greatest number of passes in which sides are moved inwards.
_PASSES = 6
# Points tested on each side, as fractions of its length; for each of these points, the conjugate normal of its side, a
# factor for coordinates along the normal; fractions of the way from the rest foothold to such a point that are tested.
_ALONG = np.array([1, 2, 3])[:, None] / 3
_EDGE_NORMALS = np.repeat(NORMALS_CONJUGATE, len(_ALONG))[:, None]
_FRACTIONS = np.array([0.3, 0.6, 0.8, 0.92, 1.0])[:, None, None]
# Fraction by which sides are moved further than needed, so that the new corners are inside; tolerance of fractions.
_EXTRA, _TOLERANCE = 0.01, 1e-9


def foot_workspace(
    robot: Robot, stance: StanceGeometry, *, foot_distance: float
) -> Incremental[Float[np.ndarray, "legs 16"]]:
    """Find the sides of each foot's polygon in one stance.

    Parameters
    ----------
    robot, stance, foot_distance : Robot, StanceGeometry, float
        A single robot; the body and the rest footholds; least distance between two feet [m].

    Returns
    -------
    array, shape (legs, 16)
        Distances of the sides from the heading frame's origin along `NORMALS` [m]. If a foot cannot be at its rest
        foothold, that foothold is outside the polygon.
    """
    margin, spacing = LegMargin(robot, stance), partial(_spacing, stance.rest, foot_distance)
    step = _ring(robot)
    rings = np.arange(_RINGS + 1)[:, None, None] * step
    inner = margin(rings[:_INNER] * _DIRECTIONS)
    yield
    outer = margin(rings[_INNER:] * _DIRECTIONS)
    last_feasible = _first_zero(rings, np.concatenate([inner, outer]), interpolation=0.0)
    yield
    rays = last_feasible + np.arange(_FINE + 1)[:, None, None] * (step / _FINE)
    reach = _first_zero(rays, margin(rays * _DIRECTIONS), interpolation=1.0) - RESERVED_MARGIN
    yield
    bounds = _sides(stance.rest, np.minimum(reach, spacing(_DIRECTIONS)))
    for _ in range(_PASSES):
        edge = _edge(bounds, stance.rest)
        fraction = spacing(edge)
        beyond = (margin(edge) < 0).any()
        yield
        if beyond:
            fraction = np.minimum(fraction, _first_zero(_FRACTIONS, margin(_FRACTIONS * edge), interpolation=1.0))
            yield
        short = fraction < 1 - _TOLERANCE
        if not short.any():
            break
        # Where the polygon reaches out too far, sides move inwards.
        sides = (_EDGE_NORMALS * (stance.rest + np.clip(fraction - _EXTRA, 0.0, 1.0) * edge)).real
        sides = np.where(short, sides, np.inf).reshape(_SIDES, len(_ALONG), -1).min(axis=1)
        bounds = np.minimum(bounds, sides.T)
    return bounds


def rest_margin(robot: Robot, stance: StanceGeometry, *, knees: bool = True) -> Float[np.ndarray, "legs"]:
    """Return how far each foot can move from its rest foothold in every direction; tested up to a small distance only.

    Parameters
    ----------
    robot, stance : Robot, StanceGeometry
        A single robot; the body and the rest footholds.
    knees : bool
        Whether femur axes and knees must stay above the ground.

    Returns
    -------
    array, shape (legs,)
        Distances [m]; where negative, the rest foothold is outside the polygon of `foot_workspace`.
    """
    rays = np.arange(2)[:, None, None] * (_ring(robot) / _FINE)
    out = np.concatenate([[[0j]], rays[1] * _DIRECTIONS])
    margin = LegMargin(robot, stance, knees=knees)(out)
    ends = np.stack([np.broadcast_to(margin[0], margin[1:].shape), margin[1:]])
    return np.asarray(_first_zero(rays, ends, interpolation=1.0).min(axis=0)) - RESERVED_MARGIN


def reach_cause(robot: Robot, stance: StanceGeometry) -> Cause:
    """Return which leg has the least room around its rest foothold, and what limits it.

    Parameters
    ----------
    robot, stance : Robot, StanceGeometry
        A single robot; the body and the rest footholds.
    """
    margin = rest_margin(robot, stance)
    leg = int(margin.argmin())
    knee = bool(rest_margin(robot, stance, knees=False)[leg] >= 0)
    return Cause("the knee touches the ground" if knee else "end of the leg's reach", robot.leg_names[leg])


def _ring(robot: Robot) -> float:
    """Return the distance between two rings at which rays are tested [m]."""
    return float((robot.geometry.femur + robot.geometry.tibia).max()) / _RINGS


def _first_zero(
    radii: Float[np.ndarray, "k m n"], margin: Float[np.ndarray, "*batch"], *, interpolation: float
) -> Float[np.ndarray, "rays legs"]:
    """Return where the margin becomes negative along each ray ``(rays, legs)``, or the end of the ray.

    `radii` are the tested points of the rays. With the `interpolation` 0, the last one before is returned; with 1, the
    zero interpolated between two. Where a ray fails at its start, the result is minus `RESERVED_MARGIN`.
    """
    fails = margin < 0
    first = np.where(fails.any(axis=0), fails.argmax(axis=0), len(margin) - 1)[None]
    last = np.maximum(first - 1, 0)
    after, before = (np.take_along_axis(margin, index, axis=0)[0] for index in (first, last))
    fraction = np.where(after < 0, before / np.where(before > after, before - after, 1.0), 1.0)
    radii = np.broadcast_to(radii, margin.shape)
    start, end = (np.take_along_axis(radii, index, axis=0)[0] for index in (last, first))
    zero = start + (end - start) * interpolation * np.clip(fraction, 0, 1)
    return np.asarray(np.where(before < 0, -RESERVED_MARGIN, zero))


def _spacing(
    rest: Complex[np.ndarray, "legs"], foot_distance: float, out: Complex[np.ndarray, "*#batch #legs"]
) -> Float[np.ndarray, "..."]:
    """Return the factor by which `out` may be scaled before a foot comes too near the middle to another rest foothold.

    Half the least distance between two feet is kept free on either side of the middle.
    """
    path = rest[None, :] - rest[:, None]
    length = np.abs(path) + np.where(np.eye(len(rest), dtype=bool), 1e9, 0.0)
    along = (out.conj()[..., None] * (path / length)).real
    room = np.maximum((length - foot_distance) / 2, 0.0)
    return np.asarray(np.where(along > 1e-6, room / np.maximum(along, 1e-6), np.inf).min(axis=-1))


def _sides(rest: Complex[np.ndarray, "legs"], reach: Float[np.ndarray, "n legs"]) -> Float[np.ndarray, "legs 16"]:
    """Return the polygons' sides, given the lengths of the rays ``(rays, legs)`` [m]."""
    reach = np.maximum(reach, -RESERVED_MARGIN)
    ends = reach * _DIRECTIONS
    tangent = np.roll(ends, -1, axis=0) - np.roll(ends, 1, axis=0)
    size = np.abs(tangent)
    normal = -1j * tangent / np.where(size > 0, size, 1.0)
    # Where the boundary runs along the ray, the direction of the ray is used as the normal.
    normal = np.where((normal.conj() * _DIRECTIONS).real < 0.3, _DIRECTIONS, normal)
    side = np.round(np.angle(normal) * _SIDES / (2 * np.pi)).astype(int) % _SIDES
    bounds = np.full((len(rest), _SIDES), reach.max())
    legs = np.broadcast_to(np.arange(len(rest)), side.shape)
    np.minimum.at(bounds, (legs, side), (NORMALS_CONJUGATE[side] * ends).real)
    return np.asarray(bounds + (NORMALS_CONJUGATE * rest[:, None]).real)


def _edge(bounds: Float[np.ndarray, "legs 16"], rest: Complex[np.ndarray, "legs"]) -> Complex[np.ndarray, "n legs"]:
    """Return points on the polygons' edges ``(3 * 16, legs)``, relative to the rest footholds."""
    start, end = (ends.T[:, None] for ends in polygon_ends(bounds, rest))
    return np.asarray(start + _ALONG * (end - start)).reshape(-1, len(rest))
