"""The calibration whose pulses a session shows beside joint angles."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass

import numpy as np

from tarsus.errors import InputError, TarsusError
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.robot.file import list_robots
from tarsus.robot.robot import Robot
from tarsus.studio.encoding import degrees
from tarsus.studio.messages.machine import CalibrationMessage

__all__ = ["CalibrationText", "calibration_message", "calibration_or_problem"]


@dataclass(frozen=True)
class CalibrationText:
    """The text of a calibration file.

    Attributes
    ----------
    name : str
        Name of the file.
    text : str
        Its content.
    """

    name: str
    text: str

    def of(self, robot: Robot) -> Calibration:
        """Return the calibration of a robot.

        Parameters
        ----------
        robot : Robot
            A single robot.

        Raises
        ------
        CalibrationError
            If the text is no calibration, is not complete, or contradicts the robot.
        InputError
            If it is for another preset.
        """
        named = self._robot()
        if named in list_robots() and named != robot.name:
            raise InputError(f"{self.name} is the calibration of {named!r}; the robot is {robot.name!r}")
        found = Calibration.from_text(self.text, robot, where=self.name)
        found.require_complete()
        return found

    def _robot(self) -> object:
        """Return the robot's name in the file; checked first, as another robot's legs would cause many other errors."""
        try:
            return tomllib.loads(self.text).get("robot")
        except (ValueError, RecursionError):
            return None


def calibration_message(name: str, calibration: Calibration, *, id: int) -> CalibrationMessage:
    """Return the message with which the page shows pulses.

    Parameters
    ----------
    name : str
        Name of the file.
    calibration : Calibration
        A complete calibration.
    id : int
        Id of the message that is answered.
    """
    commands, limits = calibration.command_limits, calibration.limits
    return CalibrationMessage(
        type="calibration",
        id=id,
        name=name,
        problem=None,
        unit=[unit for row in calibration.units for unit in row],
        zero=calibration.zeros.ravel().tolist(),
        per_deg=np.radians(calibration.slopes).ravel().tolist(),
        low=np.ceil(commands[..., 0]).astype(int).ravel().tolist(),
        high=np.floor(commands[..., 1]).astype(int).ravel().tolist(),
        low_deg=degrees(limits[..., 0]),
        high_deg=degrees(limits[..., 1]),
    )


def calibration_or_problem(text: CalibrationText | None, robot: Robot, *, id: int) -> CalibrationMessage:
    """Return the message with which the page shows pulses, or that says why there are none.

    Parameters
    ----------
    text : CalibrationText or None
        The calibration; None if there is none.
    robot : Robot
        A single robot, which may have changed since the calibration was loaded.
    id : int
        Id of the message that is answered.
    """
    name = problem = None
    if text is not None:
        name = text.name
        try:
            return calibration_message(name, text.of(robot), id=id)
        except TarsusError as error:
            problem = str(error)
    return CalibrationMessage(
        type="calibration",
        id=id,
        name=name,
        problem=problem,
        unit=[],
        zero=[],
        per_deg=[],
        low=[],
        high=[],
        low_deg=[],
        high_deg=[],
    )
