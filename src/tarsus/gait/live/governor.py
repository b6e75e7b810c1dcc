"""How much of a wish the feet that are on the ground allow, until each of them is next lifted.

A reference governor (I. Kolmanovsky, E. Garone, S. Di Cairano, "Reference and command governors", American Control
Conference 2014): the target goes from where it is towards the wish, as far as the walk that follows from it, stays
within bounds if the target stays there for good. What worked a tick ago then works again, so that there always is
something that works.
"""

from __future__ import annotations

import cmath
import functools
from collections.abc import Callable
from typing import Any

import numpy as np

from tarsus.gait.live.lag import travel_factors
from tarsus.gait.live.moment import Moment, turned
from tarsus.gait.live.workspace import NORMALS

__all__ = ["allowed_target", "excess"]

Floats = np.ndarray[Any, Any]

# What rounding may add to a distance [m]: no bound is broken by so little.
_TOLERANCE = 1e-9
# How many targets are tried at the most; how near to one that fails is near enough, over the target's size; and what
# is no step [m/s], [rad/s].
_TRIES, _NEAR, _NO_STEP = 4, 0.02, 1e-12
_SHARES = np.array([0.0, 0.5, 1.0])[:, None]


def excess(now: Moment, targets: Floats, *, begins: Floats, ends: Floats, bounds: Floats, bandwidth: float) -> Floats:
    """Return how far each foot will be beyond each side of its polygon, were the target so from now on.

    Parameters
    ----------
    now : Moment
        The moment.
    targets : array, shape (n, 3)
        Twists to follow.
    begins, ends : array, shape (..., legs)
        From when until when the foot stays where it is, or is about to be put down [s].
    bounds : array, shape (legs, 16)
        Sides of the polygons [m].
    bandwidth : float
        How fast the twist follows its target [rad/s].

    Returns
    -------
    array, shape (..., n, 3, legs, 16)
        At the beginning, in the middle and at the end of that time [m]; negative within bounds.
    """
    times = begins[..., None, :] + (ends - begins)[..., None, :] * _SHARES
    of_target, of_value, of_rate = travel_factors(times[..., None, :, :], bandwidth=bandwidth)
    v, a = now.twist
    x, y, angle = (targets[:, i, None, None] * of_target + (v[i] * of_value + a[i] * of_rate) for i in range(3))
    seen = (now.target - now.origin) * cmath.exp(-1j * now.yaw)
    place = (seen - (x + 1j * y) * turned(angle)) * np.exp(-1j * angle)
    out: Floats = (place[..., None] * NORMALS.conj()).real - bounds
    return out


def allowed_target(
    now: Moment,
    current: Floats,
    wish: Floats,
    *,
    begins: Floats,
    ends: Floats,
    bounds: Floats,
    bandwidth: float,
) -> Floats:
    """Return the target on the way from the current one to the wish that is as near to the wish as works.

    Parameters
    ----------
    now : Moment
        The moment.
    current, wish : array, shape (3,)
        The twist that is followed, and the one that should be.
    begins, ends, bounds, bandwidth
        As for `excess`.

    Returns
    -------
    array, shape (3,)
        The target. Where not even the current one works, as much less of it as does.
    """
    bounded = functools.partial(excess, now, begins=begins, ends=ends, bounds=bounds, bandwidth=bandwidth)
    nothing = np.zeros(3)
    here, there, still = bounded(np.stack([current, wish, nothing])).reshape(3, -1)
    if there.max() <= _TOLERANCE:
        return wish
    if here.max() <= _TOLERANCE:
        return _as_far_as_works(bounded, (current, here), (wish, there))
    if still.max() <= _TOLERANCE:
        return _as_far_as_works(bounded, (nothing, still), (current, here))
    # Nothing keeps every foot within bounds: what takes it least beyond.
    if here.max() <= still.max():
        return current
    broken = here > 0
    gain = here[broken] - still[broken]
    needed = np.where(gain > 0, here[broken] / np.where(gain > 0, gain, 1.0), 1.0).max()
    slower: Floats = current * (1 - min(float(needed), 1.0))
    return slower


def _as_far_as_works(
    bounded: Callable[[Floats], Floats], works: tuple[Floats, Floats], fails: tuple[Floats, Floats]
) -> Floats:
    """Return the farthest target that works, from one that does to one that doesn't, each with its excess.

    Where nothing turns, the excess is linear in the target, and the first that is tried is the farthest that works.
    """
    for _ in range(_TRIES):
        (start, room), (end, over) = works, fails
        breaks = over > _TOLERANCE
        inside = np.maximum(-room[breaks], 0.0)
        share = float((inside / (over[breaks] + inside)).min())
        if share * np.abs(end - start).max() <= _NO_STEP:
            break
        target = start + share * (end - start)
        found = bounded(target[None]).reshape(-1)
        if found.max() > _TOLERANCE:
            # Half the room is reckoned with from now on, or turning takes it out of bounds again (the Illinois method).
            works, fails = (start, room / 2), (target, found)
        elif (1 - share) * np.abs(end - start).max() <= _NEAR * np.abs(target).max():
            return target
        else:
            works = target, found
    return works[0]
