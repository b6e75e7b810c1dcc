"""How near the feet come to each other."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.arrays import Array
from tarsus.robot.robot import Robot

__all__ = ["default_foot_distance", "feet_distance", "passing_distance"]


def default_foot_distance(robot: Robot) -> float:
    """Return the least distance between the centres of two feet that a walk must keep: two radii and 10 mm [m].

    Parameters
    ----------
    robot : Robot
        The robot.
    """
    return 2 * float(np.max(np.asarray(robot.foot_radius))) + 0.010


def feet_distance(feet: Array) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return the least distance between any two feet, and which two.

    Parameters
    ----------
    feet : array, shape (..., legs, 3)
        The feet [m].

    Returns
    -------
    distance : array, shape (...)
        Between the two nearest feet [m].
    pair : array of int, shape (..., 2)
        Which legs they belong to.
    """
    feet = np.asarray(feet)
    first, second = np.triu_indices(feet.shape[-2], k=1)
    apart = feet[..., first, :] - feet[..., second, :]
    distance2 = (apart * apart).sum(-1)
    nearest = distance2.argmin(-1)
    pair = np.stack([first[nearest], second[nearest]], axis=-1)
    return np.sqrt(distance2.min(-1)), pair


def passing_distance(feet: Array) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return the least distance between any two feet from each moment to the next, and which two.

    From one moment to the next every foot is taken to go straight: fast feet that pass each other between two moments
    are seen.

    Parameters
    ----------
    feet : array, shape (..., n, legs, 3)
        The feet at `n` moments one after the other [m].

    Returns
    -------
    distance : array, shape (..., n - 1)
        Between the two nearest feet [m].
    pair : array of int, shape (..., n - 1, 2)
        Which legs they belong to.
    """
    feet = np.asarray(feet)
    first, second = np.triu_indices(feet.shape[-2], k=1)
    apart = feet[..., first, :] - feet[..., second, :]
    start, way = apart[..., :-1, :, :], np.diff(apart, axis=-3)
    length2 = (way * way).sum(-1)
    share = np.clip(-(start * way).sum(-1) / np.where(length2 > 0, length2, 1.0), 0, 1)
    nearest = start + share[..., None] * way
    distance2 = (nearest * nearest).sum(-1)
    at = distance2.argmin(-1)
    return np.sqrt(distance2.min(-1)), np.stack([first[at], second[at]], axis=-1)
