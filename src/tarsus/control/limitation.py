"""Limitations: why a command is not met in full, as values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

__all__ = ["Limitation", "LimitationKind"]

_NONE = math.nan


class LimitationKind(StrEnum):
    """What of a command is not met in full; the value is the name in records and messages."""

    TWIST = "twist"
    BODY = "body"
    BODY_HEIGHT = "body_height"
    SWING_HEIGHT = "swing_height"
    STANCE_WIDTH = "stance_width"
    GAIT = "gait"
    CYCLE_TIME = "cycle_time"
    SWAY = "sway"
    FOOT_TARGET = "foot_target"
    STATE = "state"
    GROUND = "ground"
    ATTITUDE = "attitude"
    READINGS = "readings"


_UNITS = {
    LimitationKind.TWIST: ("%", 100.0),
    LimitationKind.BODY: ("%", 100.0),
    LimitationKind.BODY_HEIGHT: ("mm", 1000.0),
    LimitationKind.SWING_HEIGHT: ("mm", 1000.0),
    LimitationKind.STANCE_WIDTH: ("mm", 1000.0),
    LimitationKind.CYCLE_TIME: ("s", 1.0),
    LimitationKind.SWAY: ("%", 100.0),
    LimitationKind.FOOT_TARGET: ("%", 100.0),
    LimitationKind.ATTITUDE: ("deg", 180 / math.pi),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Limitation:
    """One reason why a command is not met in full.

    Attributes
    ----------
    kind : LimitationKind
        The part of the command.
    cause : str
        The reason in words, without numbers that change from tick to tick.
    leg, joint : str
        Name of the leg and of the joint that set the bound; empty where none does.
    asked, granted : float
        What was commanded and what is done, in SI units; fractions of the command (0 to 1) for twist, body pose, sway
        and foot targets; NaN where there is no number.
    bound : float
        The bound that is reached, in the unit of `asked`; NaN where it is no single number.
    """

    kind: LimitationKind
    cause: str
    leg: str = ""
    joint: str = ""
    asked: float = _NONE
    granted: float = _NONE
    bound: float = _NONE

    @property
    def key(self) -> tuple[str, str, str, str]:
        """What identifies a limitation from tick to tick: all of it but the numbers."""
        return (str(self.kind), self.cause, self.leg, self.joint)

    def text(self) -> str:
        """Return it as a line of text, in mm, degrees and percent."""
        unit, scale = _UNITS.get(self.kind, ("", 1.0))
        where = " ".join(name for name in (self.leg, self.joint) if name)
        numbers = []
        if not math.isnan(self.granted):
            asked = "" if math.isnan(self.asked) else f" of {self.asked * scale:.4g}"
            numbers.append(f"{self.granted * scale:.4g}{asked} {unit}".strip())
        if not math.isnan(self.bound):
            numbers.append(f"bound {self.bound * scale:.4g} {unit}".strip())
        parts = [", ".join(numbers), ": ".join(part for part in (where, self.cause) if part)]
        return f"{self.kind}: " + "; ".join(part for part in parts if part)
