"""That the robot can't tip over, wherever in their polygons the feet are."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.gait.gait import Gait
from tarsus.gait.live.polygon import NORMALS, polygon_ends

__all__ = ["safe_share", "support_sets"]

Floats = np.ndarray[Any, Any]

_SHARES = np.array([*np.linspace(1.0, 0.1, 10), 0.06, 0.03])


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


def safe_share(
    sets: Floats, bounds: Floats, rest: Floats, centre: complex, *, margin: float, shift: Floats | None = None
) -> float:
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
        The projected centre of mass with the feet at rest [m].
    margin : float
        How far inside it must be at the least [m].
    shift : complex array, shape (legs, 16), optional
        How far each leg shifts it by being at each corner of `polygon_ends` [m]; nowhere where left out.

    Returns
    -------
    float
        A share of the polygons' size; 0 where the robot tips over even with its feet at rest.
    """
    edges = {edge for row in sets for edge in _edges(np.flatnonzero(row))}
    if _NO_EDGE in edges:
        return 0.0
    pairs = np.array(sorted(edges)).T
    away, (_, corners) = rest - centre, polygon_ends(bounds, rest)
    shift = np.zeros(corners.shape, dtype=complex) if shift is None else shift
    for share in _SHARES:
        if _least_margin(pairs, away[:, None] + share * corners, share * shift) >= margin:
            return float(share)
    return 0.0


def _least_margin(pairs: Floats, feet: Floats, shift: Floats) -> float:
    """Return how far inside the nearest edge the centre of mass is, wherever the feet are.

    Round the ring, the centre is to the left of every edge. How far, times the edge's length, is linear in either of
    the edge's feet, and the length convex: what is worst is at corners. `feet` are these, seen from where the centre
    of mass is with the feet at rest.
    """
    first, second = pairs
    start, end = feet[first][:, :, None], feet[second][:, None, :]
    along = end - start
    inward = 1j * along / np.maximum(np.abs(along), 1e-12)
    moved = shift[first][:, :, None] + shift[second][:, None, :]
    # The other legs, down or in the air, shift the centre as far towards the edge as they can.
    side = np.round(np.angle(inward) * len(NORMALS) / (2 * np.pi)).astype(int) % len(NORMALS)
    least = (NORMALS.conj()[:, None, None] * shift).real.min(axis=-1)
    others = least.sum(axis=-1)[side] - least[side, first[:, None, None]] - least[side, second[:, None, None]]
    return float(((inward.conj() * (moved - start)).real + others).min())


_NO_EDGE = (-1, -1)


def _edges(legs: Floats) -> list[tuple[int, int]]:
    """Return each foot that is down with the next of them round the ring; fewer than three support nothing."""
    if len(legs) < 3:
        return [_NO_EDGE]
    return list(zip(legs.tolist(), np.roll(legs, -1).tolist(), strict=True))
