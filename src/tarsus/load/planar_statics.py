"""Statics of a level robot on level ground, in the planes of its legs; axes are (legs, phases, designs).

All forces are vertical, so only the radial distances of the points in a leg's plane matter: heights do not, and the
coxa joints, with their vertical axes, bear nothing. If a foot is reached, the leg's heading and its knee follow from
the foot position without cosines, which would take most of the computation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.arrays import Array, Namespace, only_where_needed, root
from tarsus.kinematics.ground import PoseComponents, certainly_above_ground, mark_below_ground
from tarsus.kinematics.planar_moments import PlanarMoments
from tarsus.kinematics.polygon import margin_and_nearest
from tarsus.kinematics.reach import all_within, reach_codes
from tarsus.kinematics.triangle import Triangle, solve_triangle, to_leg_frame
from tarsus.load.load_distribution import load_fractions
from tarsus.robot.geometry import LegGeometry

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = [
    "Block",
    "LegPlane",
    "feet_from_load",
    "plane_by_angles",
    "plane_by_foot",
    "solve_block",
    "torques_in_plane",
    "weight_fractions",
]

_ROUNDING = 1e-12  # of the margin of a load on the edge of the support polygon [m]
_COLLINEAR = 1e-12  # ratio of determinant to squared trace of the second moments below which feet are collinear
_SINGULAR = 1e-18  # squared distance [m^2] below which a foot lies on a joint axis, and its direction is undefined


class Block(NamedTuple):
    """A block of designs. Arrays are ``(legs, 1, designs)``; `moment`, `mass` and the last three ``(designs,)``.

    `masses` are the point masses of the four leg points, `moment` the first moment of body and payload in x and y
    [kg m], `mass` the total mass, `rest` the rest footholds in B.
    """

    legs: LegGeometry
    masses: tuple[Float[Array, "... legs m n"], ...]
    moment: tuple[Float[Array, "..."], ...]
    mass: Float[Array, "..."]
    rest: tuple[Float[Array, "... legs m n"], ...]
    stroke: Float[Array, "*#batch"]
    body_height: Float[Array, "*#batch"]
    swing_height: Float[Array, "*#batch"]


class LegPlane(NamedTuple):
    """Legs in their planes ``(legs, phases, designs)``.

    `cos` and `sin` are those of the coxa angle; `knee` and `foot` are radial distances from the femur axis [m].
    """

    cos: Float[Array, "... legs m n"]
    sin: Float[Array, "... legs m n"]
    knee: Float[Array, "... legs m n"]
    foot: Float[Array, "... legs m n"]


def solve_block(
    block: Block, offsets: Float[Array, "3 legs phases 1"]
) -> tuple[Triangle, Bool[Array, "designs"], LegPlane]:
    """Return the joint angles and leg planes of NumPy designs; designs with an unreachable foot are marked unsolved.

    Parameters
    ----------
    block : Block
        The designs.
    offsets : array, shape (3, legs, phases, 1)
        Foot offsets from rest: forward and left in strokes, up in swing heights.

    Returns
    -------
    triangle : Triangle
        Joint angles and reach, ``(legs, phases, designs)``.
    solved : array of bool, shape (designs,)
        Designs with every foot reached; the other results are valid for these only.
    plane : LegPlane
        The legs in their planes.
    """
    g = block.legs
    x, y, z = to_leg_frame(g, *block.rest)
    forward, left = offsets[0] * block.stroke, offsets[1] * block.stroke
    x, y = x + g.cos_yaw * forward + g.sin_yaw * left, y + g.cos_yaw * left - g.sin_yaw * forward
    z = z + offsets[2] * block.swing_height
    sideways = bool(g.side.any())
    triangle = solve_triangle(np, g, x, y, z, knee=1, sideways=sideways)
    within = all_within(g, triangle)
    codes = np.zeros(triangle.far.shape, dtype=np.int8) if within else reach_codes(np, g, triangle)
    zero, one = np.zeros(1), np.ones(1)
    body = PoseComponents(((one, zero, zero), (zero, one, zero), (zero, zero, one)), (zero, zero, block.body_height))
    if not certainly_above_ground(g, triangle.femur, body):
        codes = mark_below_ground(np, g, triangle[:3], codes, body)
    plane, singular = plane_by_foot(g, triangle, x, y, z, sideways=sideways)
    return triangle, ~((codes != 0) | singular).any((0, 1)), plane


def plane_by_foot(
    g: LegGeometry,
    triangle: Triangle,
    x: Float[Array, "*#batch"],
    y: Float[Array, "*#batch"],
    z: Float[Array, "... legs"],
    *,
    sideways: bool,
) -> tuple[LegPlane, Bool[Array, "..."]]:
    """Return NumPy legs in their planes from the feet in the leg frames, and which are singular."""
    across2 = x * x + y * y
    radial = root(np, across2 - g.side2 if sideways else across2)
    foot = radial - g.coxa
    distance2 = foot * foot + z * z
    singular = (across2 <= _SINGULAR) | (distance2 <= _SINGULAR)
    if singular.any():
        across2, distance2 = (np.where(singular, 1.0, square) for square in (across2, distance2))
    bend = root(np, triangle.far * triangle.near)
    knee = (foot * (distance2 + g.difference2) - z * bend) / (2 * distance2)
    forward, left = (x * radial + y * g.side, y * radial - x * g.side) if sideways else (x * radial, y * radial)
    return LegPlane(forward / across2, left / across2, knee, foot), singular


def plane_by_angles(
    xp: Namespace,
    g: LegGeometry,
    coxa: Float[Array, "*#batch legs"],
    femur: Float[Array, "*#batch legs"],
    tibia: Float[Array, "*#batch legs"],
) -> LegPlane:
    """Return legs in their planes from joint angles."""
    knee = g.femur * xp.cos(femur)
    return LegPlane(xp.cos(coxa), xp.sin(coxa), knee, knee + g.tibia * xp.cos(femur + tibia))


def feet_from_load(
    xp: Namespace, block: Block, plane: LegPlane
) -> tuple[Float[Array, "... legs m n"], Float[Array, "... legs m n"]]:
    """Return x and y of the feet relative to the centre of mass, ``(legs, phases, designs)`` [m]."""
    g = block.legs
    mount, axis, knee, foot = block.masses
    outer = axis + knee + foot
    radial_moment = outer * g.coxa + knee * plane.knee + foot * plane.foot
    side_moment = outer * g.side
    moment_x, moment_y = _to_body(
        g, radial_moment * plane.cos - side_moment * plane.sin, radial_moment * plane.sin + side_moment * plane.cos
    )
    leg_mass = mount + outer
    com_x = (xp.sum(moment_x + leg_mass * g.mount_x, axis=0) + block.moment[0]) / block.mass
    com_y = (xp.sum(moment_y + leg_mass * g.mount_y, axis=0) + block.moment[1]) / block.mass
    radial = g.coxa + plane.foot
    x, y = _to_body(g, radial * plane.cos - g.side * plane.sin, radial * plane.sin + g.side * plane.cos)
    return x + (g.mount_x - com_x), y + (g.mount_y - com_y)


def _to_body(
    g: LegGeometry, x: Float[Array, "*#batch"], y: Float[Array, "*#batch"]
) -> tuple[Float[Array, "... legs m n"], Float[Array, "... legs m n"]]:
    """Rotate vectors of the leg frames into B."""
    return g.cos_yaw * x - g.sin_yaw * y, g.sin_yaw * x + g.cos_yaw * y


def weight_fractions(
    xp: Namespace, x: Float[Array, "feet batch"], y: Float[Array, "feet batch"]
) -> tuple[Float[Array, "feet batch"], Bool[Array, "batch"]]:
    """Return the fraction of the weight on each foot, and whether there is an equilibrium.

    Parameters
    ----------
    xp : namespace
        The array library.
    x, y : array, shape (feet, batch)
        Feet on the ground relative to the load [m].

    Returns
    -------
    fractions : array, shape (feet, batch)
        Fractions of the weight, at least 0.
    balanced : array of bool, shape (batch,)
        Whether the load is inside the support polygon or on its edge.
    """
    fractions, settled = _least_squares_fractions(xp, x, y)
    settled = settled & xp.all(fractions >= 0, axis=0)
    if xp is np:
        # The unconstrained least squares hold wherever no foot would have to pull, which is almost everywhere.
        few = np.flatnonzero(~settled)
        if len(few):
            fractions[:, few], settled[few] = _constrained_fractions(np, x[:, few], y[:, few])
        return fractions, settled

    def recompute() -> tuple[Array, Array]:
        constrained, balanced = _constrained_fractions(xp, x, y)
        return xp.where(settled, fractions, constrained), settled | balanced

    result, balanced = only_where_needed(xp.any(~settled), recompute, (fractions, settled))
    return result, balanced


def _least_squares_fractions(
    xp: Namespace, x: Float[Array, "feet batch"], y: Float[Array, "feet batch"]
) -> tuple[Float[Array, "... feet batch"], Bool[Array, "... batch"]]:
    """Return the unconstrained least-squares fractions, and whether the feet are not collinear."""
    feet = x.shape[0]
    mid_x, mid_y = xp.sum(x, axis=0) / feet, xp.sum(y, axis=0) / feet
    u, v = x - mid_x, y - mid_y
    moments = PlanarMoments(xp.sum(u * u, axis=0), xp.sum(u * v, axis=0), xp.sum(v * v, axis=0))
    spans_area = moments.span_area(_COLLINEAR)
    along_x, along_y = moments.slopes(-mid_x, -mid_y, determinant=xp.where(spans_area, moments.determinant, 1.0))
    return 1 / feet + along_x * u + along_y * v, spans_area


def _constrained_fractions(
    xp: Namespace, x: Float[Array, "feet batch"], y: Float[Array, "feet batch"]
) -> tuple[Float[Array, "... feet batch"], Bool[Array, "... batch"]]:
    down = xp.ones_like(x, dtype=xp.bool)
    margin, near_x, near_y = margin_and_nearest(xp, x, y, down)
    return load_fractions(xp, x - near_x, y - near_y, down), margin >= -_ROUNDING


def torques_in_plane(
    block: Block, plane: LegPlane, normal_force: Float[Array, "... legs m n"], gravity: float
) -> tuple[Float[Array, "... legs m n"], Float[Array, "... legs m n"]]:
    """Return femur and tibia torques for vertical contact forces ``(legs, phases, designs)`` [N m]."""
    at_foot = normal_force - gravity * block.masses[3]
    femur = gravity * block.masses[2] * plane.knee - at_foot * plane.foot
    return femur, at_foot * (plane.knee - plane.foot)
