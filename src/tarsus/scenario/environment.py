"""What the robot is made to feel of the ground: sensor readings as they would be on ground that isn't flat."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.control.readings import SensorReadings
from tarsus.control.sensing.foot_force import STANDARD_GRAVITY, balanced_forces
from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot
from tarsus.scenario.commands import Force, Ground, Tilt

__all__ = ["Environment"]

Floats = np.ndarray[Any, Any]

# How much over the ground a foot's switch closes [m].
_TOUCH = 1e-4


class Environment:
    """Ground under each leg, how it is tilted, and how it pushes; none until there is a command.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """

    def __init__(self, robot: Robot) -> None:
        self._weight = float(total_mass(robot)) * STANDARD_GRAVITY if robot.has_masses else 0.0
        self._height, self._force = np.zeros(robot.legs), np.zeros(robot.legs)
        self._tilt = np.zeros(2)
        self._contacts = self._attitude = self._forces = False

    def take(self, command: Ground | Tilt | Force, leg: int | None) -> None:
        """Change the ground; from then on the sense that tells of it is there."""
        if isinstance(command, Tilt):
            self._tilt, self._attitude = np.array([command.roll, command.pitch]), True
        elif leg is not None and isinstance(command, Ground):
            self._height[leg], self._contacts = command.height, True
        elif leg is not None and isinstance(command, Force):
            self._force[leg], self._forces = command.force, True

    def readings(self, feet: Floats, body: Pose, down: Floats) -> SensorReadings | None:
        """Return what is felt; None where there is no sense at all.

        Parameters
        ----------
        feet : array, shape (legs, 3)
            The feet in G [m].
        body : Pose
            The body's pose in G, as it would be on flat ground.
        down : array of bool, shape (legs,)
            Which feet are down and bear.
        """
        if not (self._contacts or self._attitude or self._forces):
            return None
        contacts = feet[:, 2] <= self._height + _TOUCH if self._contacts else None
        attitude = tuple(np.asarray(body.rpy)[:2] + self._tilt) if self._attitude else None
        forces = self._pushes(feet, down) if self._forces else None
        return SensorReadings(contacts=contacts, attitude=attitude, forces=forces)

    def _pushes(self, feet: Floats, down: Floats) -> Floats:
        """Return the ground's forces on the feet ``(legs,)`` [N]: each its share of the weight, and what is more."""
        # The walker takes the centre of mass to be in the middle of the feet; only so is a share no error.
        centre = feet[:, :2].mean(axis=0)
        share = balanced_forces(feet.tolist(), down.tolist(), centre.tolist(), self._weight)
        return np.where(down, np.array(share) + self._force, 0.0)
