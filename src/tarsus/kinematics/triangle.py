"""Closed-form inverse kinematics of a leg: the triangle of femur, tibia and the line to the foot.

With `r`, `z` the foot relative to the femur axis, `d^2 = r^2 + z^2`, and

    far = (femur + tibia)^2 - d^2        near = d^2 - (femur - tibia)^2

the tibia angle is ``atan2(sqrt(far near), d^2 - femur^2 - tibia^2)`` and the femur angle is the direction of the foot
plus ``atan2(sqrt(far near), d^2 + femur^2 - tibia^2)``: the law of cosines of sources 000 to 004 with sine and cosine.
Near the straight or folded leg, a rounded position determines either angle to half the digits only; as both angles come
from the same root, their errors cancel and the foot is accurate. Errors of two arc cosines do not cancel: with the
tibia at 1e-7 rad the foot is off by 2.5e-10 m.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.arrays import Array, Namespace, root
from tarsus.robot.geometry import LegGeometry

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Triangle", "direction", "solve_triangle", "to_leg_frame"]


class Triangle(NamedTuple):
    """Joint angles, and three quantities whose signs tell whether the triangle exists.

    Attributes
    ----------
    coxa, femur, tibia : array, shape (..., legs)
        Joint angles [rad].
    far, near, beside : array, shape (..., legs)
        Negative where the foot is too far from the femur axis, too near to it, or nearer to the coxa axis than the
        sideways offset of the femur axis [m^2].
    """

    coxa: Float[Array, "*#batch legs"]
    femur: Float[Array, "*#batch legs"]
    tibia: Float[Array, "*#batch legs"]
    far: Float[Array, "*#batch legs"]
    near: Float[Array, "*#batch legs"]
    beside: Float[Array, "*#batch legs"]


def direction(
    xp: Namespace, y: Float[Array, "*#batch legs"], x: Float[Array, "*#batch legs"]
) -> Float[Array, "... legs"]:
    """Return ``atan2(y, x)``, with a gradient that stays finite at the origin."""
    if xp is np:
        return np.atan2(y, x)
    return xp.atan2(y, xp.where((x == 0) & (y == 0), xp.ones_like(x), x))


def to_leg_frame(
    geometry: LegGeometry,
    x: Float[Array, "*#batch legs"],
    y: Float[Array, "*#batch legs"],
    z: Float[Array, "*#batch #legs"],
) -> tuple[Float[Array, "..."], Float[Array, "..."], Float[Array, "..."]]:
    """Transform points from the body frame to the coxa frame, raised to the height of the femur axis."""
    g = geometry
    x, y = x - g.mount_x, y - g.mount_y
    return g.cos_yaw * x + g.sin_yaw * y, g.cos_yaw * y - g.sin_yaw * x, z - (g.mount_z + g.up)


def solve_triangle(
    xp: Namespace,
    geometry: LegGeometry,
    x: Float[Array, "*#batch legs"],
    y: Float[Array, "*#batch legs"],
    z: Float[Array, "*#batch #legs"],
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
        Knee branch: 1 with the knee above the line from femur axis to foot, -1 below.
    facing : int
        1 with the leg's plane facing the foot, -1 facing away from it, the foot behind the coxa axis.
    sideways : bool
        Whether any femur axis has a sideways offset; without one, a sixth of the computation is skipped.
    """
    g = geometry
    radius2 = x * x + y * y
    beside = radius2 - g.side2 if sideways else radius2
    along = root(xp, beside) if facing > 0 else -root(xp, beside)
    if sideways:
        ahead, aside = x * along + y * g.side, y * along - x * g.side
    else:
        ahead, aside = (x, y) if facing > 0 else (-x, -y)
    r = along - g.coxa
    distance2 = r * r + z * z
    far, near = g.farthest2 - distance2, distance2 - g.nearest2
    bend = root(xp, far * near) if knee > 0 else -root(xp, far * near)
    base = distance2 + g.difference2
    return Triangle(
        coxa=direction(xp, aside, ahead),
        femur=direction(xp, z * base + r * bend, r * base - z * bend),
        tibia=-direction(xp, bend, distance2 - g.sum2),
        far=far,
        near=near,
        beside=beside,
    )
