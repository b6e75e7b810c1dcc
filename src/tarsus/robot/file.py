"""Robot files: reading, writing, and the presets of Tarsus."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from tarsus.errors import InputError, RobotFileError, nearest_name
from tarsus.robot.build import build_robot
from tarsus.robot.document import decimal_document, plain
from tarsus.robot.parse import parse_toml
from tarsus.robot.preset_names import PRESETS, preset_names
from tarsus.robot.problems import problems_of
from tarsus.robot.robot import Robot
from tarsus.robot.schema import RobotFile
from tarsus.robot.special_file import is_pipe_or_device
from tarsus.robot.writer import toml_string, toml_text

__all__ = [
    "file_text",
    "list_robots",
    "load_robot",
    "robot_from_dict",
    "robot_from_text",
    "robot_text",
    "robot_to_dict",
    "save_robot",
    "template_text",
]

_HERE = Path(__file__).parent
_LARGEST = 2**20


def list_robots() -> tuple[str, ...]:
    """Return the names of the preset robots."""
    return preset_names()


def load_robot(name_or_path: str | os.PathLike[str]) -> Robot:
    """Load a robot.

    Parameters
    ----------
    name_or_path : str or path
        One of `list_robots`, or the path of a robot file.

    Raises
    ------
    InputError
        If it is neither a name nor a path.
    RobotFileError
        If there is no such robot, its file can't be read, or something in it is wrong; each line of the message names a
        key, its value and what is allowed.
    """
    if isinstance(name_or_path, str) and name_or_path in list_robots():
        return _load_preset(name_or_path)
    return robot_from_text(file_text(name_or_path), where=str(Path(name_or_path)))


def file_text(name_or_path: str | os.PathLike[str]) -> str:
    """Return the text of a preset's file, or of the file at a path.

    Parameters
    ----------
    name_or_path : str or path
        One of `list_robots`, or the path of a robot file.

    Raises
    ------
    InputError
        If it is neither a name nor a path.
    RobotFileError
        If there is no such robot, or its file can't be read.
    """
    if name_or_path == "" or not isinstance(name_or_path, str | os.PathLike):
        raise InputError(f"{name_or_path!r} is no robot's name or path; the presets are {', '.join(list_robots())}")
    return _read(PRESETS / f"{name_or_path}.toml" if name_or_path in list_robots() else Path(name_or_path))


@cache
def _load_preset(name: str) -> Robot:
    return robot_from_text(file_text(name), where=name)


def robot_from_dict(document: Mapping[str, Any], *, where: str = "robot") -> Robot:
    """Build a robot from the keys of a robot file.

    Parameters
    ----------
    document : mapping
        The file's tables and keys, in mm, degrees and kg.
    where : str
        Name of the document in messages.

    Raises
    ------
    RobotFileError
        If something in it is wrong; each line of the message names a key, its value and what is allowed.
    """
    try:
        file = RobotFile.model_validate(document)
    except ValidationError as error:
        raise RobotFileError(where, problems_of(error)) from None
    return build_robot(file, where=where)


def robot_to_dict(robot: Robot) -> dict[str, Any]:
    """Return the keys of a robot file, in mm, degrees and kg; `robot_from_dict` builds the same robot from them.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Raises
    ------
    RobotFileError
        If the robot is a batch of designs.
    """
    document: dict[str, Any] = plain(decimal_document(robot))
    return document


def robot_text(robot: Robot) -> str:
    """Return the text of a robot file; `robot_from_text` reads the same robot back, to the bit.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Raises
    ------
    RobotFileError
        If the robot is a batch of designs, or has a value that no robot file may have.
    """
    document = decimal_document(robot)
    # A robot built in Python may have values that no robot file may have: it is not written.
    robot_from_dict(document, where=f"robot {robot.name!r} as a file")
    return toml_text(document)


def robot_from_text(text: str, *, where: str) -> Robot:
    """Build a robot from the text of a robot file.

    Parameters
    ----------
    text : str
        Text of the file.
    where : str
        Name of the file in messages.

    Raises
    ------
    RobotFileError
        If something in it is wrong.
    """
    return robot_from_dict(parse_toml(text, where=where), where=where)


def save_robot(robot: Robot, path: str | os.PathLike[str]) -> None:
    """Write a robot file; `load_robot` reads the same robot back, to the bit.

    Parameters
    ----------
    robot : Robot
        A single robot.
    path : path
        Where to write it.

    Raises
    ------
    RobotFileError
        If it can't be written, or the robot is a batch of designs or has a value that no robot file may have.
    """
    text = robot_text(robot)
    try:
        Path(path).write_bytes(text.encode())
    except (OSError, ValueError) as error:
        raise RobotFileError(str(path), [f"can't be written: {_reason(error)}"]) from None


def template_text(name: str) -> str:
    """Return the commented robot file of a plain symmetric hexapod, as a template.

    Parameters
    ----------
    name : str
        Name of the robot.
    """
    text = (_HERE / "template.toml").read_text(encoding="utf-8")
    return text.replace('"my hexapod"', toml_string(name), 1)


def _read(path: Path) -> str:
    where = str(path)
    if path.is_dir():
        raise RobotFileError(where, ["is a folder; a robot file is a TOML file"])
    try:
        if is_pipe_or_device(path):
            raise RobotFileError(where, ["is a pipe or a device; a robot file is a regular file"])
        with path.open("rb") as file:
            content = file.read(_LARGEST + 1)
    except FileNotFoundError:
        raise RobotFileError(where, [_no_such_robot(where)]) from None
    except (OSError, ValueError) as error:
        raise RobotFileError(where, [f"can't be read: {_reason(error)}"]) from None
    if len(content) > _LARGEST:
        raise RobotFileError(where, ["is larger than 1 MiB; a robot file has a few kilobytes"])
    try:
        # Windows editors write a byte order mark.
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise RobotFileError(where, [f"byte {error.start} is not UTF-8; a robot file is a text file"]) from None
    if not text.strip():
        raise RobotFileError(where, ["the file is empty; a robot file needs at least name, [leg] and [[legs]]"])
    return text


def _no_such_robot(name: str) -> str:
    known = list_robots()
    # The path of a file is not a preset's name typed wrong.
    nearest = None if Path(name).suffix or Path(name).name != name else nearest_name(name, known)
    hint = f" Did you mean {nearest!r}?" if nearest else ""
    return f"no such file, and no preset robot of that name.{hint} Presets: {', '.join(known)}"


def _reason(error: OSError | ValueError) -> str:
    return (error.strerror or "is not a regular file") if isinstance(error, OSError) else "is not a valid path"
