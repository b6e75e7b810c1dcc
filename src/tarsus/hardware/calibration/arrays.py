"""What follows from the values of a calibration: arrays over joints, and conversions between angles and commands."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import CalibrationError, InputError
from tarsus.hardware.calibration.contradictions import angle_range
from tarsus.hardware.calibration.fields import CalibrationFields
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["CalibrationArrays"]


@dataclass(frozen=True, kw_only=True, eq=False)
class CalibrationArrays(CalibrationFields):
    """Arrays over the joints of a calibration, and its commands: ``zero + direction * scale * angle``."""

    @cached_property
    def units(self) -> tuple[tuple[str, ...], ...]:
        """Unit of each joint's commands, ``units[leg][joint]``: ``"us"`` or ``"ticks"``."""
        return tuple(tuple(self.kind(leg, j).unit for j in range(len(JOINTS))) for leg in range(self.robot.legs))

    @cached_property
    def missing(self) -> tuple[str, ...]:
        """What is not known yet, a line for each joint."""
        return tuple(
            f"{self.joint_name(leg, j)}: {', '.join(self._words(leg, j))}"
            for leg, row in enumerate(self.joints)
            for j, joint in enumerate(row)
            if joint.missing
        )

    def _words(self, leg: int, joint: int) -> list[str]:
        key = self.kind(leg, joint).number_key
        return [key if name == "number" else name for name in self.joints[leg][joint].missing]

    def joint_name(self, leg: int, joint: int) -> str:
        """Return the name of a joint: ``"front left femur"``.

        Parameters
        ----------
        leg, joint : int
            Numbers of the leg and of the joint.
        """
        return f"{self.robot.leg_names[leg]} {JOINTS[joint]}"

    def require_complete(self) -> None:
        """Raise an error where something in the calibration is not known yet.

        Raises
        ------
        CalibrationError
            If something is missing; a line for each joint.
        """
        if self.missing:
            raise CalibrationError(
                f"{self.name}: not calibrated yet; tarsus bring-up asks for what is missing", self.missing
            )

    @cached_property
    def zeros(self) -> Float[np.ndarray, "legs 3"]:
        """Command of each joint at an angle of 0 ``(legs, 3)`` [us or ticks]."""
        return self._array([[joint.zero for joint in row] for row in self.joints])

    @cached_property
    def slopes(self) -> Float[np.ndarray, "legs 3"]:
        """Change of each joint's command with its angle, with the sign ``(legs, 3)`` [us/rad or ticks/rad]."""
        self.require_complete()
        return self._array([[joint.slope for joint in row] for row in self.joints])

    @cached_property
    def limits(self) -> Float[np.ndarray, "legs 3 2"]:
        """Least and greatest joint angles within robot file, commands and soft limits ``(legs, 3, 2)`` [rad]."""
        self.require_complete()
        ranges = np.array([[angle_range(joint) for joint in row] for row in self.joints])
        soft = np.array([[joint.soft_limits or (-np.inf, np.inf) for joint in row] for row in self.joints])
        own = np.asarray(self.robot.limits)
        low, high = (part(np.stack([ranges, soft, own]), axis=0) for part in (np.max, np.min))
        return self._array(np.stack([low[..., 0], high[..., 1]], axis=-1))

    @cached_property
    def command_limits(self) -> Float[np.ndarray, "legs 3 2"]:
        """Least and greatest command of each joint, which correspond to `limits` ``(legs, 3, 2)`` [us or ticks]."""
        ends = np.sort(self.zeros[..., None] + self.slopes[..., None] * self.limits, axis=-1)
        given = np.array([[joint.limits for joint in row] for row in self.joints])
        # Converted to angles and back, a limit may differ by its rounding.
        return self._array(np.clip(ends, given[..., :1], given[..., 1:]))

    def commands(self, angles: Float[np.ndarray, "*batch legs 3"]) -> Float[np.ndarray, "*batch legs 3"]:
        """Return the commands of joint angles, not limited.

        Parameters
        ----------
        angles : array, shape (..., legs, 3)
            Joint angles [rad].

        Returns
        -------
        array, shape (..., legs, 3)
            Pulse widths [us] or positions [ticks], in `units`.

        Raises
        ------
        CalibrationError
            If something is not known yet.
        InputError
            If the shape does not fit the robot.
        """
        return np.asarray(self.zeros + self.slopes * self._fitting("angles", angles))

    def angles(self, commands: Float[np.ndarray, "*batch legs 3"]) -> Float[np.ndarray, "*batch legs 3"]:
        """Return the joint angles of commands, the inverse of `commands`.

        Parameters
        ----------
        commands : array, shape (..., legs, 3)
            Pulse widths [us] or positions [ticks].

        Returns
        -------
        array, shape (..., legs, 3)
            Joint angles [rad].

        Raises
        ------
        CalibrationError
            If something is not known yet.
        InputError
            If the shape does not fit the robot.
        """
        return np.asarray((self._fitting("commands", commands) - self.zeros) / self.slopes)

    def clamped(self, commands: Float[np.ndarray, "*batch legs 3"]) -> Float[np.ndarray, "*batch legs 3"]:
        """Return commands within `command_limits`.

        Parameters
        ----------
        commands : array, shape (..., legs, 3)
            Pulse widths [us] or positions [ticks].

        Returns
        -------
        array, shape (..., legs, 3)
            The nearest allowed commands.

        Raises
        ------
        CalibrationError
            If something is not known yet.
        InputError
            If the shape does not fit the robot, or a command is NaN.
        """
        given = self._fitting("commands", commands)
        if np.isnan(given).any():
            leg, joint = np.argwhere(np.isnan(given))[0, -2:].tolist()
            raise InputError(f"the command of {self.joint_name(leg, joint)} is NaN; it must be a number")
        return np.asarray(np.clip(given, self.command_limits[..., 0], self.command_limits[..., 1]))

    def _array(self, values: Any) -> Float[np.ndarray, "..."]:
        self.require_complete()
        array = np.array(values, dtype=float)
        array.setflags(write=False)
        return array

    def _fitting(self, what: str, values: Float[np.ndarray, "*batch legs 3"]) -> Float[np.ndarray, "*batch legs 3"]:
        array, shape = np.asarray(values, dtype=float), (self.robot.legs, len(JOINTS))
        if array.shape[-2:] != shape:
            raise InputError(f"{what} have the shape {array.shape}; it must be (..., {shape[0]}, {shape[1]})")
        return array
