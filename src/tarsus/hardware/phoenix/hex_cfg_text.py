"""Writes a robot and its calibration as `Hex_Cfg.h` of the Phoenix firmware."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tarsus.errors import InputError
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.phoenix.hex_cfg import DRIVERS, LEGS, Driver
from tarsus.kinematics.stance import default_body_height, default_stance
from tarsus.robot.robot import JOINTS

__all__ = ["hex_cfg_text"]

_CODES = {name: code for code, name in LEGS.items()}
# Rounding of the header's whole tenths of a degree [deg] and millimetres [m].
_TENTH, _MILLIMETRE = 0.1, 1e-3
_SCALE = 0.01


def hex_cfg_text(calibration: Calibration) -> str:
    """Return the text of a header: pins, limits, horn offsets, inversion, dimensions and start positions.

    Angles are in tenths of a degree and lengths in whole millimetres there. What the firmware can't express is written
    as comments: servo offsets of the coxa, and a scale that is not the driver's.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.

    Raises
    ------
    InputError
        If the legs have other names than the firmware's, more than one bus, a bus that it has no driver for, or femur
        axes that are offset.
    CalibrationError
        If the calibration is not complete.
    """
    calibration.require_complete()
    robot = calibration.robot
    driver = _driver(calibration)
    if not set(robot.leg_names) <= set(_CODES) or robot.legs not in (4, 6):
        raise InputError(
            f"the firmware's legs are {', '.join(_CODES)}; {robot.name!r} has {', '.join(robot.leg_names)}"
        )
    if np.abs(np.asarray(robot.femur_axis_offset)).max() > _MILLIMETRE:
        raise InputError(f"{robot.name!r} has offset femur axes; the firmware has none")
    parts = [
        ["#ifndef HEX_CFG_H", "#define HEX_CFG_H", f"// {robot.name}; angles in tenths of a degree, lengths in mm"],
        ["#define QUADMODE"] if robot.legs == 4 else [],
        _flags(calibration, driver),
        *(list(part(calibration, driver)) for part in (_servos, _joint_limits, _dimensions, _start)),
        ["#endif"],
    ]
    return "\n\n".join("\n".join(part) for part in parts if part) + "\n"


def _driver(calibration: Calibration) -> Driver:
    kinds = {bus.kind for bus in calibration.buses}
    found = [driver for driver in DRIVERS.values() if {driver.kind} == kinds]
    if not found or len(calibration.buses) > 1:
        known = ", ".join(driver.kind for driver in DRIVERS.values())
        raise InputError(f"the firmware drives one bus of {known}; the calibration has {', '.join(sorted(kinds))}")
    return found[0]


def _flags(calibration: Calibration, driver: Driver) -> list[str]:
    """Return the lines that choose the driver, and the baud rate of a board."""
    flag = {"ssc32": "USE_SSC32", "maestro": "USE_MAESTRO", "dynamixel-ax": "USE_AX12_DRIVER"}[driver.kind]
    usual = 115_200 if driver.kind == "maestro" else 38_400
    rate = [f"#define {driver.baud} {calibration.buses[0].baud or usual}"] if driver.baud else []
    return [f"#define {flag}", *rate]


def _each(calibration: Calibration) -> Iterator[tuple[str, int, int, str]]:
    """Yield the firmware's code of each leg, its number, and number and name of each joint."""
    for leg, name in enumerate(calibration.robot.leg_names):
        for j, joint in enumerate(JOINTS):
            yield _CODES[name], leg, j, joint.capitalize()


def _servo(calibration: Calibration, leg: int, j: int, driver: Driver) -> tuple[int, float]:
    """Return whether the servo is inverted, and the code's angle at an angle of 0 here [deg]."""
    joint = calibration.joints[leg][j]
    assert joint.direction is not None
    assert joint.zero is not None
    right = calibration.robot.leg_names[leg].endswith("right")
    sign = (-1 if right else 1, -1, 1)[j]
    turned = joint.direction * sign
    inverted = turned != driver.turned(inverted=False, right=right)
    return int(inverted), turned * (joint.zero - driver.middle) / driver.per_degree


def _horn_tenths(calibration: Calibration, leg: int, j: int, driver: Driver) -> int:
    """Return the horn's offset [0.1 deg]: added to the femur's angle, subtracted from the tibia's."""
    _, at_zero = _servo(calibration, leg, j, driver)
    return round((0.0, at_zero, 90.0 - at_zero)[j] * 10)


def _servos(calibration: Calibration, driver: Driver) -> Iterator[str]:
    for code, leg, j, joint in _each(calibration):
        found = calibration.joints[leg][j]
        inverted, at_zero = _servo(calibration, leg, j, driver)
        yield f"#define c{code}{joint}Pin {found.number}"
        yield f"#define c{code}{joint}Inv {inverted}"
        if j > 0:
            yield f"#define c{code}{joint}HornOffset1 {_horn_tenths(calibration, leg, j, driver)}"
        elif abs(at_zero) > _TENTH / 2:
            yield f"// c{code}{joint}: turn this servo's offset to {found.zero:g} {calibration.units[leg][j]} for 0"
        assert found.scale is not None
        per_degree = math.radians(1) * found.scale
        if abs(per_degree / driver.per_degree - 1) > _SCALE:
            unit = calibration.units[leg][j]
            yield f"// c{code}{joint}: the servo has {per_degree:.4g} {unit}/deg, the driver {driver.per_degree:.4g}"


def _joint_limits(calibration: Calibration, driver: Driver) -> Iterator[str]:
    degrees = np.degrees(calibration.limits)
    for code, leg, j, joint in _each(calibration):
        low, high = degrees[leg, j]
        horn = _horn_tenths(calibration, leg, j, driver) / 10
        right = code.startswith("R")
        ends = (
            (-low, -high) if right else (low, high),
            (horn - low, horn - high),
            (low + 90 - horn, high + 90 - horn),
        )[j]
        # Rounded inward, so that no limit grows.
        yield f"#define c{code}{joint}Min1 {math.ceil(min(ends) * 10 - 1e-6)}"
        yield f"#define c{code}{joint}Max1 {math.floor(max(ends) * 10 + 1e-6)}"


def _dimensions(calibration: Calibration, driver: Driver) -> Iterator[str]:  # noqa: ARG001
    robot = calibration.robot
    position, yaw = np.asarray(robot.mount_position) * 1000, np.degrees(np.asarray(robot.mount_yaw))
    for leg, name in enumerate(robot.leg_names):
        code = _CODES[name]
        for joint in JOINTS:
            length = float(np.asarray(getattr(robot, joint))[leg])
            yield f"#define c{code}{joint.capitalize()}Length {round(length * 1000)}"
        angle = 90 - yaw[leg] if code.startswith("L") else 90 + yaw[leg]
        yield f"#define c{code}CoxaAngle1 {round(angle * 10)}"
        yield f"#define c{code}OffsetX {round(position[leg, 1])}"
        yield f"#define c{code}OffsetZ {round(-position[leg, 0])}"


def _start(calibration: Calibration, driver: Driver) -> Iterator[str]:  # noqa: ARG001
    """Yield the start positions: feet from the coxa axes, outward, down and to the rear."""
    robot = calibration.robot
    height = default_body_height(robot)
    feet = (np.asarray(default_stance(robot, height)) - np.asarray(robot.mount_position)) * 1000
    for leg, name in enumerate(robot.leg_names):
        code = _CODES[name]
        outward = feet[leg, 1] * (1 if code.startswith("L") else -1)
        yield f"#define c{code}InitPosX {round(outward)}"
        # The firmware starts with its body low, and is raised by hand.
        yield f"#define c{code}InitPosY {round(min(-feet[leg, 2], 25))}"
        yield f"#define c{code}InitPosZ {round(-feet[leg, 0])}"
