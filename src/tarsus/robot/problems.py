"""Problems of a robot file, one line each: the key, its value, and what is allowed there."""

from __future__ import annotations

from pydantic import BaseModel, ValidationError

from tarsus.robot.document_problems import Location, Wording, problem_lines
from tarsus.robot.schema import (
    JOINTS_TAG,
    TAGS,
    Body,
    Gait,
    JointServos,
    Leg,
    LegEntry,
    RobotFile,
    ServoFigures,
    SourceEntry,
)

__all__ = ["problems_of"]

# The model of each table, by the last name in its path.
_TABLES: dict[str, type[BaseModel]] = {
    "": RobotFile,
    "body": Body,
    "leg": Leg,
    "legs": LegEntry,
    "gait": Gait,
    "sources": SourceEntry,
}
_HEADERS = {"": "the top of the file", "body": "[body]", "leg": "[leg]", "legs": "[[legs]]", "gait": "[gait]"}


def problems_of(error: ValidationError) -> list[str]:
    """Return one line for each of pydantic's findings in a robot file."""
    return problem_lines(error, _WORDING)


def _table_of(location: Location) -> type[BaseModel]:
    inside = [part for part in location[:-1] if isinstance(part, str)]
    last = inside[-1] if inside else ""
    if last in TAGS:
        return JointServos if last == JOINTS_TAG else ServoFigures
    return _TABLES.get(last, JointServos)


def _other_place(name: str, _table: type[BaseModel]) -> str:
    return " or ".join(_HEADERS[at] for at, table in _TABLES.items() if at in _HEADERS and name in table.model_fields)


_WORDING = Wording(table_of=_table_of, other_place=_other_place, tags=TAGS)
