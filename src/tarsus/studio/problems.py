"""Problems of a message or a state, worded as those of robot files: the key, its value, and what is allowed there."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple, get_args

from pydantic import BaseModel, ValidationError

from tarsus.robot.document_problems import Location, Wording, problem_lines

__all__ = ["problems_of"]


class _Place(NamedTuple):
    """Where a path of pydantic leads: keys, without the names of union members, and the model of the last table."""

    keys: tuple[int | str, ...]
    table: type[BaseModel]


def problems_of(error: ValidationError, root: Any, *, whole: str) -> list[str]:
    """Return one line for each of pydantic's findings.

    Parameters
    ----------
    error : ValidationError
        The findings.
    root : type
        The model, or the union of models, that was expected.
    whole : str
        What the whole is called: ``"the message"``.
    """
    return problem_lines(
        error,
        Wording(
            table_of=lambda location: _place(location, root).table,
            other_place=lambda _name, _table: "",
            path=lambda location: _place(location, root).keys,
            whole=whole,
        ),
    )


def _place(location: Location, root: Any) -> _Place:
    models = list(_models(root))
    keys: list[int | str] = []
    table: type[BaseModel] = models[0]
    for part in location:
        if isinstance(part, int):
            keys.append(part)
        elif len(models) == 1 and models[0].__name__ != part and _is_key(part, models[0]):
            table = models[0]
            keys.append(part)
            field = table.model_fields.get(part)
            models = list(_models(field.annotation)) if field is not None else []
        else:
            # The name of a union member: go on with its model; where it is a type and no model, keep the first model.
            models = [model for model in models if part in _names(model)] or models[:1]
    return _Place(tuple(keys), table)


def _is_key(part: str, model: type[BaseModel]) -> bool:
    """Return whether a part of a path is a key, known or not, rather than a type such as ``constrained-str``."""
    return part in model.model_fields or part not in _TYPES


_TYPES = frozenset({"constrained-str", "str", "float", "int", "dict[str,any]"})


def _names(model: type[BaseModel]) -> Iterator[str]:
    """Yield the names by which pydantic calls a member of a union: its own, and its tag, the one value of a key."""
    yield model.__name__
    for field in model.model_fields.values():
        values = get_args(field.annotation)
        if len(values) == 1 and isinstance(values[0], str):
            yield values[0]


def _models(annotation: Any) -> Iterator[type[BaseModel]]:
    """Yield the models in an annotation."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from _models(argument)
