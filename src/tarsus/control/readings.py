"""Sensor readings: what plants measure and report to a controller, and the part that passed validation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, NamedTuple, TypeAlias

from tarsus.gait.ground_heights import GroundHeights
from tarsus.representation import represented

__all__ = ["CHANNELS", "RollPitch", "SensorReadings", "ValidReadings", "Vector"]

Vector: TypeAlias = tuple[float, float, float]
RollPitch: TypeAlias = tuple[float, float]


@represented()
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SensorReadings:
    """Readings of all sensors at one tick, as measured; each channel may be missing (None).

    Nothing is checked here: a `WalkController` validates readings before it uses them, and reports in its
    limitations which it rejected. Where a sensor is slower than the controller, pass its last reading again with
    its `age`.

    Attributes
    ----------
    joint_angles : array, shape (legs, 3), or None
        Measured joint angles of coxa, femur and tibia [rad].
    joint_speeds : array, shape (legs, 3), or None
        Measured joint speeds [rad/s].
    currents : array, shape (legs, 3), or None
        Servo currents [A].
    temperatures : array, shape (legs, 3), or None
        Servo temperatures [deg C].
    voltages : array, shape (legs, 3), or None
        Supply voltages at the servos [V].
    contacts : array of bool, shape (legs,), or None
        Which feet touch the ground; 0 and 1 are accepted too.
    forces : array, shape (legs, 3) or (legs,), or None
        Forces of the ground on the feet in B, or their components along B's z axis [N].
    torques : array, shape (legs, 3), or None
        Torques exerted by the servos, signs as in `tarsus.joint_torques` [N m].
    attitude : array, shape (2,), or None
        Roll and pitch of B in the world, z along gravity: those of ``Rz(yaw) Ry(pitch) Rx(roll)`` [rad].
    angular_rates : array, shape (3,), or None
        Angular velocity of B in the world, mean over the tick, components along B's axes [rad/s].
    ground : GroundHeights or None
        Heights of the ground around the body.
    age : float or mapping of str to (float or array of shape (legs, 3))
        Time since the measurement [s]: of all channels, or of each by its name; channels not in the mapping have
        age 0. Where servos are read in turn, `joint_angles` may have an age for each joint.
    """

    joint_angles: Any = None
    joint_speeds: Any = None
    currents: Any = None
    temperatures: Any = None
    voltages: Any = None
    contacts: Any = None
    forces: Any = None
    torques: Any = None
    attitude: Any = None
    angular_rates: Any = None
    ground: Any = None
    age: float | Mapping[str, Any] = 0.0

    @property
    def has_ground_feedback(self) -> bool:
        """Whether any channel that tells of the ground is present: contacts, attitude, forces or torques."""
        return not (self.contacts is None and self.attitude is None and self.forces is None and self.torques is None)


CHANNELS = tuple(field.name for field in fields(SensorReadings) if field.name != "age")
"""Names of all channels, as used for ages."""


class ValidReadings(NamedTuple):
    """Readings that passed validation, as plain Python values; a channel, or one leg of it, that did not is None.

    Channels that nothing in the control uses are not among them.

    Attributes
    ----------
    joint_angles, torques : tuple of (three floats or None), or None
        By leg, the values of coxa, femur and tibia; units as in `SensorReadings`.
    contacts : tuple of (bool or None), or None
        Which feet touch the ground.
    forces : tuple of ((x, y, z) or None), or None
        Forces of the ground on the feet in B; x and y are 0 where only z was measured [N].
    attitude : (roll, pitch), or None
        Roll and pitch of B in the world [rad].
    angular_rates : (x, y, z), or None
        Angular velocity of B in the world, components along B's axes [rad/s].
    ground : GroundHeights or None
        Heights of the ground around the body.
    tilt : float or None
        Angle of the body against gravity by the measured attitude, even if that is rejected [rad].
    joint_age : float
        Time since the measurement of the joint angles, of the oldest where their ages differ [s].
    joint_ages : tuple of (three floats), or None
        By leg, the age of each joint's angle, where ages were given joint by joint; else None [s].
    ground_age : float
        Time since the measurement of the heights [s].
    contact_age : float
        Time since the measurement of contacts; without contacts, of forces; without either, of joint angles [s].
    predicted : frozenset of int
        Legs whose coxa angle is not new in this tick, but moved on from an earlier measurement as commanded.
    rejected : tuple of str
        Rejected channels, or single legs of a channel, each with the reason.
    """

    joint_angles: tuple[Vector | None, ...] | None = None
    contacts: tuple[bool | None, ...] | None = None
    forces: tuple[Vector | None, ...] | None = None
    torques: tuple[Vector | None, ...] | None = None
    attitude: RollPitch | None = None
    angular_rates: Vector | None = None
    ground: GroundHeights | None = None
    tilt: float | None = None
    joint_age: float = 0.0
    joint_ages: tuple[Vector, ...] | None = None
    ground_age: float = 0.0
    contact_age: float = 0.0
    predicted: frozenset[int] = frozenset()
    rejected: tuple[str, ...] = ()
