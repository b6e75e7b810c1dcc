"""Reads `Hex_Cfg.h` of the Phoenix firmware as a robot and a calibration.

Source: github.com/KurtE/Arduino_Phoenix_Parts: Phoenix/Phoenix_Code.h (angles, limits, inversion) and its drivers for
the SSC-32 and AX-12 (pulse widths and ticks); for the Maestro Phoenix_Driver_Maestro.h at 081eb21, which is
not in its main branch.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from decimal import Decimal
from types import MappingProxyType
from typing import Any, NamedTuple

from tarsus.errors import InputError
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.calibration.parts import BusSettings, JointCalibration
from tarsus.hardware.phoenix.defines import Defines, read_defines
from tarsus.robot.file import robot_from_dict
from tarsus.robot.firmware import convert_limits
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["DRIVERS", "LEGS", "Driver", "calibration_from_hex_cfg", "robot_from_hex_cfg"]

LEGS: Mapping[str, str] = MappingProxyType(
    {
        "LF": "front left",
        "LM": "middle left",
        "LR": "rear left",
        "RR": "rear right",
        "RM": "middle right",
        "RF": "front right",
    }
)
"""The firmware's short names of legs, and their names here, in the ring's order."""


class Driver(NamedTuple):
    """How a servo driver of the firmware makes commands: ``middle + per_degree * angle of the servo``.

    Attributes
    ----------
    kind : str
        Kind of bus.
    middle : float
        Command at an angle of 0.
    per_degree : float
        Units of the command for a degree.
    limits : (float, float)
        Commands of the servos' travel.
    baud : str
        Name of the constant with the bits per second; empty without.
    mirrors : bool
        Whether it negates the angles of the right legs, in addition to the inversions in the header.
    """

    kind: str
    middle: float
    per_degree: float
    limits: tuple[float, float]
    baud: str = ""
    mirrors: bool = False

    def turned(self, *, inverted: bool, right: bool) -> int:
        """Return the sign of a servo's angle.

        Parameters
        ----------
        inverted : bool
            Whether the header inverts the servo.
        right : bool
            Whether it is one of a right leg.
        """
        return -1 if inverted is not (self.mirrors and right) else 1


DRIVERS: Mapping[str, Driver] = MappingProxyType(
    {
        # cPwmDiv = 991, cPFConst = 592 for tenths of a degree + 900.
        "ssc32": Driver("ssc32", 900 * 1000 / 991 + 592, 10_000 / 991, (500.0, 2500.0), baud="cSSC_BAUD"),
        "maestro": Driver(
            "maestro", 900 * 1000 / 991 + 592, 10_000 / 991, (500.0, 2500.0), baud="cMAESTRO_BAUD", mirrors=True
        ),
        # cPwmMult = 128, cPwmDiv = 375, cPFConst = 512.
        "ax12": Driver("dynamixel-ax", 512.0, 10 * 128 / 375, (0.0, 1023.0)),
    }
)
"""Servo drivers of the firmware."""


# Names that a header defines to choose its driver; without any, it is for an SSC-32.
_FLAGS = {"USE_AX12_DRIVER": "ax12", "USE_MAESTRO": "maestro"}


def robot_from_hex_cfg(text: str, *, name: str, where: str = "Hex_Cfg.h") -> Robot:
    """Return the robot that a configuration header describes: links, mounting points and joint limits.

    Parameters
    ----------
    text : str
        Text of the header.
    name : str
        Name of the robot.
    where : str
        Name of the header in messages.

    Raises
    ------
    InputError
        If a constant is missing or no number.
    RobotFileError
        If the robot is none, for example with a link of length 0.
    """
    defines = read_defines(text, where=where)
    legs = _legs(defines, where)
    firmware = "lynxmotion" if _mirrored(defines, legs) else "phoenix"
    entries = []
    for code in legs:
        left = code.startswith("L")
        x, z, yaw = (defines.number(f"c{code}{what}") for what in ("OffsetX", "OffsetZ", "CoxaAngle1"))
        entry: dict[str, Any] = {
            "name": LEGS[code],
            # The firmware's x is to the left, its z to the rear.
            "position_mm": [-z, x, 0],
            "yaw_deg": Decimal(900 - yaw if left else yaw - 900) / 10,
        }
        entry |= {f"{joint}_mm": _length(defines, code, joint) for joint in JOINTS}
        entry["limits_deg"] = {joint: _limits(defines, code, joint, firmware) for joint in JOINTS}
        entries.append(entry)
    source = {"of": ["legs"], "source": f"{where}, a configuration of the Phoenix firmware", "confidence": "A"}
    return robot_from_dict({"name": name, "legs": entries, "sources": [source]}, where=where)


def calibration_from_hex_cfg(
    text: str, *, robot: Robot, robot_file: str, driver: str | None = None, where: str = "Hex_Cfg.h"
) -> Calibration:
    """Return the calibration that a configuration header describes: pins, zeros, directions.

    Offsets of single servos that are stored in an SSC-32 are not in the header.

    Parameters
    ----------
    text : str
        Text of the header.
    robot : Robot
        The robot, as from `robot_from_hex_cfg`.
    robot_file : str
        Name of its file.
    driver : str, optional
        One of `DRIVERS`; that of the header where left out.
    where : str
        Name of the header in messages.

    Raises
    ------
    InputError
        If a constant is missing or no number.
    CalibrationError
        If the calibration contradicts the robot.
    """
    defines = read_defines(text, where=where)
    chosen = DRIVERS[driver or next((name for flag, name in _FLAGS.items() if flag in defines), "ssc32")]
    legs = _legs(defines, where)
    by_name = {LEGS[code]: code for code in legs}
    if set(by_name) != set(robot.leg_names):
        raise InputError(f"{where} has the legs {', '.join(by_name)}; {robot.name!r} has {', '.join(robot.leg_names)}")
    joints = tuple(
        tuple(_joint(defines, by_name[name], j, joint, chosen) for j, joint in enumerate(JOINTS))
        for name in robot.leg_names
    )
    baud = defines.number(chosen.baud, 0) if chosen.baud else 0
    return Calibration(
        name=robot.name,
        robot=robot,
        robot_file=robot_file,
        buses=(BusSettings(name="main", kind=chosen.kind, baud=baud or None),),
        joints=joints,
    )


def _legs(defines: Defines, where: str) -> list[str]:
    legs = [code for code in LEGS if f"c{code}CoxaPin" in defines]
    if len(legs) < 4:
        raise InputError(f"{where} defines the pins of {len(legs)} legs (cRRCoxaPin and so on); there must be 4 or 6")
    return legs


def _length(defines: Defines, code: str, joint: str) -> int:
    """Return the length of a link; older headers have one for all legs."""
    own, shared = f"c{code}{joint.capitalize()}Length", f"c{joint.capitalize()}Length"
    return defines.number(own if own in defines or shared not in defines else shared)


def _raw_limits(defines: Defines, code: str, joint: str) -> tuple[int, int]:
    low, high = (defines.number(f"c{code}{joint.capitalize()}{end}1") for end in ("Min", "Max"))
    return low, high


def _mirrored(defines: Defines, legs: list[str]) -> bool:
    """Return whether the limits of the right legs have the servos' signs: they mirror those of the left ones."""
    pairs = [(code, f"R{code[1]}") for code in legs if code.startswith("L") and f"R{code[1]}" in legs]
    same = mirrored = True
    for left, right in pairs:
        for joint in ("femur", "tibia"):
            (low, high), other = _raw_limits(defines, left, joint), _raw_limits(defines, right, joint)
            same, mirrored = same and other == (low, high), mirrored and other == (-high, -low)
    return mirrored and not same


def _horn(defines: Defines, code: str, joint: str) -> float:
    """Return the offset of a servo horn [deg]."""
    if joint == "coxa":
        return 0.0
    shared = defines.number(f"c{joint.capitalize()}HornOffset1", 0)
    return defines.number(f"c{code}{joint.capitalize()}HornOffset1", shared) / 10


def _limits(defines: Defines, code: str, joint: str, firmware: str) -> list[Decimal]:
    side = "left" if code.startswith("L") else "right"
    horn = _horn(defines, code, joint)
    pair = convert_limits(firmware, joint, _raw_limits(defines, code, joint), side=side, unit="tenths", horn=horn)
    return [Decimal(str(round(limit, 3))) for limit in pair]


def _joint(defines: Defines, code: str, j: int, joint: str, driver: Driver) -> JointCalibration:
    """Return a joint: the servo's angle is that of the code, negated where it is inverted."""
    right = code.startswith("R")
    inverted = defines.number(f"c{code}{joint.capitalize()}Inv", int(right))
    horn = _horn(defines, code, joint)
    # The code's angle at an angle of 0 here, and its sign.
    at_zero, sign = ((0.0, -1 if right else 1), (horn, -1), (90.0 - horn, 1))[j]
    turned = driver.turned(inverted=bool(inverted), right=right)
    return JointCalibration(
        bus="main",
        number=defines.number(f"c{code}{joint.capitalize()}Pin"),
        zero=driver.middle + turned * at_zero * driver.per_degree,
        direction=turned * sign,
        scale=driver.per_degree * 180 / math.pi,
        limits=driver.limits,
    )
