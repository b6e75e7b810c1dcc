"""Pydantic's findings, in a maker's words: the key, its value, and what is allowed there."""

from __future__ import annotations

import datetime
import json
import re
from collections.abc import Callable, Sequence
from decimal import Decimal
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from tarsus.errors import nearest_name
from tarsus.robot.fields import REFUSED
from tarsus.robot.schema import (
    JOINTS_TAG,
    TAGS,
    Body,
    Gait,
    JointTable,
    Leg,
    LegEntry,
    RobotFile,
    ServoFigures,
    SourceEntry,
)
from tarsus.robot.writer import toml_number

__all__ = ["key_of", "problems_of", "show"]

_Location = Sequence[int | str]

# Each table under the last name of the path that leads to it.
_TABLES: dict[str, type[BaseModel]] = {
    "": RobotFile,
    "body": Body,
    "leg": Leg,
    "legs": LegEntry,
    "gait": Gait,
    "sources": SourceEntry,
}
_HEADERS = {"": "the top of the file", "body": "[body]", "leg": "[leg]", "legs": "[[legs]]", "gait": "[gait]"}
_LONGEST_VALUE = 60
_TABLE = "a table"


def problems_of(error: ValidationError) -> list[str]:
    """Return one line for each thing that pydantic found wrong."""
    return list(dict.fromkeys(_line(found) for found in error.errors(include_url=False)))


def key_of(location: _Location) -> str:
    """Return a path as the file's reader would write it: ``legs[2].position_mm``."""
    key = ""
    for part in location:
        if isinstance(part, int):
            key += f"[{part}]"
        elif part not in TAGS:
            bare = re.fullmatch(r"[A-Za-z0-9_-]{1,60}", part)
            key += ("." if key else "") + (part if bare else _shorten(json.dumps(part)))
    return key


def show(value: object) -> str:
    """Return a value as it would stand in the file, shortened."""
    for kind, words in _SHOWN.items():
        if isinstance(value, kind):
            return _shorten(words(value))
    return f"a value of type {type(value).__name__}"


def _show_list(value: list[Any] | tuple[Any, ...]) -> str:
    inside = ("[...]" if isinstance(item, list | tuple) else show(item) for item in value[:6])
    return f"[{', '.join([*inside, *['...'] * (len(value) > 6)])}]"


def _show_int(value: int) -> str:
    # Python refuses to write out an integer of more than 4300 digits.
    return str(value) if value.bit_length() <= 128 else "an integer of more than 38 digits"


def _show_decimal(value: Decimal) -> str:
    # Without its exponent, 1e999999999 would fill the memory.
    plain = value.is_finite() and abs(value.adjusted()) < _LONGEST_VALUE
    return toml_number(value) if plain else str(value).replace("Infinity", "inf").lower()


# The kinds of value that a file can hold; bool stands before int, of which it is one.
_SHOWN: dict[type, Callable[[Any], str]] = {
    dict: lambda _: _TABLE,
    list: _show_list,
    tuple: _show_list,
    bool: lambda value: str(value).lower(),
    int: _show_int,
    float: str,
    Decimal: _show_decimal,
    str: lambda value: json.dumps(value[: 2 * _LONGEST_VALUE], ensure_ascii=False),
    datetime.date: datetime.date.isoformat,
    datetime.time: datetime.time.isoformat,
}


def _shorten(text: str) -> str:
    return text if len(text) <= _LONGEST_VALUE else text[: _LONGEST_VALUE - 3] + "..."


def _line(found: ErrorDetails) -> str:
    location = found["loc"]
    if found["type"] == "missing":
        return f"{key_of(location)}: missing; {_describe(location)}"
    if found["type"] == "extra_forbidden":
        return f"{key_of(location)}: unknown key; {_suggest(location)}"
    words = _WORDS.get(found["type"], _other)(found)
    key = key_of(location)
    shown = show(found["input"])
    if not key:
        return f"the document is {shown}: {words}"
    return f"{key}: {words}" if shown == _TABLE else f"{key} = {shown}: {words}"


def _table(location: _Location) -> type[BaseModel]:
    """Return the model of the table in which a path ends."""
    inside = [part for part in location[:-1] if isinstance(part, str)]
    last = inside[-1] if inside else ""
    if last in TAGS:
        return JointTable if last == JOINTS_TAG else ServoFigures
    return _TABLES.get(last, JointTable)


def _known(table: type[BaseModel]) -> list[str]:
    return list(table.model_fields) or ["coxa", "femur", "tibia"]


def _suggest(location: _Location) -> str:
    name = str(location[-1])
    known = _known(_table(location))
    elsewhere = [_HEADERS[at] for at, table in _TABLES.items() if at in _HEADERS and name in table.model_fields]
    if elsewhere:
        return f"it belongs to {' or '.join(elsewhere)}"
    nearest = nearest_name(name[:_LONGEST_VALUE], known)
    return f"did you mean {nearest!r}?" if nearest else f"known here: {', '.join(known)}"


def _describe(location: _Location) -> str:
    field = _table(location).model_fields[str(location[-1])]
    description = str(field.description)
    return description[0].lower() + description[1:].rstrip(".")


def _refused(found: ErrorDetails) -> str:
    return found["msg"]


def _number_of_entries(found: ErrorDetails) -> str:
    context: dict[str, Any] = found["ctx"]
    wanted = f"at least {context['min_length']}" if "min_length" in context else f"at most {context['max_length']}"
    return f"{len(found['input'])} entries; there must be {wanted}"


def _other(found: ErrorDetails) -> str:
    """Word what is left: something that is no table or no list where one belongs."""
    if found["type"] != "list_type":
        return "must be a table of keys"
    header = f"[[{found['loc'][-1]}]]"
    return "must be a list" if header == "[[of]]" else f"must be a list of tables, each under {header}"


_WORDS: dict[str, Callable[[ErrorDetails], str]] = {
    REFUSED: _refused,
    "invalid_key": lambda _: "keys must be text",
    "too_short": _number_of_entries,
    "too_long": _number_of_entries,
}
