"""What the robot is made to feel of the ground: sensor readings as they would be on ground that isn't flat."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.drive.commands import Ground, Tilt
from tarsus.gait.live.senses import Senses
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

__all__ = ["Feeling"]

# How much over the ground a foot's switch closes [m].
_TOUCH = 1e-4


class Feeling:
    """Ground under each leg, and how it is tilted; none until there is a command.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """

    def __init__(self, robot: Robot) -> None:
        self._height = np.zeros(robot.legs)
        self._tilt = np.zeros(2)
        self._contacts = self._attitude = False

    def take(self, command: Ground | Tilt, leg: int | None) -> None:
        """Change the ground; from then on the sense that tells of it is there."""
        if isinstance(command, Tilt):
            self._tilt, self._attitude = np.array([command.roll, command.pitch]), True
        elif leg is not None:
            self._height[leg], self._contacts = command.height, True

    def senses(self, feet: np.ndarray[Any, Any], body: Pose) -> Senses | None:
        """Return what is felt; None where there is no sense at all.

        Parameters
        ----------
        feet : array, shape (legs, 3)
            The feet in G [m].
        body : Pose
            The body's pose in G, as it would be on flat ground.
        """
        if not (self._contacts or self._attitude):
            return None
        contacts = feet[:, 2] <= self._height + _TOUCH if self._contacts else None
        attitude = tuple(np.asarray(body.rpy)[:2] + self._tilt) if self._attitude else None
        return Senses(contacts=contacts, attitude=attitude)
