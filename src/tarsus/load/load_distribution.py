"""Distribution of a load among feet that can only push: equilibrium with the least sum of squares.

Feet at ``(x_i, y_i)``, relative to the point where the load acts, carry fractions ``s_i >= 0`` of the load such that

    sum s_i = 1        sum s_i x_i = 0        sum s_i y_i = 0

with the least sum of squares. The optimum has the form ``s_i = max(0, a + b x_i + c y_i)``, where a, b and c are the
dual variables. The dual function is convex and piecewise quadratic; Newton's method with an exact line search finds the
piece in a few iterations, for all samples of a batch together. On up to three feet the problem is statically
determinate.

The constraints are invariant under affine maps of the plane. The feet are therefore scaled to unit second moments in
both directions, which conditions nearly collinear feet well; collinear feet have one coordinate at zero.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.arrays import Array, Namespace, is_traced, root
from tarsus.kinematics.convex_hull import origin_margin
from tarsus.kinematics.planar_moments import PlanarMoments
from tarsus.load.foot_spread import FLAT, Spread, Triple, evaluate_plane

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["load_fractions", "single_pose_fractions"]

_MAX_ITERATIONS = 40
_REFINEMENTS = 2
_ROUNDING = 1e-14  # of a fraction, or of a relative change of one
_LEAST_FRACTION = 1e-6  # on a foot that certainly bears
_LEAST_SPREAD = 1e-4  # relative determinant above which the normal equations are accurate to 12 digits


def load_fractions(
    xp: Namespace, x: Float[Array, "legs batch"], y: Float[Array, "legs batch"], down: Bool[Array, "legs batch"]
) -> Float[Array, "legs batch"]:
    """Return the fraction of a load on each foot.

    Parameters
    ----------
    xp : namespace
        The array library.
    x, y : array, shape (legs, batch)
        Feet relative to the point where the load acts [m]. That point must be inside the support polygon or on its
        edge.
    down : array of bool, shape (legs, batch)
        Which feet are on the ground.

    Returns
    -------
    array, shape (legs, batch)
        Fractions, at least 0; 0 for feet off the ground.
    """
    x, y = _normalised(xp, x, y, down)
    dual = Spread.of(xp, x, y, down).balance(xp, *_unit_load(xp, x))
    bearing = down & (evaluate_plane(dual, x, y) > _ROUNDING)
    unsettled = xp.any(bearing != down, axis=0)
    if xp is np:
        # Usually all feet bear; only the samples in which one would have to pull need the iteration.
        few = np.flatnonzero(unsettled)
        if len(few):
            bearing[:, few] = _find_bearing(
                np, x[:, few], y[:, few], down[:, few], (dual[0][few], dual[1][few], dual[2][few])
            )
    elif is_traced(unsettled) or bool(xp.any(unsettled)):
        bearing = _find_bearing(xp, x, y, down, dual)
    return _fractions_of(xp, x, y, bearing)


def single_pose_fractions(
    feet: Sequence[tuple[float, float]], contacts: Sequence[bool]
) -> tuple[list[float], float] | None:
    """Return the fraction of a load on each foot and its margin for a single pose, computed in plain floats.

    Parameters
    ----------
    feet : sequence of (x, y)
        Feet relative to the point where the load acts [m].
    contacts : sequence of bool
        Which feet are on the ground.

    Returns
    -------
    (list of float, float) or None
        Fractions, 0 for feet off the ground, and the distance of the load from the nearest edge of the support polygon
        [m]. None unless the feet span an area and all of them certainly bear: use `load_fractions` then.
    """
    down = [foot for foot, touches in zip(feet, contacts, strict=True) if touches]
    count = len(down)
    mean_x, mean_y = sum(x for x, _ in down) / count, sum(y for _, y in down) / count
    arms = [(x - mean_x, y - mean_y) for x, y in down]
    moments = PlanarMoments(sum(u * u for u, _ in arms), sum(u * v for u, v in arms), sum(v * v for _, v in arms))
    if not moments.span_area(_LEAST_SPREAD):
        return None
    a, b = moments.slopes(-mean_x, -mean_y, determinant=moments.determinant)
    bearing = [1 / count + a * u + b * v for u, v in arms]
    if min(bearing) < _LEAST_FRACTION:
        return None
    fractions = iter(bearing)
    return [next(fractions) if touches else 0.0 for touches in contacts], origin_margin(down)[0]


def _normalised(
    xp: Namespace, x: Float[Array, "legs batch"], y: Float[Array, "legs batch"], down: Bool[Array, "legs batch"]
) -> tuple[Float[Array, "... legs batch"], Float[Array, "... legs batch"]]:
    """Map the plane affinely so that the feet on the ground have unit second moments in both directions."""
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


def _unit_load(xp: Namespace, x: Float[Array, "legs batch"]) -> Triple:
    zero = xp.zeros_like(x[0, ...])
    return xp.ones_like(zero), zero, zero


def _residual(
    xp: Namespace,
    x: Float[Array, "legs batch"],
    y: Float[Array, "legs batch"],
    fractions: Float[Array, "... legs batch"],
) -> Triple:
    return 1 - xp.sum(fractions, axis=0), -xp.sum(fractions * x, axis=0), -xp.sum(fractions * y, axis=0)


def _fractions_of(
    xp: Namespace, x: Float[Array, "legs batch"], y: Float[Array, "legs batch"], bearing: Bool[Array, "... legs batch"]
) -> Float[Array, "... legs batch"]:
    """Return the fractions of the bearing feet, refined to remove the residual left by rounding."""
    fractions = xp.zeros_like(x)
    for _ in range(2):
        # A foot whose fraction is negative by rounding is left out in the second pass.
        spread = Spread.of(xp, x, y, bearing)
        fractions = xp.where(bearing, fractions, 0.0)
        for _ in range(_REFINEMENTS):
            correction = evaluate_plane(spread.balance(xp, *_residual(xp, x, y, fractions)), x, y)
            fractions = fractions + xp.where(bearing, correction, 0.0)
        bearing = bearing & (fractions > 0)
    return xp.where(bearing, fractions, 0.0)


def _find_bearing(
    xp: Namespace,
    x: Float[Array, "legs batch"],
    y: Float[Array, "legs batch"],
    down: Bool[Array, "legs batch"],
    dual: Triple,
) -> Bool[Array, "... legs batch"]:
    """Find the feet that bear load, by Newton's method on the dual."""

    def step(state: tuple[Array, ...]) -> tuple[Array, ...]:
        _, before, *old, count = state
        new: Triple = (old[0], old[1], old[2])
        bearing = before
        # First towards the equilibrium of the bearing feet; where they have none, towards another foot.
        for direction in (Spread.balance, Spread.free):
            fractions = xp.where(bearing, evaluate_plane(new, x, y), 0.0)
            new = _line_search(
                xp, x, y, down, new, direction(Spread.of(xp, x, y, bearing), xp, *_residual(xp, x, y, fractions))
            )
            bearing = down & (evaluate_plane(new, x, y) > _ROUNDING)
        return before, bearing, *new, count + 1

    def unfinished(state: tuple[Array, ...]) -> Any:
        return xp.any(state[0] != state[1]) & (state[-1] < _MAX_ITERATIONS)

    if is_traced(x):
        # The set of bearing feet has no derivative; the fractions computed from it do.
        jax = sys.modules["jax"]
        x, y, dual = jax.lax.stop_gradient((x, y, dual))
        loop: Callable[..., tuple[Array, ...]] = jax.lax.while_loop
    else:
        loop = _while
    start = down & (evaluate_plane(dual, x, y) > _ROUNDING)
    return loop(unfinished, step, (down, start, *dual, 0))[1]


def _while(unfinished: Callable[..., Any], step: Callable[..., tuple[Array, ...]], state: tuple[Any, ...]) -> Any:
    while bool(unfinished(state)):
        state = step(state)
    return state


def _line_search(
    xp: Namespace,
    x: Float[Array, "legs batch"],
    y: Float[Array, "legs batch"],
    down: Bool[Array, "legs batch"],
    dual: Triple,
    direction: Triple,
) -> Triple:
    """Minimise the dual along a direction: its slope is linear between the zeros of the feet's fractions."""
    value, change, gain = evaluate_plane(dual, x, y), evaluate_plane(direction, x, y), direction[0]

    def slope(step_length: Array) -> Array:
        pushed = xp.maximum(value + step_length * change, xp.zeros_like(value))
        return xp.sum(xp.where(down, pushed * change, xp.zeros_like(value)), axis=0) - gain

    size = xp.max(xp.where(down, xp.abs(change), xp.zeros_like(change)), axis=0)
    moving = down & (xp.abs(change) > _ROUNDING * (size + _ROUNDING))
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
    step_length = low + (high - low) * xp.where(
        rise > 0, xp.maximum(-at_low, zero) / xp.where(rise > 0, rise, 1.0), 0.0
    )
    return (
        dual[0] + step_length * direction[0],
        dual[1] + step_length * direction[1],
        dual[2] + step_length * direction[2],
    )
