"""New calibrations: what is known before the machine is looked at, and nominal ones for emulated servos."""

from __future__ import annotations

import math

import numpy as np

from tarsus.hardware.calibration.bus_commands import BusCommands, bus_commands, usual_bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.calibration.parts import BusSettings, JointCalibration
from tarsus.robot.robot import Robot, require_robot
from tarsus.robot.servo import Servo
from tarsus.robot.units import per_radian, to_decimal

__all__ = ["new_calibration", "nominal_calibration"]

# Hobby servos take 500 to 2500 us over their whole travel [us]; an unknown travel is taken to be 180 deg [rad].
_PULSES, _USUAL_TRAVEL = (500.0, 2500.0), math.pi


def new_calibration(
    robot: Robot, robot_file: str, *, kind: str | None = None, name: str = "", port: str = ""
) -> Calibration:
    """Return a calibration in which only buses, scales and the limits of the servos are filled in.

    Parameters
    ----------
    robot : Robot
        A single robot.
    robot_file : str
        Name of its preset, or path of its file from the folder of the calibration file.
    kind : str, optional
        Kind of its bus; that of its servos where left out.
    name : str
        Name of the machine; that of the robot where left out.
    port : str
        Port of the bus; searched for where left out.

    Raises
    ------
    UnknownNameError
        If there is no such kind of bus.
    """
    require_robot(robot)
    chosen = usual_bus(robot.servos[0][0]) if kind is None else bus_commands(kind)
    joints = tuple(tuple(_joint(chosen, "main", servo) for servo in row) for row in robot.servos)
    buses = (BusSettings(name="main", kind=chosen.name, port=port),)
    return Calibration(name=name or robot.name, robot=robot, robot_file=robot_file, buses=buses, joints=joints)


def nominal_calibration(robot: Robot, robot_file: str, *, kind: str | None = None, port: str = "") -> Calibration:
    """Return the calibration of a machine that is built as planned, for emulated servos.

    Servos are numbered leg by leg, the middle of their travel is the middle of the joint's limits, and those of the
    right legs turn the other way.

    Parameters
    ----------
    robot : Robot
        A single robot.
    robot_file : str
        Name of its preset, or path of its file.
    kind : str, optional
        Kind of its bus; that of its servos where left out.
    port : str
        Port of the bus.

    Raises
    ------
    UnknownNameError
        If there is no such kind of bus.
    """
    blank = new_calibration(robot, robot_file, kind=kind, port=port)
    rows = []
    for leg, row in enumerate(blank.joints):
        side = 1 if np.sin(float(np.asarray(robot.mount_yaw)[leg])) >= 0 else -1
        joints = []
        for j, joint in enumerate(row):
            # Ids count from 1, channels from 0.
            number = 3 * leg + j + (blank.kind(leg, j).unit == "ticks")
            assert joint.scale is not None
            assert joint.limits is not None
            centre = float(np.asarray(robot.limits)[leg, j].mean())
            middle = sum(joint.limits) / 2
            zero = round(middle - side * joint.scale * centre, 1)
            joints.append(
                JointCalibration(
                    bus=joint.bus, number=number, zero=zero, direction=side, scale=joint.scale, limits=joint.limits
                )
            )
        rows.append(tuple(joints))
    return blank.replace(joints=tuple(rows))


def _joint(kind: BusCommands, bus: str, servo: Servo | None) -> JointCalibration:
    """Return what is known of a joint from its servo."""
    if kind.unit == "us":
        travel = (servo and servo.travel) or _USUAL_TRAVEL
        per_degree = to_decimal(round((_PULSES[1] - _PULSES[0]) / math.degrees(travel), 3))
        return JointCalibration(bus=bus, scale=per_radian(per_degree), limits=_PULSES)
    steps, degrees = kind.steps or (4096, 360.0)
    per_degree = to_decimal(round(steps / degrees, 5))
    travel = math.degrees(servo.travel) if servo is not None and servo.travel else degrees
    # A servo whose travel is less than the range of its bus uses the middle of that range.
    unused = max(0, math.ceil((steps - 1 - travel * steps / degrees) / 2))
    return JointCalibration(bus=bus, scale=per_radian(per_degree), limits=(float(unused), float(steps - 1 - unused)))
