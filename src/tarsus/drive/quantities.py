"""Quantities of commands: their units in files and in text, their bounds, and the way to SI and back."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from decimal import Decimal
from types import MappingProxyType
from typing import Any, NamedTuple

from tarsus.robot.units import degrees, from_milli, radians, to_decimal, to_milli

__all__ = ["UNITS", "Quantity", "Unit", "quantity"]


class Unit(NamedTuple):
    """A unit of files.

    Attributes
    ----------
    shown : str
        How it is written in text and messages.
    others : mapping of str to Decimal
        What may be written in text, and how many of this unit it is.
    to_si, from_si : callable
        The way to SI and back, exact to the bit.
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
    }
)
"""The units that keys of a scenario end in."""


@dataclasses.dataclass(frozen=True)
class Quantity:
    """A number of a command.

    Attributes
    ----------
    name : str
        What it is called in Python and in text; in a file the unit follows.
    unit : str
        One of `UNITS`.
    low, high : float
        Its bounds, in that unit.
    text : str
        What it is.
    needed : bool
        Whether it must be given; else it is 0 where left out.
    """

    name: str
    unit: str
    low: float
    high: float
    text: str
    needed: bool = False

    @property
    def key(self) -> str:
        """Its key in a file, such as ``vx_mm_s``."""
        return f"{self.name}_{self.unit}"

    @property
    def shown(self) -> str:
        """Its unit in text, such as ``mm/s``."""
        return UNITS[self.unit].shown


def quantity(unit: str, text: str, *, low: float, high: float, needed: bool = False) -> Any:
    """Return the dataclass field of a quantity; its value is in SI.

    Parameters
    ----------
    unit : str
        Its unit in files: one of `UNITS`.
    text : str
        What it is.
    low, high : float
        Its bounds, in that unit.
    needed : bool
        Whether it must be given; else it is 0 where left out.
    """
    metadata = {"quantity": {"unit": unit, "text": text, "low": low, "high": high, "needed": needed}}
    if needed:
        return dataclasses.field(metadata=metadata)
    return dataclasses.field(default=0.0, metadata=metadata)
