"""Types of command line options: finite numbers, and comma-separated numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    _ParamType = click.ParamType[Any]
else:  # older versions of click can't be subscripted
    _ParamType = click.ParamType

__all__ = ["Numbers", "examples", "json_option", "number_option", "robot_argument"]

# Larger than any robot dimension, and far below the overflow of squares.
_MAX_VALUE = 1e9
# Units in messages, where they are not those of the help in lower case.
_UNITS = {"HZ": "Hz", "V": "V", "AH": "A h", "N": "", "NUMBER": ""}
_F = TypeVar("_F", bound=Callable[..., Any])


def _finite(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if abs(value) <= _MAX_VALUE else None


class Number(_ParamType):
    """A finite number in a unit, at least as large as one bound and larger than another."""

    name = "number"

    def __init__(self, unit: str, *, least: float, above: float) -> None:
        self.unit, self.least, self.above = _UNITS.get(unit, unit.lower()), least, above

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number; NaN, infinities and numbers out of range are rejected."""
        number = _finite(str(value))
        if number is None:
            self.fail(f"{value!r} is not a number between -1e9 and 1e9", param, ctx)
        if number < self.least or number <= self.above:
            bound = f"at least {self.least:g}" if number < self.least else f"greater than {self.above:g}"
            self.fail(f"{number:g} {self.unit}".rstrip() + f"; it must be {bound}", param, ctx)
        return number


class Numbers(_ParamType):
    """A fixed number of finite, comma-separated numbers."""

    name = "numbers"

    def __init__(self, *names: str) -> None:
        self.names = names

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        """Return the numbers."""
        if isinstance(value, tuple):
            return value
        numbers = [_finite(text) for text in str(value).split(",")]
        if len(numbers) != len(self.names) or None in numbers:
            self.fail(
                f"{value!r} is not {len(self.names)} numbers between -1e9 and 1e9, {','.join(self.names)}", param, ctx
            )
        return tuple(number for number in numbers if number is not None)


def number_option(
    flag: str, unit: str, text: str, *, least: float = -_MAX_VALUE, above: float = -math.inf, **more: Any
) -> Callable[[_F], _F]:
    """Return an option for a finite number, with its unit in the help; see `Number` for its bounds."""
    return click.option(flag, type=Number(unit, least=least, above=above), metavar=unit, help=text, **more)


def robot_argument(function: _F) -> _F:
    """Add the argument ROBOT."""
    return click.argument("robot", metavar="ROBOT")(function)


def json_option(function: _F) -> _F:
    """Add the option ``--json``."""
    return click.option("--json", "as_json", is_flag=True, help="Print a JSON document.")(function)


def examples(*lines: str) -> str:
    """Return example command lines for the end of a command's help, one per line."""
    return "\n".join(("\b", "Examples:", *(f"  {line}" for line in lines)))
