"""Channels of sensor readings: parts are rejected, and accepted again once they have settled; those of the body."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, TypeVar

from tarsus.control.readings import RollPitch, Vector
from tarsus.control.sensing.plain_values import as_items, as_number, as_vector

__all__ = ["SETTLED", "AngularRateChannel", "AttitudeChannel", "Channel"]

SETTLED = 3
"""Consecutive plausible readings after which what was rejected is accepted again."""

_T = TypeVar("_T")
# Greatest magnitude of roll and pitch [rad], and greatest rate of change of each [rad/s].
_MOST_TILT, _MOST_TURN = math.radians(60.0), 6.0
# Allowance for sensor noise in the change between two readings [rad].
_NOISE = 0.03
_BEYOND = f"roll or pitch beyond {math.degrees(_MOST_TILT):.4g} deg"
_JUMP = f"changes faster than {math.degrees(_MOST_TURN):.4g} deg/s"


class Channel:
    """The state of a channel: that of one part for the body, or of one for each leg.

    Parameters
    ----------
    names : sequence of str
        Names of the parts in messages.

    Attributes
    ----------
    now : float
        The time [s].
    """

    def __init__(self, names: Sequence[str]) -> None:
        # Consecutive plausible readings of each part, at most `SETTLED`.
        self._names, self._plausible, self.now = names, [SETTLED] * len(names), 0.0

    def reset(self) -> None:
        """Reject every part until it has been plausible `SETTLED` times in a row."""
        self._plausible = [0] * len(self._plausible)

    def _accepted(self, part: int, reading: _T | str, rejected: list[str]) -> _T | None:
        """Return the reading of a part; None if it is rejected: a text is what is wrong with it."""
        if isinstance(reading, str):
            self._plausible[part] = 0
            rejected.append(f"{self._names[part]}: {reading}")
        elif self._plausible[part] < SETTLED:
            self._plausible[part] += 1
            rejected.append(f"{self._names[part]}: settling after a rejected reading")
        else:
            return reading
        return None


class _BodyChannel(Channel, ABC):
    """A channel with one reading for the body."""

    def read(self, value: Any, rejected: list[str]) -> Any:
        """Return the reading if it is accepted.

        Parameters
        ----------
        value, rejected : anything, list of str
            The reading; the reason of a rejection is appended to it.
        """
        return self._accepted(0, self._checked(value), rejected)

    @abstractmethod
    def _checked(self, value: Any) -> Any:
        """Return a reading, or what is wrong with it."""


class AttitudeChannel(_BodyChannel):
    """Roll and pitch, plausible while they change no faster than a robot can turn."""

    def __init__(self) -> None:
        super().__init__(["attitude"])
        # The last reading within the greatest tilt, accepted or not, and when it was read.
        self._last: RollPitch | None = None
        self._read = 0.0

    def _checked(self, value: Any) -> RollPitch | str:
        """Return a reading, or what is wrong with it; remember it if it is within the greatest tilt."""
        parts = as_items(value, (2,))
        if parts is None:
            return "expected roll and pitch"
        roll, pitch = as_number(parts[0]), as_number(parts[1])
        if not (-_MOST_TILT <= roll <= _MOST_TILT and -_MOST_TILT <= pitch <= _MOST_TILT):
            return _BEYOND if roll - roll == 0.0 == pitch - pitch else "not finite numbers"
        before, change = self._last, _MOST_TURN * (self.now - self._read) + _NOISE
        self._last, self._read = (roll, pitch), self.now
        if before is not None and not (abs(roll - before[0]) <= change and abs(pitch - before[1]) <= change):
            return _JUMP
        return self._last


class AngularRateChannel(_BodyChannel):
    """Angular velocity of the body, plausible where it is finite."""

    def __init__(self) -> None:
        super().__init__(["angular_rates"])

    def _checked(self, value: Any) -> Vector | str:
        """Return a reading, or what is wrong with it."""
        reading = as_vector(value)
        if reading is None:
            return "expected three numbers"
        return reading if all(map(math.isfinite, reading)) else "not finite numbers"
