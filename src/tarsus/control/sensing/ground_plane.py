"""The ground that a robot stands on: a plane through its stance feet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.arrays import Array, broadcast_shapes, require_shape
from tarsus.errors import InputError
from tarsus.kinematics.polygon import as_mask

__all__ = ["FLAT", "GroundPlane", "ground_plane"]

# Feet are as good as in a line where their spread across it is this share of their spread along it, squared: there
# a millimetre's error in a foot's height would tilt the plane by degrees. Two feet, or one, always are.
_NARROW = 0.05**2
_FARTHEST = 1e9  # [m]; beyond, squares of squares would overflow


@dataclass(frozen=True, slots=True)
class GroundPlane:
    """A plane ``z = height + slope . ((x, y) - place)`` in G: numbers, or arrays of one shape for a batch.

    Attributes
    ----------
    x, y : float or array, shape (...)
        The place where its height is given: the middle of the feet [m].
    z : float or array, shape (...)
        Height there [m].
    slope_x, slope_y : float or array, shape (...)
        How much it rises along x and y [m/m].
    """

    x: Array = 0.0
    y: Array = 0.0
    z: Array = 0.0
    slope_x: Array = 0.0
    slope_y: Array = 0.0

    def height(self, x: Array, y: Array) -> Array:
        """Return the plane's height at a place.

        Parameters
        ----------
        x, y : float or array, shape (...)
            The place in G [m].

        Returns
        -------
        float or array, shape (...)
            z in G [m].
        """
        return self.z + self.slope_x * (x - self.x) + self.slope_y * (y - self.y)


FLAT = GroundPlane()
"""The plane z = 0."""


def ground_plane(feet: Array, contacts: Array, previous: GroundPlane = FLAT) -> GroundPlane:
    """Return the plane from which the stance feet's heights differ least, in squares.

    Three feet or more that are not in a line give a plane. Otherwise its slope stays what it was, and goes
    through the feet's middle; with no foot down the plane stays as it was.

    Parameters
    ----------
    feet : array, shape (..., legs, 3)
        Feet in G [m].
    contacts : array of bool, shape (..., legs)
        Which are on the ground.
    previous : GroundPlane
        The plane before: flat ground, where nothing is known.

    Returns
    -------
    GroundPlane
        Of plain numbers for one robot, of arrays ``(...)`` for a batch.

    Raises
    ------
    InputError
        If a shape is wrong, `contacts` is not of booleans, or a foot on the ground is NaN or infinite.

    Notes
    -----
    The normal equations of ``z - z_mean = a (x - x_mean) + b (y - y_mean)``: two unknowns, and well conditioned
    wherever the feet are not in a line, wherever in G they are.
    """
    feet, contacts = np.asarray(feet, dtype=float), as_mask(np, contacts, name="contacts")
    legs = contacts.shape[-1] if contacts.ndim else 0
    require_shape("feet", feet, (legs, 3))
    if feet.ndim == 2 and contacts.ndim == 1:
        return _one(feet.tolist(), contacts.tolist(), previous)
    return _many(feet, contacts, previous)


def _one(feet: list[list[float]], contacts: list[bool], previous: GroundPlane) -> GroundPlane:
    """Fit one plane in plain numbers: several times as fast as arrays of six."""
    down = [foot for foot, touch in zip(feet, contacts, strict=True) if touch]
    count = len(down)
    if not count:
        return previous
    if not all(abs(part) < _FARTHEST for foot in down for part in foot):
        raise _not_there()
    mean_x, mean_y, mean_z = (sum(parts) / count for parts in zip(*down, strict=True))
    xx = xy = yy = xz = yz = 0.0
    for foot in down:
        x, y, z = foot[0] - mean_x, foot[1] - mean_y, foot[2] - mean_z
        xx, xy, yy = xx + x * x, xy + x * y, yy + y * y
        xz, yz = xz + x * z, yz + y * z
    area = xx * yy - xy * xy
    if area <= _NARROW * (xx + yy) ** 2:
        return GroundPlane(mean_x, mean_y, mean_z, previous.slope_x, previous.slope_y)
    return GroundPlane(mean_x, mean_y, mean_z, (yy * xz - xy * yz) / area, (xx * yz - xy * xz) / area)


def _many(feet: np.ndarray[Any, Any], contacts: np.ndarray[Any, Any], previous: GroundPlane) -> GroundPlane:
    broadcast_shapes("feet and contacts", feet.shape[:-2], contacts.shape[:-1])
    feet = np.where(contacts[..., None], feet, 0.0)
    if not (np.abs(feet) < _FARTHEST).all():
        raise _not_there()
    count = np.broadcast_to(contacts.sum(-1), feet.shape[:-2])
    mean = feet.sum(-2) / np.maximum(count, 1)[..., None]
    x, y, z = np.moveaxis(np.where(contacts[..., None], feet - mean[..., None, :], 0.0), -1, 0)
    xx, xy, yy, xz, yz = ((a * b).sum(-1) for a, b in ((x, x), (x, y), (y, y), (x, z), (y, z)))
    area = xx * yy - xy * xy
    plane = area > _NARROW * (xx + yy) ** 2
    area = np.where(plane, area, 1.0)
    down = count > 0
    return GroundPlane(
        np.where(down, mean[..., 0], previous.x),
        np.where(down, mean[..., 1], previous.y),
        np.where(down, mean[..., 2], previous.z),
        np.where(plane, (yy * xz - xy * yz) / area, previous.slope_x),
        np.where(plane, (xx * yz - xy * xz) / area, previous.slope_y),
    )


def _not_there() -> InputError:
    return InputError(f"feet: a foot on the ground is NaN, infinite or more than {_FARTHEST:g} m away")
