"""Three numbers for each leg from the command line: as arguments, as one triple for every leg, or from a file."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from tarsus.errors import UnknownNameError
from tarsus.robot.robot import Robot
from tarsus.robot.special_file import is_pipe_or_device

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["ANGLES", "POINTS", "LegValues", "leg_of", "read_leg_values"]

_MAX_FILE_SIZE = 2**20
_MOST = 1e6


@dataclass(frozen=True)
class LegValues:
    """Description of the three numbers of a leg.

    Attributes
    ----------
    noun, kind : str
        Words for the three numbers, and for one of them, in messages.
    of : tuple of str
        Names of the three numbers.
    unit : str
        Their unit.
    key : str
        Their key in a JSON document.
    """

    noun: str
    kind: str
    of: tuple[str, str, str]
    unit: str
    key: str


ANGLES = LegValues("angles", "an angle", ("coxa", "femur", "tibia"), "deg", "angles_deg")
POINTS = LegValues("coordinates", "a coordinate", ("x", "y", "z"), "mm", "feet_mm")


def leg_of(robot: Robot, name: str) -> int:
    """Return the index of a leg, given by its short or its full name.

    Parameters
    ----------
    robot : Robot
        The robot.
    name : str
        Name of the leg, case-insensitive.

    Raises
    ------
    UnknownNameError
        If the robot has no such leg.
    """
    names = [*robot.leg_codes, *robot.leg_names]
    found = [index % robot.legs for index, known in enumerate(names) if known.lower() == name.lower()]
    if not found:
        raise UnknownNameError.of("leg", name, names)
    return found[0]


def read_leg_values(
    robot: Robot,
    what: LegValues,
    arguments: tuple[str, ...],
    *,
    same_for_all: tuple[float, float, float] | None,
    file: Path | None,
    leg: int | None = None,
) -> Float[np.ndarray, "legs 3"]:
    """Return three numbers for each leg, or for one, from the arguments or a file.

    Parameters
    ----------
    robot : Robot
        The robot.
    what : LegValues
        Description of the numbers.
    arguments : tuple of str
        Positional arguments of the command.
    same_for_all : tuple of float, optional
        Three numbers for every leg.
    file : Path, optional
        JSON file with the numbers.
    leg : int, optional
        Index of the one leg to which the numbers belong; they are returned for every leg.

    Returns
    -------
    array, shape (legs, 3)
        The numbers, in their unit.

    Raises
    ------
    UsageError
        If there are not exactly three finite numbers for each leg, from exactly one source.
    """
    if (bool(arguments) + (same_for_all is not None) + (file is not None)) != 1:
        raise click.UsageError(f"give the {what.noun} either as arguments, with --all, or with --file")
    if same_for_all is not None:
        return np.tile(np.array(same_for_all), (robot.legs, 1))
    values, prefix = (_from_file(file, what), f"{file}: ") if file is not None else (list(arguments), "")
    numbers = [_number(value, what, prefix=prefix) for value in values]
    legs = robot.leg_codes if leg is None else (robot.leg_codes[leg],)
    required = len(what.of) * len(legs)
    if len(numbers) != required:
        one = "; for one leg, name it with --leg" if leg is None and len(numbers) == len(what.of) else ""
        raise click.UsageError(
            f"{prefix}{len(numbers)} {what.noun}; {robot.name} needs {required}: {', '.join(what.of)} of "
            f"{', '.join(legs)}{one}"
        )
    return np.tile(np.array(numbers).reshape(-1, 3), (1 if leg is None else robot.legs, 1))


def _number(value: object, what: LegValues, *, prefix: str) -> float:
    try:
        number = math.nan if isinstance(value, bool) or not isinstance(value, str | int | float) else float(value)
    except (ValueError, OverflowError):
        number = math.nan
    if not abs(number) <= _MOST:
        # Values of a file are shown as they are written there: null, true, NaN.
        shown = repr(value[:60]) if isinstance(value, str) else json.dumps(value)[:60]
        raise click.UsageError(
            f"{prefix}{shown} is not {what.kind}; expected a number between -1e6 and 1e6 [{what.unit}]"
        )
    return number


def _from_file(file: Path, what: LegValues) -> list[Any]:
    """Return the values of a JSON file with a list, a list of lists, or an object with such a list."""
    document = _document(file)
    if isinstance(document, dict):
        document = document.get(what.key)
    if not isinstance(document, list):
        raise click.UsageError(f'{file}: expected a list of {what.noun}, or an object with "{what.key}"')
    return [value for item in document for value in (item if isinstance(item, list) else [item])]


def _document(file: Path) -> Any:
    if is_pipe_or_device(file):
        raise click.UsageError(f"{file} is a pipe or a device; give a regular file")
    try:
        with file.open("rb") as stream:
            content = stream.read(_MAX_FILE_SIZE + 1)
    except OSError as error:
        raise click.UsageError(f"{file} can't be read: {error.strerror}") from None
    if len(content) > _MAX_FILE_SIZE:
        raise click.UsageError(f"{file}: the file is larger than 1 MiB")
    try:
        return json.loads(content.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise click.UsageError(f"{file}: not valid JSON: {error}") from None
