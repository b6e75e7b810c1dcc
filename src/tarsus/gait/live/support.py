"""That the robot can't tip over, wherever in their polygons the feet are."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.gait.gait import Gait
from tarsus.gait.live.workspace import polygon_radii

__all__ = ["safe_share", "support_sets"]

Floats = np.ndarray[Any, Any]

_SHARES = np.linspace(0.1, 1.0, 10)
_CORNERS = np.exp(2j * np.pi * np.arange(12) / 12)


def support_sets(gait: Gait, gone: tuple[int, ...] = ()) -> Floats:
    """Return which feet are down together, for each moment when few are.

    Parameters
    ----------
    gait : Gait
        The gait.
    gone : tuple of int
        Legs that don't step with it, and bear nothing.

    Returns
    -------
    array of bool, shape (n, legs)
        Sets of which none holds another: where these support the robot, all do.
    """
    after = np.asarray(gait.offsets) + gait.duty + 1e-6
    down = gait.phase(after)[2]
    down[:, list(gone)] = False
    sets = np.unique(down, axis=0)
    holds = (sets[:, None] >= sets[None]).all(-1) & ~np.eye(len(sets), dtype=bool)
    return np.asarray(sets[~holds.any(1)])


def safe_share(sets: Floats, bounds: Floats, rest: Floats, centre: complex, *, margin: float) -> float:
    """Return by how much the polygons must shrink towards the rest footholds, so that no support tips over.

    Parameters
    ----------
    sets : array of bool, shape (n, legs)
        Feet that are down together.
    bounds : array, shape (legs, 16)
        The polygons' sides [m].
    rest : complex array, shape (legs,)
        Rest footholds [m].
    centre : complex
        The projected centre of mass [m].
    margin : float
        How far inside it must be at the least [m].

    Returns
    -------
    float
        A share of the polygons' size; 0 where the robot tips over even with its feet at rest.
    """
    away = rest - centre
    corners = polygon_radii(bounds, rest, _CORNERS) * _CORNERS
    first, second = np.array([pair for row in sets for pair in _edges(np.flatnonzero(row))]).reshape(-1, 2).T
    # Round the ring, the centre is to the left of every edge: whatever corners the edge's two feet are at. Twice the
    # area between edge and centre is linear in either foot, so that it is least at corners.
    share = _SHARES[:, None, None]
    starts = away[first, None] + share * corners[first]
    ends = away[second, None] + share * corners[second]
    area = (starts.conj()[..., :, None] * ends[..., None, :]).imag
    length = np.abs(ends[..., None, :] - starts[..., :, None])
    works = (area >= margin * length).all(axis=(1, 2, 3))
    if works.all():
        return 1.0
    return float(_SHARES[int(np.argmin(works)) - 1]) if works[0] else 0.0


def _edges(legs: Floats) -> list[tuple[int, int]]:
    """Return each foot that is down with the next of them round the ring; of fewer than three, an impossible edge."""
    if len(legs) < 3:
        return [(0, 0)]
    return list(zip(legs.tolist(), np.roll(legs, -1).tolist(), strict=True))
