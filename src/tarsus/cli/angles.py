"""Joint angles from the command line: as arguments, the same for every leg, or from a file."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["read_angles"]

_MAX_FILE_SIZE = 2**20
_MAX_DEGREES = 1e6


def read_angles(
    robot: Robot, arguments: tuple[str, ...], *, same_for_all: tuple[float, float, float] | None, file: Path | None
) -> Float[np.ndarray, "legs 3"]:
    """Return the joint angles given to `tarsus rest`.

    Parameters
    ----------
    robot : Robot
        The robot.
    arguments : tuple of str
        Positional arguments of the command.
    same_for_all : tuple of float, optional
        Three angles for every leg [deg].
    file : Path, optional
        JSON file with the angles.

    Returns
    -------
    array, shape (legs, 3)
        Joint angles [deg].

    Raises
    ------
    UsageError
        If there are not exactly three finite angles for each leg, from exactly one source.
    """
    if (bool(arguments) + (same_for_all is not None) + (file is not None)) != 1:
        raise click.UsageError("give the angles either as arguments, with --all, or with --file")
    if same_for_all is not None:
        return np.tile(np.array(same_for_all), (robot.legs, 1))
    values, prefix = (_from_file(file), f"{file}: ") if file is not None else (list(arguments), "")
    numbers = [_number(value, prefix=prefix) for value in values]
    required = len(JOINTS) * robot.legs
    if len(numbers) != required:
        raise click.UsageError(
            f"{prefix}{len(numbers)} angles; {robot.name} needs {required}: coxa, femur, tibia of "
            f"{', '.join(robot.leg_codes)}"
        )
    return np.array(numbers).reshape(robot.legs, 3)


def _number(value: object, *, prefix: str) -> float:
    try:
        number = math.nan if isinstance(value, bool) or not isinstance(value, str | int | float) else float(value)
    except (ValueError, OverflowError):
        number = math.nan
    if not abs(number) <= _MAX_DEGREES:
        raise click.UsageError(
            f"{prefix}{str(value)[:60]!r} is not an angle; expected a number between -1e6 and 1e6 [deg]"
        )
    return number


def _from_file(file: Path) -> list[Any]:
    """Return the values of a JSON file with a list, a list of lists, or an object with such a list."""
    document = _document(file)
    if isinstance(document, dict):
        document = document.get("angles_deg")
    if not isinstance(document, list):
        raise click.UsageError(f'{file}: expected a list of angles, or an object with "angles_deg"')
    return [value for item in document for value in (item if isinstance(item, list) else [item])]


def _document(file: Path) -> Any:
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
