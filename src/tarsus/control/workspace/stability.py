"""That the robot can't tip over, wherever in their polygons the feet are."""

from __future__ import annotations

import functools
import math
from bisect import bisect_left
from typing import Any

import numpy as np

from tarsus.control.workspace.polygon import NORMALS, NORMALS_CONJUGATE, polygon_ends
from tarsus.control.workspace.stance_geometry import StanceGeometry
from tarsus.gait.gait import Gait
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import point_masses, total_mass
from tarsus.robot.robot import Robot

__all__ = ["StabilityCheck", "margin_at_rest", "safe_fraction", "support_sets"]

Floats = np.ndarray[Any, Any]

_SHARES = np.array([*np.linspace(1.0, 0.1, 10), 0.06, 0.03])
_LIKELY = 3


def support_sets(gait: Gait, excluded: tuple[int, ...] = ()) -> Floats:
    """Return which feet are down together, for each moment when few are.

    Parameters
    ----------
    gait : Gait
        The gait.
    excluded : tuple of int
        Legs that don't step with it, and bear nothing.

    Returns
    -------
    array of bool, shape (n, legs)
        Sets of which none holds another: where these support the robot, all do.
    """
    return _support_sets(gait, tuple(excluded))


@functools.lru_cache(maxsize=64)
def _support_sets(gait: Gait, excluded: tuple[int, ...]) -> Floats:
    after = np.asarray(gait.offsets) + gait.duty_factor + 1e-6
    down = gait.phase(after)[2]
    down[:, list(excluded)] = False
    sets = np.unique(down, axis=0)
    holds = (sets[:, None] >= sets[None]).all(-1) & ~np.eye(len(sets), dtype=bool)
    sets = np.asarray(sets[~holds.any(1)])
    sets.setflags(write=False)
    return sets


def safe_fraction(
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
    pairs = _edges_of(np.asarray(sets).tobytes(), sets.shape[1])
    if pairs is None:
        return 0.0
    away, (_, corners) = rest - centre, polygon_ends(bounds, rest)
    shift = np.zeros(corners.shape, dtype=complex) if shift is None else shift

    def works(index: int) -> bool:
        share = _SHARES[index]
        return _least_margin(pairs, away[:, None] + share * corners, share * shift) >= margin

    # Most robots stand safely enough for one of the first; the less of a polygon, the safer.
    for index in range(_LIKELY):
        if works(index):
            return float(_SHARES[index])
    index = bisect_left(range(len(_SHARES)), True, lo=_LIKELY, key=works)
    return float(_SHARES[index]) if index < len(_SHARES) else 0.0


def margin_at_rest(sets: Floats, rest: Floats, centre: complex) -> float:
    """Return how far inside every support a centre of mass is, with the feet at rest.

    Parameters
    ----------
    sets : array of bool, shape (n, legs)
        Feet that are down together.
    rest : complex array, shape (legs,)
        Rest footholds [m].
    centre : complex
        The projected centre of mass [m].

    Returns
    -------
    float
        Negative outside; minus infinity where fewer than three feet are down [m].
    """
    pairs = _edges_of(np.asarray(sets).tobytes(), sets.shape[1])
    return -math.inf if pairs is None else _least_margin(pairs, (rest - centre)[:, None], np.zeros((len(rest), 1)))


def _least_margin(pairs: Floats, feet: Floats, shift: Floats) -> float:
    """Return how far inside the nearest edge the centre of mass is, wherever the feet are.

    Round the ring, the centre is to the left of every edge. How far, times the edge's length, is linear in either of
    the edge's feet, and the length convex: what is worst is at corners. `feet` are these, seen from where the centre
    of mass is with the feet at rest.
    """
    first, second = pairs
    start, end = feet[first][:, :, None], feet[second][:, None, :]
    along = end - start
    # Times i, and of length 1.
    inward = along * (1j / np.maximum(np.abs(along), 1e-12))
    moved = shift[first][:, :, None] + shift[second][:, None, :]
    # The other legs, down or in the air, shift the centre as far towards the edge as they can.
    least = (NORMALS_CONJUGATE[:, None, None] * shift).real.min(axis=-1)
    others = (least.sum(axis=-1)[:, None] - least[:, first] - least[:, second]).T
    side = np.rint(np.arctan2(inward.imag, inward.real) * (len(NORMALS) / (2 * np.pi))).astype(int)
    # The sides before the first, from the end.
    others = others[np.arange(len(first))[:, None, None], side]
    return float(((inward.conj() * (moved - start)).real + others).min())


@functools.lru_cache(maxsize=64)
def _edges_of(sets: bytes, legs: int) -> Floats | None:
    """Return the edges ``(2, n)`` of all sets of feet, given as their bytes; None where one supports nothing."""
    edges: set[tuple[int, int]] = set()
    for row in np.frombuffer(sets, dtype=bool).reshape(-1, legs):
        down = np.flatnonzero(row).tolist()
        if len(down) < 3:
            return None
        # Each foot that is down with the next of them round the ring.
        edges.update(zip(down, down[1:] + down[:1], strict=True))
    return np.array(sorted(edges)).T


# How far inside its support the centre of mass stays [m].
_LEAST_MARGIN = 0.004


class StabilityCheck:
    """Keeps a robot that walks in some order of steps from tipping over.

    Where the robot's file gives no masses, its legs count as massless.

    Parameters
    ----------
    robot : Robot
        A single robot.
    sets : array of bool, shape (n, legs)
        Feet that are down together.
    excluded : tuple of int
        Legs that don't step: wherever they hang about, they shift the centre of mass.

    Attributes
    ----------
    least_margin : float
        How far inside its support the centre of mass stays [m].
    """

    def __init__(self, robot: Robot, sets: Floats, excluded: tuple[int, ...] = ()) -> None:
        self._robot, self._sets, self._gone = robot, sets, list(excluded)
        self.least_margin = _LEAST_MARGIN
        # Shares of the whole that the legs' points and the body's centre weigh.
        self._weights, self._body = np.zeros((robot.legs, 4)), np.asarray(robot.body_com)
        if robot.has_masses:
            total = total_mass(robot)
            self._weights = point_masses(np, robot) / total
            self._body = self._body * (robot.body_mass / total)
            reach = np.asarray(robot.coxa + robot.femur + robot.tibia) * np.asarray(robot.link_mass).sum(-1) / 4
            self.least_margin += float(reach[self._gone].sum() / total)

    def safe_fraction(self, stand: StanceGeometry, sides: Floats, centre: complex, shift: Floats) -> float:
        """Return by how much the feet's polygons must shrink towards the rest footholds, so that nothing tips over.

        Parameters
        ----------
        stand : Stand
            The body and the rest footholds.
        sides : array, shape (legs, 16)
            The polygons' sides [m].
        centre, shift
            From `centre_of_mass`.

        Returns
        -------
        float
            A share of the polygons' size; 0 where the robot tips over even with its feet at rest.
        """
        return safe_fraction(self._sets, sides, stand.rest, centre, margin=self.least_margin, shift=shift)

    def centre_of_mass(self, stand: StanceGeometry, sides: Floats) -> tuple[complex, Floats]:
        """Return the projected centre of mass with the feet at rest, and its shift by each leg at each corner.

        Parameters
        ----------
        stand : Stand
            The body and the rest footholds.
        sides : array, shape (legs, 16)
            The polygons' sides [m].

        Returns
        -------
        centre : complex
            In the heading frame [m].
        shift : complex array, shape (legs, 16)
            By each leg, at each corner of `polygon_ends` [m]; none by legs that don't step.
        """
        # Every foot at rest first, then at one of its corners after the other.
        corners = polygon_ends(sides, stand.rest)[1]
        moments, centre = self._moments(stand, np.concatenate([np.zeros((1, len(corners))), corners.T]))
        shift = (moments[1:] - moments[0]).T
        shift[self._gone] = 0.0
        return centre, shift

    def margin_at_rest(self, stand: StanceGeometry) -> float:
        """Return how far inside its supports the centre of mass is with the feet at rest [m].

        Parameters
        ----------
        stand : Stand
            The body and the rest footholds.
        """
        return margin_at_rest(self._sets, stand.rest, self._moments(stand, np.zeros((1, len(stand.rest))))[1])

    def _moments(self, stand: StanceGeometry, out: Floats) -> tuple[Floats, complex]:
        """Return what each leg adds to the centre of mass ``(n, legs)``, and where that is in the first row [m]."""
        feet = stand.rest + out
        solution = stand.solve(self._robot, feet.real, feet.imag, np.zeros((1, 1)))
        points = forward_kinematics(self._robot, np.stack(solution[:3], axis=-1))
        moments = (points * self._weights[..., None]).sum(axis=-2) @ stand.rotation.T
        moments = moments[..., 0] + 1j * moments[..., 1]
        body = stand.rotation @ self._body + stand.position
        return moments, complex(moments[0].sum() + complex(body[0], body[1]))
