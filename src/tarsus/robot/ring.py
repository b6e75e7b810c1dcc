"""The order of a robot's legs: around the body, as robot files list them and imports number them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Complex

__all__ = ["ring"]

# Decimals to which directions are rounded [deg]: finer than a micrometre, coarser than the noise of computed mounts.
_DIGITS = 6
# Shift of mounts in the same direction along their legs, as a fraction of the greatest distance from the middle.
_ASIDE = 1e-3


def ring(mounts: Complex[np.ndarray, "legs"], directions: Complex[np.ndarray, "legs"]) -> list[int]:
    """Return the legs counter-clockwise, starting from straight ahead.

    Legs are ordered by the directions of their mounts, seen from the middle of the mounts. Those whose mounts lie in
    the same direction, for example on one line along the body, are ordered by where they point.

    Parameters
    ----------
    mounts : complex array, shape (legs,)
        Positions of the coxa axes, x forward and y left, in any unit.
    directions : complex array, shape (legs,)
        Unit vectors of the directions in which the legs point at a coxa angle of zero.

    Returns
    -------
    list of int
        Indices of the legs.
    """
    places = mounts - mounts.mean()
    # Rounding puts a leg straight ahead first, whatever the sign of its y.
    angles = np.round(np.angle(places, deg=True), _DIGITS) % 360
    shared = (angles[:, None] == angles).sum(axis=1) > 1
    beside = np.angle(places + _ASIDE * np.abs(places).max() * directions, deg=True)
    aside = np.where(shared, np.round((beside - angles + 180) % 360 - 180, _DIGITS), 0.0)
    # The ring begins straight ahead: of the legs mounted there, those that point to the right come last.
    angles = np.where((angles == 0) & (aside < 0), 360.0, angles)
    return [int(leg) for leg in np.lexsort((aside, angles))]
