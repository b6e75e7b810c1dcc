"""Calibration: the servos of one machine, with its file."""

from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Self

from tarsus.errors import CalibrationError, InputError
from tarsus.hardware.calibration.arrays import CalibrationArrays
from tarsus.hardware.calibration.contradictions import contradictions
from tarsus.hardware.calibration.file import parse_calibration, read_calibration, write_calibration
from tarsus.representation import represented
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["Calibration"]


@represented("name", "robot", "date", "buses", "supply", "missing")
@dataclass(frozen=True, kw_only=True, eq=False)
class Calibration(CalibrationArrays):
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
    def limited_robot(self) -> Robot:
        """The robot with the joint limits of this machine, for planners and controllers."""
        return self.robot.replace(limits=self.limits)

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
