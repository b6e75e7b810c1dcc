"""Ground plane: least-squares fit through the stance feet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, broadcast_shapes, require_shape
from tarsus.errors import InputError
from tarsus.kinematics.planar_moments import PlanarMoments
from tarsus.kinematics.polygon import as_mask

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["FLAT", "GroundPlane", "ground_plane"]

# Feet count as collinear where the square of their spread across a line is this fraction of that along it: there, an
# error of a millimetre in a foot's height tilts the plane by degrees. One or two feet are always collinear.
_NARROW = 0.05**2
_FARTHEST = 1e9  # [m]; beyond, fourth powers could overflow


@dataclass(frozen=True, slots=True)
class GroundPlane:
    """A plane ``z_0 + slope . ((x, y) - (x_0, y_0))`` in G: numbers, or arrays of one shape for a batch.

    Attributes
    ----------
    x, y : float or array, shape (...)
        Reference point: the mean of the feet [m].
    z : float or array, shape (...)
        Height of the plane there [m].
    slope_x, slope_y : float or array, shape (...)
        Rise along x and y [m/m].
    """

    x: Float[Array, "*#batch"] = 0.0
    y: Float[Array, "*#batch"] = 0.0
    z: Float[Array, "*#batch"] = 0.0
    slope_x: Float[Array, "*#batch"] = 0.0
    slope_y: Float[Array, "*#batch"] = 0.0

    def height(self, x: Float[Array, "*#batch"], y: Float[Array, "*#batch"]) -> Float[Array, "*batch"]:
        """Return the height of the plane at a point.

        Parameters
        ----------
        x, y : float or array, shape (...)
            The point in G [m].

        Returns
        -------
        float or array, shape (...)
            z in G [m].
        """
        return self.z + self.slope_x * (x - self.x) + self.slope_y * (y - self.y)


FLAT = GroundPlane()
"""The plane z = 0."""


def ground_plane(
    feet: Float[Array, "*#batch legs 3"], contacts: Bool[Array, "*#batch legs"], previous: GroundPlane = FLAT
) -> GroundPlane:
    """Return the least-squares plane through the stance feet.

    Three or more feet that are not collinear determine a plane. With fewer, or collinear, feet it keeps the previous
    slope and passes through their mean; with no foot in stance the previous plane is returned.

    Parameters
    ----------
    feet : array, shape (..., legs, 3)
        Feet in G [m].
    contacts : array of bool, shape (..., legs)
        Which feet are in stance.
    previous : GroundPlane
        The previous plane; flat ground by default.

    Returns
    -------
    GroundPlane
        Plain numbers for one robot, arrays ``(...)`` for a batch.

    Raises
    ------
    InputError
        If a shape is wrong, `contacts` is not boolean, or a stance foot is NaN, infinite or more than 1e9 m away.

    Notes
    -----
    Solves the normal equations of ``z - z_mean = a (x - x_mean) + b (y - y_mean)``. Centring keeps these two equations
    well conditioned at any distance from the origin of G, unless the feet are collinear.
    """
    feet, contacts = np.asarray(feet, dtype=float), as_mask(np, contacts, name="contacts")
    legs = contacts.shape[-1] if contacts.ndim else 0
    require_shape("feet", feet, (legs, 3))
    if feet.ndim == 2 and contacts.ndim == 1:
        return _fit_one(feet.tolist(), contacts.tolist(), previous)
    return _fit_batch(feet, contacts, previous)


def _fit_one(feet: list[list[float]], contacts: list[bool], previous: GroundPlane) -> GroundPlane:
    """Fit one plane in plain numbers: for six feet several times as fast as arrays."""
    down = [foot for foot, touch in zip(feet, contacts, strict=True) if touch]
    count = len(down)
    if not count:
        return previous
    if not all(abs(part) < _FARTHEST for foot in down for part in foot):
        raise _bad_feet()
    mean_x, mean_y, mean_z = (sum(parts) / count for parts in zip(*down, strict=True))
    xx = xy = yy = xz = yz = 0.0
    for foot in down:
        x, y, z = foot[0] - mean_x, foot[1] - mean_y, foot[2] - mean_z
        xx, xy, yy = xx + x * x, xy + x * y, yy + y * y
        xz, yz = xz + x * z, yz + y * z
    moments = PlanarMoments(xx, xy, yy)
    if not moments.span_area(_NARROW):
        return GroundPlane(mean_x, mean_y, mean_z, previous.slope_x, previous.slope_y)
    return GroundPlane(mean_x, mean_y, mean_z, *moments.slopes(xz, yz, determinant=moments.determinant))


def _fit_batch(
    feet: Float[np.ndarray, "*#batch legs 3"], contacts: Bool[np.ndarray, "*#batch legs"], previous: GroundPlane
) -> GroundPlane:
    broadcast_shapes("feet and contacts", feet.shape[:-2], contacts.shape[:-1])
    feet = np.where(contacts[..., None], feet, 0.0)
    if not (np.abs(feet) < _FARTHEST).all():
        raise _bad_feet()
    count = np.broadcast_to(contacts.sum(-1), feet.shape[:-2])
    mean = feet.sum(-2) / np.maximum(count, 1)[..., None]
    x, y, z = np.moveaxis(np.where(contacts[..., None], feet - mean[..., None, :], 0.0), -1, 0)
    xx, xy, yy, xz, yz = ((a * b).sum(-1) for a, b in ((x, x), (x, y), (y, y), (x, z), (y, z)))
    moments = PlanarMoments(xx, xy, yy)
    plane = moments.span_area(_NARROW)
    slope_x, slope_y = moments.slopes(xz, yz, determinant=np.where(plane, moments.determinant, 1.0))
    down = count > 0
    return GroundPlane(
        np.where(down, mean[..., 0], previous.x),
        np.where(down, mean[..., 1], previous.y),
        np.where(down, mean[..., 2], previous.z),
        np.where(plane, slope_x, previous.slope_x),
        np.where(plane, slope_y, previous.slope_y),
    )


def _bad_feet() -> InputError:
    return InputError(f"feet: a stance foot is NaN, infinite or more than {_FARTHEST:g} m away")
