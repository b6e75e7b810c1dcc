"""Convex polygons in the ground plane, one per foot, with sixteen sides of fixed directions.

Points are complex numbers, x + iy. A polygon is given by the distances of its sides from the origin along `NORMALS`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["NORMALS", "NORMALS_CONJUGATE", "polygon_ends", "polygon_margin"]

_SIDES = 16
NORMALS: Complex[np.ndarray, "16"] = np.exp(2j * np.pi * np.arange(_SIDES) / _SIDES)
"""Outward normals of the polygons' sides ``(16,)``, the second half opposite to the first."""
NORMALS.setflags(write=False)

NORMALS_CONJUGATE: Complex[np.ndarray, "16"] = NORMALS.conj()
"""Conjugates of `NORMALS`: the real part of their product with a point is its coordinate along each normal."""
NORMALS_CONJUGATE.setflags(write=False)

# Cosine and sine of the angle from each normal to each of them; the sine as a divisor, 1 where it is 0.
_COSINE, _SINE = ((NORMALS_CONJUGATE[:, None] * NORMALS).view(float).reshape(_SIDES, _SIDES, 2)[..., i] for i in (0, 1))
_SINE = np.where(np.abs(_SINE) < 1e-9, 0.0, _SINE)
_DIVISOR = np.where(_SINE == 0, 1.0, _SINE)
# Added to the cuts of a side with others, so that only those count which bound its clockwise end, or its other end.
_BEFORE, _AFTER = np.where(_SINE < 0, 0.0, -np.inf), np.where(_SINE > 0, 0.0, np.inf)
# Tolerance for corners that lie beyond another side by rounding [m].
_ROUNDING = 1e-12


def polygon_margin(
    bounds: Float[np.ndarray, "legs 16"], inside: Complex[np.ndarray, "legs"]
) -> Float[np.ndarray, "legs 16"]:
    """Return the distance of each side from a point.

    Parameters
    ----------
    bounds : array, shape (legs, 16)
        The polygons' sides [m].
    inside : complex array, shape (legs,)
        The points [m].

    Returns
    -------
    array, shape (legs, 16)
        Distances [m]; negative where the point is beyond a side.
    """
    return np.asarray(bounds - (NORMALS.conj() * inside[:, None]).real)


def polygon_ends(
    bounds: Float[np.ndarray, "legs 16"], inside: Complex[np.ndarray, "legs"]
) -> tuple[Complex[np.ndarray, "legs 16"], Complex[np.ndarray, "legs 16"]]:
    """Return the ends of the polygons' sides, relative to a point inside.

    Parameters
    ----------
    bounds : array, shape (legs, 16)
        The polygons' sides [m].
    inside : complex array, shape (legs,)
        The points [m].

    Returns
    -------
    start, end : complex array, shape (legs, 16)
        Clockwise and counter-clockwise end of each side [m]; 0 for a redundant side. All ends, or all starts, are the
        polygon's corners.
    """
    margins = np.maximum(polygon_margin(bounds, inside), 0.0)
    # Where the line of side j intersects that of side k, measured from the foot of the perpendicular.
    cut = (margins[:, None, :] - margins[:, :, None] * _COSINE) / _DIVISOR
    start, end = (cut + _BEFORE).max(axis=-1), (cut + _AFTER).min(axis=-1)
    on_boundary = start <= end + _ROUNDING
    return np.where(on_boundary, (margins + 1j * start) * NORMALS, 0.0), np.where(
        on_boundary, (margins + 1j * end) * NORMALS, 0.0
    )
