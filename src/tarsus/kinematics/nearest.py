"""Nearest point that a leg reaches within its joint limits.

In the leg's plane the reachable points are the image of a rectangle of femur and tibia angles. Its boundary consists of
arcs of five kinds: femur at either limit, tibia at either limit, and the straight or folded leg (also limits, as the
tibia stays in one knee branch). The nearest point of an arc is its intersection with the ray from its centre, or its
nearer end. The nearest reachable point is therefore exactly the best of a few candidates.

The plane faces the target, faces away from it, or is at a coxa limit: exactly so without a sideways offset of the femur
axis. With an offset, the best coxa angle depends on the radius of the foot and vice versa; both are corrected
alternately, from several initial values.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from tarsus.arrays import Array, Namespace, improve, root
from tarsus.kinematics.triangle import direction
from tarsus.robot.geometry import LegGeometry

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["clip_angle", "nearest_angles", "tibia_bend", "tibia_branch"]

_TURN = 2 * math.pi
# Step sizes, in multiples of the computed correction of the coxa angle: corrections converge slowly where the target is
# near the coxa axis. A step that increases the distance to the target is rejected.
_STEP_SIZES = (1.0, 2.0, 6.0)
# Most rounds of these steps; a leg is final once a round reduces the squared distance by no more than this [m^2].
_ROUNDS = 8
_CONVERGED = 1e-15


def wrap(xp: Namespace, angle: Float[Array, "..."]) -> Float[Array, "..."]:
    """Return the equivalent angle in -pi..pi."""
    return angle - _TURN * xp.round(angle / _TURN)


def clip_angle(
    xp: Namespace, angle: Float[Array, "..."], lower: Float[Array, "..."], upper: Float[Array, "..."]
) -> Float[Array, "..."]:
    """Return the angle if it is within its limits, else the limit nearer on the circle."""
    below, above = xp.abs(wrap(xp, lower - angle)), xp.abs(wrap(xp, angle - upper))
    nearer = xp.where(below < above, lower, upper)
    return xp.where((angle >= lower) & (angle <= upper), angle, nearer)


def tibia_branch(xp: Namespace, geometry: LegGeometry, *, knee: int) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    """Return the tibia limits restricted to a knee branch; unrestricted where no angle is in that branch."""
    lower, upper = geometry.tibia_lower, geometry.tibia_upper
    zero = xp.zeros_like(lower)
    if knee > 0:
        return lower, xp.where(lower <= zero, xp.minimum(upper, zero), upper)
    return xp.where(upper >= zero, xp.maximum(lower, zero), lower), upper


def tibia_bend(xp: Namespace, geometry: LegGeometry, *, knee: int) -> Float[Array, "..."]:
    """Return the sign of the tibia angles in a knee branch; the opposite sign where the limits exclude that branch."""
    one = xp.ones_like(geometry.tibia_lower)
    if knee > 0:
        return xp.where(geometry.tibia_lower > 0, one, -one)
    return xp.where(geometry.tibia_upper < 0, -one, one)


def nearest_angles(
    xp: Namespace,
    geometry: LegGeometry,
    x: Float[Array, "*#batch legs"],
    y: Float[Array, "*#batch legs"],
    z: Float[Array, "*#batch legs"],
    *,
    knee: int,
    sideways: bool,
) -> tuple[Float[Array, "... legs"], ...]:
    """Return the squared distance from a target to the nearest reachable point [m^2], and its joint angles [rad].

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
    sideways : bool
        Whether any femur axis is offset sideways.
    """
    g = geometry
    along = root(xp, x * x + y * y - g.side2)
    lower, upper = g.coxa_lower, g.coxa_upper
    towards = direction(xp, y * along - x * g.side, x * along + y * g.side)
    away = direction(xp, -y * along - x * g.side, y * g.side - x * along)
    if not sideways:
        return _best(xp, _in_planes(xp, g, x, y, z, clip_angle(xp, xp.stack((towards, away)), lower, upper), knee=knee))
    zero = xp.zeros_like(x)
    bearing = direction(xp, y, x)
    turns = xp.stack((towards, away, lower + zero, upper + zero, bearing, wrap(xp, bearing + math.pi)))
    found = _in_planes(xp, g, x, y, z, clip_angle(xp, turns, lower, upper), knee=knee)
    first = _best(xp, found)
    tracks = tuple(xp.stack((a, b[4, ...], b[5, ...])) for a, b in zip(first, found, strict=True))

    def correct(tracks: tuple[Array, ...]) -> tuple[Array, ...]:
        for step_size in _STEP_SIZES:
            foot_r = g.coxa + g.femur * xp.cos(tracks[2]) + g.tibia * xp.cos(tracks[2] + tracks[3])
            better = bearing - direction(xp, g.side + xp.zeros_like(foot_r), foot_r)
            turns = wrap(xp, tracks[1] + step_size * wrap(xp, better - tracks[1]))
            found = _in_planes(xp, g, x, y, z, clip_angle(xp, turns, lower, upper), knee=knee)
            tracks = _better(xp, tracks, found)
        return tracks

    return _best(xp, improve(correct, tracks, times=_ROUNDS, enough=_CONVERGED))


def _best(xp: Namespace, candidates: tuple[Float[Array, "..."], ...]) -> tuple[Float[Array, "..."], ...]:
    """Return for each leg the best of the candidates stacked along the first axis."""
    first = xp.argmin(candidates[0], axis=0, keepdims=True)
    return tuple(xp.take_along_axis(values, first, axis=0)[0, ...] for values in candidates)


def _better(
    xp: Namespace, best: tuple[Float[Array, "..."], ...], other: tuple[Float[Array, "..."], ...]
) -> tuple[Float[Array, "..."], ...]:
    """Return for each leg the candidate (squared distance, angles...) with the smaller distance."""
    closer = other[0] < best[0]
    return tuple(xp.where(closer, new, old) for new, old in zip(other, best, strict=True))


def _in_planes(
    xp: Namespace,
    geometry: LegGeometry,
    x: Float[Array, "*#batch legs"],
    y: Float[Array, "*#batch legs"],
    z: Float[Array, "*#batch legs"],
    coxa: Float[Array, "*#batch legs"],
    *,
    knee: int,
) -> tuple[Float[Array, "... legs"], ...]:
    """Return squared distance and angles of the nearest points for each of the coxa angles ``(k, ...)``."""
    g = geometry
    cos, sin = xp.cos(coxa), xp.sin(coxa)
    r, off = x * cos + y * sin - g.coxa, y * cos - x * sin - g.side
    bent, straight = tibia_branch(xp, g, knee=knee)
    q1, q2 = _candidates(xp, g, r, z + xp.zeros_like(r), bent, straight, tibia_bend(xp, g, knee=knee))
    q1 = clip_angle(xp, wrap(xp, q1), g.femur_lower, g.femur_upper)
    q2 = clip_angle(xp, wrap(xp, q2), bent, straight)
    miss_r = g.femur * xp.cos(q1) + g.tibia * xp.cos(q1 + q2) - r
    miss_z = g.femur * xp.sin(q1) + g.tibia * xp.sin(q1 + q2) - z
    miss2 = miss_r * miss_r + miss_z * miss_z + off * off
    return _best(xp, (miss2, xp.broadcast_to(coxa, miss2.shape), q1, q2))


def _candidates(
    xp: Namespace,
    geometry: LegGeometry,
    r: Float[Array, "..."],
    z: Float[Array, "*#batch legs"],
    bent: Float[Array, "... legs"],
    straight: Float[Array, "... legs"],
    bend: Float[Array, "... legs"],
) -> tuple[Float[Array, "... legs"], Float[Array, "... legs"]]:
    """Return the femur and tibia angles of the five candidates ``(5, ...)``, before the limits are applied."""
    g = geometry
    zero = xp.zeros_like(r)
    distance2 = r * r + z * z
    height = bend * root(xp, (g.farthest2 - distance2) * (distance2 - g.nearest2))
    slope = direction(xp, z, r)
    femurs = [slope - direction(xp, height, distance2 + g.difference2)]
    tibias = [direction(xp, height, distance2 - g.sum2)]
    for femur in (g.femur_lower, g.femur_upper):
        femurs.append(femur + zero)
        tibias.append(direction(xp, z - g.femur * xp.sin(femur), r - g.femur * xp.cos(femur)) - femur)
    for tibia in (bent, straight):
        femurs.append(slope - direction(xp, g.tibia * xp.sin(tibia), g.femur + g.tibia * xp.cos(tibia)))
        tibias.append(tibia + zero)
    return xp.stack(femurs), xp.stack(tibias)
