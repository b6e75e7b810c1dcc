"""Joint limits of common firmware, converted to those of a robot file: zeros, signs and pulse widths.

Sources: github.com/KurtE/Arduino_Phoenix_Parts @35eb0e1 (Phoenix/Phoenix_Code.h, its configurations and drivers);
github.com/Freenove/Freenove_Big_Hexapod_Robot_Kit_for_Raspberry_Pi (Code/Server/control.py and servo.py).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import NamedTuple

from tarsus.errors import InputError, UnknownNameError
from tarsus.representation import represented
from tarsus.robot.shape import JOINTS

__all__ = ["FIRMWARE", "SIDES", "Firmware", "convert_limits"]

SIDES = ("left", "right")
"""Sides of the robot; in firmware, angles often have the opposite sign on one of them."""

_LARGEST = 180.0
_ROUNDING = 1e-6


class _Unit(NamedTuple):
    """A unit of limits: its value at an angle of 0, the degrees per unit, whether it measures the servo's own angle."""

    zero: float
    degrees: float
    of_servo: bool


_Signs = tuple[int, int, int]
_Angles = tuple[tuple[int, float], tuple[int, float], tuple[int, float]]


@represented("name", "units")
@dataclass(frozen=True, kw_only=True)
class Firmware:
    """Zeros, signs and units of a firmware's joint angles.

    Attributes
    ----------
    name : str
        Name of the firmware.
    units : mapping
        Units in which its limits may be given, by name.
    angles : mapping
        For each side, sign and offset of each joint [deg]: ours = sign * (angle of the firmware) + offset.
    servo_signs : mapping
        For each side, the sign of each joint's servo angle relative to the angle of the firmware.
    horns : tuple of float
        Usual offsets of the servo horns of coxa, femur and tibia, which the firmware's angles contain [deg].
    """

    name: str
    units: Mapping[str, _Unit]
    angles: Mapping[str, _Angles]
    servo_signs: Mapping[str, _Signs] = field(default_factory=lambda: dict.fromkeys(SIDES, (1, 1, 1)))
    horns: tuple[float, float, float] = (0.0, 0.0, 0.0)


# In Phoenix, positive angles turn the coxa to the rear, the femur down from level, and the tibia outward from a right
# angle with the femur. To the rear is counter-clockwise for the left legs, clockwise for the right ones.
_PHOENIX_ANGLES: Mapping[str, _Angles] = {"left": ((1, 0), (-1, 0), (1, -90)), "right": ((-1, 0), (-1, 0), (1, -90))}
_INVERTED_RIGHT: Mapping[str, _Signs] = {"left": (1, 1, 1), "right": (-1, -1, -1)}
# cPwmDiv = 991, cPFConst = 592: 1500 us at an angle of 0, 1000/99.1 us per degree.
_SSC32 = _Unit(1500, 0.0991, True)
# cPwmMult = 128, cPwmDiv = 375, for tenths of a degree.
_AX12 = _Unit(512, 37.5 / 128, True)

FIRMWARE: Mapping[str, Firmware] = MappingProxyType(
    {
        firmware.name: firmware
        for firmware in (
            Firmware(
                name="phoenix",
                units={"deg": _Unit(0, 1, False), "tenths": _Unit(0, 0.1, False), "us": _SSC32},
                angles=_PHOENIX_ANGLES,
                servo_signs=_INVERTED_RIGHT,
            ),
            Firmware(
                name="lynxmotion",
                units={"deg": _Unit(0, 1, True), "tenths": _Unit(0, 0.1, True), "us": _SSC32},
                angles=_PHOENIX_ANGLES,
                servo_signs=_INVERTED_RIGHT,
            ),
            Firmware(
                name="phantomx",
                units={"deg": _Unit(0, 1, False), "tenths": _Unit(0, 0.1, False), "ticks": _AX12},
                angles=_PHOENIX_ANGLES,
                servo_signs={"left": (1, 1, -1), "right": (-1, -1, 1)},
                horns=(0.0, -3.5, 46.3),
            ),
            Firmware(
                name="freenove",
                units={"deg": _Unit(0, 1, True), "us": _Unit(500, 0.09, True)},
                angles={"left": ((-1, 90), (-1, 90), (1, -180)), "right": ((-1, 90), (1, -90), (-1, 0))},
            ),
        )
    }
)
"""Firmware whose limits `convert_limits` converts, by name."""


def convert_limits(
    firmware: str,
    joint: str,
    limits: Sequence[float],
    *,
    side: str,
    unit: str = "deg",
    horn: float | None = None,
) -> tuple[float, float]:
    """Return the limits of a joint of some firmware as those of a robot file.

    Parameters
    ----------
    firmware : str
        One of `FIRMWARE`: ``"phoenix"`` (angles of the Phoenix code), ``"lynxmotion"`` (its configuration for the
        Lynxmotion Phoenix and the SSC-32, whose right legs have the signs of the servos), ``"phantomx"`` (its
        configuration for AX-12 servos) or ``"freenove"``.
    joint : str
        ``"coxa"``, ``"femur"`` or ``"tibia"``.
    limits : (float, float)
        Both limits, in any order.
    side : str
        ``"left"`` or ``"right"``.
    unit : str
        ``"deg"``, ``"tenths"`` of a degree, ``"us"`` (pulse width) or ``"ticks"``.
    horn : float, optional
        Offset of the servo horn in the firmware's angle [deg]. Default: that of the firmware.

    Returns
    -------
    low, high : float
        Limits for ``limits_deg`` [deg].

    Raises
    ------
    UnknownNameError
        If there is no such firmware, joint, side or unit.
    InputError
        If there are not two finite limits, or they are beyond half a turn.
    """
    if firmware not in FIRMWARE:
        raise UnknownNameError.of("firmware", firmware, FIRMWARE)
    known = FIRMWARE[firmware]
    for kind, name, names in (
        ("joint", joint, JOINTS),
        ("side", side, SIDES),
        (f"unit of the {firmware} firmware", unit, known.units),
    ):
        if name not in names:
            raise UnknownNameError.of(kind, name, names)
    if len(limits) != 2 or not all(math.isfinite(limit) for limit in limits):
        raise InputError(f"the limits of the {joint} are {limits!r}; they must be two finite numbers")
    j = JOINTS.index(joint)
    sign, offset = known.angles[side][j]
    zero, degrees, of_servo = known.units[unit]
    servo = known.servo_signs[side][j] if of_servo else 1
    shift = known.horns[j] if horn is None else horn
    # The horn's offset is added to the femur's angle and subtracted from the tibia's.
    shift *= -1 if joint == "tibia" else 1
    low, high = sorted(sign * (servo * degrees * (limit - zero) - shift) + offset for limit in limits)
    if low < -_LARGEST - _ROUNDING or high > _LARGEST + _ROUNDING:
        other = SIDES[1 - SIDES.index(side)]
        raise InputError(
            f"{joint}: {limits[0]:g} to {limits[1]:g} {unit} of a {side} leg of the {firmware} firmware are {low:.4g} "
            f"to {high:.4g} deg here, beyond half a turn: perhaps they are those of a {other} leg, have the sign of "
            f"the servo, or another unit ({', '.join(known.units)})"
        )
    return low + 0.0, high + 0.0
