"""The last stage before the bus: keeps commands within the limits of the calibration and the speeds of the joints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.robot.joint_limits import joint_limits

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["CommandLimiter"]


class CommandLimiter:
    """Turns joint angles into whole commands, never beyond a limit and never faster than the joint moves.

    Whatever angles it is given, each command is within `Calibration.command_limits`, and the way of a joint since any
    command before is less than one command more than its greatest speed times the time between them.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.

    Attributes
    ----------
    sent : array of int, shape (legs, 3), or None
        The last commands; None before `begin`.
    """

    def __init__(self, calibration: Calibration) -> None:
        self._calibration = calibration
        limits = calibration.command_limits
        self._low, self._high = np.ceil(limits[..., 0]), np.floor(limits[..., 1])
        if (self._low > self._high).any():
            leg, joint = np.argwhere(self._low > self._high)[0].tolist()
            raise InputError(f"the limits of the {calibration.joint_name(leg, joint)} contain no whole command")
        self._speed = joint_limits(calibration.robot).speed * np.abs(calibration.slopes)
        self._unused = np.zeros_like(self._speed)
        self.sent: Int[np.ndarray, "legs 3"] | None = None

    def begin(self, angles: Float[np.ndarray, "legs 3"]) -> Int[np.ndarray, "legs 3"]:
        """Set where the joints are, and return the nearest commands.

        Parameters
        ----------
        angles : array, shape (legs, 3)
            Measured or declared joint angles [rad].

        Raises
        ------
        InputError
            If they are not finite.
        """
        self.sent = self._whole(self._finite(angles))
        self._unused = np.zeros_like(self._speed)
        return self.sent

    def limited(self, angles: Float[np.ndarray, "legs 3"], elapsed: float) -> Int[np.ndarray, "legs 3"]:
        """Return the commands to send.

        Parameters
        ----------
        angles : array, shape (legs, 3)
            Joint angles to execute [rad].
        elapsed : float
            Time since the last commands [s]; nothing moves unless it is finite and positive.

        Raises
        ------
        InputError
            If an angle is not finite, their shape does not fit the robot, or `begin` was not called.
        """
        if self.sent is None:
            raise InputError("where the joints are is not known yet; call begin(angles) first")
        way = self._whole(self._finite(angles)) - self.sent
        possible = self._unused + self._speed * (elapsed if 0 < elapsed < np.inf else 0.0)
        most = np.floor(possible)
        # Slow joints move by less than a command in a tick: what is left counts for the next, unless they have arrived.
        self._unused = np.where(np.abs(way) > most, possible - most, 0.0)
        self.sent = self.sent + np.clip(way, -most, most).astype(int)
        return self.sent

    def _whole(self, angles: Float[np.ndarray, "legs 3"]) -> Int[np.ndarray, "legs 3"]:
        # Values far beyond a limit must not overflow on their way to it.
        limits = self._calibration.limits
        commands = self._calibration.commands(np.clip(angles, limits[..., 0], limits[..., 1]))
        return np.asarray(np.clip(np.rint(commands), self._low, self._high)).astype(int)

    def _finite(self, angles: Float[np.ndarray, "..."]) -> Float[np.ndarray, "legs 3"]:
        try:
            array = np.asarray(angles, dtype=float)
        except (TypeError, ValueError):
            raise InputError(f"joint angles are {angles!r}; they must be numbers") from None
        shape = self._low.shape
        if array.shape != shape:
            raise InputError(f"joint angles have the shape {array.shape}; it must be {shape}")
        if not np.isfinite(array).all():
            leg, joint = np.argwhere(~np.isfinite(array))[0].tolist()
            name = self._calibration.joint_name(leg, joint)
            raise InputError(f"the angle of the {name} is {array[leg, joint]}; it must be finite")
        return array
