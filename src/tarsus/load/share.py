"""How a load is shared among feet that can only push: the least sum of squares in balance.

Feet at ``(x_i, y_i)``, seen from where the load acts, push with shares ``s_i >= 0`` such that

    sum s_i = 1        sum s_i x_i = 0        sum s_i y_i = 0

and the sum of squares is least. The optimum has the form ``s_i = max(0, a + b x_i + c y_i)``: the three numbers are
those of the dual problem, a convex function that is quadratic in pieces, and Newton's method with a line search finds
the piece in a few steps, for all samples of a batch at once. On up to three feet it is plain statics.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from tarsus.arrays import Array, Namespace, is_traced

__all__ = ["shared_load"]

Column: TypeAlias = Array
Triple: TypeAlias = tuple[Column, Column, Column]

_MOST_STEPS = 40
# Relative to a matrix of entries of about 1: enough to solve where the feet that bear lie on a line.
_SOFTENING = 1e-14
_DAMPING = 1e-9
_POLISHES = 3


def shared_load(xp: Namespace, x: Array, y: Array, down: Array) -> Array:
    """Return each foot's share of a load.

    Parameters
    ----------
    xp : namespace
        The array library.
    x, y : array, shape (legs, batch)
        The feet, seen from where the load acts [m]. That point must be inside the polygon of the feet that are
        down, or on its edge.
    down : array of bool, shape (legs, batch)
        Which feet are down.

    Returns
    -------
    array, shape (legs, batch)
        Shares, not negative, 0 for feet that are not down.
    """
    count = xp.sum(xp.astype(down, x.dtype), axis=0)
    size = xp.sqrt(xp.max(xp.where(down, x * x + y * y, xp.zeros_like(x)), axis=0))
    scale = xp.where(size > 0, size, xp.ones_like(size))
    x, y = x / scale, y / scale
    zero = xp.zeros_like(count)
    dual: Triple = (1 / xp.where(count > 0, count, xp.ones_like(count)), zero, zero)
    dual = _corrected(xp, x, y, down, dual)
    bearing = down & (_plane(dual, x, y) > 0)
    unsettled = xp.any(bearing != down, axis=0)
    if xp is np:
        # Nearly always all feet bear: only the few samples where one would have to pull go on.
        few = np.flatnonzero(unsettled)
        found = _search(np, x[:, few], y[:, few], down[:, few], bearing[:, few], tuple(v[few] for v in dual))
        bearing[:, few], dual = found[0], tuple(_put(v, few, new) for v, new in zip(dual, found[1], strict=True))
    elif is_traced(unsettled) or bool(xp.any(unsettled)):
        bearing, dual = _search(xp, x, y, down, bearing, dual)
    for _ in range(_POLISHES):
        dual = _corrected(xp, x, y, bearing, dual)
    shares = xp.where(bearing, _plane(dual, x, y), xp.zeros_like(x))
    return xp.maximum(shares, xp.zeros_like(shares))


def _put(values: Array, where: Array, new: Array) -> Array:
    values = values.copy()
    values[where] = new
    return values


def _search(xp: Namespace, x: Array, y: Array, down: Array, bearing: Array, dual: Triple) -> tuple[Array, Triple]:
    """Find which feet bear, and the dual's solution for them."""
    for _ in range(_MOST_STEPS):
        dual = _newton(xp, x, y, down, bearing, dual)
        now = down & (_plane(dual, x, y) > 0)
        same = xp.all(now == bearing)
        bearing = now
        if not is_traced(same) and bool(same):
            break
    return bearing, dual


def _plane(dual: Triple, x: Array, y: Array) -> Array:
    return dual[0] + dual[1] * x + dual[2] * y


def _corrected(
    xp: Namespace, x: Array, y: Array, bearing: Array, dual: Triple, *, softening: float = _SOFTENING
) -> Triple:
    """Solve for the balance of the feet that bear, from what is still missing."""
    weights = xp.astype(bearing, x.dtype)
    wx, wy = weights * x, weights * y
    entries = [xp.sum(v, axis=0) for v in (weights, wx, wy, wx * x, wx * y, wy * y)]
    shares = weights * _plane(dual, x, y)
    missing = (1 - xp.sum(shares, axis=0), -xp.sum(shares * x, axis=0), -xp.sum(shares * y, axis=0))
    change = _solve(entries, missing, softening)
    return dual[0] + change[0], dual[1] + change[1], dual[2] + change[2]


def _solve(entries: list[Array], right: Triple, softening: float) -> Triple:
    """Solve symmetric 3 x 3 systems by their adjugates; slightly softened, so that singular ones have a solution."""
    a, b, c, d, e, f = entries
    soft = softening * (a + d + f) + 1e-300
    a, d, f = a + soft, d + soft, f + soft
    aa, bb, cc = d * f - e * e, c * e - b * f, b * e - c * d
    dd, ee, ff = a * f - c * c, b * c - a * e, a * d - b * b
    determinant = a * aa + b * bb + c * cc
    p, q, r = right
    return (
        (aa * p + bb * q + cc * r) / determinant,
        (bb * p + dd * q + ee * r) / determinant,
        (cc * p + ee * q + ff * r) / determinant,
    )


def _newton(xp: Namespace, x: Array, y: Array, down: Array, bearing: Array, dual: Triple) -> Triple:
    """Go towards the solution for the feet that bear now, as far as the dual falls."""
    goal = _corrected(xp, x, y, bearing, dual, softening=_DAMPING)
    way = (goal[0] - dual[0], goal[1] - dual[1], goal[2] - dual[2])
    share = _lowest_point(xp, _plane(dual, x, y), _plane(way, x, y), way[0], down)
    return dual[0] + share * way[0], dual[1] + share * way[1], dual[2] + share * way[2]


def _lowest_point(xp: Namespace, value: Array, change: Array, gain: Array, down: Array) -> Array:
    """Return where along the way the dual is least: where its slope, linear between the feet's zeros, is zero."""

    def slope(share: Array) -> Array:
        pushes = xp.maximum(value + share * change, xp.zeros_like(value))
        return xp.sum(xp.where(down, pushes * change, xp.zeros_like(value)), axis=0) - gain

    moving = down & (change != 0)
    zeros = -value / xp.where(moving, change, xp.ones_like(change))
    zeros = xp.where(moving & (zeros > 0), zeros, xp.zeros_like(zeros))
    low, high = xp.zeros_like(gain), xp.full_like(gain, xp.inf)
    for foot in range(value.shape[0]):
        falls = slope(zeros[foot, ...]) <= 0
        low = xp.where(falls, xp.maximum(low, zeros[foot, ...]), low)
        high = xp.where(falls, high, xp.minimum(high, zeros[foot, ...]))
    high = xp.where(xp.isfinite(high), high, low + 1)
    at_low, at_high = slope(low), slope(high)
    rise = at_high - at_low
    return low + (high - low) * xp.where(rise > 0, -at_low / xp.where(rise > 0, rise, xp.ones_like(rise)), 0.0)
