"""Heading feedback: turns the body back to its commanded heading, from measured angular rates."""

from __future__ import annotations

import math

from tarsus.control.readings import ValidReadings

__all__ = ["HeadingFeedback"]

# Gain [1/s], greatest rate [rad/s], its greatest change [rad/s^2], and greatest heading error that is kept [rad].
_GAIN, _MOST, _CHANGE, _FARTHEST = 1.0, 0.15, 0.5, 0.5
# Time constants with which the heading error is forgotten, and with which the rates' offset is learnt at rest [s].
_MEMORY, _LEARNS = 10.0, 1.0
# A body at rest is measured to turn more slowly than this, the offset of the rates included [rad/s].
_STILL = 0.02
# How long rates may be missing until the heading error is forgotten [s].
_HOLDS = 0.3


class HeadingFeedback:
    """Keeps the body on its heading, from which it turns where feet slip on rough ground.

    Attributes
    ----------
    behind : float
        Heading error: by how much less than commanded the body has turned to the left [rad].
    rate : float
        How fast the body is to turn over its standing feet to correct it [rad/s].
    """

    def __init__(self) -> None:
        self.behind, self.rate, self._offset, self._unmeasured = 0.0, 0.0, 0.0, 0.0

    def step(self, valid: ValidReadings, commanded: float, dt: float, *, rests: bool, still: bool) -> None:
        """Take in angular rates.

        Parameters
        ----------
        valid : ValidReadings
            The readings; once angular rates have been missing for longer than a moment, nothing is corrected.
        commanded, dt : float, float
            Rate at which the body is to turn, by the walk and by its pose [rad/s]; time since the last step [s].
        rests : bool
            Whether the robot is to stand still: it does not turn then.
        still : bool
            Whether feet and body have stopped moving, so that what is measured is the offset of the rates.
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
        """Forget the heading error, as for a robot that is carried."""
        self.behind = self.rate = 0.0
