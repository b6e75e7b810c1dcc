"""Calibration: the servos of one machine, and how joint angles become their commands."""

from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tarsus.errors import CalibrationError, InputError
from tarsus.hardware.calibration.contradictions import angle_range, contradictions
from tarsus.hardware.calibration.fields import CalibrationFields
from tarsus.hardware.calibration.file import parse_calibration, read_calibration, write_calibration
from tarsus.representation import represented
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Calibration"]


@represented("name", "robot", "date", "buses", "supply", "missing")
@dataclass(frozen=True, kw_only=True, eq=False)
class Calibration(CalibrationFields):
    """The servos of one machine: a command is ``zero + direction * scale * angle``.

    Source: document 004's ``zero + sign * angle``, with a scale in units of the command for an angle.

    Attributes
    ----------
    name : str
        Name of the machine.
    robot : Robot
        Which robot it is.
    robot_file : str
        Name of the preset or path of the robot file, as it is written in the calibration file.
    date : date or None
        When it was calibrated.
    buses : tuple of BusSettings
        The servo buses or boards.
    joints : tuple of tuple of JointCalibration
        The joints, ``joints[leg][joint]``.
    supply : SupplySettings or None
        The supply; None where unknown.
    foot_switches : FootSwitches or None
        The foot switches; None without.
    imu : Mounting or None
        The inertial sensor; None without.

    Raises
    ------
    CalibrationError
        If it contradicts itself or the robot.
    InputError
        If the robot is a batch of designs, or has another number of legs.
    """

    def __post_init__(self) -> None:
        if self.robot.batch_shape:
            raise InputError(f"a calibration is for a single robot; {self.robot.name!r} is {self.robot.batch_shape}")
        object.__setattr__(self, "joints", tuple(tuple(row) for row in self.joints))
        if [len(row) for row in self.joints] != [len(JOINTS)] * self.robot.legs:
            raise InputError(
                f"a calibration of {self.robot.name!r} has {len(JOINTS)} joints for each of its {self.robot.legs} legs"
            )
        problems = contradictions(self.robot, self.buses, self.joints, self.foot_switches, self.supply)
        if problems:
            raise CalibrationError(self.name, [each.text for each in problems])

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
        """Refuse a calibration of which something is not known yet.

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
        """Least and greatest command of each joint, those of `limits` ``(legs, 3, 2)`` [us or ticks]."""
        ends = np.sort(self.zeros[..., None] + self.slopes[..., None] * self.limits, axis=-1)
        given = np.array([[joint.limits for joint in row] for row in self.joints])
        # Converted to angles and back, a limit may differ by its rounding.
        return self._array(np.clip(ends, given[..., :1], given[..., 1:]))

    @cached_property
    def limited_robot(self) -> Robot:
        """The robot with the joint limits of this machine, for planners and controllers."""
        return self.robot.replace(limits=self.limits)

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

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some attributes changed.

        Parameters
        ----------
        **changes
            Attributes and their new values.

        Raises
        ------
        CalibrationError
            If the copy contradicts itself or the robot.
        """
        return dataclasses.replace(self, **changes)

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, robot: Robot | None = None) -> Self:
        """Read a calibration file (TOML).

        Parameters
        ----------
        path : path
            Where it is.
        robot : Robot, optional
            The robot; that which the file names where left out.

        Raises
        ------
        CalibrationError
            If it can't be read, something in it is wrong, or it contradicts the robot; each line of the message names
            a key, the line and what is allowed.
        """
        return cls(**vars(read_calibration(path, robot=robot)))

    @classmethod
    def from_text(cls, text: str, robot: Robot, *, where: str = "the calibration") -> Self:
        """Return the calibration of a robot from the text of its file; the robot file that it names is not read.

        Parameters
        ----------
        text : str
            TOML.
        robot : Robot
            A single robot.
        where : str
            Name of the source in error messages.

        Raises
        ------
        CalibrationError
            If something in it is wrong, or it contradicts the robot.
        """
        return cls(**vars(parse_calibration(text, where=where, folder=Path(), robot=robot)))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a calibration file; `load` reads the same calibration back, to the bit.

        A reader finds the old file or the new one, never a part of it.

        Parameters
        ----------
        path : path
            Where to write it.

        Raises
        ------
        CalibrationError
            If it can't be written.
        """
        write_calibration(self, path)

    def with_joint(self, leg: int, joint: int, **changes: Any) -> Self:
        """Return a copy with one joint changed.

        Parameters
        ----------
        leg, joint : int
            Numbers of the leg and of the joint.
        **changes
            Attributes of its `JointCalibration` and their new values.

        Raises
        ------
        CalibrationError
            If the copy contradicts itself or the robot.
        """
        rows = [list(row) for row in self.joints]
        rows[leg][joint] = dataclasses.replace(rows[leg][joint], **changes)
        return self.replace(joints=tuple(tuple(row) for row in rows))

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
