"""Heading feedback: turns the body back by what it has turned more than commanded, by the measured angular rates."""

from __future__ import annotations

import math

from tarsus.control.readings import ValidReadings

__all__ = ["HeadingFeedback"]

# Gain [1/s], greatest rate [rad/s], its greatest change [rad/s^2], and what is made up for at most [rad].
_GAIN, _MOST, _CHANGE, _FARTHEST = 1.0, 0.15, 0.5, 0.5
# Time in which the difference is forgotten, and in which the offset of the rates is learnt at rest [s].
_MEMORY, _LEARNS = 10.0, 1.0
# A body at rest turns more slowly than this, offset included [rad/s].
_STILL = 0.02
# How long rates may be missing until what is made up for is forgotten [s].
_HOLDS = 0.3


class HeadingFeedback:
    """Keeps the body on its heading: on rough ground feet slip, and the body turns.

    Attributes
    ----------
    behind : float
        By how much the body has turned less than commanded, to the left [rad].
    rate : float
        How fast the body is to turn over its standing feet to make up for that [rad/s].
    """

    def __init__(self) -> None:
        self.behind, self.rate, self._offset, self._unmeasured = 0.0, 0.0, 0.0, 0.0

    def step(self, valid: ValidReadings, commanded: float, dt: float, *, rests: bool, still: bool) -> None:
        """Take in angular rates.

        Parameters
        ----------
        valid : ValidReadings
            The readings; without angular rates for longer than a moment, nothing is made up for.
        commanded, dt : float, float
            Rate at which the body is to turn, by the walk and by its pose [rad/s]; time since the last step [s].
        rests : bool
            Whether the robot is to stand still: it does not turn then.
        still : bool
            Whether neither feet nor body move any more: what is measured then is the offset of the rates.
        """
        if valid.angular_rates is None:
            self._unmeasured += dt
            if self._unmeasured > _HOLDS or rests:
                self.forget()
            return
        self._unmeasured = 0.0
        (roll, pitch), (_, about_y, about_z) = valid.attitude or (0.0, 0.0), valid.angular_rates
        faster = (math.sin(roll) * about_y + math.cos(roll) * about_z) / math.cos(pitch) - commanded
        if rests:
            self.rate, self.behind = 0.0, self.behind * (1 - dt / _MEMORY)
            if still and abs(faster) < _STILL:
                self._offset += min(dt / _LEARNS, 1.0) * (faster - self._offset)
            return
        behind = (self.behind - (faster - self._offset) * dt) * (1 - dt / _MEMORY)
        self.behind = min(max(behind, -_FARTHEST), _FARTHEST)
        wanted = min(max(_GAIN * self.behind, -_MOST), _MOST)
        self.rate += min(max(wanted - self.rate, -_CHANGE * dt), _CHANGE * dt)

    def forget(self) -> None:
        """Forget what is missing: the robot is carried."""
        self.behind = self.rate = 0.0
