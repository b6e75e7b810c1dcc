"""What a scenario sets before it begins: the keys in its file, and the way from there to SI and back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from decimal import Decimal
from types import MappingProxyType
from typing import Any, NamedTuple

from tarsus.control.pose.admittance import Admittance
from tarsus.robot.units import from_milli, to_decimal, to_milli
from tarsus.scenario.quantities import UNITS, Quantity

__all__ = ["ADMITTANCE", "SETTINGS", "Setting", "settings_of"]

# Within these bounds no admittance is too fast to be one.
ADMITTANCE = (
    Quantity("mass", "kg", 0.1, 1000, "virtual mass of a foot", needed=True),
    Quantity("damping", "ns_m", 0.001, 100_000, "its virtual damper", needed=True),
    Quantity("stiffness", "n_m", 0.1, 1_000_000, "its virtual spring", needed=True),
    Quantity("travel", "mm", 0.1, 100, "how far it gives way at the most"),
)
"""The numbers of how feet give way."""


def _admittance(table: Any) -> Admittance:
    given = {each.name: (each, getattr(table, each.key)) for each in ADMITTANCE}
    return Admittance(**{n: UNITS[each.unit].to_si(value) for n, (each, value) in given.items() if value is not None})


def _admittance_keys(admittance: Admittance) -> dict[str, Decimal]:
    return {each.key: UNITS[each.unit].from_si(getattr(admittance, each.name)) for each in ADMITTANCE}


class Setting(NamedTuple):
    """How a setting is written.

    Attributes
    ----------
    key : str
        Its key.
    read, write : callable
        The way from its value in the file to SI, and back.
    """

    key: str
    read: Callable[[Any], Any]
    write: Callable[[Any], Any]


SETTINGS: Mapping[str, Setting] = MappingProxyType(
    {
        "name": Setting("name", str, str),
        "robot": Setting("robot", str, str),
        "rate": Setting("rate_hz", float, to_decimal),
        "jitter": Setting("jitter_ms", from_milli, to_milli),
        "seed": Setting("seed", int, Decimal),
        "start": Setting("start", str, str),
        "duration": Setting("duration_s", float, to_decimal),
        "gait": Setting("gait", str, str),
        "body_height": Setting("body_height_mm", from_milli, to_milli),
        "swing_height": Setting("swing_height_mm", from_milli, to_milli),
        "levelling": Setting("levelling", str, str),
        "admittance": Setting("admittance", _admittance, _admittance_keys),
    }
)
"""Every attribute of a scenario but its commands."""


def settings_of(file: Any) -> dict[str, Any]:
    """Return the attributes that a file sets.

    Parameters
    ----------
    file : ScenarioFile
        The file.
    """
    given = {name: (getattr(file, setting.key), setting.read) for name, setting in SETTINGS.items()}
    return {name: read(value) for name, (value, read) in given.items() if value is not None}
