"""Plays a sequence tick by tick; can brake at any moment, go on, or go back."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.sequence.sequence import MotionSequence, SequenceSample
from tarsus.control.sequence.stage import GRID
from tarsus.errors import InputError
from tarsus.kinematics.pose import Pose

__all__ = ["SequencePlayer"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# While the pace changes, joint accelerations are looked at this often [s].
_LOOK = 1e-3
# The pace changes from standing to full at most within this time [s].
_RAMP = 0.05
# Of the joints' greatest acceleration, the share that is used: between two looks it changes.
_SHARE = 0.98
# What is this near to the end of the way is at its end [s].
_AT_END = 1e-9


class SequencePlayer:
    """Plays a sequence: each step gives the next joint angles.

    Parameters
    ----------
    sequence : Sequence
        What to play.

    Notes
    -----
    The sequence's time passes at a pace from -1 (back) to 1 (on). Between two paces it changes as fast as every
    joint's greatest acceleration lets it, at most by 20 a second: the joints keep to their path, whatever the pace.
    """

    def __init__(self, sequence: MotionSequence) -> None:
        self.sequence = sequence
        self._time = 0.0
        self._pace = 1.0
        self._wanted = 1.0
        # Worked out now, so that no tick has to wait for it when it comes to braking.
        self._tables = {id(stage): stage.table for stage in sequence.stages}

    @property
    def time(self) -> float:
        """How far in the sequence it is [s]."""
        return self._time

    @property
    def pace(self) -> float:
        """How fast the sequence's time passes: 1 on, 0 stopped, -1 back."""
        return self._pace

    @property
    def now(self) -> SequenceSample:
        """What the robot does now."""
        return self.sequence.at(self._time)

    @property
    def angles(self) -> Floats:
        """The joint angles now ``(legs, 3)`` [rad]."""
        return self.now.angles

    @property
    def contacts(self) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """The feet on the ground now ``(legs,)``."""
        return self.now.contacts

    @property
    def body(self) -> Pose:
        """The body's pose in G now."""
        return self.now.body

    @property
    def stage(self) -> str:
        """The name of the stage that is being played."""
        return self.sequence.stage_at(self._time)[0].name

    @property
    def done(self) -> bool:
        """Whether it is at the end of its way: the sequence's end, or its start where it goes back."""
        return self._time <= 0 if self._wanted < 0 else self._time >= self.sequence.duration

    @property
    def stopped(self) -> bool:
        """Whether nothing moves, by `stop` or because it is done."""
        return self.done or self._pace == self._wanted == 0

    def stop(self) -> None:
        """Brake, as fast as the joints may, and stay there."""
        self._wanted = 0.0

    def resume(self) -> None:
        """Go on towards the sequence's end."""
        self._wanted = 1.0

    def go_back(self) -> None:
        """Brake and go back the way it came, to the sequence's start."""
        self._wanted = -1.0

    def step(self, dt: float) -> Floats:
        """Return the joint angles a tick later.

        Parameters
        ----------
        dt : float
            How much later [s].

        Returns
        -------
        array, shape (legs, 3)
            Joint angles, read-only [rad].

        Raises
        ------
        InputError
            If `dt` is negative or not a finite number.
        """
        if not 0 <= dt < math.inf:
            raise InputError(f"dt is {dt} s; it must be a finite number, not negative")
        left = float(dt)
        while left > 0 and self._pace != self._wanted:
            piece = min(left, _LOOK)
            self._advance(piece, self._change(piece))
            left -= piece
        self._advance(left, 0.0)
        angles = self.angles
        angles.setflags(write=False)
        return angles

    def _advance(self, dt: float, change: float) -> None:
        """Let time pass, with the pace changing evenly; at either end of the sequence everything stands."""
        time = self._time + (self._pace + change / 2) * dt
        self._pace += change
        end = self.sequence.duration
        # Many small steps may end a rounding before the end.
        self._time = end if time > end - _AT_END else 0.0 if time < _AT_END and self._wanted < 0 else max(time, 0.0)

    def _change(self, dt: float) -> float:
        """Return by how much the pace may change within `dt`."""
        sequence = self.sequence
        stage, share = sequence.stage_at(self._time)
        command = min(max(self._wanted - self._pace, -dt / _RAMP), dt / _RAMP)
        if not stage.duration:
            return command
        first, second = (_between(values, share) for values in self._tables[id(stage)][1:])
        speed = first / stage.duration
        bend = second / stage.duration**2 * self._pace**2
        most = _SHARE * sequence.pace.acceleration
        # |bend + speed * change / dt| <= most, for every joint; changing nothing is always within it.
        with np.errstate(divide="ignore"):
            room = (most - np.sign(command) * np.sign(speed) * bend) / np.abs(speed)
        return math.copysign(min(abs(command), max(float(room.min()), 0.0) * dt), command)


def _between(values: Floats, share: float) -> Floats:
    """Interpolate a table over `GRID`."""
    at = share * (len(GRID) - 1)
    low = min(int(at), len(GRID) - 2)
    found: Floats = values[low] + (at - low) * (values[low + 1] - values[low])
    return found
