"""Scenario files: TOML in mm, degrees and seconds, with tables or lines of text for the commands."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Mapping
from decimal import Decimal
from pathlib import Path
from typing import Any

from tarsus.errors import InputError
from tarsus.robot.parse import toml_problem
from tarsus.robot.special_file import is_pipe_or_device
from tarsus.robot.writer import toml_string, toml_text
from tarsus.scenario.document import decimal_document, document_error, plain, scenario_from_document
from tarsus.scenario.scenario import Scenario
from tarsus.scenario.text import read_timeline

__all__ = ["load_scenario", "save_scenario", "scenario_from_dict", "scenario_from_text", "scenario_to_dict"]

_LARGEST = 2**20


def load_scenario(path: str | os.PathLike[str]) -> Scenario:
    """Read a scenario file (TOML).

    Parameters
    ----------
    path : path
        Where it is.

    Raises
    ------
    InputError
        If it can't be read, or something in it is wrong; a line of the message for each problem.
    """
    where = str(path)
    if is_pipe_or_device(Path(path)):
        raise InputError(f"{where} is a pipe or a device; a scenario is a regular file")
    try:
        with Path(path).open("rb") as file:
            content = file.read(_LARGEST + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not a valid path"
        raise InputError(f"{where} can't be read: {reason}; a scenario is a TOML file") from None
    if len(content) > _LARGEST:
        raise InputError(f"{where} is larger than 1 MiB; a scenario is a few kilobytes of text")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{where}: byte {error.start} is not UTF-8: not a text file") from None
    try:
        document = tomllib.loads(text, parse_float=Decimal)
    except (ValueError, ArithmeticError, RecursionError) as error:
        raise InputError(f"{where}: {toml_problem(error, text)}") from None
    lines = [number for number, line in enumerate(text.splitlines(), 1) if re.match(r"\s*\[\[\s*at\s*\]\]", line)]
    return scenario_from_document(document, where=where, lines=lines)


def scenario_from_text(timeline: str, **settings: Any) -> Scenario:
    """Build a scenario from a timeline in the short text form.

    Parameters
    ----------
    timeline : str
        Such as ``"at 2 s: walk 0.1 m/s; at 5 s: gait wave"``.
    **settings
        Attributes of `Scenario` except `commands`.

    Raises
    ------
    InputError
        If something in it is wrong; a line of the message for each problem.
    """
    found, problems = read_timeline(timeline)
    if problems:
        raise document_error("the timeline", problems)
    return Scenario(tuple(command for _, command in found), **settings)


def scenario_from_dict(document: Mapping[str, Any]) -> Scenario:
    """Build a scenario from the keys of a scenario file.

    Parameters
    ----------
    document : mapping
        The keys, in mm, degrees and seconds.

    Raises
    ------
    InputError
        If something in it is wrong; a line of the message for each problem.
    """
    return scenario_from_document(dict(document), where="the scenario")


def scenario_to_dict(scenario: Scenario) -> dict[str, Any]:
    """Return the keys of a scenario file, in mm, degrees and seconds; `scenario_from_dict` reads the same back.

    Parameters
    ----------
    scenario : Scenario
        The scenario.
    """
    document: dict[str, Any] = plain(decimal_document(scenario))
    return document


def save_scenario(scenario: Scenario, path: str | os.PathLike[str]) -> None:
    """Write a scenario file (TOML); `load_scenario` reads the same scenario back, to the bit.

    Parameters
    ----------
    scenario : Scenario
        The scenario.
    path : path
        Where to write it.

    Raises
    ------
    InputError
        If it can't be written.
    """
    text = toml_text(_quoted(decimal_document(scenario))).lstrip("\n")
    try:
        Path(path).write_bytes(text.encode())
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not a valid path"
        raise InputError(f"{path} can't be written: {reason}") from None


def _quoted(value: Any) -> Any:
    """Return a document with its keys as TOML wants them: legs may have names of several words."""
    if isinstance(value, dict):
        return {
            key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else toml_string(key): _quoted(v) for key, v in value.items()
        }
    return [_quoted(item) for item in value] if isinstance(value, list) else value
