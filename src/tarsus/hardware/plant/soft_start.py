"""Motions of the soft start: slowly from where the servos are, and leg by leg where that is unknown."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["glide", "glide_duration", "release_order"]

# Peak over mean speed of a minimum-jerk motion: 15/8.
_PEAK = 1.875


def glide_duration(start: Float[np.ndarray, "legs 3"], end: Float[np.ndarray, "legs 3"], speed: float) -> float:
    """Return how long a slow motion takes, whose fastest joint just reaches a speed [s].

    Parameters
    ----------
    start, end : array, shape (legs, 3)
        Joint angles [rad].
    speed : float
        Greatest joint speed [rad/s].
    """
    return _PEAK * float(np.abs(end - start).max()) / speed


def glide(
    start: Float[np.ndarray, "legs 3"], end: Float[np.ndarray, "legs 3"], *, speed: float, dt: float
) -> Iterator[Float[np.ndarray, "legs 3"]]:
    """Yield joint angles from one pose to another, tick by tick, with minimum jerk.

    Parameters
    ----------
    start, end : array, shape (legs, 3)
        Joint angles [rad].
    speed : float
        Greatest joint speed [rad/s].
    dt : float
        Duration of a tick [s].
    """
    ticks = max(1, math.ceil(glide_duration(start, end, speed) / dt))
    for tick in range(1, ticks + 1):
        t = tick / ticks
        yield start + (end - start) * (t**3 * (10 - 15 * t + 6 * t * t))


def release_order(legs: int) -> Iterator[int]:
    """Yield the legs in the order in which they get their pulses: one side and the other in turn, never neighbours.

    Parameters
    ----------
    legs : int
        Number of legs, in the ring's order.
    """
    half = (legs + 1) // 2
    for leg in range(half):
        yield leg
        if leg + half < legs:
            yield leg + half
