"""Convex polygons of the ground plane with sixteen sides of fixed directions, one for each foot.

Points are complex numbers, x + iy. A polygon is how far out each of its sides is, along `NORMALS` from the origin.
"""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["NORMALS", "NORMALS_CONJUGATE", "polygon_ends", "polygon_margin", "polygon_radii"]

Floats = np.ndarray[Any, Any]

_SIDES = 16
NORMALS: Floats = np.exp(2j * np.pi * np.arange(_SIDES) / _SIDES)
"""Outward normals of the polygons' sides ``(16,)``, the second half opposite to the first."""
NORMALS.setflags(write=False)

NORMALS_CONJUGATE: Floats = NORMALS.conj()
"""What a point is multiplied by for the real part to be how far out it is along each normal."""
NORMALS_CONJUGATE.setflags(write=False)

_COSINE, _SINE = ((NORMALS_CONJUGATE[:, None] * NORMALS).view(float).reshape(_SIDES, _SIDES, 2)[..., i] for i in (0, 1))
_SINE = np.where(np.abs(_SINE) < 1e-9, 0.0, _SINE)
_DIVISOR = np.where(_SINE == 0, 1.0, _SINE)
# Which sides cut a side off at its clockwise end, which at the other.
_BEFORE, _AFTER = np.where(_SINE < 0, 0.0, -np.inf), np.where(_SINE > 0, 0.0, np.inf)
# What a corner may seem to be beyond another side from rounding [m].
_ROUNDING = 1e-12


def polygon_margin(bounds: Floats, inside: Floats) -> Floats:
    """Return how far each side is from a point.

    Parameters
    ----------
    bounds : array, shape (legs, 16)
        The polygons' sides [m].
    inside : complex array, shape (legs,)
        The points [m].

    Returns
    -------
    array, shape (legs, 16)
        Distances [m]; negative where the point is outside.
    """
    return np.asarray(bounds - (NORMALS.conj() * inside[:, None]).real)


def polygon_radii(bounds: Floats, inside: Floats, directions: Floats) -> Floats:
    """Return how far the polygons reach from a point inside along directions.

    Parameters
    ----------
    bounds : array, shape (legs, 16)
        The polygons' sides [m].
    inside : complex array, shape (legs,)
        The points [m].
    directions : complex array, shape (n,)
        Unit directions.

    Returns
    -------
    array, shape (legs, n)
        Distances [m].
    """
    room = np.maximum(polygon_margin(bounds, inside), 0.0)
    along = (NORMALS.conj()[:, None] * directions).real
    return np.asarray(np.where(along > 1e-9, room[:, :, None] / np.maximum(along, 1e-9), np.inf).min(axis=1))


def polygon_ends(bounds: Floats, inside: Floats) -> tuple[Floats, Floats]:
    """Return the ends of the polygons' sides, seen from a point inside.

    Parameters
    ----------
    bounds : array, shape (legs, 16)
        The polygons' sides [m].
    inside : complex array, shape (legs,)
        The points [m].

    Returns
    -------
    start, end : complex array, shape (legs, 16)
        Each side's clockwise and counter-clockwise end [m]; 0 for a side that touches the polygon nowhere. The ends
        alone, or the starts, are all the polygon's corners.
    """
    room = np.maximum(polygon_margin(bounds, inside), 0.0)
    # Along the line of side k, from the foot of the perpendicular: where the line of side j cuts it off.
    cut = (room[:, None, :] - room[:, :, None] * _COSINE) / _DIVISOR
    start, end = (cut + _BEFORE).max(axis=-1), (cut + _AFTER).min(axis=-1)
    touches = start <= end + _ROUNDING
    return np.where(touches, (room + 1j * start) * NORMALS, 0.0), np.where(touches, (room + 1j * end) * NORMALS, 0.0)
