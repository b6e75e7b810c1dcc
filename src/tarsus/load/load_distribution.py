"""How a load is shared among feet that can only push: the least sum of squares in balance.

Feet at ``(x_i, y_i)``, seen from where the load acts, push with shares ``s_i >= 0`` such that

    sum s_i = 1        sum s_i x_i = 0        sum s_i y_i = 0

and the sum of squares is least. The optimum has the form ``s_i = max(0, a + b x_i + c y_i)``: the three numbers are
those of the dual problem, a convex function that is quadratic in pieces, and Newton's method with an exact line search
finds the piece in a few steps, for all samples of a batch at once. On up to three feet it is plain statics.

The conditions stay the same in any skewed and stretched coordinates. So the feet are first brought to unit spread both
ways: feet that are all but on a line are then no worse than others, and those on a line leave one coordinate at zero.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from tarsus.arrays import Array, Namespace, is_traced, root
from tarsus.load.foot_spread import FLAT, Spread, Triple, plane

__all__ = ["shared_load"]

_MOST_STEPS = 40
_ROUNDS = 2
_STILL = 1e-14  # a share, or a relative change of one, that is but a rounding


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
    x, y = _evened(xp, x, y, down)
    dual = Spread.of(xp, x, y, down).balance(xp, *_whole(xp, x))
    bearing = down & (plane(dual, x, y) > _STILL)
    unsettled = xp.any(bearing != down, axis=0)
    if xp is np:
        # Nearly always all feet bear: only the few samples where one would have to pull go on.
        few = np.flatnonzero(unsettled)
        if len(few):
            bearing[:, few] = _search(
                np, x[:, few], y[:, few], down[:, few], (dual[0][few], dual[1][few], dual[2][few])
            )
    elif is_traced(unsettled) or bool(xp.any(unsettled)):
        bearing = _search(xp, x, y, down, dual)
    return _shares(xp, x, y, bearing)


def _evened(xp: Namespace, x: Array, y: Array, down: Array) -> tuple[Array, Array]:
    """Skew and stretch the plane so that the feet that are down spread alike both ways."""
    size = xp.max(xp.where(down, xp.maximum(xp.abs(x), xp.abs(y)), xp.zeros_like(x)), axis=0)
    size = xp.where(size > 0, size, xp.ones_like(size))
    x, y = x / size, y / size
    spread = Spread.of(xp, x, y, down)
    x, y = xp.where(spread.swap, y, x), xp.where(spread.swap, x, y)
    long, thin = root(xp, spread.along), root(xp, spread.across)
    wide, high = long > FLAT, thin > FLAT
    y = (y - spread.slope * x) / xp.where(high, thin, 1.0)
    x = x / xp.where(wide, long, 1.0)
    return xp.where(down & wide, x, 0.0), xp.where(down & high, y, 0.0)


def _whole(xp: Namespace, x: Array) -> Triple:
    zero = xp.zeros_like(x[0, ...])
    return xp.ones_like(zero), zero, zero


def _missing(xp: Namespace, x: Array, y: Array, shares: Array) -> Triple:
    return 1 - xp.sum(shares, axis=0), -xp.sum(shares * x, axis=0), -xp.sum(shares * y, axis=0)


def _shares(xp: Namespace, x: Array, y: Array, bearing: Array) -> Array:
    """Return the shares of the feet that bear, balanced again as far as rounding left them unbalanced."""
    shares = xp.zeros_like(x)
    for _ in range(2):
        # A foot that pulls after all, by a rounding, is left out the second time.
        spread = Spread.of(xp, x, y, bearing)
        shares = xp.where(bearing, shares, 0.0)
        for _ in range(_ROUNDS):
            more = plane(spread.balance(xp, *_missing(xp, x, y, shares)), x, y)
            shares = shares + xp.where(bearing, more, 0.0)
        bearing = bearing & (shares > 0)
    return xp.where(bearing, shares, 0.0)


def _search(xp: Namespace, x: Array, y: Array, down: Array, dual: Triple) -> Array:
    """Find which feet bear."""

    def step(state: tuple[Array, ...]) -> tuple[Array, ...]:
        _, before, *old, count = state
        new: Triple = (old[0], old[1], old[2])
        bearing = before
        # First to the balance of the feet that bear now; then, where they can't, to where another joins them.
        for way in (Spread.balance, Spread.free):
            shares = xp.where(bearing, plane(new, x, y), 0.0)
            new = _lowest(xp, x, y, down, new, way(Spread.of(xp, x, y, bearing), xp, *_missing(xp, x, y, shares)))
            bearing = down & (plane(new, x, y) > _STILL)
        return before, bearing, *new, count + 1

    def goes_on(state: tuple[Array, ...]) -> Any:
        return xp.any(state[0] != state[1]) & (state[-1] < _MOST_STEPS)

    if is_traced(x):
        # Which feet bear has no derivative; the shares of those that do, taken afterwards, have.
        jax = sys.modules["jax"]
        x, y, dual = jax.lax.stop_gradient((x, y, dual))
        loop: Callable[..., tuple[Array, ...]] = jax.lax.while_loop
    else:
        loop = _while
    start = down & (plane(dual, x, y) > _STILL)
    return loop(goes_on, step, (down, start, *dual, 0))[1]


def _while(goes_on: Callable[..., Any], step: Callable[..., tuple[Array, ...]], state: tuple[Array, ...]) -> Any:
    while bool(goes_on(state)):
        state = step(state)
    return state


def _lowest(xp: Namespace, x: Array, y: Array, down: Array, dual: Triple, way: Triple) -> Triple:
    """Go along a way to where the dual is least: where its slope, linear between the feet's zeros, is zero."""
    value, change, gain = plane(dual, x, y), plane(way, x, y), way[0]

    def slope(share: Array) -> Array:
        pushes = xp.maximum(value + share * change, xp.zeros_like(value))
        return xp.sum(xp.where(down, pushes * change, xp.zeros_like(value)), axis=0) - gain

    size = xp.max(xp.where(down, xp.abs(change), xp.zeros_like(change)), axis=0)
    moving = down & (xp.abs(change) > _STILL * (size + _STILL))
    change = xp.where(moving, change, xp.zeros_like(change))
    zeros = -value / xp.where(moving, change, xp.ones_like(change))
    zeros = xp.where(moving & (zeros > 0), zeros, xp.zeros_like(zeros))
    zero = xp.zeros_like(gain)
    low, high = zero, xp.full_like(gain, xp.inf)
    for foot in range(value.shape[0]):
        falls = slope(zeros[foot, ...]) <= 0
        low = xp.where(falls, xp.maximum(low, zeros[foot, ...]), low)
        high = xp.where(falls, high, xp.minimum(high, zeros[foot, ...]))
    high = xp.where(xp.isfinite(high), high, low + 1)
    at_low, at_high = slope(low), slope(high)
    rise = at_high - at_low
    share = low + (high - low) * xp.where(rise > 0, xp.maximum(-at_low, zero) / xp.where(rise > 0, rise, 1.0), 0.0)
    return dual[0] + share * way[0], dual[1] + share * way[1], dual[2] + share * way[2]
