"""Settings of a scenario: their keys, units and bounds, and their conversion from the file to SI and back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from decimal import Decimal
from types import MappingProxyType
from typing import Any, NamedTuple

from tarsus.control.pose.admittance import Admittance
from tarsus.scenario.quantities import UNITS, Quantity
from tarsus.scenario.timed_command import LATEST

__all__ = ["ADMITTANCE", "LEVELLINGS", "NUMBERS", "SETTINGS", "STARTS", "Setting", "settings_of"]

STARTS = ("standing", "sitting", "folded")
"""Initial states of the robot."""

LEVELLINGS = ("level", "between", "follow", "none")
"""Body attitudes on sloping ground: level, halfway between level and slope, along the slope, or uncontrolled."""

NUMBERS = (
    Quantity("rate", "hz", 20, 1000, "control rate"),
    Quantity("jitter", "ms", 0, 25, "largest random deviation of a tick's duration"),
    Quantity("seed", "", 0, 2**53, "seed of the random numbers"),
    Quantity("duration", "s", 0.1, LATEST, "duration"),
    Quantity("body_height", "mm", 0.001, 1000, "height of the body's origin above the ground at the start"),
    Quantity("swing_height", "mm", 0, 1000, "swing height at the start"),
)
"""Settings that are one number."""

# Within these bounds, `Admittance` accepts every combination of numbers.
ADMITTANCE = (
    Quantity("mass", "kg", 0.1, 1000, "virtual mass of a foot", needed=True),
    Quantity("damping", "ns_m", 0.001, 100_000, "virtual damping of a foot", needed=True),
    Quantity("stiffness", "n_m", 0.1, 1_000_000, "virtual stiffness of a foot", needed=True),
    Quantity("travel", "mm", 0.1, 100, "largest displacement of a foot"),
)
"""Parameters of the admittance."""


def _admittance(table: Any) -> Admittance:
    given = {each.name: (each, getattr(table, each.key)) for each in ADMITTANCE}
    return Admittance(**{n: UNITS[each.unit].to_si(value) for n, (each, value) in given.items() if value is not None})


def _admittance_keys(admittance: Admittance) -> dict[str, Decimal]:
    return {each.key: UNITS[each.unit].from_si(getattr(admittance, each.name)) for each in ADMITTANCE}


class Setting(NamedTuple):
    """How a setting is stored in a file.

    Attributes
    ----------
    key : str
        Key in the file.
    read, write : callable
        Conversion from the value in the file to SI, and back.
    """

    key: str
    read: Callable[[Any], Any]
    write: Callable[[Any], Any]


def _numeric(each: Quantity) -> Setting:
    return Setting(each.key, UNITS[each.unit].to_si, UNITS[each.unit].from_si)


SETTINGS: Mapping[str, Setting] = MappingProxyType(
    {
        **{name: Setting(name, str, str) for name in ("name", "robot", "start", "gait", "levelling")},
        **{each.name: _numeric(each) for each in NUMBERS},
        "admittance": Setting("admittance", _admittance, _admittance_keys),
    }
)
"""All attributes of a scenario except its commands."""


def settings_of(file: Any) -> dict[str, Any]:
    """Return the attributes that a file sets.

    Parameters
    ----------
    file : ScenarioFile
        The file.
    """
    given = {name: (getattr(file, setting.key), setting.read) for name, setting in SETTINGS.items()}
    return {name: read(value) for name, (value, read) in given.items() if value is not None}
