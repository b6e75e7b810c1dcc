"""The base of every command of a scenario: its time, and quantities within their bounds."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

from tarsus.errors import UnknownNameError
from tarsus.gait.gait import GAITS
from tarsus.scenario.quantities import Quantity, require_quantity

__all__ = ["GAIT_NAMES", "LATEST", "TimedCommand", "quantities"]

GAIT_NAMES = (*GAITS, "amble")
"""Names of gaits in a scenario; amble is an alias of tetrapod."""

LATEST = 3600.0
"""Greatest time of a command [s]."""

_AT = Quantity("at", "s", 0, LATEST, "time of the command", needed=True)


@dataclass(frozen=True)
class TimedCommand:
    """A command to the robot at a time.

    Attributes
    ----------
    at : float
        Time of the command [s].
    """

    word: ClassVar[str] = ""
    at: float

    def __post_init__(self) -> None:
        require_quantity(f"{self.word}: at", self.at, _AT)
        for each in quantities(type(self)).values():
            value = getattr(self, each.name)
            require_quantity(f"{self.word} at {self.at:g} s: {each.name}", value, each)
        gait = getattr(self, "gait", GAIT_NAMES[0])
        if gait not in GAIT_NAMES:
            raise UnknownNameError.of("gait", str(gait), GAIT_NAMES)


def quantities(kind: type[TimedCommand]) -> Mapping[str, Quantity]:
    """Return the quantities of a command by their names.

    Parameters
    ----------
    kind : type
        The command's class.
    """
    fields = ((field.name, field.metadata.get("quantity")) for field in dataclasses.fields(kind))
    return MappingProxyType({name: Quantity(name=name, **about) for name, about in fields if about is not None})
