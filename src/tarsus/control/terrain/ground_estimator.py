"""What the walker makes of what it feels: the ground under each foot, how the body should lean, how feet give way."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from tarsus.control.pose.admittance import Admittance, AdmittanceFilter
from tarsus.control.pose.attitude import CommandedAttitude, slope_along, turned
from tarsus.control.pose.levelling import Correction, Levelling, LevellingMode, com_shift_ratio
from tarsus.control.readings import SensorReadings, ValidReadings
from tarsus.control.sensing.foot_force import STANDARD_GRAVITY, FootForceEstimator, balanced_forces
from tarsus.control.sensing.ground_plane import FLAT, GroundPlane, ground_plane
from tarsus.control.sensing.validation import ReadingsValidator
from tarsus.kinematics.mass import centre_of_mass, total_mass
from tarsus.robot.robot import Robot

__all__ = ["GroundEstimate", "GroundEstimator"]

Floats = np.ndarray[Any, Any]

# The body's correction and the ground's slope are gone over to in steps of these sizes: x, y [m], roll, pitch [rad],
# slope along x and y.
_STEPS = np.array([0.004, 0.004, 0.012, 0.012, 0.015, 0.015])


class GroundEstimate(NamedTuple):
    """What is felt in a tick.

    Attributes
    ----------
    contacts : tuple of (bool or None), or None
        Which feet touch the ground; None where that is not known.
    correction : tuple of float
        x, y, z [m], roll, pitch, yaw [rad] to be added to the body's wish.
    slope : complex
        How much the ground rises along x and y of the heading frame [m/m].
    offsets : array, shape (legs,)
        How far each foot gives way upwards [m].
    rejected : tuple of str
        Readings that are not believed, and why.
    """

    contacts: tuple[bool | None, ...] | None
    correction: tuple[float, ...]
    slope: complex
    offsets: Floats
    rejected: tuple[str, ...]


class GroundEstimator:
    """Goes from readings to what they mean for the walk, tick by tick.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles, feet : array, shape (legs, 3)
        Joint angles [rad] and feet in G [m] when it stands.
    levelling : "level", "follow" or None
        Whether the body stays level on a slope, follows it, or neither.
    admittance : Admittance, optional
        How feet give way to forces; left out, they don't.

    Attributes
    ----------
    plane : GroundPlane
        The ground, as the feet that stand tell.
    levelling : Levelling
        What holds the body.
    """

    def __init__(
        self,
        robot: Robot,
        angles: Floats,
        feet: Floats,
        *,
        levelling: LevellingMode | None,
        admittance: Admittance | None,
    ) -> None:
        self._validator = ReadingsValidator(robot)
        self.plane: GroundPlane = FLAT
        com = centre_of_mass(robot, angles)
        self.levelling = Levelling(levelling, com=tuple(com.tolist()), com_shift_ratio=com_shift_ratio(robot, feet))
        self._filter = AdmittanceFilter(admittance, robot.legs) if admittance else None
        self._torques = FootForceEstimator(robot) if admittance and robot.has_masses else None
        self._weight = float(total_mass(robot)) * STANDARD_GRAVITY if robot.has_masses else 0.0
        self._correction, self._slope, self._found = (0.0,) * 6, 0j, np.zeros(len(_STEPS))
        self._none = np.zeros(robot.legs)

    def step(
        self,
        readings: SensorReadings | None,
        dt: float,
        *,
        feet: Floats,
        offsets: Floats,
        contacts: Floats,
        yaw: float,
        commanded: CommandedAttitude,
        angles: Floats,
    ) -> GroundEstimate:
        """Take in one tick's readings.

        Parameters
        ----------
        readings : SensorReadings, optional
            The readings.
        dt : float
            Time since the last tick [s].
        feet : array, shape (legs, 3)
            In G [m].
        offsets : array, shape (legs,)
            How far each has given way upwards [m].
        contacts : array of bool, shape (legs,)
            Which feet the walker has put down.
        yaw : float
            Where the heading frame faces [rad].
        commanded : Commanded
            How the body is asked to stand.
        angles : array, shape (legs, 3)
            Joint angles [rad].
        """
        valid = self._validator.validate(readings, dt)
        # Where the ground is, not where feet are that have given way.
        stood = feet - np.outer(offsets, (0.0, 0.0, 1.0))
        self.plane = ground_plane(stood, contacts, self.plane)
        self._correct(self.levelling.step(dt, self.plane, valid.attitude, commanded), yaw, commanded.yaw)
        return GroundEstimate(
            contacts=valid.contacts,
            correction=self._correction,
            slope=self._slope,
            offsets=self._offsets(valid, dt, feet=feet, contacts=contacts, angles=angles),
            rejected=valid.rejected,
        )

    def set_applied_correction(self, roll: float, pitch: float) -> None:
        """Take note of how much of the correction has been carried out.

        Parameters
        ----------
        roll, pitch : float
            How the body leans against the command [rad].
        """
        self.levelling.correction = self.levelling.correction._replace(roll=roll, pitch=pitch)

    def _correct(self, level: Correction, yaw: float, body_yaw: float) -> None:
        """Go over to what the ground asks of the body by now, where that is a step from what it asked before."""
        cos, sin = math.cos(body_yaw - yaw), math.sin(body_yaw - yaw)
        x, y = turned(level.x, level.y, cos, sin)
        rise_x, rise_y = slope_along(self.plane, math.cos(yaw), math.sin(yaw))
        found = np.array([x, y, level.roll, level.pitch, rise_x, rise_y])
        if (np.abs(found - self._found) > _STEPS).any():
            # As high over the ground beneath it as it was before it was shifted.
            self._correction = (x, y, rise_x * x + rise_y * y, level.roll, level.pitch, 0.0)
            self._slope, self._found = complex(rise_x, rise_y), found

    def _offsets(self, valid: ValidReadings, dt: float, *, feet: Floats, contacts: Floats, angles: Floats) -> Floats:
        """Return how far each foot gives way."""
        if self._filter is None:
            return self._none
        measured = valid.forces
        if measured is None and valid.torques is not None and self._torques is not None:
            measured = self._torques.forces(angles.tolist(), valid.torques)
        if measured is None or not self._weight:
            return np.array(self._filter.step((None,) * len(feet), dt))
        wanted = balanced_forces(feet.tolist(), contacts.tolist(), feet[:, :2].mean(axis=0).tolist(), self._weight)
        errors = [
            force[2] - float(want) if force is not None and down else None
            for force, want, down in zip(measured, wanted, contacts.tolist(), strict=True)
        ]
        return np.array(self._filter.step(errors, dt))
