"""How much of a wish the feet that are on the ground allow, until each of them is next lifted.

A reference governor (I. Kolmanovsky, E. Garone, S. Di Cairano, "Reference and command governors", American Control
Conference 2014): the target goes from where it is towards the wish, as far as the walk that follows from it, stays
within bounds if the target stays there for good. What worked a tick ago then works again, so that there always is
something that works.
"""

from __future__ import annotations

import cmath
from typing import Any

import numpy as np

from tarsus.gait.live.lag import travel_factors
from tarsus.gait.live.moment import Moment, turned
from tarsus.gait.live.workspace import NORMALS

__all__ = ["allowed_target", "excess"]

Floats = np.ndarray[Any, Any]

# What rounding may add to a distance [m]: no bound is broken by so little.
_TOLERANCE = 1e-9
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
    tried = np.stack([current, wish, np.zeros(3)])
    over = excess(now, tried, begins=begins, ends=ends, bounds=bounds, bandwidth=bandwidth)
    here, there, still = over.reshape(3, -1)
    if there.max() <= _TOLERANCE:
        return wish
    if here.max() <= _TOLERANCE:
        breaks = there > _TOLERANCE
        share = (np.maximum(-here[breaks], 0.0) / (there[breaks] - np.minimum(here[breaks], 0.0))).min()
        target: Floats = current + min(float(share), 1.0) * (wish - current)
        return target
    broken = here > 0
    gain = here[broken] - still[broken]
    needed = np.where(gain > 0, here[broken] / np.where(gain > 0, gain, 1.0), 1.0).max()
    slower: Floats = current * (1 - min(float(needed), 1.0))
    return slower
