"""Plants: what executes joint angles and gives sensor readings."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np

from tarsus.arrays import require_float
from tarsus.control.control_output import ControlOutput
from tarsus.control.readings import RollPitch, SensorReadings
from tarsus.kinematics.mass import centre_of_mass, known_weight
from tarsus.load.foot_force import balanced_forces
from tarsus.representation import represented
from tarsus.robot.robot import Robot, require_leg_number, require_robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["Environment", "IdealPlant", "Plant"]

# Height over the ground below which a foot switch closes [m].
_TOUCH = 1e-4


@runtime_checkable
class Plant(Protocol):
    """A robot, ideal, simulated or real, that executes what a controller gives out.

    A new kind of plant needs these methods only; `tarsus.run` works with each.

    Attributes
    ----------
    robot : Robot
        The robot that executes the joint angles.
    """

    robot: Robot

    def start(self, output: ControlOutput) -> None:
        """Bring the joints to the angles with which the controller starts, however long that takes."""

    def step(self, output: ControlOutput, dt: float) -> SensorReadings:
        """Execute joint angles for one tick, and return what is measured at its end.

        Parameters
        ----------
        output, dt : ControlOutput, float
            What the controller gave out, of which a real plant uses only the angles; duration of the tick [s].
        """

    def stop(self) -> None:
        """Release what is held; may be called after an error, and more than once."""


class Environment:
    """Deviations from flat, level ground that an ideal plant measures; none until they are set.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Raises
    ------
    InputError
        If what is set is not finite, or the robot has no such leg.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot, self._weight = robot, known_weight(robot)
        self._height, self._force = np.zeros(robot.legs), np.zeros(robot.legs)
        self._tilt: RollPitch | None = None
        self._contacts = self._forces = False

    def set_ground(self, leg: int, height: float) -> None:
        """Set the height of the ground under a foot; foot switches are present from then on.

        Parameters
        ----------
        leg, height : int, float
            Number of the leg; height relative to the flat ground [m].
        """
        require_leg_number("environment", leg, len(self._height))
        self._height[leg], self._contacts = require_float("height", height, finite=True), True

    def set_tilt(self, roll: float, pitch: float) -> None:
        """Set the tilt of the ground; an attitude sensor is present from then on.

        Parameters
        ----------
        roll, pitch : float
            Positive with the left side up, and with the front down, in the robot's axes whatever its heading [rad].
        """
        self._tilt = require_float("roll", roll, finite=True), require_float("pitch", pitch, finite=True)

    def set_force(self, leg: int, force: float) -> None:
        """Set the vertical force on a foot beyond its share of the weight; load cells are present from then on.

        Parameters
        ----------
        leg, force : int, float
            Number of the leg; force of the ground on the foot, positive upward [N].
        """
        require_leg_number("environment", leg, len(self._force))
        self._force[leg], self._forces = require_float("force", force, finite=True), True

    def readings(self, output: ControlOutput) -> dict[str, Any]:
        """Return the readings of the sensors that are present, named as in `SensorReadings`; None for the others.

        Parameters
        ----------
        output : ControlOutput
            What the controller gave out: feet and body pose as on flat ground, and which feet bear load.
        """
        touching = output.feet[:, 2] <= self._height + _TOUCH
        return {
            "contacts": touching if self._contacts else None,
            "attitude": None if self._tilt is None else self._tilted(output, self._tilt),
            "forces": self._loads(output, output.contacts | touching) if self._forces else None,
        }

    def _tilted(self, output: ControlOutput, tilt: RollPitch) -> RollPitch:
        """Return roll and pitch: commanded tilt, plus the tilt set, plus that of unequal ground under feet [rad]."""
        roll, pitch, yaw = np.asarray(output.body.rpy).tolist()
        feet, height = output.feet[output.contacts], self._height[output.contacts]
        over = feet - feet.mean(axis=0)
        slope_x, slope_y = np.linalg.lstsq(over[:, :2], over[:, 2] - height, rcond=None)[0].tolist()
        # The slopes are along the axes of G, the tilt is about the body's axes.
        tilted = complex(-math.atan(slope_y), math.atan(slope_x)) * cmath.exp(-1j * yaw) + complex(*tilt)
        return roll + tilted.real, pitch + tilted.imag

    def _loads(self, output: ControlOutput, bears: Bool[np.ndarray, "legs"]) -> Float[np.ndarray, "legs"]:
        """Return the vertical forces of the ground on the feet ``(legs,)`` [N]."""
        centre = output.body @ np.asarray(centre_of_mass(self._robot, output.angles))
        share = balanced_forces(output.feet.tolist(), bears.tolist(), centre[:2].tolist(), self._weight)
        return np.where(bears, np.array(share) + self._force, 0.0)


@represented("robot")
class IdealPlant:
    """Executes joint angles exactly and at once, and measures them exactly.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Attributes
    ----------
    environment : Environment
        Deviations from flat, level ground, as they are measured.
    """

    def __init__(self, robot: Robot) -> None:
        require_robot(robot)
        self.robot = robot
        self.environment = Environment(robot)
        self._angles: np.ndarray | None = None

    def start(self, output: ControlOutput) -> None:
        """Take over the joint angles that the controller starts with."""
        self._angles = output.angles

    def step(self, output: ControlOutput, dt: float) -> SensorReadings:
        """Execute joint angles, and return exact readings.

        Parameters
        ----------
        output, dt : ControlOutput, float
            What the controller gave out; duration of the tick [s].
        """
        before = output.angles if self._angles is None else self._angles
        self._angles = output.angles
        felt = {} if output.belly else self.environment.readings(output)
        return SensorReadings(joint_angles=output.angles, joint_speeds=(output.angles - before) / dt, **felt)

    def stop(self) -> None:
        """Do nothing: there is nothing to release."""
