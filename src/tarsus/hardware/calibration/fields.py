"""What a calibration consists of."""

from __future__ import annotations

import datetime
from dataclasses import dataclass

from tarsus.hardware.calibration.bus_commands import BusCommands
from tarsus.hardware.calibration.parts import BusSettings, FootSwitches, JointCalibration, Mounting, SupplySettings
from tarsus.robot.robot import Robot

__all__ = ["CalibrationFields"]


@dataclass(frozen=True, kw_only=True, eq=False)
class CalibrationFields:
    """The values of a calibration, unchecked.

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
    """

    name: str
    robot: Robot
    robot_file: str
    buses: tuple[BusSettings, ...]
    joints: tuple[tuple[JointCalibration, ...], ...]
    date: datetime.date | None = None
    supply: SupplySettings | None = None
    foot_switches: FootSwitches | None = None
    imu: Mounting | None = None

    def kind(self, leg: int, joint: int) -> BusCommands:
        """Return the kind of bus of a joint.

        Parameters
        ----------
        leg, joint : int
            Numbers of the leg and of the joint.
        """
        name = self.joints[leg][joint].bus
        return next(bus.properties for bus in self.buses if bus.name == name)
