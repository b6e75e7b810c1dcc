"""The attitude: what is plausible of it, and since when."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from tarsus.control.sensing.channel_validation import items, number

__all__ = ["AttitudeValidator"]

# What a sensor's noise may add to a turn between two readings [rad].
_NOISE = 0.03


class AttitudeValidator:
    """Roll and pitch, believed where they go on from the reading before.

    Parameters
    ----------
    max_tilt : float
        Greatest roll or pitch, either way [rad].
    max_turn : float
        Greatest speed of each [rad/s].
    settle : int
        Readings in a row that agree after which the sense is believed again.
    """

    def __init__(self, *, max_tilt: float, max_turn: float, settle: int) -> None:
        self._max_tilt, self._max_turn, self._settle = max_tilt, max_turn, settle
        self._beyond = f"attitude: beyond {math.degrees(max_tilt):.4g} deg"
        self._jump = f"attitude: turned by more than {math.degrees(max_turn):.4g} deg/s"
        self._last: tuple[float, float] | None = None  # the last plausible reading, believed or not
        self._since = 0.0  # time since then [s]
        self._agreed = settle  # how many in a row went on from the one before

    def wait(self, dt: float) -> None:
        """Let time pass.

        Parameters
        ----------
        dt : float
            How much [s].
        """
        self._since += dt

    def distrust(self) -> None:
        """Believe nothing before readings have agreed for a while."""
        self._agreed = 0

    def read(self, value: Any, rejected: list[str]) -> tuple[float, float] | None:
        """Return roll and pitch if they are believed; add the reason to `refused` if not.

        Parameters
        ----------
        value : anything
            The reading.
        rejected : list of str
            The reason is added to it.
        """
        if value is None:
            return None
        why = self._problem(items(value, (2,)))
        if why:
            self._agreed = 0
            rejected.append(why)
            return None
        if self._agreed < self._settle:
            self._agreed += 1
            rejected.append("attitude: on trial")
            return None
        return self._last

    def _problem(self, parts: Sequence[Any] | None) -> str:
        """Return what is wrong with a reading, nothing if it goes on from the last; keep it if it is plausible."""
        if parts is None:
            return "attitude: not roll and pitch"
        roll, pitch = number(parts[0]), number(parts[1])
        most = self._max_tilt
        if not (-most <= roll <= most and -most <= pitch <= most):
            return self._beyond if roll - roll == 0.0 == pitch - pitch else "attitude: not finite numbers"
        last, way = self._last, self._max_turn * self._since + _NOISE
        self._last, self._since = (roll, pitch), 0.0
        if last is not None and not (abs(roll - last[0]) <= way and abs(pitch - last[1]) <= way):
            return self._jump
        return ""
