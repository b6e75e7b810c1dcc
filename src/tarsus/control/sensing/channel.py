"""Channels of sensor readings: parts are rejected, and accepted again once they have settled; those of the body."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeVar

from tarsus.control.readings import RollPitch, Vector
from tarsus.control.sensing.plain_values import as_items, as_number, as_vector

__all__ = ["AngularRateChannel", "AttitudeChannel", "Channel"]

_T = TypeVar("_T")
# Consecutive plausible readings after which what was rejected is accepted again.
_SETTLED = 3
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
        # Consecutive plausible readings of each part, at most `_SETTLED`.
        self._names, self._plausible, self.now = names, [_SETTLED] * len(names), 0.0

    def reset(self) -> None:
        """Reject every part until it has been plausible `_SETTLED` times in a row."""
        self._plausible = [0] * len(self._plausible)

    def _accepted(self, part: int, reading: _T | str, rejected: list[str]) -> _T | None:
        """Return the reading of a part; None if it is rejected: a text is what is wrong with it."""
        if isinstance(reading, str):
            self._plausible[part] = 0
            rejected.append(f"{self._names[part]}: {reading}")
        elif self._plausible[part] < _SETTLED:
            self._plausible[part] += 1
            rejected.append(f"{self._names[part]}: settling after a rejected reading")
        else:
            return reading
        return None


class AttitudeChannel(Channel):
    """Roll and pitch, plausible while they change no faster than a robot can turn."""

    def __init__(self) -> None:
        super().__init__(["attitude"])
        # The last reading within the greatest tilt, accepted or not, and when it was read.
        self._last: RollPitch | None = None
        self._read = 0.0

    def read(self, value: Any, rejected: list[str]) -> RollPitch | None:
        """Return the reading if it is accepted; the reason of a rejection is appended to `rejected`."""
        return self._accepted(0, self._checked(value), rejected)

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


class AngularRateChannel(Channel):
    """Angular velocity of the body, plausible where it is finite."""

    def read(self, value: Any, rejected: list[str]) -> Vector | None:
        """Return the reading if it is accepted; the reason of a rejection is appended to `rejected`."""
        reading: Vector | str = as_vector(value) or "expected three numbers"
        if not (isinstance(reading, str) or all(map(math.isfinite, reading))):
            reading = "not finite numbers"
        return self._accepted(0, reading, rejected)
