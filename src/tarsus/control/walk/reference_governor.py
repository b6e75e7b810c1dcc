"""Reference governor: how far the twist may change so that standing feet stay in their workspaces until they lift off.

I. Kolmanovsky, E. Garone, S. Di Cairano, "Reference and command governors", American Control Conference 2014: the
target moves from its present value towards the command as far as the predicted walk, with the target held constant,
stays within bounds. What was feasible in the last tick is feasible again, so that a feasible target always exists.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.filters import integral_factors
from tarsus.control.walk.state import ROUNDING, GaitState
from tarsus.gait.foot_polygons import NORMALS

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["FootPrediction"]

# Fractions of the path to the command that are tried; fractions to which an infeasible present target is reduced.
_FRACTIONS = np.array([0.0, 0.002, 0.006, 0.02, 0.06, 0.12, 0.22, 0.36, 0.55, 0.8, 1.0])[:, None]
_REDUCTIONS = np.array([0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 1.0])[:, None]
# How much farther outside its polygon a foot may get that would be outside even with a target of 0 [m].
_SLACK = 0.005
# Times within a stance at which its foot is examined, as fractions.
_TIMES = np.array([0.0, 0.5, 1.0])[:, None]
_NORMALS = np.stack([NORMALS.real, NORMALS.imag])
# Added to an angle to avoid a division by 0 [rad].
_NO_ANGLE = 1e-30


class FootPrediction(NamedTuple):
    """Prediction of the feet in the heading frame for any target of the twist, at three times, shape (..., 3, legs).

    The integral of a critically damped filter is linear in target, value and rate (see `integral_factors`): `of_target`
    is the factor of the target, `travel` is the part of value and rate, shape (3, ..., 1, 3, legs).

    Attributes
    ----------
    seen : complex array, shape (legs,)
        Where the feet stand, or will be put down, in the heading frame [m].
    of_target, travel : array
        The factor [s], and the part [m, m, rad].
    """

    seen: Complex[np.ndarray, "legs"]
    of_target: Float[np.ndarray, "*batch 1 3 legs"]
    travel: Float[np.ndarray, "3 *batch 1 3 legs"]

    @classmethod
    def of(
        cls,
        state: GaitState,
        begins: Float[np.ndarray, "*#batch legs"],
        ends: Float[np.ndarray, "*#batch legs"],
        bandwidth: float,
    ) -> FootPrediction:
        """Predict the feet over the interval for which each one stands.

        Parameters
        ----------
        state : GaitState
            The gait state.
        begins, ends : array, shape (..., legs)
            Start and end of the time for which each foot stands where it is, or where it will be put down [s].
        bandwidth : float
            Bandwidth with which the twist follows its target [rad/s].
        """
        begins = begins[..., None, None, :]
        times = begins + (ends[..., None, None, :] - begins) * _TIMES
        of_target, of_value, of_rate = integral_factors(times, bandwidth=bandwidth)
        axes = (3, *(1,) * times.ndim)
        travel = state.twist.value.reshape(axes) * of_value
        travel += state.twist.rate.reshape(axes) * of_rate
        return cls(state.in_heading(state.foothold), of_target, travel)

    def excess(
        self, targets: Float[np.ndarray, "n 3"], bounds: Float[np.ndarray, "legs 16"]
    ) -> Float[np.ndarray, "*batch n 3 legs 16"]:
        """Return how far each foot will be outside each side of its polygon, with a constant target of the twist.

        Parameters
        ----------
        targets : array, shape (n, 3)
            Targets of the twist.
        bounds : array, shape (legs, 16)
            Sides of the polygons [m].

        Returns
        -------
        array, shape (..., n, 3, legs, 16)
            At the start, in the middle and at the end of that time [m]; negative inside.
        """
        driven = targets.T[(slice(None), *(None,) * (self.of_target.ndim - 3), ..., None, None)]
        x, y, angle = driven * self.of_target + self.travel
        # A travel (x, y) that turns by an angle ends at (x + iy) exp(i angle / 2) sin(angle / 2) / (angle / 2).
        half = angle * -0.5
        half += np.copysign(_NO_ANGLE, half)
        back, travel = np.empty(half.shape, dtype=complex), np.empty(half.shape, dtype=complex)
        np.cos(half, out=back.real)
        np.sin(half, out=back.imag)
        chord = back.imag / half
        np.multiply(x, chord, out=travel.real)
        np.multiply(y, chord, out=travel.imag)
        place = self.seen * back
        place -= travel
        place *= back
        out: np.ndarray = (place.view(float).reshape(-1, 2) @ _NORMALS).reshape(*place.shape, -1)
        out -= bounds
        return out

    def governed_twist(
        self, current: Float[np.ndarray, "3"], command: Float[np.ndarray, "3"], bounds: Float[np.ndarray, "legs 16"]
    ) -> Float[np.ndarray, "3"]:
        """Return a feasible target on the path from the current one to the command; the command where it is feasible.

        The largest feasible one of some fractions of the path is taken. Repeated tick after tick, it comes as close as
        0.2 % of the remaining path.

        Parameters
        ----------
        current, command : array, shape (3,)
            The present target of the twist, and the commanded one.
        bounds : array, shape (legs, 16)
            Sides of the polygons [m].

        Returns
        -------
        array, shape (3,)
            The target; where not even the current one is feasible, a reduction of it.
        """
        unchanged = command.tolist() == current.tolist()
        targets = command[None] if unchanged else current + _FRACTIONS * (command - current)
        if (last := _last_feasible(self.excess(targets, bounds))) is not None:
            return command if last == len(targets) - 1 else np.asarray(targets[last])
        reduced = _REDUCTIONS * current
        over = self.excess(reduced, bounds)
        if (last := _last_feasible(over)) is not None:
            return np.asarray(reduced[last])
        # A foot that is outside already, such as one put down before an obstacle, may not get farther out.
        if (last := _last_feasible(self.excess(targets, bounds + over[0, 0].clip(0.0)))) is not None:
            return np.asarray(targets[last])
        # A foot that gets outside even if the walk stops may get slightly farther out, as it lifts off soon.
        return np.asarray(reduced[_last_feasible(over - over[0].max(axis=0).clip(0.0) - _SLACK) or 0])


def _last_feasible(excess: Float[np.ndarray, "n 3 legs 16"]) -> int | None:
    """Return the index of the last target with which every foot stays in its polygon."""
    feasible: list[bool] = (np.maximum.reduce(excess, axis=(1, 2, 3)) <= ROUNDING).tolist()
    return len(feasible) - 1 - feasible[::-1].index(True) if True in feasible else None
