"""Static stability: the centre of mass stays inside every support polygon for all positions of the feet."""

from __future__ import annotations

import functools
import math
from bisect import bisect_left
from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.foot_polygons import NORMALS, NORMALS_CONJUGATE, polygon_ends
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stance_geometry import StanceGeometry
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import point_masses, total_mass
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Float, Int

__all__ = ["StabilityCheck", "safe_fraction", "support_sets"]

# Factors tried, largest first; how many of them are tried one by one before the rest are bisected.
_FRACTIONS = np.array([*np.linspace(1.0, 0.1, 10), 0.06, 0.03])
_FIRST = 3


@functools.lru_cache(maxsize=64)
def support_sets(gait: Gait, excluded: tuple[int, ...] = ()) -> Bool[np.ndarray, "n legs"]:
    """Return the minimal sets of feet that are in stance together.

    Parameters
    ----------
    gait : Gait
        The gait.
    excluded : tuple of int
        Legs that neither step nor bear load.

    Returns
    -------
    array of bool, shape (n, legs)
        No set contains another. If these sets support the robot, all sets of the gait do.
    """
    after = np.asarray(gait.offsets) + gait.duty_factor + 1e-6
    down = gait.phase(after)[2]
    down[:, list(excluded)] = False
    sets = np.unique(down, axis=0)
    contains = (sets[:, None] >= sets[None]).all(-1) & ~np.eye(len(sets), dtype=bool)
    sets = np.asarray(sets[~contains.any(1)])
    sets.setflags(write=False)
    return sets


def safe_fraction(
    sets: Bool[np.ndarray, "n legs"],
    bounds: Float[np.ndarray, "legs 16"],
    rest: Complex[np.ndarray, "legs"],
    centre: complex,
    *,
    margin: float,
    shift: Complex[np.ndarray, "legs 16"] | None = None,
) -> float:
    """Return the factor by which the foot polygons must shrink towards the rest footholds for static stability.

    Parameters
    ----------
    sets : array of bool, shape (n, legs)
        Feet that are in stance together.
    bounds : array, shape (legs, 16)
        The polygons' sides [m].
    rest : complex array, shape (legs,)
        Rest footholds [m].
    centre : complex
        Projection of the centre of mass with the feet at rest [m].
    margin : float
        Least stability margin [m].
    shift : complex array, shape (legs, 16), optional
        Shift of the centre of mass by each leg with its foot at each corner of `polygon_ends` [m]; 0 if left out.

    Returns
    -------
    float
        At most 1; 0 if the robot is unstable even with its feet at rest.
    """
    pairs = _edges_of(np.asarray(sets).tobytes(), sets.shape[1])
    if pairs is None:
        return 0.0
    away, (_, corners) = rest - centre, polygon_ends(bounds, rest)
    shift = np.zeros(corners.shape, dtype=complex) if shift is None else shift

    def works(index: int) -> bool:
        fraction = _FRACTIONS[index]
        return _least_margin(pairs, away[:, None] + fraction * corners, fraction * shift) >= margin

    # One of the first fractions is feasible for most robots. Stability is monotonic, so the others are bisected.
    for index in range(_FIRST):
        if works(index):
            return float(_FRACTIONS[index])
    index = bisect_left(range(len(_FRACTIONS)), True, lo=_FIRST, key=works)
    return float(_FRACTIONS[index]) if index < len(_FRACTIONS) else 0.0


def _least_margin(
    pairs: Int[np.ndarray, "2 n"],
    feet: Complex[np.ndarray, "legs m"],
    shift: Complex[np.ndarray, "legs m"] | Float[np.ndarray, "legs m"],
) -> float:
    """Return the least distance of the centre of mass inside any edge, over all positions of the feet.

    Counter-clockwise, the centre of mass is to the left of every edge. Its distance times the length of the edge is
    linear in the position of either foot of the edge, and the length is convex: the minimum is at corners of the foot
    polygons. `feet` are these corners, relative to the centre of mass with the feet at rest.
    """
    first, second = pairs
    start, end = feet[first][:, :, None], feet[second][:, None, :]
    along = end - start
    # The inward unit normal.
    inward = along * (1j / np.maximum(np.abs(along), 1e-12))
    moved = shift[first][:, :, None] + shift[second][:, None, :]
    # All other legs, in stance or swing, shift the centre of mass as far towards the edge as they can.
    least = (NORMALS_CONJUGATE[:, None, None] * shift).real.min(axis=-1)
    others = (least.sum(axis=-1)[:, None] - least[:, first] - least[:, second]).T
    side = np.rint(np.arctan2(inward.imag, inward.real) * (len(NORMALS) / (2 * np.pi))).astype(int)
    # By the normal nearest to the inward one; negative indices count from the end.
    others = others[np.arange(len(first))[:, None, None], side]
    return float(((inward.conj() * (moved - start)).real + others).min())


@functools.lru_cache(maxsize=64)
def _edges_of(sets: bytes, legs: int) -> Float[np.ndarray, "2 n"] | None:
    """Return the edges ``(2, n)`` of the support polygons of all sets, given as bytes; None if one has no polygon."""
    edges: set[tuple[int, int]] = set()
    for row in np.frombuffer(sets, dtype=bool).reshape(-1, legs):
        down = np.flatnonzero(row).tolist()
        if len(down) < 3:
            return None
        # From each stance foot to the next one, counter-clockwise around the body.
        edges.update(zip(down, down[1:] + down[:1], strict=True))
    return np.array(sorted(edges)).T


# Least stability margin [m].
_LEAST_MARGIN = 0.004


class StabilityCheck:
    """Checks the static stability of a robot that walks with a gait.

    Without masses in the robot's file, its legs count as massless.

    Parameters
    ----------
    robot : Robot
        A single robot.
    sets : array of bool, shape (n, legs)
        Feet that are in stance together.
    excluded : tuple of int
        Legs that do not step; `least_margin` allows for the shift of the centre of mass by their positions.

    Attributes
    ----------
    excluded : list of int
        Legs that do not step.
    least_margin : float
        Least stability margin that is safe [m].
    """

    def __init__(self, robot: Robot, sets: Bool[np.ndarray, "n legs"], excluded: tuple[int, ...] = ()) -> None:
        self._robot, self._sets, self.excluded = robot, np.asarray(sets), list(excluded)
        self.least_margin = _LEAST_MARGIN
        # Masses of the leg points, and first moment of the body [m], both over the total mass.
        self._weights, self._body = np.zeros((robot.legs, 4)), np.asarray(robot.body_com)
        if robot.has_masses:
            total = total_mass(robot)
            self._weights = point_masses(np, robot) / total
            self._body = self._body * (robot.body_mass / total)
            reach = np.asarray(robot.coxa + robot.femur + robot.tibia) * np.asarray(robot.link_mass).sum(-1) / 4
            self.least_margin += float(reach[self.excluded].sum() / total)

    def centre_of_mass(
        self, stance: StanceGeometry, sides: Float[np.ndarray, "legs 16"]
    ) -> tuple[complex, Complex[np.ndarray, "legs 16"]]:
        """Return the projection of the centre of mass with the feet at rest, and its shift by each leg.

        Parameters
        ----------
        stance : StanceGeometry
            The body and the rest footholds.
        sides : array, shape (legs, 16)
            The polygons' sides [m].

        Returns
        -------
        centre : complex
            In the heading frame [m].
        shift : complex array, shape (legs, 16)
            Shift by each leg with its foot at each corner of `polygon_ends` [m]; 0 for legs that do not step.
        """
        # First every foot at rest, then all feet at each of their corners.
        corners = polygon_ends(sides, stance.rest)[1]
        moments, centre = self._moments(stance, np.concatenate([np.zeros((1, len(corners))), corners.T]))
        shift = (moments[1:] - moments[0]).T
        shift[self.excluded] = 0.0
        return centre, shift

    def margin_at_rest(self, stance: StanceGeometry) -> float:
        """Return the least stability margin with feet at rest [m]; minus infinity if a set has fewer than three feet.

        Parameters
        ----------
        stance : StanceGeometry
            The body and the rest footholds.
        """
        pairs, legs = _edges_of(self._sets.tobytes(), self._sets.shape[1]), len(stance.rest)
        if pairs is None:
            return -math.inf
        centre = self._moments(stance, np.zeros((1, legs)))[1]
        return _least_margin(pairs, (stance.rest - centre)[:, None], np.zeros((legs, 1)))

    def _moments(
        self,
        stance: StanceGeometry,
        out: Complex[np.ndarray, "*#batch legs"]
        | Complex[np.ndarray, "*#batch 1"]
        | Float[np.ndarray, "*#batch legs"]
        | Float[np.ndarray, "*#batch 1"],
    ) -> tuple[Complex[np.ndarray, "n legs"], complex]:
        """Return each leg's contribution to the centre of mass ``(n, legs)``, and that centre for the first row [m]."""
        feet = stance.rest + out
        solution = stance.solve(self._robot.geometry, feet.real, feet.imag, np.zeros((1, 1)))
        points = forward_kinematics(self._robot, np.stack(solution[:3], axis=-1))
        moments = (points * self._weights[..., None]).sum(axis=-2) @ stance.rotation.T
        moments = moments[..., 0] + 1j * moments[..., 1]
        body = stance.rotation @ self._body + stance.position
        return moments, complex(moments[0].sum() + complex(body[0], body[1]))
