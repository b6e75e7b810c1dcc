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
        self.behind, self.rate, self._offset = 0.0, 0.0, 0.0
        self._yaw: float | None = None

    def step(self, valid: ValidReadings, commanded: float, dt: float, *, yaw: float, rests: bool) -> None:
        """Take in angular rates.

        Parameters
        ----------
        valid : ValidReadings
            The readings; without angular rates, nothing is made up for.
        commanded, dt : float, float
            Rate at which the walk turns [rad/s]; time since the last step [s].
        yaw : float
            Of the body in the heading frame, as commanded [rad]: turning there is no error.
        rests : bool
            Whether the robot is to stand still: it does not turn then, and what is measured is the offset of the rates.
        """
        turned, self._yaw = 0.0 if self._yaw is None else yaw - self._yaw, yaw
        if valid.angular_rates is None:
            self.behind = self.rate = 0.0
            return
        (roll, pitch), (_, about_y, about_z) = valid.attitude or (0.0, 0.0), valid.angular_rates
        measured = (math.sin(roll) * about_y + math.cos(roll) * about_z) / math.cos(pitch) - turned / dt
        if rests:
            self.rate, self.behind = 0.0, self.behind * (1 - dt / _MEMORY)
            if abs(measured) < _STILL:
                self._offset += min(dt / _LEARNS, 1.0) * (measured - self._offset)
            return
        measured -= self._offset
        behind = (self.behind + (commanded - measured) * dt) * (1 - dt / _MEMORY)
        self.behind = min(max(behind, -_FARTHEST), _FARTHEST)
        wanted = min(max(_GAIN * self.behind, -_MOST), _MOST)
        self.rate += min(max(wanted - self.rate, -_CHANGE * dt), _CHANGE * dt)

    def forget(self) -> None:
        """Forget what is missing, and how the body was turned: the robot is carried."""
        self.behind = self.rate = 0.0
        self._yaw = None
