"""Scenario files: TOML in mm, degrees and seconds, with tables or lines of text for the commands."""

from __future__ import annotations

import os
import re
import tomllib
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tarsus.errors import InputError
from tarsus.robot.units import to_decimal
from tarsus.robot.writer import toml_string, toml_text
from tarsus.scenario.commands import COMMANDS, GaitChange
from tarsus.scenario.leg_tables import commands_of_legs, entry_of_leg
from tarsus.scenario.settings import SETTINGS, settings_of
from tarsus.scenario.timed_command import TimedCommand, quantities
from tarsus.scenario.wording import command_from, numbers_of, takes

if TYPE_CHECKING:
    from tarsus.scenario.scenario import Scenario

__all__ = ["commands_of_text", "document_of", "read_scenario", "scenario_of", "write_scenario"]

_LARGEST = 2**20


def read_scenario(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the attributes of the scenario in a file (see `Scenario.load`)."""
    where = str(path)
    try:
        with Path(path).open("rb") as file:
            content = file.read(_LARGEST + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "this is no path"
        raise InputError(f"{where} can't be read: {reason}; a scenario is a TOML file") from None
    if len(content) > _LARGEST:
        raise InputError(f"{where} is larger than 1 MiB; a scenario is a few kilobytes of text")
    try:
        text = content.decode("utf-8-sig")
        document = tomllib.loads(text, parse_float=Decimal)
    except UnicodeDecodeError as error:
        raise InputError(f"{where}: byte {error.start} is not UTF-8: this is no text file") from None
    except (ValueError, ArithmeticError, RecursionError) as error:
        raise InputError(f"{where}: this is not TOML: {error}") from None
    lines = [number for number, line in enumerate(text.splitlines(), 1) if re.match(r"\s*\[\[\s*at\s*\]\]", line)]
    return scenario_of(document, where=where, lines=lines)


def scenario_of(document: dict[str, Any], *, where: str, lines: list[int] | None = None) -> dict[str, Any]:
    """Return the attributes of the scenario that a document describes.

    Parameters
    ----------
    document : dict
        The keys of a scenario file.
    where : str
        What to call it in messages.
    lines : list of int, optional
        The lines on which the tables of commands begin.

    Raises
    ------
    InputError
        If something in it is wrong; a line of the message for each.
    """
    from pydantic import ValidationError

    from tarsus.scenario.problems import problems_of
    from tarsus.scenario.schema import ScenarioFile
    from tarsus.scenario.text import read_timeline

    try:
        file = ScenarioFile.model_validate(document)
    except ValidationError as error:
        raise _wrong(where, problems_of(error, lines or [])) from None
    commands: list[TimedCommand] = []
    problems: list[str] = []
    for number, table in enumerate(file.at):
        try:
            commands += _commands_of(table)
        except ValueError as error:
            line = f" (line {lines[number]})" if lines and number < len(lines) else ""
            problems.append(f"at[{number}]{line}: {error}")
    if file.timeline is not None:
        found, wrong = read_timeline(file.timeline)
        commands += [command for _, command in found]
        problems += wrong
    if problems:
        raise _wrong(where, problems)
    return {"commands": tuple(commands), **settings_of(file)}


def commands_of_text(timeline: str) -> tuple[TimedCommand, ...]:
    """Return the commands of a timeline in the short text form.

    Parameters
    ----------
    timeline : str
        The text.

    Raises
    ------
    InputError
        If something in it is wrong; a line of the message for each.
    """
    from tarsus.scenario.text import read_timeline

    found, problems = read_timeline(timeline)
    if problems:
        raise _wrong("the timeline", problems)
    return tuple(command for _, command in found)


def _wrong(where: str, problems: list[str]) -> InputError:
    lines = "".join(f"\n  {problem}" for problem in problems)
    return InputError(f"{where}: {len(problems)} problem{'s' * (len(problems) != 1)}{lines}")


def _commands_of(table: Any) -> list[TimedCommand]:
    """Return the commands of one ``[[at]]``."""
    from tarsus.scenario.schema import SCALARS, TABLES

    at, found = table.time_s, []
    if table.gait is not None:
        found.append(command_from(GaitChange, at, {}, gait=table.gait))
    for kind in TABLES:
        inside = getattr(table, kind.word)
        if inside is not None:
            given = {name: getattr(inside, each.key) for name, each in takes(kind).items()}
            found.append(command_from(kind, at, {name: value for name, value in given.items() if value is not None}))
    for kind in SCALARS:
        for name, each in quantities(kind).items():
            value = getattr(table, each.key)
            found += [] if value is None else [command_from(kind, at, {name: value})]
    found += [*commands_of_legs(table, at), *_of_word(table, at)]
    if not found:
        raise ValueError(
            "no command; there are: do, gait, walk, body, sway, tilt, body_height_mm, swing_height_mm, ..."
        )
    return found


def _of_word(table: Any, at: Decimal) -> list[TimedCommand]:
    return [] if table.do is None else [command_from(COMMANDS[table.do], at, {})]


def _document(scenario: Scenario) -> dict[str, Any]:
    """Return the keys of the scenario's file, every number a decimal; what is at its default is left out."""
    default = type(scenario)()
    document: dict[str, Any] = {}
    for name, setting in SETTINGS.items():
        value = getattr(scenario, name)
        if value != getattr(default, name):
            document[setting.key] = setting.write(value)
    if scenario.commands:
        document["at"] = [{"time_s": to_decimal(each.at), **_entry(each)} for each in scenario.commands]
    return document


def _entry(command: TimedCommand) -> dict[str, Any]:
    """Return a command's key and value."""
    from tarsus.scenario.schema import SCALARS, TABLES

    of_leg = entry_of_leg(command)
    if of_leg is not None:
        return of_leg
    if isinstance(command, GaitChange):
        return {"gait": command.gait}
    keyed = {quantities(type(command))[name].key: number for name, number in numbers_of(command).items()}
    if type(command) in TABLES:
        return {command.word: keyed}
    return keyed if type(command) in SCALARS else {"do": command.word}


def document_of(scenario: Scenario) -> dict[str, Any]:
    """Return the keys of a scenario's file (see `Scenario.to_dict`)."""
    document: dict[str, Any] = _plain(_document(scenario))
    return document


def _plain(value: Any) -> Any:
    """Return a document with its decimals as ints and floats, but for those that no double is."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    if not isinstance(value, Decimal):
        return value
    if value == value.to_integral_value():
        return int(value)
    return float(value) if to_decimal(float(value)) == value else value


def write_scenario(scenario: Scenario, path: str | os.PathLike[str]) -> None:
    """Write a scenario's file (see `Scenario.save`)."""
    text = toml_text(_quoted(_document(scenario))).lstrip("\n")
    try:
        Path(path).write_bytes(text.encode())
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "this is no path"
        raise InputError(f"{path} can't be written: {reason}") from None


def _quoted(value: Any) -> Any:
    """Return a document with its keys as TOML wants them: legs may have names of several words."""
    if isinstance(value, dict):
        return {
            key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else toml_string(key): _quoted(v) for key, v in value.items()
        }
    return [_quoted(item) for item in value] if isinstance(value, list) else value
