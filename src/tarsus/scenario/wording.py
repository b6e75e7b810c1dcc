"""Conversion of commands from names and numbers and back, for files and text alike."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from decimal import Decimal
from types import MappingProxyType
from typing import Any, TypeAlias

from tarsus.robot.writer import toml_number
from tarsus.scenario.commands import Walk
from tarsus.scenario.quantities import UNITS, Quantity
from tarsus.scenario.timed_command import TimedCommand, quantities

__all__ = ["WORD", "Value", "command_from", "command_text", "numbers_of", "takes", "time_text"]

WORD = re.compile(r"[^\W\d][\w/-]*")
"""A name that needs no quotes in text."""

Value: TypeAlias = Decimal | str
"""A number in the unit used in files, or a word in its place."""

_ROUNDING = 1e-15

_SPEED = Quantity("speed", "mm_s", -10_000, 10_000, "speed along the heading")
_HEADING = Quantity("heading", "deg", -360, 360, "direction from the front; 90 is to the left")


def takes(kind: type[TimedCommand]) -> Mapping[str, Quantity]:
    """Return the numbers that a command takes: its own, and for a walk also speed and heading.

    Parameters
    ----------
    kind : type
        The command's class.
    """
    more = {each.name: each for each in (_SPEED, _HEADING)} if kind is Walk else {}
    return MappingProxyType({**more, **quantities(kind)})


def command_from(kind: type[TimedCommand], at: Decimal, numbers: Mapping[str, Value], **names: str) -> TimedCommand:
    """Return a command from its numbers in the units used in files.

    Parameters
    ----------
    kind : type
        The command's class.
    at : Decimal
        Time of the command [s].
    numbers : mapping of str to (Decimal or str)
        By name; numbers within their bounds, or words.
    **names : str
        Leg or gait.

    Raises
    ------
    ValueError
        If a number is missing, or two contradict each other.
    """
    known = takes(kind)
    missing = [_named(each) for name, each in known.items() if each.needed and name not in numbers]
    if missing:
        raise ValueError(f"{kind.word} needs {', '.join(missing)}")
    si: dict[str, Any] = {name: _to_si(known[name], value) for name, value in numbers.items()}
    heading = si.pop("heading", None)
    speed = si.pop("speed", None)
    if heading is not None and speed is None:
        raise ValueError("heading needs speed, the speed in that direction")
    if speed is not None:
        if si.keys() & {"vx", "vy"}:
            raise ValueError("speed and heading are the same as vx and vy; give one pair only")
        # Through rounding, cos(90 deg) is not exactly 0: a walk straight to the left would get a tiny forward speed.
        parts = (math.cos(heading or 0.0), math.sin(heading or 0.0))
        si |= {
            axis: speed * part if abs(part) > _ROUNDING else 0.0 for axis, part in zip(("vx", "vy"), parts, strict=True)
        }
    return kind(float(at), **si, **names)


def _named(each: Quantity) -> str:
    return f"{each.name} ({', or '.join((each.shown, *each.words))})"


def _to_si(each: Quantity, value: Value) -> float | str:
    return value if isinstance(value, str) else UNITS[each.unit].to_si(value)


def numbers_of(command: TimedCommand, *, zeros: bool = False) -> dict[str, Value]:
    """Return a command's numbers in the units used in files, or the words in their place.

    Parameters
    ----------
    command : Command
        The command.
    zeros : bool
        Whether to include optional numbers that are 0.
    """
    rows = {name: (each, getattr(command, name)) for name, each in quantities(type(command)).items()}
    return {
        name: value if isinstance(value, str) else UNITS[each.unit].from_si(value)
        for name, (each, value) in rows.items()
        if zeros or each.needed or value
    }


def time_text(at: float) -> str:
    """Return a time as text: ``2.5 s``."""
    return f"{toml_number(UNITS['s'].from_si(at))} s"


def command_text(command: TimedCommand) -> str:
    """Return a command as text, such as ``walk vx 100 mm/s``.

    Parameters
    ----------
    command : Command
        The command.
    """
    words = [command.word]
    for name in ("leg", "gait"):
        value = getattr(command, name, None)
        if value is not None:
            words.append(value if WORD.fullmatch(value) else json.dumps(value, ensure_ascii=False))
    known, numbers = quantities(type(command)), numbers_of(command)
    for name, number in numbers.items():
        if len(known) > 1:
            words.append(name)
        words += [number] if isinstance(number, str) else [toml_number(number), known[name].shown]
    return " ".join(words)
