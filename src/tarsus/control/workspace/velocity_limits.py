"""What the robot can do while it walks as it stands now: where its feet may be, and how fast it may move."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.control.incremental import Incremental
from tarsus.control.workspace.foot_workspace import foot_workspace
from tarsus.control.workspace.polygon import NORMALS, NORMALS_CONJUGATE
from tarsus.control.workspace.stability import StabilityCheck
from tarsus.control.workspace.stance_geometry import StanceGeometry
from tarsus.gait.swing import ground_share
from tarsus.robot.robot import Robot

__all__ = ["VelocityLimits", "stance_overhang", "velocity_limits", "with_stroke_limits"]

Floats = np.ndarray[Any, Any]

# What is left between the fastest steady walk and the polygons.
_RESERVE = 0.99


@dataclass(frozen=True, eq=False)
class VelocityLimits:
    """Where the feet may be in all of some stands, and what twists that allows.

    Attributes
    ----------
    bounds : array, shape (legs, 16)
        Sides of the feet's polygons, from the heading frame's origin along `NORMALS` [m].
    margins : array, shape (legs, 16)
        How far a foot may go from its rest foothold along `NORMALS` [m]; negative where it can't even be there.
    rest : complex array, shape (legs,)
        Rest footholds of the last stand [m].
    balanced : bool
        Whether the centre of mass stays over the feet that bear, while they are at their rest footholds.
    stroke, turning : float
        The longest strokes, straight on and on the spot, for which the joints are fast enough [m].
    """

    bounds: Floats
    margins: Floats
    rest: Floats
    balanced: bool = True
    stroke: float = math.inf
    turning: float = math.inf

    @property
    def feasible(self) -> bool:
        """Whether every foot can be at its rest foothold."""
        return bool((self.margins >= 0).all())

    @property
    def limiting_leg(self) -> int:
        """The leg with the least room."""
        return int(self.margins.min(-1).argmin())

    def intersection(self, other: VelocityLimits) -> VelocityLimits:
        """Return what is possible in both.

        Parameters
        ----------
        other : VelocityLimits
            The other.
        """
        return VelocityLimits(
            np.minimum(self.bounds, other.bounds),
            np.minimum(self.margins, other.margins),
            self.rest,
            self.balanced and other.balanced,
            min(self.stroke, other.stroke),
            min(self.turning, other.turning),
        )

    def feasible_fraction(
        self, twist: Floats, *, stance_time: float, duty_factor: float, hold: float = 0.0
    ) -> tuple[float, int]:
        """Return how much of a twist the robot can walk at for good, and which leg stops it.

        Parameters
        ----------
        twist : array, shape (3,)
            Forward [m/s], left [m/s], turning [rad/s].
        stance_time : float
            How long a foot stays on the ground [s].
        duty_factor : float
            Duty factor.
        hold : float
            How much longer than that it may have to wait there [s].

        Returns
        -------
        share : float
            From 0 up; above 1 where it could walk faster.
        leg : int
            The leg that allows no more.
        """
        # Of a wish without measure, as much as can be reckoned with.
        scale = max(1.0, float(np.abs(twist).max()))
        forward, left, turn = (np.asarray(twist) / scale).tolist()
        share = self._share_by_side(
            complex(forward, left), turn, (stance_overhang(duty_factor) * stance_time + hold) / _RESERVE
        )
        worst = int(share.argmin())
        straight, turning = math.hypot(forward, left), abs(turn)
        fastest = 1 / max(self._strain(straight, turning, stance_time), _LEAST)
        return min(float(share.flat[worst]), fastest) / scale, worst // len(NORMALS)

    def feasible_fractions(self, twists: Floats, *, stance_time: float, duty_factor: float) -> Floats:
        """Return how much of each of some twists the robot can walk at for good, as `feasible_fraction`.

        Parameters
        ----------
        twists : array, shape (n, 3)
            Forward [m/s], left [m/s], turning [rad/s]; none is beyond all measure.
        stance_time : float
            How long a foot stays on the ground [s].
        duty_factor : float
            Duty factor.

        Returns
        -------
        array, shape (n,)
            Shares from 0 up.
        """
        straight, turn = twists[:, :1] + 1j * twists[:, 1:2], twists[:, 2:]
        share = self._share_by_side(straight, turn, stance_overhang(duty_factor) * stance_time / _RESERVE).min(
            axis=(-2, -1)
        )
        strain = self._strain(np.abs(straight), np.abs(turn), stance_time)[:, 0]
        return np.asarray(np.minimum(share, 1 / np.maximum(strain, _LEAST)))

    def _share_by_side(self, straight: Floats | complex, turn: Floats | float, ahead: float) -> Floats:
        """Return how much of a twist each side allows ``(..., legs, 16)``, so many seconds ahead and back."""
        # An arc to either side of the rest foothold: to the second order along and across the way, and less than that
        # in truth, as sin x < x and 1 - cos x < x^2 / 2.
        way = (straight + 1j * turn * self.rest) * ahead
        along = np.abs((NORMALS_CONJUGATE * way[..., None]).real)
        across = np.maximum((NORMALS_CONJUGATE * (0.5j * turn * ahead * way)[..., None]).real, 0.0)
        return _positive_root(across, along, np.maximum(self.margins, 0.0))

    def _strain(self, straight: Any, turning: Any, stance_time: float) -> Any:
        """Return how much of the joints' speed is taken: what straight on and turning ask of them adds up."""
        outermost = float(np.abs(self.rest).max())
        by_stroke, by_turning = (stance_time / max(longest, _LEAST) for longest in (self.stroke, self.turning))
        return straight * by_stroke + turning * outermost * by_turning


# What may be divided by.
_LEAST = 1e-12


def _positive_root(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return where ``a x^2 + b x = c``, of numbers that are not negative; very far out where both are 0."""
    bounded = np.minimum(c, 1e3)
    return np.asarray(2 * bounded / np.maximum(b + np.sqrt(b * b + 4 * a * bounded), _LEAST))


@functools.cache
def stance_overhang(duty_factor: float) -> float:
    """Return how far a foot is from its rest foothold at most in steady walking, over the stroke: 1/2 and a little.

    Until it gathers speed, a foot that is lifted stays behind.

    Parameters
    ----------
    duty_factor : float
        Duty factor.
    """
    share = np.linspace(0, 0.5, 51)
    ratio = (1 - duty_factor) / duty_factor
    return float((0.5 + ratio * share - (1 + ratio) * ground_share(share)).max())


def with_stroke_limits(limits: VelocityLimits, stroke: float, turning: float, *, duty_factor: float) -> VelocityLimits:
    """Return the envelope for joints that allow no longer strokes.

    Parameters
    ----------
    limits : VelocityLimits
        What the legs' reach allows.
    stroke, turning : float
        The longest strokes straight on and on the spot [m].
    duty_factor : float
        Duty factor.
    """
    at_rest = (NORMALS_CONJUGATE * limits.rest[:, None]).real
    bounds = np.minimum(limits.bounds, at_rest + stance_overhang(duty_factor) * max(stroke, turning))
    # Legs that don't step are bounded by nothing here.
    bounds = np.where(np.isinf(limits.bounds), np.inf, bounds)
    return dataclasses.replace(limits, bounds=bounds, stroke=stroke, turning=turning)


def velocity_limits(
    robot: Robot,
    stands: Sequence[StanceGeometry],
    sets: Floats,
    *,
    foot_distance: float,
    excluded: tuple[int, ...] = (),
) -> Incremental[VelocityLimits]:
    """Work out what is possible in all of some stands, in parts.

    Parameters
    ----------
    robot : Robot
        A single robot.
    stands : sequence of Stand
        At least one; the last is the one that stays.
    sets : array of bool, shape (n, legs)
        Feet that are down together.
    foot_distance : float
        Least distance between two feet [m].
    excluded : tuple of int
        Legs that don't step: where they are is not bounded here, but may shift the centre of mass.
    """
    bounds = np.full((robot.legs, len(NORMALS)), np.inf)
    room = np.full(bounds.shape, np.inf)
    balance, balanced = StabilityCheck(robot, sets, excluded), True
    for stand in stands:
        sides = yield from foot_workspace(robot, stand, foot_distance=foot_distance)
        centre, shift = balance.centre_of_mass(stand, sides)
        yield
        share = balance.safe_fraction(stand, sides, centre, shift)
        at_rest = (NORMALS_CONJUGATE * stand.rest[:, None]).real
        free = sides - at_rest
        free = np.where(free > 0, free * share, free)
        # Where a centre of mass stands outside, no step is safe.
        free = free if share > 0 else np.minimum(free, -1e-3)
        balanced = balanced and share > 0
        bounds, room = np.minimum(bounds, at_rest + free), np.minimum(room, free)
        yield
    bounds[list(excluded)], room[list(excluded)] = np.inf, np.inf
    return VelocityLimits(bounds, room, stands[-1].rest, balanced)
