"""Quasi-static rolling of a rigid body of points on flat ground until it rests.

The height of the centre of mass c above the ground is ``H(up) = max_i up . (c - p_i)`` over the points p_i, for the
direction `up` in the body. A body that rolls slowly follows the steepest descent of H on the sphere of directions, in
arcs of great circles: it turns about the point of the contact polygon nearest to the projected centre of mass until the
next point touches the ground. The descent is followed exactly, from contact to contact.

The axis of points precedes the batch, ``(points, batch)``, so that reductions run along contiguous memory.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from tarsus.arrays import Array, Namespace, root
from tarsus.kinematics.pairs import Pairs

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Int

__all__ = ["TOUCH", "Settled", "rotation_rows", "settle"]

TOUCH = 1e-9
"""Height below which a point is in contact [m]; the rounding of a dozen rolls is 1e-14."""

_ALONG = 1e-9  # x of an edge's normal below which the edge counts as parallel to x
_LEVEL = 1e-12  # cosine of the pitch below which roll and yaw are not separable

Vector = tuple[Array, Array, Array]


class Settled(NamedTuple):
    """How bodies rest.

    Attributes
    ----------
    up : three arrays, shape (batch,)
        The ground's z axis in the body.
    height : array, shape (batch,)
        Height of the body's origin above the ground [m].
    down : array of bool, shape (points, batch)
        Points in contact.
    margin : array, shape (batch,)
        Margin of the centre of mass in the hull of these points [m].
    stable : array of bool, shape (batch,)
        Whether the body rests.
    rolls : array of int, shape (batch,)
        Number of rolls.
    """

    up: Vector
    height: Float[Array, "batch"]
    down: Bool[Array, "points batch"]
    margin: Float[Array, "batch"]
    stable: Bool[Array, "batch"]
    rolls: Int[Array, "batch"]


class _Stance(NamedTuple):
    """Positions of the points relative to the ground, with the projected centre of mass as the origin."""

    rows: tuple[Vector, Vector, Vector]
    x: Float[Array, "*#batch legs"]
    y: Float[Array, "*#batch legs"]
    height: Float[Array, "..."]
    lowest: Float[Array, "... legs"]
    down: Bool[Array, "points batch"]


class _Balance(NamedTuple):
    """Margin of the centre of mass over the contacts; if not stable, pivot and direction of the roll."""

    margin: Float[Array, "batch"]
    stable: Bool[Array, "batch"]
    pivot_x: Float[Array, "... batch"]
    pivot_y: Float[Array, "... batch"]
    toward_x: Float[Array, "... batch"]
    toward_y: Float[Array, "... batch"]


def settle(xp: Namespace, points: Vector, com: Vector, *, max_rolls: int) -> Settled:
    """Lower bodies upright and let them roll until they rest.

    Parameters
    ----------
    xp : namespace
        The array library.
    points : three arrays, shape (points, batch)
        Coordinates of the points in the body [m].
    com : three arrays, shape (batch,)
        Coordinates of the centre of mass in the body [m].
    max_rolls : int
        Most rolls.

    Returns
    -------
    Settled
        State at rest, or after the last roll.
    """
    touch = max(TOUCH, 64 * float(xp.finfo(com[0].dtype).eps))
    up = (xp.zeros_like(com[0]), xp.zeros_like(com[0]), xp.ones_like(com[0]))
    rolls = xp.zeros(com[0].shape, dtype=xp.int32)
    stance = _stance(xp, up, points, com, touch)
    balance = _balance(xp, stance, touch)
    for _ in range(max_rolls):
        if bool(xp.all(balance.stable)):
            break
        rolled, moves = _roll(xp, stance, balance)
        up = (
            xp.where(moves, rolled[0], up[0]),
            xp.where(moves, rolled[1], up[1]),
            xp.where(moves, rolled[2], up[2]),
        )
        rolls = rolls + xp.astype(moves, rolls.dtype)
        stance = _stance(xp, up, points, com, touch)
        balance = _balance(xp, stance, touch)
    margin = xp.where(balance.stable, xp.clip(balance.margin, 0.0, None), balance.margin)
    return Settled(up, -stance.lowest, stance.down, margin, balance.stable, rolls)


def rotation_rows(xp: Namespace, up: Vector) -> tuple[Vector, Vector, Vector]:
    """Return the rows of the rotation of yaw 0 that turns `up` to z; at a pitch of +-90 deg, that of roll 0."""
    cos_pitch = xp.sqrt(up[1] * up[1] + up[2] * up[2])
    level = cos_pitch > _LEVEL
    divisor = xp.where(level, cos_pitch, 1.0)
    sin_roll, cos_roll = xp.where(level, up[1] / divisor, 0.0), xp.where(level, up[2] / divisor, 1.0)
    return (
        (cos_pitch, 0.0 - up[0] * sin_roll, 0.0 - up[0] * cos_roll),
        (xp.zeros_like(cos_pitch), cos_roll, 0.0 - sin_roll),
        (up[0], cos_pitch * sin_roll, cos_pitch * cos_roll),
    )


def _along(row: Vector, vector: Vector) -> Float[Array, "..."]:
    return row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2]


def _stance(xp: Namespace, up: Vector, points: Vector, com: Vector, touch: float) -> _Stance:
    rows = rotation_rows(xp, up)
    z = _along(rows[2], points)
    lowest = xp.min(z, axis=0)
    height = z - lowest
    x, y = (_along(row, points) - _along(row, com) for row in rows[:2])
    return _Stance(rows, x, y, height, lowest, height < touch)


def _balance(xp: Namespace, stance: _Stance, touch: float) -> _Balance:
    pairs = _contact_pairs(xp, stance)
    depth, width = pairs.depth_and_width(xp)
    near_x, near_y, fraction = pairs.nearest(xp)
    nearest = xp.argmin(near_x * near_x + near_y * near_y, axis=0)
    near_x, near_y, fraction, length = (_pick(xp, v, nearest) for v in (near_x, near_y, fraction, pairs.length))
    gap = root(xp, near_x * near_x + near_y * near_y)
    margin = xp.where(depth > 0, depth, -gap)

    across = pairs.normals(xp)
    # The normal of the edge is exact; the direction of a tiny offset is dominated by rounding.
    edge_x, edge_y = (_pick(xp, v, nearest) for v in across)
    side = xp.where(edge_x * near_x + edge_y * near_y > 0, -1.0, xp.ones_like(near_x))
    on_edge = (fraction > 0) & (fraction < 1) & (length > 0)
    distance = xp.where(gap > 0, gap, 1.0)
    toward_x = xp.where(on_edge, side * edge_x, -near_x / distance)
    toward_y = xp.where(on_edge, side * edge_y, -near_y / distance)

    balanced = gap <= touch
    if bool(xp.any(balanced)):
        fall_x, fall_y = _fall(xp, pairs, across, touch)
        toward_x, toward_y = xp.where(balanced, fall_x, toward_x), xp.where(balanced, fall_y, toward_y)
    return _Balance(margin, (margin >= -touch) & (width > touch), near_x, near_y, toward_x, toward_y)


def _fall(
    xp: Namespace, pairs: Pairs, across: tuple[Float[Array, "..."], Float[Array, "..."]], touch: float
) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    """Return the direction in which a body balanced on a point or an edge tips: forward, or left if parallel to x."""
    longest = xp.argmax(pairs.length, axis=0)
    x, y, length = (_pick(xp, v, longest) for v in (*across, pairs.length))
    sign = xp.where(xp.where(xp.abs(x) > _ALONG, x, y) < 0, -1.0, xp.ones_like(x))
    point = length <= touch
    return xp.where(point, 1.0, sign * x), xp.where(point, 0.0, sign * y)


def _contact_pairs(xp: Namespace, stance: _Stance) -> Pairs:
    """Return the segments of the contact points, padded with the lowest point where a body has fewer than others."""
    counts = xp.sum(xp.astype(stance.down, xp.int32), axis=0)
    most = int(xp.max(counts)) if counts.shape[0] else 1
    order = xp.argsort(stance.height, axis=0)[:most, ...]
    down = xp.take_along_axis(stance.down, order, axis=0)
    x, y = (xp.take_along_axis(values, order, axis=0) for values in (stance.x, stance.y))
    return Pairs.of(xp, xp.where(down, x, x[:1, ...]), xp.where(down, y, y[:1, ...]))


def _pick(xp: Namespace, values: Float[Array, "..."], which: Int[Array, "..."]) -> Float[Array, "..."]:
    # For a single body, in a tenth of the time.
    if which.shape == (1,):
        return values[int(which[0]), ...]
    return xp.take_along_axis(values, which[None, ...], axis=0)[0, ...]


def _roll(xp: Namespace, stance: _Stance, balance: _Balance) -> tuple[Vector, Bool[Array, "..."]]:
    """Roll until the next point touches the ground: return `up` afterwards, and which bodies rolled.

    A point at height h, at distance u ahead of the pivot, touches after the angle ``atan2(h, u)``: the first to do so
    has the greatest cotangent ``u / h``.
    """
    ahead = balance.toward_x * (stance.x - balance.pivot_x) + balance.toward_y * (stance.y - balance.pivot_y)
    cotangents = xp.where(stance.down, -xp.inf, ahead / xp.where(stance.down, 1.0, stance.height))
    cotangent = xp.max(cotangents, axis=0)
    moves = ~balance.stable & xp.isfinite(cotangent)
    cotangent = xp.where(moves, cotangent, 0.0)
    scale = 1 / xp.sqrt(1 + cotangent * cotangent)
    weights = (-balance.toward_x * scale, -balance.toward_y * scale, cotangent * scale)
    up = tuple(_along(weights, column) for column in zip(*stance.rows, strict=True))
    length = xp.sqrt(_along(up, up))
    return (up[0] / length, up[1] / length, up[2] / length), moves
