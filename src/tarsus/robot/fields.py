"""Kinds of values in robot and scenario files: each checks a value, words its error and describes itself.

A check raises one type of pydantic error, whose text is the complete message; the description goes into the JSON schema
that editors use.
"""

from __future__ import annotations

import math
import re
from abc import ABC, abstractmethod
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import numpy as np
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from tarsus.errors import nearest_name
from tarsus.robot.catalogue import list_servos
from tarsus.robot.plain_name import PLAIN, control_character
from tarsus.robot.units import to_decimal

__all__ = ["REFUSED", "Choice", "JointRange", "Number", "Numbers", "ServoName", "Text", "refuse"]

REFUSED = "tarsus"
"""Type of the pydantic errors raised here."""

_LONGEST_TEXT = 1000
_ORDINALS = ("first", "second", "third")


def refuse(why: str) -> PydanticCustomError:
    """Return the pydantic error whose complete message is `why`."""
    return PydanticCustomError(REFUSED, "{why}", {"why": why})


class _Kind(ABC):
    """A kind of value; pydantic calls `check` for validation and `describe` for the JSON schema."""

    @abstractmethod
    def check(self, value: object) -> Any:
        """Return the value for building the robot; raise an error if it is not allowed."""

    @abstractmethod
    def describe(self) -> dict[str, Any]:
        """Return the JSON schema."""

    def __get_pydantic_core_schema__(self, source: object, handler: object) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)

    def __get_pydantic_json_schema__(self, schema: object, handler: object) -> dict[str, Any]:
        return self.describe()


@dataclass(frozen=True)
class Number(_Kind):
    """A finite number from `low` to `high`, in `unit`."""

    low: float
    high: float
    unit: str

    @property
    def allowed(self) -> str:
        """The range as text."""
        return f"from {self.low:g} to {self.high:g} {self.unit}"

    def check(self, value: object) -> Decimal:
        """Return the value as the decimal written in the file."""
        number = _decimal(_unwrap(value))
        if number is None:
            is_text = isinstance(value, str) and re.match(r"\s*[-+.]?\d", value)
            bare = ", without quotes and without a unit" if is_text else ""
            raise refuse(f"must be a number {self.allowed}{bare}")
        if not number.is_finite():
            raise refuse(f"must be a finite number {self.allowed}")
        if not to_decimal(self.low) <= number <= to_decimal(self.high):
            raise refuse(f"must be {self.allowed}")
        return number

    def describe(self) -> dict[str, Any]:
        """Return the JSON schema."""
        return {"type": "number", "minimum": _plain(self.low), "maximum": _plain(self.high)}


@dataclass(frozen=True)
class Numbers(_Kind):
    """A list of `count` numbers of the kind `each`."""

    count: int
    each: Number

    def check(self, value: object) -> tuple[Decimal, ...]:
        """Return the values as decimals."""
        value = _unwrap(value)
        what = f"a list of {self.count} numbers {self.each.allowed}"
        if not isinstance(value, list | tuple):
            raise refuse(f"must be {what}")
        if len(value) != self.count:
            raise refuse(f"must be {what}, and has {len(value)}")
        numbers = []
        for ordinal, item in zip(_ORDINALS, value, strict=False):
            try:
                numbers.append(self.each.check(item))
            except PydanticCustomError as error:
                raise refuse(f"the {ordinal} number {error.message()}") from None
        return tuple(numbers)

    def describe(self) -> dict[str, Any]:
        """Return the JSON schema."""
        size = {"minItems": self.count, "maxItems": self.count}
        return {"type": "array", "items": self.each.describe(), **size}


@dataclass(frozen=True)
class JointRange(Numbers):
    """The lower and the upper limit of a joint; errors name another unit or zero in which they may have been typed."""

    def check(self, value: object) -> tuple[Decimal, ...]:
        """Return the limits as decimals."""
        try:
            low, high = super().check(value)
        except PydanticCustomError as error:
            raise refuse(f"{error.message()}{_likely_angles(value)}") from None
        if low > high:
            raise refuse("the limits are reversed; the lower limit comes first")
        return low, high


def _likely_angles(value: object) -> str:
    """Return what two limits beyond half a turn may be instead of angles in degrees."""
    value = _unwrap(value)
    limits = [_decimal(item) for item in value] if isinstance(value, list | tuple) else []
    if len(limits) != 2 or any(limit is None or not limit.is_finite() for limit in limits):
        return ""
    low, high = sorted(float(limit) for limit in limits if limit is not None)
    if low >= 400 and high <= 2600:
        what = "these look like pulse widths in us"
    elif low < 0 and high <= 1800 and low >= -1800 and max(-low, high) > 360:
        what = "these look like tenths of a degree, as in the Phoenix firmware"
    elif low >= 0 and high in (1023, 4095):
        what = "these look like the ticks of a servo"
    elif low >= -360 and high <= 360:
        what = "the angles are measured from another direction; at 0 the leg is straight, and the coxa at yaw_deg"
    else:
        return ""
    return f". Likely cause: {what}; tarsus robots convert-limits converts those of common firmware"


@dataclass(frozen=True)
class Text(_Kind):
    """A string, not empty unless `empty` allows it, and without control characters if it is a `label`."""

    empty: bool = False
    label: bool = False

    def check(self, value: object) -> str:
        """Return the string."""
        if not isinstance(value, str):
            raise refuse('must be text in quotes, such as "front left"')
        if len(value) > _LONGEST_TEXT:
            raise refuse(f"must be no longer than {_LONGEST_TEXT} characters, and has {len(value)}")
        if not value and not self.empty:
            raise refuse("must not be empty")
        if not value.isascii() and any(0xD800 <= ord(character) <= 0xDFFF for character in value):
            raise refuse("must be valid Unicode text; it contains an unpaired surrogate")
        if self.label and (code := control_character(value)):
            raise refuse(f"must not contain control characters, such as {code}")
        return value

    def describe(self) -> dict[str, Any]:
        """Return the JSON schema."""
        pattern = {"pattern": PLAIN} if self.label else {}
        return {"type": "string", "minLength": int(not self.empty), "maxLength": _LONGEST_TEXT, **pattern}


@dataclass(frozen=True)
class Choice(_Kind):
    """One of the strings `options`."""

    options: tuple[str, ...]

    def check(self, value: object) -> str:
        """Return the string."""
        if isinstance(value, str) and value in self.options:
            return value
        raise refuse(f"must be one of {', '.join(self.options)}{_hint(value, self.options)}")

    def describe(self) -> dict[str, Any]:
        """Return the JSON schema."""
        return {"type": "string", "enum": list(self.options)}


@dataclass(frozen=True)
class ServoName(_Kind):
    """The name of a servo in the catalogue, case-insensitive."""

    def check(self, value: object) -> str:
        """Return the name."""
        name, known = str(value), list_servos()
        if name.lower() in {each.lower() for each in known}:
            return name
        raise refuse(f"the catalogue has no such servo{_hint(name, known)} Known: {', '.join(known)}")

    def describe(self) -> dict[str, Any]:
        """Return the JSON schema."""
        return {"type": "string", "examples": list(list_servos())}


def _hint(value: object, options: tuple[str, ...]) -> str:
    nearest = nearest_name(value[:_LONGEST_TEXT], options) if isinstance(value, str) else None
    return f"; did you mean {nearest!r}?" if nearest else ""


def _unwrap(value: object) -> object:
    """Return NumPy numbers and arrays, which a document built in Python may contain, as Python values."""
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def _decimal(value: object) -> Decimal | None:
    """Return a number as a decimal; None for anything else, including bools."""
    if isinstance(value, bool):
        return None
    if isinstance(value, int):
        # An integer of a million digits (0x...) would take minutes to convert.
        return Decimal(value) if value.bit_length() <= 64 else Decimal(10**20).copy_sign(-1 if value < 0 else 1)
    if isinstance(value, float):
        return to_decimal(value) if math.isfinite(value) else Decimal("NaN")
    return value if isinstance(value, Decimal) else None


def _plain(value: float) -> float:
    return int(value) if value == int(value) else value
