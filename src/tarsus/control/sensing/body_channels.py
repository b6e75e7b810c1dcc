"""Validation of channels with one reading for the body: attitude and angular rates."""

from __future__ import annotations

import math
from typing import Any

from tarsus.control.readings import Vector
from tarsus.control.sensing.plain_values import as_items, as_number, as_vector

__all__ = ["AngularRateChannel", "AttitudeChannel"]

# Allowance for sensor noise in the change between two readings [rad].
_NOISE = 0.03


class _BodyChannel:
    """A channel that is rejected, and accepted again, as a whole."""

    def __init__(self, name: str, *, settle: int) -> None:
        self._settle = settle
        self._settling = f"{name}: settling after a rejected reading"
        self._plausible = settle  # consecutive plausible readings, at most `settle`

    def reset(self) -> None:
        """Reject the channel until it has been plausible `settle` times in a row."""
        self._plausible = 0

    def _accept(self, problem: str, rejected: list[str]) -> bool:
        """Count a reading, implausible if it has a problem; return whether it is accepted."""
        if problem:
            self._plausible = 0
            rejected.append(problem)
            return False
        if self._plausible < self._settle:
            self._plausible += 1
            rejected.append(self._settling)
            return False
        return True


class AttitudeChannel(_BodyChannel):
    """Roll and pitch, plausible while they change no faster than a robot can turn.

    Parameters
    ----------
    max_tilt : float
        Greatest magnitude of roll and pitch [rad].
    max_turn : float
        Greatest rate of change of each [rad/s].
    settle : int
        Consecutive plausible readings after which the channel is accepted again.
    """

    def __init__(self, *, max_tilt: float, max_turn: float, settle: int) -> None:
        super().__init__("attitude", settle=settle)
        self._max_tilt, self._max_turn = max_tilt, max_turn
        self._beyond = f"attitude: roll or pitch beyond {math.degrees(max_tilt):.4g} deg"
        self._jump = f"attitude: changes faster than {math.degrees(max_turn):.4g} deg/s"
        self._last: tuple[float, float] | None = None  # the last reading within `max_tilt`, accepted or not
        self._since_last = 0.0  # [s]

    def elapse(self, dt: float) -> None:
        """Count the time since the last reading.

        Parameters
        ----------
        dt : float
            Time since the last call [s].
        """
        self._since_last += dt

    def read(self, value: Any, rejected: list[str]) -> tuple[float, float] | None:
        """Return roll and pitch if they are accepted [rad].

        Parameters
        ----------
        value : anything
            The reading.
        rejected : list of str
            The reason of a rejection is appended to it.
        """
        return self._last if self._accept(self._problem(value), rejected) else None

    def _problem(self, value: Any) -> str:
        """Return what is wrong with a reading, "" if nothing is; remember it if it is within `max_tilt`."""
        parts = as_items(value, (2,))
        if parts is None:
            return "attitude: expected roll and pitch"
        roll, pitch = as_number(parts[0]), as_number(parts[1])
        most = self._max_tilt
        if not (-most <= roll <= most and -most <= pitch <= most):
            return self._beyond if roll - roll == 0.0 == pitch - pitch else "attitude: not finite numbers"
        last, change = self._last, self._max_turn * self._since_last + _NOISE
        self._last, self._since_last = (roll, pitch), 0.0
        if last is not None and not (abs(roll - last[0]) <= change and abs(pitch - last[1]) <= change):
            return self._jump
        return ""


class AngularRateChannel(_BodyChannel):
    """Angular velocity of the body, plausible where it is finite.

    Parameters
    ----------
    settle : int
        Consecutive plausible readings after which the channel is accepted again.
    """

    def __init__(self, *, settle: int) -> None:
        super().__init__("angular_rates", settle=settle)

    def read(self, value: Any, rejected: list[str]) -> Vector | None:
        """Return the angular velocity if it is accepted [rad/s].

        Parameters
        ----------
        value : anything
            The reading.
        rejected : list of str
            The reason of a rejection is appended to it.
        """
        vector = as_vector(value)
        if vector is None:
            problem = "angular_rates: expected three numbers"
        else:
            problem = "" if all(map(math.isfinite, vector)) else "angular_rates: not finite numbers"
        return vector if self._accept(problem, rejected) else None
