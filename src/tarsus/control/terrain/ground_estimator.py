"""Ground estimate from sensor readings: contacts, ground plane, body correction and compliance of the feet."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.pose.admittance import Admittance, AdmittanceFilter
from tarsus.control.pose.attitude import CommandedAttitude, rotate_z, slope_along
from tarsus.control.pose.levelling import Correction, Levelling, LevellingMode, com_shift_ratio
from tarsus.control.readings import SensorReadings, ValidReadings, Vector
from tarsus.control.sensing.foot_force import FootForceEstimator, balanced_forces
from tarsus.control.sensing.ground_plane import FLAT, GroundPlane, ground_plane
from tarsus.control.sensing.validation import ReadingsValidator
from tarsus.kinematics.mass import STANDARD_GRAVITY, centre_of_mass, total_mass
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["GroundEstimate", "GroundEstimator"]


# Body correction and slope are updated once they have changed by this much, since each update plans a new stance:
# x, y [m], roll, pitch [rad], slope along x and y.
_UPDATE_STEPS = np.array([0.004, 0.004, 0.012, 0.012, 0.015, 0.015])


class GroundEstimate(NamedTuple):
    """Estimate of the ground after one tick.

    Attributes
    ----------
    contacts : tuple of (bool or None), or None
        Which feet touch the ground; None where unknown.
    correction : tuple of float
        x, y, z [m], roll, pitch, yaw [rad] to be added to the commanded body pose.
    slope : complex
        Rise of the ground along x and y of the heading frame [m/m].
    offsets : array, shape (legs,)
        Upward admittance offset of each foot [m].
    rejected : tuple of str
        Rejected readings, with the reason.
    tilt : float
        Angle between the measured and the commanded upward direction [rad]; NaN where no attitude is measured.
    """

    contacts: tuple[bool | None, ...] | None
    correction: tuple[float, ...]
    slope: complex
    offsets: Float[np.ndarray, "legs"]
    rejected: tuple[str, ...]
    tilt: float = math.nan


class GroundEstimator:
    """Estimates the ground from sensor readings, tick by tick.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles, feet : array, shape (legs, 3)
        Joint angles [rad] and feet in G [m] in the initial stance.
    levelling : "level", "follow" or None
        Whether the body stays level on a slope, follows it, or neither.
    admittance : Admittance, optional
        Compliance of the feet; left out, they are stiff.

    Attributes
    ----------
    plane : GroundPlane
        Plane through the stance feet, in G.
    levelling : Levelling
        Correction of the body pose.
    """

    def __init__(
        self,
        robot: Robot,
        angles: Float[np.ndarray, "legs 3"],
        feet: Float[np.ndarray, "legs 3"],
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
        self._correction, self._slope, self._adopted = (0.0,) * 6, 0j, np.zeros(len(_UPDATE_STEPS))
        self._no_offsets = np.zeros(robot.legs)

    def step(
        self,
        readings: SensorReadings | None,
        dt: float,
        *,
        feet: Float[np.ndarray, "legs 3"],
        offsets: Float[np.ndarray, "legs"],
        contacts: Bool[np.ndarray, "legs"],
        yaw: float,
        commanded: CommandedAttitude,
        angles: Float[np.ndarray, "legs 3"],
    ) -> GroundEstimate:
        """Return the estimate after one tick.

        Parameters
        ----------
        readings : SensorReadings, optional
            The readings.
        dt : float
            Time since the last tick [s].
        feet : array, shape (legs, 3)
            Feet in G [m].
        offsets : array, shape (legs,)
            Their admittance offsets [m].
        contacts : array of bool, shape (legs,)
            Which feet are in stance.
        yaw : float
            Yaw of the heading frame in G [rad].
        commanded : CommandedAttitude
            Commanded attitude and height of the body.
        angles : array, shape (legs, 3)
            Joint angles [rad].
        """
        valid = self._validator.validate(readings, dt)
        # The ground is where the feet would be without their admittance offsets.
        uncorrected = feet - np.outer(offsets, (0.0, 0.0, 1.0))
        self.plane = ground_plane(uncorrected, contacts, self.plane)
        self._correct(self.levelling.step(dt, self.plane, valid.attitude, commanded), yaw, commanded.yaw)
        return GroundEstimate(
            contacts=valid.contacts,
            correction=self._correction,
            slope=self._slope,
            offsets=self._offsets(valid, dt, feet=feet, contacts=contacts, angles=angles),
            rejected=valid.rejected,
            tilt=math.nan if valid.attitude is None else _tilt(valid.attitude, commanded),
        )

    def set_applied_correction(self, roll: float, pitch: float) -> None:
        """Set the part of the correction that has been applied so far.

        Parameters
        ----------
        roll, pitch : float
            Difference between the attitude of the body in G and the commanded one [rad].
        """
        self.levelling.correction = self.levelling.correction._replace(roll=roll, pitch=pitch)

    def _correct(self, level: Correction, yaw: float, body_yaw: float) -> None:
        """Adopt the correction and the slope once they differ enough from those in use."""
        cos, sin = math.cos(body_yaw - yaw), math.sin(body_yaw - yaw)
        x, y = rotate_z(level.x, level.y, cos, sin)
        rise_x, rise_y = slope_along(self.plane, math.cos(yaw), math.sin(yaw))
        current = np.array([x, y, level.roll, level.pitch, rise_x, rise_y])
        if (np.abs(current - self._adopted) > _UPDATE_STEPS).any():
            # z keeps the height over the ground plane when the body shifts along the slope.
            self._correction = (x, y, rise_x * x + rise_y * y, level.roll, level.pitch, 0.0)
            self._slope, self._adopted = complex(rise_x, rise_y), current

    def _offsets(
        self,
        valid: ValidReadings,
        dt: float,
        *,
        feet: Float[np.ndarray, "legs 3"],
        contacts: Bool[np.ndarray, "legs"],
        angles: Float[np.ndarray, "legs 3"],
    ) -> Float[np.ndarray, "legs"]:
        """Return the admittance offsets of the feet."""
        if self._filter is None:
            return self._no_offsets
        measured = valid.forces
        if measured is None and valid.torques is not None and self._torques is not None:
            measured = self._torques.forces(angles.tolist(), valid.torques)
        if measured is None or not self._weight:
            return np.array(self._filter.step((None,) * len(feet), dt))
        expected = balanced_forces(feet.tolist(), contacts.tolist(), feet[:, :2].mean(axis=0).tolist(), self._weight)
        errors = [
            force[2] - float(share) if force is not None and down else None
            for force, share, down in zip(measured, expected, contacts.tolist(), strict=True)
        ]
        return np.array(self._filter.step(errors, dt))


def _tilt(attitude: tuple[float, float], commanded: CommandedAttitude) -> float:
    """Return the angle between the upward directions of two attitudes [rad]."""
    up = (_upward(roll, pitch) for roll, pitch in (attitude, (commanded.roll, commanded.pitch)))
    return math.acos(min(sum(a * b for a, b in zip(*up, strict=True)), 1.0))


def _upward(roll: float, pitch: float) -> Vector:
    """Return the world's upward direction in B."""
    return -math.sin(pitch), math.cos(pitch) * math.sin(roll), math.cos(pitch) * math.cos(roll)
