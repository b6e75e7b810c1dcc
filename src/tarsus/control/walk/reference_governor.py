"""Reference governor: how far the twist may change so that standing feet stay in their workspaces until they lift off.

I. Kolmanovsky, E. Garone, S. Di Cairano, "Reference and command governors", American Control Conference 2014: the
target moves from its present value towards the command as far as the predicted walk, with the target held constant,
stays within bounds. What was feasible in the last tick is feasible again, so that a feasible target always exists.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.filters import integral_factors
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.step_timing import StepTiming
from tarsus.gait.foot_polygons import NORMALS
from tarsus.gait.gait import Gait
from tarsus.gait.stance.velocity_limits import stance_overhang

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["FootPrediction", "lift_delays", "stance_intervals", "time_to_touchdown"]

# Rounding of a distance [m].
_TOLERANCE = 1e-9
# Fractions of the path to the command that are tried, and fractions of a target that is no longer feasible.
_FRACTIONS = np.array([0.0, 0.002, 0.006, 0.02, 0.06, 0.12, 0.22, 0.36, 0.55, 0.8, 1.0])[:, None]
_REDUCTIONS = np.array([0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 1.0])[:, None]
# How much farther out a foot may get that would be outside with the twist 0 as well [m].
_SLACK = 0.005
# Times within a stance at which its foot is examined, as fractions.
_TIMES = np.array([0.0, 0.5, 1.0])[:, None]
_NORMALS = np.stack([NORMALS.real, NORMALS.imag])
# Added to an angle so that it can be divided by.
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
        """Predict for feet that stand for an interval.

        Parameters
        ----------
        state : GaitState
            The gait state.
        begins, ends : array, shape (..., legs)
            From when until when the foot stands where it is, or where it will be put down [s].
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
        # A foot that is outside already, as one that is put down before an obstacle, may not get farther out.
        if (last := _last_feasible(self.excess(targets, bounds + over[0, 0].clip(0.0)))) is not None:
            return np.asarray(targets[last])
        # One that gets outside even if the walk stops may get a little farther out, as it lifts off soon.
        return np.asarray(reduced[_last_feasible(over - over[0].max(axis=0).clip(0.0) - _SLACK) or 0])


def _last_feasible(excess: Float[np.ndarray, "n 3 legs 16"]) -> int | None:
    """Return the index of the last target with which every foot stays in its polygon."""
    feasible: list[bool] = (np.maximum.reduce(excess, axis=(1, 2, 3)) <= _TOLERANCE).tolist()
    return len(feasible) - 1 - feasible[::-1].index(True) if True in feasible else None


def stance_intervals(
    state: GaitState, timing: StepTiming
) -> tuple[Float[np.ndarray, "legs"], Float[np.ndarray, "legs"]]:
    """Return from when until when each foot stands where it is, or where it will be put down: shape (legs,) each [s].

    Parameters
    ----------
    state, timing : GaitState, StepTiming
        The gait state; the gait and its frequency.
    """
    gait, frequency = timing
    duty_factor = gait.duty_factor
    over = (stance_overhang(duty_factor) - 0.5) * duty_factor / frequency
    touchdown = np.asarray(gait.offsets) + state.step_number - state.clock
    # A foot that has met the ground before its planned touchdown is where it may be from then on. One that waits
    # already is past its lift-off: on ground that is felt, feet often wait for a tick or two until others have landed,
    # which is taken from the time in which they fall behind after lift-off.
    waits, least = (touchdown.clip(0.0) / frequency, 0.0) if state.felt else (0.0, over)
    begins = np.where(state.down, waits, time_to_touchdown(state, timing))
    lift_off = np.maximum((touchdown + duty_factor) / frequency + over, least)
    return begins, np.where(state.down, lift_off, begins + duty_factor / frequency + over)


def time_to_touchdown(state: GaitState, timing: StepTiming) -> Float[np.ndarray, "legs"]:
    """Return the time until each foot touches down: array, shape (legs,) [s]."""
    return np.where(state.down, 0.0, (1 - state.swing_phase) * (1 - timing.gait.duty_factor) / timing.frequency)


def lift_delays(gait: Gait, cycle_time: float) -> Float[np.ndarray, "legs legs"]:
    """Return how long each foot stands at the start of a gait, with all feet down: array, shape (legs, legs) [s].

    Parameters
    ----------
    gait, cycle_time : Gait, float
        Order of the steps; duration of a cycle [s].

    Returns
    -------
    array
        For each leg, in each row for the row's leg lifting off first.
    """
    offsets = np.asarray(gait.offsets)
    over = (stance_overhang(gait.duty_factor) - 0.5) * gait.duty_factor
    return np.asarray(((offsets - offsets[:, None]) % 1 + over) * cycle_time)
