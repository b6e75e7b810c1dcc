"""Problems of a scenario file, one line each: the key, its line, its value, and what is allowed there."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ValidationError

from tarsus.robot.document_problems import Location, Wording, problem_lines
from tarsus.scenario.schema import TABLES, At, GivingWay, ScenarioFile

__all__ = ["problems_of"]


def problems_of(error: ValidationError, lines: list[int]) -> list[str]:
    """Return one line for each of pydantic's findings in a scenario.

    Parameters
    ----------
    error : ValidationError
        The findings.
    lines : list of int
        Line numbers of the ``[[at]]`` tables, as far as they are known.
    """

    def position(location: Location) -> str:
        if len(location) > 1 and isinstance(location[1], int) and location[1] < len(lines):
            return f" (in the table of line {lines[location[1]]})"
        return ""

    return problem_lines(error, Wording(table_of=_table_of, other_place=_other_place, position=position))


def _table_of(location: Location) -> type[BaseModel]:
    inside = [part for part in location[:-1] if isinstance(part, str)]
    if not inside:
        return ScenarioFile
    if inside[-1] == "admittance":
        return GivingWay
    models: dict[str, Any] = {kind.word: At.model_fields[kind.word].annotation for kind in TABLES}
    for argument in getattr(models.get(inside[-1]), "__args__", ()):
        if isinstance(argument, type) and issubclass(argument, BaseModel):
            return argument
    return At


def _other_place(name: str, table: type[BaseModel]) -> str:
    return "a table [[at]], or to the timeline" if table is ScenarioFile and name in At.model_fields else ""
