"""Velocity limits of a stance: the polygons in which its feet may be, and the twists that keep them there."""

from __future__ import annotations

import dataclasses
import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.gait.foot_polygons import NORMALS, NORMALS_CONJUGATE
from tarsus.gait.swing import horizontal_profile

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["VelocityLimits", "stance_overhang", "with_stroke_limits"]


# Fraction of the polygons that the fastest steady walk uses.
_USED_FRACTION = 0.99


@dataclass(frozen=True, eq=False)
class VelocityLimits:
    """Polygons in which the feet may be in all of one or more stances, and the twists that they allow.

    Attributes
    ----------
    bounds : array, shape (legs, 16)
        Sides of the feet's polygons, distances from the heading frame's origin along `NORMALS` [m].
    margins : array, shape (legs, 16)
        Distances from the rest footholds to the sides along `NORMALS` [m]; negative if a rest foothold is infeasible.
    rest : complex array, shape (legs,)
        Rest footholds of the last stance [m].
    balanced : bool
        Whether the centre of mass is inside the support polygons with the feet at their rest footholds.
    stroke, turning : float
        Longest strokes that the joints are fast enough for, walking straight and turning on the spot [m].
    shift : complex array, shape (7,), or None
        Coefficients of the body shift with which these limits hold [m]; None without a shift.
    """

    bounds: Float[np.ndarray, "legs 16"]
    margins: Float[np.ndarray, "legs 16"]
    rest: Complex[np.ndarray, "legs"]
    balanced: bool = True
    stroke: float = math.inf
    turning: float = math.inf
    shift: Complex[np.ndarray, "7"] | None = None

    @property
    def feasible(self) -> bool:
        """Whether every foot can be at its rest foothold."""
        return bool((self.margins >= 0).all())

    @property
    def limiting_leg(self) -> int:
        """Index of the leg with the smallest margin."""
        return int(self.margins.min(-1).argmin())

    def intersection(self, other: VelocityLimits) -> VelocityLimits:
        """Return the intersection of these limits with others.

        Parameters
        ----------
        other : VelocityLimits
            The other limits.
        """
        return VelocityLimits(
            np.minimum(self.bounds, other.bounds),
            np.minimum(self.margins, other.margins),
            self.rest,
            self.balanced and other.balanced,
            min(self.stroke, other.stroke),
            min(self.turning, other.turning),
            self.shift,
        )

    def feasible_fraction(
        self, twist: Float[np.ndarray, "3"], *, stance_time: float, duty_factor: float
    ) -> tuple[float, int]:
        """Return the largest multiple of a twist that can be walked steadily, and the leg that limits it.

        Parameters
        ----------
        twist : array, shape (3,)
            Forward [m/s], left [m/s], turning [rad/s].
        stance_time : float
            Duration of a stance [s].
        duty_factor : float
            Duty factor.

        Returns
        -------
        fraction : float
            At least 0; above 1 if the robot could walk faster.
        leg : int
            Index of the limiting leg.
        """
        # Very large twists are scaled down so that squares do not overflow.
        scale = max(1.0, float(np.abs(twist).max()))
        forward, left, turn = (np.asarray(twist) / scale).tolist()
        fraction = self._fraction_by_side(
            complex(forward, left), turn, stance_overhang(duty_factor) * stance_time / _USED_FRACTION
        )
        worst = int(fraction.argmin())
        straight, turning = math.hypot(forward, left), abs(turn)
        fastest = 1 / max(self._speed_usage(straight, turning, stance_time), _LEAST)
        return min(float(fraction.flat[worst]), fastest) / scale, worst // len(NORMALS)

    def feasible_fractions(
        self, twists: Float[np.ndarray, "n 3"], *, stance_time: float, duty_factor: float
    ) -> Float[np.ndarray, "n"]:
        """Return the largest multiple of each of some twists that can be walked steadily.

        Parameters
        ----------
        twists : array, shape (n, 3)
            Forward [m/s], left [m/s], turning [rad/s]; not extremely large.
        stance_time : float
            Duration of a stance [s].
        duty_factor : float
            Duty factor.

        Returns
        -------
        array, shape (n,)
            As in `feasible_fraction`.
        """
        straight, turn = twists[:, :1] + 1j * twists[:, 1:2], twists[:, 2:]
        fraction = self._fraction_by_side(
            straight, turn, stance_overhang(duty_factor) * stance_time / _USED_FRACTION
        ).min(axis=(-2, -1))
        usage = self._speed_usage(np.abs(straight), np.abs(turn), stance_time)[:, 0]
        return np.asarray(np.minimum(fraction, 1 / np.maximum(usage, _LEAST)))

    def _fraction_by_side(
        self,
        straight: Complex[np.ndarray, "*#batch"] | complex,
        turn: Float[np.ndarray, "*#batch"] | float,
        ahead: float,
    ) -> Float[np.ndarray, "... legs 16"]:
        """Return the multiple of a twist that each side allows ``(..., legs, 16)``, for a time ahead and behind [s]."""
        # An arc to either side of the rest foothold, to second order along and across: an upper bound, as sin x < x and
        # 1 - cos x < x^2 / 2.
        path = (straight + 1j * turn * self.rest) * ahead
        along = np.abs((NORMALS_CONJUGATE * path[..., None]).real)
        across = np.maximum((NORMALS_CONJUGATE * (0.5j * turn * ahead * path)[..., None]).real, 0.0)
        return _positive_root(across, along, np.maximum(self.margins, 0.0))

    def _speed_usage(self, straight: Any, turning: Any, stance_time: float) -> Any:
        """Return the used fraction of the joints' speed, the sum of that for walking straight and for turning."""
        outermost = float(np.abs(self.rest).max())
        by_stroke, by_turning = (stance_time / max(longest, _LEAST) for longest in (self.stroke, self.turning))
        return straight * by_stroke + turning * outermost * by_turning


# Lower bound of divisors.
_LEAST = 1e-12


def _positive_root(
    a: Float[np.ndarray, "*batch legs 16"], b: Float[np.ndarray, "*batch legs 16"], c: Float[np.ndarray, "legs 16"]
) -> Float[np.ndarray, "*batch legs 16"]:
    """Return the root of ``a x^2 + b x = c`` for non-negative numbers; a very large one where a and b are 0."""
    bounded = np.minimum(c, 1e3)
    return np.asarray(2 * bounded / np.maximum(b + np.sqrt(b * b + 4 * a * bounded), _LEAST))


@functools.cache
def stance_overhang(duty_factor: float) -> float:
    """Return the greatest distance of a foot from its rest foothold in steady walking, over the stroke.

    It is a little more than 1/2: after lift-off a foot still falls behind until it is as fast as the body.

    Parameters
    ----------
    duty_factor : float
        Duty factor.
    """
    phase = np.linspace(0, 0.5, 51)
    ratio = (1 - duty_factor) / duty_factor
    return float((0.5 + ratio * phase - (1 + ratio) * horizontal_profile(phase)).max())


def with_stroke_limits(limits: VelocityLimits, stroke: float, turning: float, *, duty_factor: float) -> VelocityLimits:
    """Return the limits with strokes that the joints are fast enough for.

    Parameters
    ----------
    limits : VelocityLimits
        Limits due to the legs' reach.
    stroke, turning : float
        Longest strokes walking straight and turning on the spot [m].
    duty_factor : float
        Duty factor.
    """
    at_rest = (NORMALS_CONJUGATE * limits.rest[:, None]).real
    bounds = np.minimum(limits.bounds, at_rest + stance_overhang(duty_factor) * max(stroke, turning))
    # Legs that do not step stay without bounds.
    bounds = np.where(np.isinf(limits.bounds), np.inf, bounds)
    return dataclasses.replace(limits, bounds=bounds, stroke=stroke, turning=turning)
