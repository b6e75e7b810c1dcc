"""The nearest point that a leg can reach, joint limits included.

In the leg's plane the reachable points are the image of a box of femur and tibia angles; its boundary lies on five
kinds of arcs: femur at a limit, tibia at a limit, and the straight or folded leg (which are limits too once the tibia
is kept in one knee branch). The nearest point of an arc is where the ray from its centre meets it, or its nearer end:
so the nearest point of the whole is the best of a few candidates, exactly. The plane itself is turned towards the
target, away from it, or to a limit of the coxa.
"""

from __future__ import annotations

import math

from tarsus.arrays import Array, Namespace, is_traced
from tarsus.kinematics.triangle import root
from tarsus.robot.geometry import LegGeometry

__all__ = ["clip_angle", "nearest_angles", "tibia_branch"]

_TURN = 2 * math.pi
# With a sideways offset the best turn of the plane depends on how far the foot gets; this many corrections bring
# the distance within a micrometre of the least.
_CORRECTIONS = 12


def wrap(xp: Namespace, angle: Array) -> Array:
    """Return the angle in -pi..pi."""
    return angle - _TURN * xp.round(angle / _TURN)


def clip_angle(xp: Namespace, angle: Array, lower: Array, upper: Array) -> Array:
    """Return the angle where it lies between its limits, else the limit nearer round the circle."""
    below, above = xp.abs(wrap(xp, lower - angle)), xp.abs(wrap(xp, angle - upper))
    nearer = xp.where(below < above, lower, upper)
    return xp.where((angle >= lower) & (angle <= upper), angle, nearer)


def tibia_branch(xp: Namespace, geometry: LegGeometry, *, knee: int) -> tuple[Array, Array]:
    """Return the tibia's limits within one knee branch; the limits as they are where none of it is in that branch."""
    lower, upper = geometry.tibia_lower, geometry.tibia_upper
    zero = xp.zeros_like(lower)
    if knee > 0:
        return lower, xp.where(lower <= zero, xp.minimum(upper, zero), upper)
    return xp.where(upper >= zero, xp.maximum(lower, zero), lower), upper


def nearest_angles(
    xp: Namespace, geometry: LegGeometry, x: Array, y: Array, z: Array, *, knee: int
) -> tuple[Array, Array, Array]:
    """Return the joint angles within the limits whose foot is nearest to a point of the leg frame.

    Parameters
    ----------
    xp : namespace
        The array library.
    geometry : LegGeometry
        The legs.
    x, y, z : array, shape (..., legs)
        The target, from `to_leg_frame` [m].
    knee : int
        The knee branch, 1 up or -1 down.
    """
    g = geometry
    along = root(xp, x * x + y * y - g.side2)
    lower, upper = g.coxa_lower, g.coxa_upper
    towards = xp.atan2(y * along - x * g.side, x * along + y * g.side)
    away = xp.atan2(-y * along - x * g.side, y * g.side - x * along)
    zero = xp.zeros_like(towards)
    best: tuple[Array, ...] = ()
    for coxa in (clip_angle(xp, towards, lower, upper), clip_angle(xp, away, lower, upper), lower, upper):
        best = _better(xp, best, _nearest_in_plane(xp, g, x, y, z, coxa + zero, knee=knee))
    for _ in range(_CORRECTIONS if is_traced(g.side) or bool(xp.any(g.side != 0)) else 0):
        foot_r = g.coxa + g.femur * xp.cos(best[2]) + g.tibia * xp.cos(best[2] + best[3])
        coxa = clip_angle(xp, wrap(xp, xp.atan2(y, x) - xp.atan2(g.side + zero, foot_r)), lower, upper)
        best = _better(xp, best, _nearest_in_plane(xp, g, x, y, z, coxa, knee=knee))
    return best[1], best[2], best[3]


def _better(xp: Namespace, best: tuple[Array, ...], other: tuple[Array, ...]) -> tuple[Array, ...]:
    """Keep, leg by leg, the candidate (squared distance, angles...) whose distance is the smaller."""
    if not best:
        return other
    closer = other[0] < best[0]
    return tuple(xp.where(closer, new, old) for new, old in zip(other, best, strict=True))


def _nearest_in_plane(
    xp: Namespace, geometry: LegGeometry, x: Array, y: Array, z: Array, coxa: Array, *, knee: int
) -> tuple[Array, ...]:
    """Return squared distance and angles of the nearest point with the plane turned to `coxa`."""
    g = geometry
    cos, sin = xp.cos(coxa), xp.sin(coxa)
    r, off = x * cos + y * sin - g.coxa, y * cos - x * sin - g.side
    low, high = g.femur_lower, g.femur_upper
    bent, straight = tibia_branch(xp, g, knee=knee)
    direction = xp.atan2(z, r)
    candidates = []
    distance2 = r * r + z * z
    height = root(xp, (g.farthest2 - distance2) * (distance2 - g.nearest2))
    inside = xp.atan2(height, distance2 + g.difference2)
    candidates.append((direction + knee * inside, -knee * xp.atan2(height, distance2 - g.sum2)))
    for femur in (low, high):
        knee_r, knee_z = g.femur * xp.cos(femur), g.femur * xp.sin(femur)
        candidates.append((femur + xp.zeros_like(r), xp.atan2(z - knee_z, r - knee_r) - femur))
    for tibia in (bent, straight):
        inside = xp.atan2(g.tibia * xp.sin(tibia), g.femur + g.tibia * xp.cos(tibia))
        candidates.append((direction - inside, tibia + xp.zeros_like(r)))
    best: tuple[Array, ...] = ()
    for femur, tibia in candidates:
        q1 = clip_angle(xp, wrap(xp, femur), low, high)
        q2 = clip_angle(xp, wrap(xp, tibia), bent, straight)
        miss_r = g.femur * xp.cos(q1) + g.tibia * xp.cos(q1 + q2) - r
        miss_z = g.femur * xp.sin(q1) + g.tibia * xp.sin(q1 + q2) - z
        best = _better(xp, best, (miss_r * miss_r + miss_z * miss_z + off * off, coxa, q1, q2))
    return best
