"""The servo catalogue: data of real servos, each with its source and confidence.

The table is ``servos.csv`` next to this module. An empty field is unknown, never zero.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from decimal import Decimal
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from tarsus.errors import UnknownNameError
from tarsus.robot.servo import Servo
from tarsus.robot.units import degrees, from_milli, radians, to_decimal, to_milli

__all__ = ["figures_of", "list_servos", "load_servo", "servo_catalogue", "servo_of"]

_CSV = Path(__file__).with_name("servos.csv")

# Data of a servo: key in the catalogue and in robot files, attribute of `Servo`, conversion to it and back.
_FIGURES: dict[str, tuple[str, Callable[[Decimal], float], Callable[[float], Decimal]]] = {
    "stall_torque_nm": ("stall_torque", float, to_decimal),
    "torque_at_v": ("torque_at", float, to_decimal),
    "rated_torque_nm": ("rated_torque", float, to_decimal),
    "no_load_rad_s": ("no_load_speed", float, to_decimal),
    "speed_at_v": ("speed_at", float, to_decimal),
    "stall_current_a": ("stall_current", float, to_decimal),
    "mass_g": ("mass", from_milli, to_milli),
    "travel_deg": ("travel", radians, degrees),
}
_SUPPLY = ("supply_min_v", "supply_max_v")
_TEXTS = ("maker", "control", "gear", "feedback", "confidence", "source", "note")


def list_servos() -> tuple[str, ...]:
    """Return the names of the servos in the catalogue."""
    return tuple(servo_catalogue())


def load_servo(name: str) -> Servo:
    """Return a servo of the catalogue.

    Parameters
    ----------
    name : str
        One of `list_servos`, case-insensitive.

    Raises
    ------
    UnknownNameError
        If the catalogue has no servo of that name; the message suggests the nearest.
    """
    servo = _by_lower_name().get(name.lower())
    if servo is None:
        raise UnknownNameError.of("servo", name, list_servos())
    return servo


@cache
def servo_catalogue() -> Mapping[str, Servo]:
    """Return the catalogue: servos by name, in the order of the table."""
    with _CSV.open(encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    return MappingProxyType({row["name"]: servo_of({k: v or None for k, v in row.items()}) for row in rows})


@cache
def _by_lower_name() -> dict[str, Servo]:
    return {name.lower(): servo for name, servo in servo_catalogue().items()}


def servo_of(figures: Mapping[str, Any]) -> Servo:
    """Return the servo with these data: decimals, or their text, under keys with units; None where unknown."""
    values: dict[str, Any] = {"name": figures["name"]}
    for key, (attribute, convert, _) in _FIGURES.items():
        if figures[key] is not None:
            values[attribute] = convert(Decimal(figures[key]))
    if figures[_SUPPLY[0]] is not None:
        values["supply"] = tuple(float(figures[key]) for key in _SUPPLY)
    values |= {key: figures[key] or "" for key in _TEXTS}
    return Servo(**values)


def figures_of(servo: Servo) -> dict[str, Decimal | str]:
    """Return the known data of a servo under keys with units, as `servo_of` takes them."""
    figures: dict[str, Decimal | str] = {"name": servo.name}
    for key, (attribute, _, convert) in _FIGURES.items():
        if getattr(servo, attribute) is not None:
            figures[key] = convert(getattr(servo, attribute))
    if servo.supply is not None:
        figures |= {key: to_decimal(volts) for key, volts in zip(_SUPPLY, servo.supply, strict=True)}
    return figures | {key: getattr(servo, key) for key in _TEXTS if getattr(servo, key)}
