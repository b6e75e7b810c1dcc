"""Statics of a level robot on level ground, in the planes of its legs: legs in front, moments, designs behind.

All forces are vertical. What counts of a point is how far outward in its leg's plane it is; heights, and the coxa
joints, which turn about the vertical, play no part. A leg whose foot is where it should be is known by its foot: its
heading and its knee's place need no cosines, which take longer than all the rest.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np

from tarsus.arrays import Array, Namespace, only_where_needed, root
from tarsus.kinematics.ground import BodyPlace, mark_below_ground, surely_above
from tarsus.kinematics.polygon import margin_and_nearest
from tarsus.kinematics.triangle import Triangle, solve_triangle, to_leg_frame
from tarsus.kinematics.verdict import all_within, reach_codes
from tarsus.load.load_distribution import shared_load
from tarsus.robot.geometry import LegGeometry

__all__ = [
    "Block",
    "LegPlane",
    "feet_from_load",
    "plane_by_angles",
    "plane_by_foot",
    "share_weight",
    "solve_block",
    "torques_in_plane",
]

Column: TypeAlias = Array

_ROUNDING = 1e-12  # how far outside the polygon rounding may put a load that acts on its very edge [m]
_THIN = 1e-12  # spread across over spread in all of feet that are taken to be on a line
_SINGULAR = 1e-18  # squares of distances [m^2] at which a foot is on an axis, and tells no direction


class Block(NamedTuple):
    """Some designs. Arrays are ``(legs, 1, designs)``, or ``(designs,)`` for `moment`, `mass` and the last three.

    `masses` are those of the leg points (four), `moment` is the body's and payload's mass times its place, x and y,
    `mass` the whole; `rest` are the footholds in B.
    """

    legs: LegGeometry
    masses: tuple[Column, ...]
    moment: tuple[Column, ...]
    mass: Column
    rest: tuple[Column, ...]
    stroke: Column
    body_height: Column
    swing_height: Column


class LegPlane(NamedTuple):
    """Legs seen in their planes ``(legs, moments, designs)``.

    `cos` and `sin` are those of the coxa joint, `knee` and `foot` how far outward from the femur axis those are [m].
    """

    cos: Array
    sin: Array
    knee: Array
    foot: Array


def solve_block(block: Block, along: Array) -> tuple[Triangle, Array, LegPlane]:
    """Return the joint angles of NumPy designs, and their legs in their planes, where every foot is reached at once.

    Parameters
    ----------
    block : Block
        The designs.
    along : array, shape (3, legs, moments, 1)
        Where the feet are, from rest: forward and left in strokes, up in lifts.

    Returns
    -------
    triangle, solved, plane
        Whether all feet of a design are solved ``(designs,)``; of one that is not, nothing here is valid.
    """
    g = block.legs
    x, y, z = to_leg_frame(g, *block.rest)
    ahead, aside = along[0] * block.stroke, along[1] * block.stroke
    x, y = x + g.cos_yaw * ahead + g.sin_yaw * aside, y + g.cos_yaw * aside - g.sin_yaw * ahead
    z = z + along[2] * block.swing_height
    sideways = bool(g.side.any())
    triangle = solve_triangle(np, g, x, y, z, knee=1, sideways=sideways)
    within = all_within(g, triangle)
    codes = np.zeros(triangle.far.shape, dtype=np.int8) if within else reach_codes(np, g, triangle)
    zero, one = np.zeros(1), np.ones(1)
    place = BodyPlace(((one, zero, zero), (zero, one, zero), (zero, zero, one)), (zero, zero, block.body_height))
    if not surely_above(g, triangle.femur, place):
        codes = mark_below_ground(np, g, triangle[:3], codes, place)
    plane, singular = plane_by_foot(g, triangle, x, y, z, sideways=sideways)
    return triangle, ~((codes != 0) | singular).any((0, 1)), plane


def plane_by_foot(
    g: LegGeometry, triangle: Triangle, x: Array, y: Array, z: Array, *, sideways: bool
) -> tuple[LegPlane, Array]:
    """Return NumPy legs in their planes, from where their feet are in the leg frames; and which can't be told so."""
    across2 = x * x + y * y
    out = root(np, across2 - g.side2 if sideways else across2)
    foot = out - g.coxa
    distance2 = foot * foot + z * z
    singular = (across2 <= _SINGULAR) | (distance2 <= _SINGULAR)
    if singular.any():
        across2, distance2 = (np.where(singular, 1.0, square) for square in (across2, distance2))
    bend = root(np, triangle.far * triangle.near)
    knee = (foot * (distance2 + g.difference2) - z * bend) / (2 * distance2)
    ahead, aside = (x * out + y * g.side, y * out - x * g.side) if sideways else (x * out, y * out)
    return LegPlane(ahead / across2, aside / across2, knee, foot), singular


def plane_by_angles(xp: Namespace, g: LegGeometry, coxa: Array, femur: Array, tibia: Array) -> LegPlane:
    """Return legs in their planes, from any joint angles."""
    knee = g.femur * xp.cos(femur)
    return LegPlane(xp.cos(coxa), xp.sin(coxa), knee, knee + g.tibia * xp.cos(femur + tibia))


def feet_from_load(xp: Namespace, block: Block, plane: LegPlane) -> tuple[Array, Array]:
    """Return x and y of the feet, seen from the centre of all that is carried ``(legs, moments, designs)`` [m]."""
    g = block.legs
    mount, axis, knee, foot = block.masses
    outer = axis + knee + foot
    far = outer * g.coxa + knee * plane.knee + foot * plane.foot
    near = outer * g.side
    moment_x, moment_y = _turned(g, far * plane.cos - near * plane.sin, far * plane.sin + near * plane.cos)
    whole = mount + outer
    com_x = (xp.sum(moment_x + whole * g.mount_x, axis=0) + block.moment[0]) / block.mass
    com_y = (xp.sum(moment_y + whole * g.mount_y, axis=0) + block.moment[1]) / block.mass
    out = g.coxa + plane.foot
    x, y = _turned(g, out * plane.cos - g.side * plane.sin, out * plane.sin + g.side * plane.cos)
    return x + (g.mount_x - com_x), y + (g.mount_y - com_y)


def _turned(g: LegGeometry, x: Array, y: Array) -> tuple[Array, Array]:
    """Turn vectors of the leg frames into B's."""
    return g.cos_yaw * x - g.sin_yaw * y, g.sin_yaw * x + g.cos_yaw * y


def share_weight(xp: Namespace, x: Array, y: Array) -> tuple[Array, Array]:
    """Return which share of the weight each of some feet bears, and whether there is an equilibrium.

    Parameters
    ----------
    xp : namespace
        The array library.
    x, y : array, shape (feet, batch)
        The feet that are down, seen from the load [m].

    Returns
    -------
    shares : array, shape (feet, batch)
        Not negative.
    balanced : array of bool, shape (batch,)
        Whether the load is inside the feet's polygon, or on its edge.
    """
    shares, clear = _even_plane(xp, x, y)
    clear = clear & xp.all(shares >= 0, axis=0)
    if xp is np:
        # Where no foot would have to pull, the plane of least squares is the answer; nearly always that is everywhere.
        few = np.flatnonzero(~clear)
        if len(few):
            shares[:, few], clear[few] = _share_by_pushing(np, x[:, few], y[:, few])
        return shares, clear

    def all_anew() -> tuple[Array, Array]:
        pushing, balanced = _share_by_pushing(xp, x, y)
        return xp.where(clear, shares, pushing), clear | balanced

    new, balanced = only_where_needed(xp.any(~clear), all_anew, (shares, clear))
    return new, balanced


def _even_plane(xp: Namespace, x: Array, y: Array) -> tuple[Array, Array]:
    """Return the shares of least squares, pulling ones included, and whether the feet span an area."""
    feet = x.shape[0]
    mid_x, mid_y = xp.sum(x, axis=0) / feet, xp.sum(y, axis=0) / feet
    u, v = x - mid_x, y - mid_y
    uu, uv, vv = xp.sum(u * u, axis=0), xp.sum(u * v, axis=0), xp.sum(v * v, axis=0)
    area = uu * vv - uv * uv
    wide = area > _THIN * (uu + vv) ** 2
    area = xp.where(wide, area, 1.0)
    along_x, along_y = (uv * mid_y - vv * mid_x) / area, (uv * mid_x - uu * mid_y) / area
    return 1 / feet + along_x * u + along_y * v, wide


def _share_by_pushing(xp: Namespace, x: Array, y: Array) -> tuple[Array, Array]:
    down = xp.ones_like(x, dtype=xp.bool)
    margin, near_x, near_y = margin_and_nearest(xp, x, y, down)
    return shared_load(xp, x - near_x, y - near_y, down), margin >= -_ROUNDING


def torques_in_plane(block: Block, plane: LegPlane, push: Array, gravity: float) -> tuple[Array, Array]:
    """Return the torques of femur and tibia for the ground's forces on the feet ``(legs, moments, designs)``."""
    at_foot = push - gravity * block.masses[3]
    femur = gravity * block.masses[2] * plane.knee - at_foot * plane.foot
    return femur, at_foot * (plane.knee - plane.foot)
