"""Distances between feet."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["default_foot_distance", "feet_distance", "passing_distance"]


def default_foot_distance(robot: Robot) -> float:
    """Return the default least distance between the centres of two feet: two foot radii and 10 mm [m].

    Parameters
    ----------
    robot : Robot
        The robot.
    """
    return 2 * float(np.max(np.asarray(robot.foot_radius))) + 0.010


def feet_distance(feet: Float[Array, "*batch legs 3"]) -> tuple[Float[Array, "*batch"], Int[np.ndarray, "*batch 2"]]:
    """Return the least distance between two feet, and their legs.

    Parameters
    ----------
    feet : array, shape (..., legs, 3)
        Feet [m].

    Returns
    -------
    distance : array, shape (...)
        Distance between the two closest feet [m].
    pair : array of int, shape (..., 2)
        Their legs.
    """
    feet = np.asarray(feet)
    first, second = np.triu_indices(feet.shape[-2], k=1)
    difference = feet[..., first, :] - feet[..., second, :]
    distance2 = (difference * difference).sum(-1)
    nearest = distance2.argmin(-1)
    pair = np.stack([first[nearest], second[nearest]], axis=-1)
    return np.sqrt(distance2.min(-1)), pair


def passing_distance(
    feet: Float[Array, "*batch n legs 3"],
) -> tuple[Float[np.ndarray, "*batch n-1"], Int[np.ndarray, "*batch n-1 2"]]:
    """Return the least distance between two feet from each sample to the next, and their legs.

    Feet are interpolated linearly between samples, so that fast feet that pass each other between samples are found.

    Parameters
    ----------
    feet : array, shape (..., n, legs, 3)
        Feet at `n` successive samples [m].

    Returns
    -------
    distance : array, shape (..., n - 1)
        Distance between the two closest feet [m].
    pair : array of int, shape (..., n - 1, 2)
        Their legs.
    """
    feet = np.asarray(feet)
    first, second = np.triu_indices(feet.shape[-2], k=1)
    difference = feet[..., first, :] - feet[..., second, :]
    start, change = difference[..., :-1, :, :], np.diff(difference, axis=-3)
    length2 = (change * change).sum(-1)
    fraction = np.clip(-(start * change).sum(-1) / np.where(length2 > 0, length2, 1.0), 0, 1)
    nearest = start + fraction[..., None] * change
    distance2 = (nearest * nearest).sum(-1)
    at = distance2.argmin(-1)
    return np.sqrt(distance2.min(-1)), np.stack([first[at], second[at]], axis=-1)
