"""Playback of a motion sequence tick by tick: forward or in reverse, to be stopped at any time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import read_only
from tarsus.control.sequence.sequence import MotionSequence, SequenceSample
from tarsus.control.sequence.stage import GRID
from tarsus.gait.walk_setup import require_number
from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["SequencePlayer"]

# Interval at which joint accelerations are evaluated while the playback rate changes [s].
_INTERVAL = 1e-3
# Shortest time in which the playback rate changes by 1 [s].
_RAMP = 0.05
# Fraction of the greatest joint acceleration that is used; the rest is a reserve for changes within an interval.
_ACCELERATION_FRACTION = 0.98
# Times this close to the end of the sequence count as the end [s].
_END_TOLERANCE = 1e-9


@represented("time", "rate", "stage", "done", "angles")
class SequencePlayer:
    """Plays a motion sequence tick by tick.

    Parameters
    ----------
    sequence : MotionSequence
        The sequence.

    Attributes
    ----------
    time : float
        Current time within the sequence [s].
    rate : float
        Current playback rate: 1 forward, 0 stopped, -1 reverse.

    Notes
    -----
    The playback rate is the time of the sequence that passes per real time, from -1 (reverse) to 1 (forward). It
    changes as fast as the greatest accelerations of all joints allow, and by at most 20 per second. The joints follow
    the same path at any rate.
    """

    def __init__(self, sequence: MotionSequence) -> None:
        self.sequence, self.time = sequence, 0.0
        self.rate = self._target_rate = 1.0
        # Evaluated in advance, so that no tick takes longer when playback brakes.
        self._derivatives = {id(stage): stage.derivatives for stage in sequence.stages}

    @property
    def now(self) -> SequenceSample:
        """Current sample of the sequence."""
        return self.sequence.at(self.time)

    @property
    def angles(self) -> Float[np.ndarray, "legs 3"]:
        """Current joint angles, shape (legs, 3) [rad]."""
        return self.now.angles

    @property
    def stage(self) -> str:
        """Name of the current stage."""
        return self.sequence.stage_at(self.time)[0].name

    @property
    def done(self) -> bool:
        """Whether playback has reached the end of the sequence, or its start in reverse."""
        return self.time <= 0 if self._target_rate < 0 else self.time >= self.sequence.duration

    @property
    def stopped(self) -> bool:
        """Whether the joints are at rest, after `stop` or at the end of playback."""
        return self.done or self.rate == self._target_rate == 0

    def stop(self) -> None:
        """Brake at the greatest joint acceleration and hold the position."""
        self._target_rate = 0.0

    def resume(self) -> None:
        """Play forward."""
        self._target_rate = 1.0

    def reverse(self) -> None:
        """Brake, then play in reverse towards the start of the sequence."""
        self._target_rate = -1.0

    def joints_held(self) -> None:
        """Note that the joints have been held in place: playback continues from rest."""
        self.rate = 0.0

    def step(self, dt: float) -> Float[np.ndarray, "legs 3"]:
        """Advance by a time step and return the joint angles.

        Parameters
        ----------
        dt : float
            Time step [s].

        Returns
        -------
        array, shape (legs, 3)
            Joint angles, read-only [rad].

        Raises
        ------
        InputError
            If `dt` is negative or not finite.
        """
        remaining = require_number("dt", dt, zero=True)
        while remaining > 0 and self.rate != self._target_rate:
            interval = min(remaining, _INTERVAL)
            self._advance(interval, self._rate_change(interval))
            remaining -= interval
        self._advance(remaining, 0.0)
        return read_only(self.angles)

    def _advance(self, dt: float, rate_change: float) -> None:
        """Advance the time of the sequence while the rate changes linearly; the time stops at both ends."""
        time = self.time + (self.rate + rate_change / 2) * dt
        self.rate += rate_change
        end = self.sequence.duration
        if time > end - _END_TOLERANCE:
            self.time = end
        else:
            self.time = 0.0 if time < _END_TOLERANCE and self._target_rate < 0 else max(time, 0.0)

    def _rate_change(self, dt: float) -> float:
        """Return the greatest change of the rate towards its target that the joints allow within `dt`."""
        stage, fraction = self.sequence.stage_at(self.time)
        change = min(max(self._target_rate - self.rate, -dt / _RAMP), dt / _RAMP)
        if not stage.duration:
            return change
        first, second = (_interpolate(values, fraction) for values in self._derivatives[id(stage)])
        speed = first / stage.duration
        curvature = second / stage.duration**2 * self.rate**2
        bound = _ACCELERATION_FRACTION * self.sequence.joint_limits.acceleration
        # Every joint must keep |curvature + speed * change / dt| <= bound; a change of 0 always does.
        with np.errstate(divide="ignore"):
            slope = (bound - np.sign(change) * np.sign(speed) * curvature) / np.abs(speed)
        return math.copysign(min(abs(change), max(float(slope.min()), 0.0) * dt), change)


def _interpolate(values: Float[np.ndarray, "n legs 3"], fraction: float) -> Float[np.ndarray, "legs 3"]:
    """Interpolate values given on `GRID`."""
    position = fraction * (len(GRID) - 1)
    low = min(int(position), len(GRID) - 2)
    return np.asarray(values[low] + (position - low) * (values[low + 1] - values[low]))
