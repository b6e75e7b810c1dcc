"""Pydantic's findings in a scenario, in the words of whoever wrote it: key, line, value, and what is allowed."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from tarsus.errors import nearest_name
from tarsus.robot.fields import REFUSED
from tarsus.robot.problems import key_of, show
from tarsus.scenario.schema import TABLES, At, GivingWay, ScenarioFile

__all__ = ["problems_of"]

_MISSING: Mapping[int | str, str] = MappingProxyType({"time_s": "when, in seconds"})


def problems_of(error: ValidationError, lines: list[int]) -> list[str]:
    """Return one line for each thing that pydantic found wrong.

    Parameters
    ----------
    error : ValidationError
        What it found.
    lines : list of int
        The lines on which the tables of commands begin, as far as they are known.
    """
    return list(dict.fromkeys(_line(found, lines) for found in error.errors(include_url=False)))


def _line(found: ErrorDetails, lines: list[int]) -> str:
    location = found["loc"]
    key, words = key_of(location), _words(found)
    if len(location) > 1 and isinstance(location[1], int) and location[1] < len(lines):
        key += f" (in the table of line {lines[location[1]]})"
    if found["type"] in ("missing", "extra_forbidden"):
        return f"{key}: {words}"
    shown = show(found["input"])
    if not location:
        return f"the document is {shown}: {words}"
    return f"{key}: {words}" if shown == "a table" else f"{key} = {shown}: {words}"


def _words(found: ErrorDetails) -> str:
    location = found["loc"]
    if found["type"] == REFUSED:
        return found["msg"]
    if found["type"] == "missing":
        return f"missing: {_MISSING.get(location[-1]) or _model(location).model_fields[str(location[-1])].description}"
    if found["type"] == "extra_forbidden":
        return f"unknown key; {_suggest(location)}"
    if found["type"] == "list_type":
        return "must be a list of tables, each under [[at]]"
    return "must be a table of keys"


def _model(location: tuple[int | str, ...]) -> type[BaseModel]:
    """Return the model of the table in which a path ends."""
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


def _suggest(location: tuple[int | str, ...]) -> str:
    name, model = str(location[-1]), _model(location)
    known = list(model.model_fields)
    if model is ScenarioFile and name in At.model_fields:
        return "it belongs into a table [[at]], or into the timeline"
    nearest = nearest_name(name[:60], known)
    hint = f"did you mean {nearest!r}? " if nearest else ""
    return f"{hint}known here: {', '.join(known)}"
