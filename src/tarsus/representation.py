"""Short text and HTML representations of values, so that every public value fits a terminal and tells what matters.

`represented` is a class decorator. ``repr`` of a decorated class is its name and some of its attributes, with the units
that its docstring states; arrays appear as their numbers where these are few, else as their range and shape.
"""

from __future__ import annotations

import functools
import html
import inspect
import itertools
import math
import operator
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from enum import Enum
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from tarsus.arrays import Array, is_traced

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["Rows", "represented"]

Rows = Sequence[Mapping[str, object]]
"""Rows of a table, each from column headings to values."""

_WIDTH = 100
_FEW = 6
_LONGEST_TEXT = 60
_LONGEST_VALUE = 150
_UNIT = re.compile(r"\[([A-Za-z][A-Za-z0-9 /^*]*)\]")
_ENTRY = re.compile(r"(\w+(?:, \w+)*) : ")
_Class = TypeVar("_Class", bound=type)


def represented(*names: str) -> Callable[[_Class], _Class]:
    """Give a class a short ``repr``, and HTML tables for notebooks.

    A class may have a method ``_rows`` that returns the rows of a second HTML table, or none.

    Parameters
    ----------
    *names : str
        Attributes to show, or attributes of these (``"output.time"``); without names, the fields of the dataclass or
        named tuple. Those that are None or NaN are left out.
    """

    def decorate(cls: _Class) -> _Class:
        fields: Any = getattr(cls, "__dataclass_fields__", None) or getattr(cls, "_fields", ())
        shown = names or tuple(fields)

        def attributes(self: Any) -> list[tuple[str, str]]:
            units = _units(cls)
            values = ((name.rpartition(".")[2], operator.attrgetter(name)(self)) for name in shown)
            known = ((name, value) for name, value in values if not _unknown(value))
            return [(name, _brief(value, units.get(name, ""))) for name, value in known]

        def as_text(self: Any) -> str:
            return _wrapped(type(self).__name__, attributes(self))

        def as_html(self: Any) -> str:
            own: Callable[[], Rows] = getattr(self, "_rows", tuple)
            tables: list[Rows] = [[{"": name, "value": text} for name, text in attributes(self)], own()]
            return f"<b>{type(self).__name__}</b>" + "".join(_html_table(table) for table in tables if table)

        cls.__repr__ = as_text  # type: ignore[method-assign, assignment]
        cls._repr_html_ = as_html  # type: ignore[attr-defined]
        return cls

    return decorate


def _wrapped(name: str, attributes: Sequence[tuple[str, str]]) -> str:
    """Return ``name(attribute=value, ...)`` in lines of at most 100 characters, divided between attributes."""
    if not attributes:
        return f"{name}()"
    lines, ends = [f"{name}("], [*[", "] * (len(attributes) - 1), ")"]
    for (key, value), end in zip(attributes, ends, strict=True):
        piece = f"{key}={value}{end}"
        if len(lines[-1] + piece.rstrip()) > _WIDTH:
            lines[-1:] = [
                lines[-1].rstrip(),
                *textwrap.wrap(piece, _WIDTH, initial_indent="    ", subsequent_indent="        "),
            ]
            lines[-1] += " " * piece.endswith(" ")
        else:
            lines[-1] += piece
    return "\n".join(lines)


def _html_table(rows: Rows) -> str:
    """Return rows as an HTML table."""
    heads = "".join(f"<th>{html.escape(head)}</th>" for head in rows[0])
    body = "".join(
        f"<tr>{''.join(f'<td>{html.escape(_cell(cell))}</td>' for cell in row.values())}</tr>" for row in rows
    )
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table>"


def _cell(value: object) -> str:
    return value if isinstance(value, str) else _brief(value)


@functools.cache
def _units(cls: type) -> dict[str, str]:
    """Return the units of a class's attributes, from its docstring and those of its properties."""
    units: dict[str, str] = {}
    documented, entry = inspect.getdoc(cls) or "", None
    descriptions: dict[tuple[str, ...], str] = {}
    for line in documented.splitlines():
        entry = tuple(found[1].split(", ")) if (found := _ENTRY.match(line)) else entry if line[:1] == " " else None
        if entry:
            descriptions[entry] = f"{descriptions.get(entry, '')} {'' if found else line}"
    for name, value in inspect.getmembers(cls):
        if isinstance(value, property | functools.cached_property):
            descriptions[(name,)] = value.__doc__ or ""
    for listed, text in descriptions.items():
        found_units = _UNIT.findall(text)
        distinct = found_units if len(found_units) == len(listed) else [*set(found_units)] * len(listed)
        if len(distinct) == len(listed):
            units |= {name: f" {unit}" for name, unit in zip(listed, distinct, strict=True)}
    return units


def _unknown(value: object) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _brief(value: object, unit: str = "", *, longest: int = _LONGEST_VALUE) -> str:
    """Return a value in a few words."""
    if isinstance(value, str):
        return (
            value.name if isinstance(value, Enum) else repr(textwrap.shorten(value, _LONGEST_TEXT, placeholder=" ..."))
        )
    if isinstance(value, float | np.floating):
        return f"{value:.6g}{unit}"
    if isinstance(value, Mapping):
        items = itertools.islice(value.items(), _FEW)
        return _some([f"{_brief(key)}: {_brief(item)}" for key, item in items], value)
    if isinstance(value, tuple | list) and not hasattr(value, "_fields"):
        plain = all(isinstance(item, str | float | int) for item in value)
        shown = value if len(value) <= 2 else value[: _FEW if plain else 1]
        return _some([_brief(item, longest=_LONGEST_TEXT) for item in shown], value) + unit * bool(value)
    return _array(value, unit) if hasattr(value, "shape") and hasattr(value, "dtype") else _object(value, longest)


def _object(value: object, longest: int) -> str:
    """Return the class and the name of a value that has one, else its shortened ``repr``."""
    if isinstance(name := getattr(value, "name", None), str):
        return f"<{type(value).__name__} {name!r}>"
    return textwrap.shorten(repr(value), longest, placeholder=" ...")


def _some(shown: list[str], of: Any) -> str:
    """Return the items shown, and the number of all where some are left out."""
    more = [f"... {len(of)} in all"] if len(of) > len(shown) else []
    if isinstance(of, Mapping):
        return f"{{{', '.join([*shown, *more])}}}"
    return f"({', '.join([*shown, *more])}{',' * (len(of) == 1)})"


def _array(value: Shaped[Array, "..."], unit: str) -> str:
    """Return a few numbers as they are, more of them as range and shape."""
    shape = f"shape {tuple(value.shape)}"
    if is_traced(value):
        return f"{value.dtype} {shape}"
    array = np.asarray(value)
    alike = array.size > _FEW // 2 and array.dtype != bool and (array == array.flat[0]).all()
    if array.size <= _FEW and not alike:
        return np.array2string(array, precision=5, suppress_small=True, separator=", ").replace("\n", "") + unit
    if array.dtype == bool:
        return f"{np.count_nonzero(array)} of {array.size} True, {shape}"
    finite = array[np.isfinite(array)]
    if not finite.size:
        return f"{array.flat[0]}, {shape}"
    low, high = f"{finite.min():.4g}", f"{finite.max():.4g}"
    unknown = f", {array.size - finite.size} not finite" if finite.size < array.size else ""
    return f"{low if low == high else f'{low} to {high}'}{unit}{unknown}, {shape}"
