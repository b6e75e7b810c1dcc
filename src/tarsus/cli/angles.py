"""Joint angles from the command line: as arguments, alike for every leg, or from a file."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import click
import numpy as np

from tarsus.robot.robot import JOINTS, Robot

__all__ = ["read_angles"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

_LARGEST = 2**20
_MOST_DEGREES = 1e6


def read_angles(
    robot: Robot, given: tuple[str, ...], *, alike: tuple[float, float, float] | None, file: Path | None
) -> Floats:
    """Return the angles ``(legs, 3)`` [deg] that the options of `tarsus rest` give.

    Parameters
    ----------
    robot : Robot
        Whose angles they are.
    given : tuple of str
        The arguments.
    alike : tuple of float, optional
        Three angles for every leg [deg].
    file : Path, optional
        A JSON file.

    Raises
    ------
    UsageError
        If they are not exactly three finite angles for each leg, given in exactly one way.
    """
    if (bool(given) + (alike is not None) + (file is not None)) != 1:
        raise click.UsageError("give the angles in one way: as arguments, with --all, or with --file")
    if alike is not None:
        return np.tile(np.array(alike), (robot.legs, 1))
    values, where = (_from_file(file), f"{file}: ") if file is not None else (list(given), "")
    numbers = [_number(value, where=where) for value in values]
    needed = len(JOINTS) * robot.legs
    if len(numbers) != needed:
        raise click.UsageError(
            f"{where}{len(numbers)} angles; {robot.name} needs {needed}: coxa, femur, tibia of each of "
            f"{', '.join(robot.leg_codes)}"
        )
    return np.array(numbers).reshape(robot.legs, 3)


def _number(value: object, *, where: str) -> float:
    try:
        number = math.nan if isinstance(value, bool) or not isinstance(value, str | int | float) else float(value)
    except (ValueError, OverflowError):
        number = math.nan
    if not abs(number) <= _MOST_DEGREES:
        raise click.UsageError(
            f"{where}{str(value)[:60]!r} is not an angle: a number of degrees between -1e6 and 1e6 is expected"
        )
    return number


def _from_file(file: Path) -> list[Any]:
    """Return the values of a JSON file: a list, a list of lists, or an object with such a list."""
    document = _document(file)
    if isinstance(document, dict):
        document = document.get("angles_deg")
    if not isinstance(document, list):
        raise click.UsageError(f'{file}: expected a list of angles, or an object with "angles_deg"')
    return [value for item in document for value in (item if isinstance(item, list) else [item])]


def _document(file: Path) -> Any:
    try:
        with file.open("rb") as stream:
            content = stream.read(_LARGEST + 1)
    except OSError as error:
        raise click.UsageError(f"{file}: can't be read: {error.strerror}") from None
    if len(content) > _LARGEST:
        raise click.UsageError(f"{file}: larger than 1 MiB; a file of angles is short")
    try:
        return json.loads(content.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise click.UsageError(f"{file}: this is not JSON: {error}") from None
