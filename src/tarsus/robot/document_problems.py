"""Wording of pydantic's findings in a document: the key, its value, and what is allowed there."""

from __future__ import annotations

import datetime
import json
import re
from collections.abc import Callable, Sequence
from decimal import Decimal
from typing import Any, NamedTuple, TypeAlias

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from tarsus.errors import nearest_name
from tarsus.robot.fields import REFUSED
from tarsus.robot.writer import toml_number

__all__ = ["Location", "Wording", "key_of", "problem_lines", "show"]

Location: TypeAlias = Sequence[int | str]

_LONGEST_VALUE = 60
_TABLE = "a table"


class Wording(NamedTuple):
    """What the wording of findings needs to know of one kind of document.

    Attributes
    ----------
    table_of : callable
        Takes a path; returns the model of the table in which it ends.
    other_place : callable
        Takes an unknown key and the model of its table; returns where the key belongs, or an empty string.
    position : callable
        Takes a path; returns its position in the file, to follow the key, or an empty string.
    tags : tuple of str
        Tags of discriminated unions, which pydantic inserts into paths.
    path : callable
        Takes a path; returns the one that is shown.
    whole : str
        What the document as a whole is called.
    """

    table_of: Callable[[Location], type[BaseModel]]
    other_place: Callable[[str, type[BaseModel]], str]
    position: Callable[[Location], str] = lambda _: ""
    tags: tuple[str, ...] = ()
    path: Callable[[Location], Location] = lambda location: location
    whole: str = "the document"


def problem_lines(error: ValidationError, wording: Wording) -> list[str]:
    """Return one line for each of pydantic's findings.

    Parameters
    ----------
    error : ValidationError
        The findings.
    wording : Wording
        The kind of document.
    """
    return list(dict.fromkeys(_line(found, wording) for found in error.errors(include_url=False)))


def key_of(location: Location, tags: Sequence[str] = ()) -> str:
    """Return a path as it is written in prose: ``legs[2].position_mm``.

    Parameters
    ----------
    location : sequence of int or str
        The path.
    tags : sequence of str
        Parts to leave out.
    """
    key = ""
    for part in location:
        if isinstance(part, int):
            key += f"[{part}]"
        elif part not in tags:
            bare = re.fullmatch(r"[A-Za-z0-9_-]{1,60}", part)
            key += ("." if key else "") + (part if bare else _shorten(json.dumps(part)))
    return key


def show(value: object) -> str:
    """Return a value as it is written in a TOML file, shortened.

    Parameters
    ----------
    value : object
        The value.
    """
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


# The kinds of value that a file can hold; bool precedes int, its base class.
_SHOWN: dict[type, Callable[[Any], str]] = {
    dict: lambda _: _TABLE,
    list: _show_list,
    tuple: _show_list,
    bool: lambda value: str(value).lower(),
    int: _show_int,
    float: str,
    Decimal: _show_decimal,
    str: lambda value: json.dumps(value[: 2 * _LONGEST_VALUE], ensure_ascii=False),
    type(None): lambda _: "null",
    datetime.date: datetime.date.isoformat,
    datetime.time: datetime.time.isoformat,
}


def _shorten(text: str) -> str:
    return text if len(text) <= _LONGEST_VALUE else text[: _LONGEST_VALUE - 3] + "..."


def _line(found: ErrorDetails, wording: Wording) -> str:
    location = found["loc"]
    key = key_of(wording.path(location), wording.tags) + wording.position(location)
    if found["type"] in _KINDS:
        return _KINDS[found["type"]](found, key)
    if found["type"] == "missing":
        description = _description(wording.table_of(location), str(location[-1]))
        return f"{key}: missing; {description}" if description else f"{key}: missing"
    if found["type"] == "extra_forbidden":
        return f"{key}: unknown key; {_suggestion(wording, location)}"
    words = _WORDS.get(found["type"], _wrong_type)(found)
    shown = show(found["input"])
    if not location:
        return f"{wording.whole} is {shown}: {words}"
    # A table, or a list of tables, is no value to show.
    return f"{key}: {words}" if _TABLE in shown.strip("[]").split(", ") else f"{key} = {shown}: {words}"


def _description(table: type[BaseModel], name: str) -> str:
    field = table.model_fields.get(name)  # none for an entry of a list
    description = (field and field.description) or ""
    return description[:1].lower() + description[1:].rstrip(".")


def _suggestion(wording: Wording, location: Location) -> str:
    name, table = str(location[-1]), wording.table_of(location)
    if place := wording.other_place(name, table):
        return f"it belongs to {place}"
    known = list(table.model_fields)
    nearest = nearest_name(name[:_LONGEST_VALUE], known)
    return f"did you mean {nearest!r}?" if nearest else f"known here: {', '.join(known)}"


def _number_of_entries(found: ErrorDetails) -> str:
    context: dict[str, Any] = found["ctx"]
    bound = f"at least {context['min_length']}" if "min_length" in context else f"at most {context['max_length']}"
    count = len(found["input"])
    return f"{count} {'entry' if count == 1 else 'entries'}; there must be {bound}"


def _not_a_list(found: ErrorDetails) -> str:
    header = f"[[{found['loc'][-1]}]]"
    return "must be a list" if header == "[[of]]" else f"must be a list of tables, each under {header}"


def _wrong_type(_found: ErrorDetails) -> str:
    return "must be a table of keys"


def _unknown_kind(found: ErrorDetails, key: str) -> str:
    """Return the problem of a table whose kind, named by one of its keys, is unknown."""
    context: dict[str, Any] = found["ctx"]
    name, tag = context["discriminator"].strip("'"), str(context["tag"])
    known = re.findall(r"'([^']*)'", context["expected_tags"])
    nearest = nearest_name(tag[:_LONGEST_VALUE], known)
    words = f"did you mean {nearest!r}?" if nearest else f"must be one of {', '.join(known)}"
    return f"{_inside(key, name)} = {show(tag)}: {words}"


def _inside(key: str, name: str) -> str:
    return f"{key}.{name}" if key else name


# Findings that concern a key inside the value found, not the value itself, or no key at all.
_KINDS: dict[str, Callable[[ErrorDetails, str], str]] = {
    "union_tag_invalid": _unknown_kind,
    "union_tag_not_found": lambda found, key: f"{_inside(key, found['ctx']['discriminator'].strip(chr(39)))}: missing",
    "json_invalid": lambda found, _: f"not valid JSON: {found['ctx']['error']}",
}


def _bound(key: str, words: str) -> Callable[[ErrorDetails], str]:
    return lambda found: f"must be {words} {found['ctx'][key]:g}"


_NUMBER, _TEXT, _WHOLE = "must be a number", "must be text", "must be a whole number"

_WORDS: dict[str, Callable[[ErrorDetails], str]] = {
    REFUSED: lambda found: found["msg"],
    "invalid_key": lambda _: "keys must be text",
    "list_type": _not_a_list,
    "too_short": _number_of_entries,
    "too_long": _number_of_entries,
    "tuple_type": lambda _: "must be a list",
    "float_type": lambda _: _NUMBER,
    "float_parsing": lambda _: _NUMBER,
    "finite_number": lambda _: "must be a finite number",
    "int_type": lambda _: _WHOLE,
    "int_from_float": lambda _: _WHOLE,
    "bool_type": lambda _: "must be true or false",
    "string_type": lambda _: _TEXT,
    "string_too_long": lambda found: f"has {len(found['input'])} characters; at most {found['ctx']['max_length']}",
    "literal_error": lambda found: f"must be {found['ctx']['expected']}",
    "greater_than_equal": _bound("ge", "at least"),
    "less_than_equal": _bound("le", "at most"),
    "less_than": _bound("lt", "less than"),
}
