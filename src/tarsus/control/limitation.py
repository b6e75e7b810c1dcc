"""Limitations: why a command is not met in full, as values."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple, Self

from tarsus.representation import represented

__all__ = ["Cause", "Limitation", "LimitationKind"]

# Unit in which the numbers of a kind are shown, and how many of them are in one SI unit.
_LENGTH, _FRACTION, _NUMBER = ("mm", 1000.0), ("%", 100.0), ("", 1.0)


class LimitationKind(StrEnum):
    """What a limitation is about, mostly a part of the command; the value is the name in records and messages.

    Attributes
    ----------
    unit : str
        Unit in which the numbers of the kind are shown.
    scale : float
        How many of these units are in one SI unit.
    """

    unit: str
    scale: float

    def __new__(cls, name: str, unit: str, scale: float) -> Self:
        """Return the member for a row of the table below."""
        kind = str.__new__(cls, name)
        kind._value_, kind.unit, kind.scale = name, unit, scale
        return kind

    TWIST = "twist", *_FRACTION
    BODY = "body", *_FRACTION
    BODY_HEIGHT = "body_height", *_LENGTH
    SWING_HEIGHT = "swing_height", *_LENGTH
    STANCE_WIDTH = "stance_width", *_LENGTH
    GAIT = "gait", *_NUMBER
    CYCLE_TIME = "cycle_time", "s", 1.0
    SWAY = "sway", *_FRACTION
    FOOT_TARGET = "foot_target", *_FRACTION
    STATE = "state", *_NUMBER
    GROUND = "ground", "mm/s", 1000.0
    ATTITUDE = "attitude", "deg", 180 / math.pi
    READINGS = "readings", *_NUMBER


@represented()
class Cause(NamedTuple):
    """What stops a motion or makes it impossible.

    Attributes
    ----------
    reason : str
        The reason in words, without numbers that change from tick to tick.
    leg : str
        Name of the leg that sets the bound; empty where none does.
    margin : float
        Static stability margin that would result [m]; NaN where the margin is not the reason.
    least_margin : float
        Least static stability margin that is allowed [m].
    """

    reason: str
    leg: str = ""
    margin: float = math.nan
    least_margin: float = math.nan

    def text(self) -> str:
        """Return the cause as a line of text."""
        cause = ": ".join(part for part in (self.leg, self.reason) if part)
        return cause + _margin_text(self.margin, self.least_margin)

    def limitation(self, kind: LimitationKind, *, asked: float = math.nan, granted: float = math.nan) -> Limitation:
        """Return the limitation of a kind that has this cause; `asked` and `granted` are those of `Limitation`."""
        reason, leg, margin, least = self
        return Limitation(
            kind=kind, cause=reason, leg=leg, asked=asked, granted=granted, margin=margin, least_margin=least
        )


@represented()
@dataclass(frozen=True, slots=True, kw_only=True)
class Limitation:
    """One reason why a command is not met in full.

    Attributes
    ----------
    kind : LimitationKind
        What is limited, mostly a part of the command.
    cause : str
        The reason in words, without numbers that change from tick to tick.
    leg, joint : str
        Name of the leg and of the joint that set the bound; empty where none does.
    asked, granted : float
        What was commanded and what is done, in SI units; fractions of the command (0 to 1) for twist, body pose, sway
        and foot targets; NaN where there is no number.
    bound : float
        The bound that is reached, in the unit of `asked`; NaN where it is no single number.
    margin, least_margin : float
        Static stability margin that would result, and the least that is allowed [m]; NaN where they are not the
        reason.
    """

    kind: LimitationKind
    cause: str
    leg: str = ""
    joint: str = ""
    asked: float = math.nan
    granted: float = math.nan
    bound: float = math.nan
    margin: float = math.nan
    least_margin: float = math.nan

    @property
    def key(self) -> tuple[str, str, str, str]:
        """What identifies a limitation from tick to tick: all of it but the numbers."""
        return (str(self.kind), self.cause, self.leg, self.joint)

    def text(self) -> str:
        """Return the limitation as a line of text, in mm, degrees, seconds and percent."""
        where = " ".join(name for name in (self.leg, self.joint) if name)
        numbers = [self._granted_text(), self._value("bound ", self.bound)]
        reason = Cause(self.cause, where, self.margin, self.least_margin).text()
        parts = [", ".join(part for part in numbers if part), reason]
        return f"{self.kind}: " + "; ".join(part for part in parts if part)

    def _granted_text(self) -> str:
        granted = self._value("", self.granted)
        if not granted or math.isnan(self.asked):
            return granted
        if self.kind.unit == "%":
            return f"{granted} of the command"
        return f"{granted} instead of {self._value('', self.asked)}"

    def _value(self, prefix: str, value: float) -> str:
        if math.isnan(value):
            return ""
        number = f"{value * self.kind.scale:{'.0f' if self.kind.unit == '%' else '.4g'}}"
        return f"{prefix}{number} {self.kind.unit}".strip()


def _margin_text(margin: float, least: float) -> str:
    if math.isnan(margin):
        return ""
    if math.isinf(margin):
        return ", without a support polygon"
    side = "outside" if margin < 0 else "inside"
    needed = "" if math.isnan(least) else f" (at least {1000 * least:.0f} mm inside needed)"
    return f", {1000 * abs(margin):.0f} mm {side} its support polygon{needed}"
