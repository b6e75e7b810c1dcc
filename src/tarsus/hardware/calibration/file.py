"""Calibration files: reading and writing, beside the robot file."""

from __future__ import annotations

import os
import tempfile
import tomllib
from decimal import Decimal
from pathlib import Path

from tarsus.errors import CalibrationError
from tarsus.hardware.calibration.document import fields_from_document
from tarsus.hardware.calibration.fields import CalibrationFields
from tarsus.hardware.calibration.lines import key_lines
from tarsus.hardware.calibration.written_document import decimal_document
from tarsus.robot.parse import toml_problem
from tarsus.robot.robot import Robot
from tarsus.robot.special_file import is_pipe_or_device
from tarsus.robot.writer import toml_text

__all__ = ["calibration_text", "parse_calibration", "read_calibration", "write_calibration"]

_LARGEST = 2**20


def read_calibration(path: str | os.PathLike[str], *, robot: Robot | None = None) -> CalibrationFields:
    """Read a calibration file (TOML).

    Parameters
    ----------
    path : path
        Where it is.
    robot : Robot, optional
        The robot; that which the file names where left out.

    Raises
    ------
    CalibrationError
        If it can't be read, something in it is wrong, or it contradicts the robot; each line of the message names a
        key, the line and what is allowed.
    """
    where = str(path)
    return parse_calibration(_text(Path(path), where), where=where, folder=Path(path).parent, robot=robot)


def parse_calibration(text: str, *, where: str, folder: Path, robot: Robot | None = None) -> CalibrationFields:
    """Return the values of a calibration from the text of its file.

    Parameters
    ----------
    text : str
        TOML.
    where : str
        Name of the source in error messages.
    folder : Path
        Folder from which the path of the robot file is taken.
    robot : Robot, optional
        The robot; that which the file names where left out.

    Raises
    ------
    CalibrationError
        If something in it is wrong, or it contradicts the robot; each line of the message names a key, the line and
        what is allowed.
    """
    try:
        document = tomllib.loads(text, parse_float=Decimal)
    except (ValueError, ArithmeticError, RecursionError) as error:
        raise CalibrationError(where, [toml_problem(error, text)]) from None
    return fields_from_document(document, where=where, folder=folder, robot=robot, lines=key_lines(text))


def calibration_text(calibration: CalibrationFields) -> str:
    """Return the text of a calibration file; it reads back to the same calibration, to the bit.

    Parameters
    ----------
    calibration : CalibrationFields
        The calibration.
    """
    return toml_text(decimal_document(calibration))


def write_calibration(calibration: CalibrationFields, path: str | os.PathLike[str]) -> None:
    """Write a calibration file; a reader finds the old file or the new one, never a part of it.

    Parameters
    ----------
    calibration : CalibrationFields
        The calibration.
    path : path
        Where to write it.

    Raises
    ------
    CalibrationError
        If it can't be written.
    """
    target, text = Path(path), calibration_text(calibration)
    try:
        with tempfile.NamedTemporaryFile("wb", dir=target.parent, prefix=f".{target.name}", delete=False) as file:
            file.write(text.encode())
            file.flush()
            os.fsync(file.fileno())
        Path(file.name).chmod(0o644)
        Path(file.name).replace(target)
    except (OSError, ValueError) as error:
        reason = (error.strerror or "is not a regular file") if isinstance(error, OSError) else "is not a valid path"
        raise CalibrationError(str(path), [f"can't be written: {reason}"]) from None


def _text(path: Path, where: str) -> str:
    try:
        if is_pipe_or_device(path):
            raise CalibrationError(where, ["is a pipe or a device; a calibration is a regular file"])
        with path.open("rb") as file:
            content = file.read(_LARGEST + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "is not a valid path"
        hint = "; tarsus calibration new writes one" if isinstance(error, FileNotFoundError) else ""
        raise CalibrationError(where, [f"can't be read: {reason}{hint}"]) from None
    if len(content) > _LARGEST:
        raise CalibrationError(where, ["is larger than 1 MiB; a calibration has a few kilobytes"])
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise CalibrationError(where, [f"byte {error.start} is not UTF-8; a calibration is a text file"]) from None
