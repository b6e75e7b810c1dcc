"""What the robot feels of the ground: the readings that a live walker may be given, and those that it believes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, TypeAlias

__all__ = ["SensorReadings", "ValidReadings", "Vector"]

Vector: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SensorReadings:
    """The sensors' readings of one moment, as they come: nothing is checked here, and each may be missing.

    `ReadingsValidator` decides what is plausible. Where the sensors are slower than the controller, give the last
    reading again with its `age`.

    Attributes
    ----------
    contacts : array of bool, shape (legs,), or None
        Which feet touch the ground; 0 and 1 will do.
    attitude : (roll, pitch), or None
        How B leans in the world, whose vertical is gravity's: of ``Rz(yaw) Ry(pitch) Rx(roll)`` [rad].
    forces : array, shape (legs,) or (legs, 3), or None
        Ground on foot in B [N]: along B's z axis alone, or all of it.
    torques : array, shape (legs, 3), or None
        What the servos of coxa, femur and tibia exert, signs as in `tarsus.joint_torques` [N m].
    age : float
        How old the readings are [s].
    """

    contacts: Any = None
    attitude: Any = None
    forces: Any = None
    torques: Any = None
    age: Any = 0.0

    @property
    def feels_ground(self) -> bool:
        """Whether anything that tells of the ground is measured: contacts, attitude, forces or torques."""
        return any(each is not None for each in (self.contacts, self.attitude, self.forces, self.torques))


@dataclass(frozen=True, slots=True, kw_only=True)
class ValidReadings:
    """The readings that are plausible, as plain numbers: None for a sense, or for one leg of it, that is not.

    Attributes
    ----------
    contacts : tuple of (bool or None), or None
        Which feet touch the ground.
    attitude : (roll, pitch), or None
        How B leans in the world [rad].
    forces : tuple of ((x, y, z) or None), or None
        Ground on foot in B [N]; x and y are 0 where only z was measured.
    torques : tuple of ((coxa, femur, tibia) or None), or None
        What the servos exert [N m].
    rejected : tuple of str
        Which readings are not believed, and why.
    """

    contacts: tuple[bool | None, ...] | None = None
    attitude: tuple[float, float] | None = None
    forces: tuple[Vector | None, ...] | None = None
    torques: tuple[Vector | None, ...] | None = None
    rejected: tuple[str, ...] = field(default=())
