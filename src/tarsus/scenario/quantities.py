"""Quantities of commands: units in files and in text, bounds, conversion to SI and back."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from decimal import Decimal
from types import MappingProxyType
from typing import Any, NamedTuple

from tarsus.errors import InputError
from tarsus.robot.units import degrees, from_milli, radians, to_decimal, to_milli

__all__ = ["UNITS", "Quantity", "Unit", "quantity", "require_quantity"]


class Unit(NamedTuple):
    """A unit of numbers in scenario files.

    Attributes
    ----------
    shown : str
        Its symbol in text and messages.
    others : mapping of str to Decimal
        Other symbols accepted in text, each with its size in this unit.
    to_si, from_si : callable
        Conversion to SI and back, exact to the bit.
    """

    shown: str
    others: Mapping[str, Decimal]
    to_si: Callable[[Decimal], float]
    from_si: Callable[[float], Decimal]


_LENGTHS = {"mm": Decimal(1), "cm": Decimal(10), "m": Decimal(1000)}

UNITS: Mapping[str, Unit] = MappingProxyType(
    {
        "mm": Unit("mm", _LENGTHS, from_milli, to_milli),
        "mm_s": Unit("mm/s", {f"{name}/s": size for name, size in _LENGTHS.items()}, from_milli, to_milli),
        "deg": Unit("deg", {"deg": Decimal(1)}, radians, degrees),
        "deg_s": Unit("deg/s", {"deg/s": Decimal(1)}, radians, degrees),
        "s": Unit("s", {"s": Decimal(1), "ms": Decimal("0.001")}, float, to_decimal),
        "ms": Unit("ms", {"ms": Decimal(1)}, from_milli, to_milli),
        "hz": Unit("Hz", {"Hz": Decimal(1)}, float, to_decimal),
        "": Unit("", {}, int, Decimal),
        "n": Unit("N", {"N": Decimal(1)}, float, to_decimal),
        "kg": Unit("kg", {"kg": Decimal(1)}, float, to_decimal),
        "ns_m": Unit("N s/m", {"N s/m": Decimal(1)}, float, to_decimal),
        "n_m": Unit("N/m", {"N/m": Decimal(1)}, float, to_decimal),
    }
)
"""The units in which keys of a scenario file end; the key ``""`` is that of numbers without a unit."""


@dataclasses.dataclass(frozen=True)
class Quantity:
    """A number of a command.

    Attributes
    ----------
    name : str
        Its name in Python and in text; in a file the unit is appended.
    unit : str
        One of `UNITS`.
    low, high : float
        Its bounds, in that unit.
    text : str
        What it describes.
    needed : bool
        Whether it is required; otherwise it is 0 where left out.
    words : tuple of str
        Words accepted in its place.
    """

    name: str
    unit: str
    low: float
    high: float
    text: str
    needed: bool = False
    words: tuple[str, ...] = ()

    @property
    def key(self) -> str:
        """Its key in a file, such as ``vx_mm_s``."""
        return f"{self.name}_{self.unit}" if self.unit else self.name

    @property
    def shown(self) -> str:
        """Its unit in text, such as ``mm/s``."""
        return UNITS[self.unit].shown


def quantity(
    unit: str, text: str, *, low: float, high: float, needed: bool = False, words: tuple[str, ...] = ()
) -> Any:
    """Return the dataclass field of a quantity; its value is in SI.

    Parameters
    ----------
    unit : str
        Its unit in files: one of `UNITS`.
    text : str
        What it describes.
    low, high : float
        Its bounds, in that unit.
    needed : bool
        Whether it is required; otherwise it is 0 where left out.
    words : tuple of str
        Words accepted in its place.
    """
    about = {"unit": unit, "text": text, "low": low, "high": high, "needed": needed, "words": words}
    metadata = {"quantity": about}
    if needed:
        return dataclasses.field(metadata=metadata)
    return dataclasses.field(default=0.0, metadata=metadata)


def require_quantity(what: str, value: object, wanted: Quantity) -> None:
    """Refuse a value that is neither a finite number within the bounds of a quantity nor one of its words.

    Parameters
    ----------
    what : str
        Its name, for the message.
    value : object
        The value, in SI.
    wanted : Quantity
        The quantity.

    Raises
    ------
    InputError
        If the value is neither.
    """
    if isinstance(value, str) and value in wanted.words:
        return
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        more = "".join(f", or {word!r}" for word in wanted.words)
        raise InputError(f"{what} is {value!r}; it must be a finite number{more}")
    number = UNITS[wanted.unit].from_si(float(value))
    low, high, shown = wanted.low, wanted.high, wanted.shown
    if not to_decimal(low) <= number <= to_decimal(high):
        unit = f" {shown}" if shown else ""
        raise InputError(f"{what} is {float(number):g}{unit}; it must be from {low:g} to {high:g}{unit}")
