"""A scenario as the keys of its file: tables and numbers in mm, degrees and seconds."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

from pydantic import ValidationError

from tarsus.errors import InputError
from tarsus.robot.units import to_decimal
from tarsus.scenario.commands import COMMANDS, GaitChange
from tarsus.scenario.leg_tables import commands_of_legs, entry_of_leg
from tarsus.scenario.problems import problems_of
from tarsus.scenario.scenario import Scenario
from tarsus.scenario.schema import SCALARS, TABLES, ScenarioFile
from tarsus.scenario.settings import SETTINGS, settings_of
from tarsus.scenario.text import read_timeline
from tarsus.scenario.timed_command import TimedCommand, quantities
from tarsus.scenario.wording import command_from, numbers_of, takes

__all__ = ["decimal_document", "document_error", "plain", "scenario_from_document"]


def scenario_from_document(document: dict[str, Any], *, where: str, lines: list[int] | None = None) -> Scenario:
    """Return the scenario that the keys of a file describe.

    Parameters
    ----------
    document : dict
        The keys of a scenario file.
    where : str
        Name of the document in messages.
    lines : list of int, optional
        Line numbers of the ``[[at]]`` tables.

    Raises
    ------
    InputError
        If something in it is wrong; a line of the message for each problem.
    """
    try:
        file: Any = ScenarioFile.model_validate(document)
    except ValidationError as error:
        raise document_error(where, problems_of(error, lines or [])) from None
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
        raise document_error(where, problems)
    return Scenario(tuple(commands), **settings_of(file))


def document_error(where: str, problems: list[str]) -> InputError:
    """Return the error that lists the problems of a document."""
    lines = "".join(f"\n  {problem}" for problem in problems)
    return InputError(f"{where}: {len(problems)} problem{'s' * (len(problems) != 1)}{lines}")


def _commands_of(table: Any) -> list[TimedCommand]:
    """Return the commands of one ``[[at]]``."""
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


def decimal_document(scenario: Scenario) -> dict[str, Any]:
    """Return the keys of the scenario's file, every number a decimal; settings at their default are left out."""
    default = Scenario()
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
    of_leg = entry_of_leg(command)
    if of_leg is not None:
        return of_leg
    if isinstance(command, GaitChange):
        return {"gait": command.gait}
    keyed = {quantities(type(command))[name].key: number for name, number in numbers_of(command).items()}
    if type(command) in TABLES:
        return {command.word: keyed}
    return keyed if type(command) in SCALARS else {"do": command.word}


def plain(value: Any) -> Any:
    """Return a document with its decimals as ints and floats; a decimal that no float reproduces stays a decimal."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain(item) for item in value]
    if not isinstance(value, Decimal):
        return value
    if value == value.to_integral_value():
        return int(value)
    return float(value) if to_decimal(float(value)) == value else value
