"""Motions of the soft start: slowly from where the servos are, and leg by leg where that is unknown."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.swing import horizontal_profile
from tarsus.hardware.calibration.calibration import Calibration

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["check_start", "glide", "glide_duration", "release_order"]

# Peak over mean speed of a minimum-jerk motion: 15/8.
_PEAK = 1.875
# A joint that is measured farther than this beyond its limits has a wrong zero or direction [rad].
_BEYOND = math.radians(20)


def glide_duration(start: Float[np.ndarray, "legs 3"], end: Float[np.ndarray, "legs 3"], speed: float) -> float:
    """Return how long a motion of `glide` takes, in which the fastest joint just reaches the given speed [s].

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
        yield start + (end - start) * horizontal_profile(tick / ticks)


def release_order(legs: int) -> Iterator[int]:
    """Yield the legs in the order in which they are switched on: sides alternate, and no leg follows its neighbour.

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


def check_start(
    calibration: Calibration, angles: Float[np.ndarray, "legs 3"], known: Bool[np.ndarray, "legs 3"]
) -> None:
    """Raise an error where a joint is measured far beyond its limits, as its zero or direction must be wrong.

    Parameters
    ----------
    calibration : Calibration
        The calibration.
    angles : array, shape (legs, 3)
        Where the joints are [rad].
    known : array of bool, shape (legs, 3)
        Which of them are measured.

    Raises
    ------
    InputError
        If a joint is measured that far beyond its limits.
    """
    limits = calibration.limits
    beyond = np.where(known, np.maximum(limits[..., 0] - angles, angles - limits[..., 1]), 0.0)
    if float(beyond.max()) <= _BEYOND:
        return
    leg, j = np.unravel_index(int(np.argmax(beyond)), beyond.shape)
    low, high = np.degrees(limits[leg, j])
    raise InputError(
        f"the {calibration.joint_name(int(leg), int(j))} is measured at {math.degrees(angles[leg, j]):.1f} deg, far "
        f"beyond its limits of {low:.1f} to {high:.1f} deg: move it there by hand, or correct its zero or direction in "
        "the calibration"
    )
