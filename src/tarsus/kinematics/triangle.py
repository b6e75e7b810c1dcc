"""The closed form of one leg's inverse kinematics: the triangle of femur, tibia and the line to the foot.

With `r`, `z` the foot seen from the femur axis, `d^2 = r^2 + z^2`, and the two products

    far = (femur + tibia)^2 - d^2        near = d^2 - (femur - tibia)^2

the tibia's angle is ``atan2(sqrt(far near), d^2 - femur^2 - tibia^2)`` and the femur's is the direction of the
foot plus ``atan2(sqrt(far near), d^2 + femur^2 - tibia^2)``: the law of cosines of sources 000 to 004 with the sine
beside the cosine. Near the straight or folded leg a rounded position tells either angle to half the digits only; but
both come from the same root, so that their errors cancel and the foot keeps all its digits. Those of two arc cosines
don't cancel: at a bend of 1e-7 rad the foot is 2.5e-10 m off.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tarsus.arrays import Array, Namespace, root
from tarsus.robot.geometry import LegGeometry

__all__ = ["Triangle", "direction", "solve_triangle", "to_leg_frame"]


class Triangle(NamedTuple):
    """Joint angles [rad], and the three quantities [m^2] whose signs tell whether the triangle closes.

    `far` is negative where the foot is too far; `near` where it is too near the femur axis; `beside` where it is
    nearer to the coxa axis than the femur axis' sideways offset lets the leg's plane come.
    """

    coxa: Array
    femur: Array
    tibia: Array
    far: Array
    near: Array
    beside: Array


def direction(xp: Namespace, y: Array, x: Array) -> Array:
    """Return ``atan2(y, x)``, with a gradient that stays finite at the origin."""
    if xp is np:
        return np.atan2(y, x)
    return xp.atan2(y, xp.where((x == 0) & (y == 0), xp.ones_like(x), x))


def to_leg_frame(geometry: LegGeometry, x: Array, y: Array, z: Array) -> tuple[Array, Array, Array]:
    """Carry points of the body frame into the coxa frame, raised to the height of the femur axis."""
    g = geometry
    x, y = x - g.mount_x, y - g.mount_y
    return g.cos_yaw * x + g.sin_yaw * y, g.cos_yaw * y - g.sin_yaw * x, z - (g.mount_z + g.up)


def solve_triangle(
    xp: Namespace,
    geometry: LegGeometry,
    x: Array,
    y: Array,
    z: Array,
    *,
    knee: int,
    facing: int = 1,
    sideways: bool = True,
) -> Triangle:
    """Return the joint angles that put the foot at a point of the leg frame.

    Parameters
    ----------
    xp : namespace
        The array library.
    geometry : LegGeometry
        The legs.
    x, y, z : array, shape (..., legs)
        The foot, from `to_leg_frame` [m].
    knee : int
        1 for the solution with the knee above the line from femur axis to foot, -1 for the one below.
    facing : int
        1 for the leg's plane turned towards the foot, -1 for turned away, the foot reached behind the coxa axis.
    sideways : bool
        Whether any femur axis is offset sideways; where none is, a sixth of the work can be left out.
    """
    g = geometry
    across2 = x * x + y * y
    beside = across2 - g.side2 if sideways else across2
    along = root(xp, beside) if facing > 0 else -root(xp, beside)
    ahead, aside = (x * along + y * g.side, y * along - x * g.side) if sideways else (facing * x, facing * y)
    r = along - g.coxa
    distance2 = r * r + z * z
    far, near = g.farthest2 - distance2, distance2 - g.nearest2
    bend = knee * root(xp, far * near)
    base = distance2 + g.difference2
    return Triangle(
        coxa=direction(xp, aside, ahead),
        femur=direction(xp, z * base + r * bend, r * base - z * bend),
        tibia=-direction(xp, bend, distance2 - g.sum2),
        far=far,
        near=near,
        beside=beside,
    )
