"""The scenario file's tables and keys, as pydantic models made from the commands; imported where a file is read."""

from __future__ import annotations

from collections.abc import Collection
from decimal import Decimal
from typing import Annotated, Any, cast

from pydantic import BaseModel, ConfigDict, Field, create_model
from pydantic_core import PydanticCustomError, core_schema

from tarsus.robot.fields import Choice, Number, Numbers, Text, refuse
from tarsus.scenario.commands import COMMANDS, MoveBody, Sway, Tilt, Walk
from tarsus.scenario.leg_tables import LEG_TABLES, LegTable
from tarsus.scenario.quantities import Quantity
from tarsus.scenario.settings import ADMITTANCE, LEVELLINGS, NUMBERS, STARTS
from tarsus.scenario.timed_command import GAIT_NAMES, LATEST, TimedCommand, quantities
from tarsus.scenario.wording import Value, takes

__all__ = ["SCALARS", "TABLES", "WORDS", "At", "GivingWay", "ScenarioFile"]

TABLES: tuple[type[TimedCommand], ...] = (Walk, MoveBody, Sway, Tilt)
"""Commands that are a table of numbers under their word."""

SCALARS = tuple(COMMANDS[word] for word in ("body_height", "swing_height", "stance_width", "cycle_time"))
"""Commands of one number, under its key."""

WORDS = ("stand_up", "stop", "sit", "fold", "power_off")
"""Commands without numbers, under ``do``."""


class Table(BaseModel):
    """Base of all tables of the file; unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class _OrWord:
    """A number or numbers, or one of some words in their place."""

    def __init__(self, each: Number | Numbers, words: Collection[str]) -> None:
        self._each, self._words = each, words

    def check(self, value: object) -> Any:
        """Return the value, or the word; refuse what is neither."""
        if isinstance(value, str) and value in self._words:
            return value
        try:
            return self._each.check(value)
        except PydanticCustomError as error:
            more = "".join(f', or "{word}"' for word in self._words)
            raise refuse(f"{error.message()}{more}") from None

    def __get_pydantic_core_schema__(self, source: object, handler: object) -> Any:
        return core_schema.no_info_plain_validator_function(self.check)


def _number(each: Quantity, *, needed: bool = False) -> Any:
    field = Field(default=... if needed else None, description=f"{each.text} [{each.shown}]")
    number = Number(each.low, each.high, each.shown)
    return Annotated[Value | None, _OrWord(number, each.words) if each.words else number], field


def _table(kind: type[TimedCommand]) -> type[Table]:
    """Return the model of a command that is a table."""
    fields: dict[str, Any] = {each.key: _number(each) for each in takes(kind).values()}
    return cast("type[Table]", create_model(kind.__name__, __base__=Table, __doc__=kind.__doc__, **fields))


class _ByLeg:
    """A table of legs, with a value for each leg as an entry of `LEG_TABLES` requires."""

    def __init__(self, table: LegTable) -> None:
        numbers = [Number(each.low, each.high, each.shown) for each in quantities(table.kind).values()]
        one = numbers[0] if len(numbers) == 1 else Numbers(len(numbers), numbers[0])
        self._each = _OrWord(one, table.words)

    def check(self, value: object) -> dict[str, Any]:
        """Return the table; refuse anything else."""
        if not isinstance(value, dict):
            raise refuse("must be a table of legs, such as { RF = ... }")
        return {str(leg): self._one(str(leg), item) for leg, item in value.items()}

    def _one(self, leg: str, value: object) -> Any:
        try:
            return self._each.check(value)
        except PydanticCustomError as error:
            raise refuse(f"{leg}: {error.message()}") from None

    def __get_pydantic_core_schema__(self, source: object, handler: object) -> Any:
        return core_schema.no_info_plain_validator_function(self.check)


class _Lines:
    """Lines of text."""

    def check(self, value: object) -> str:
        """Return the text."""
        if not isinstance(value, str):
            raise refuse('must be text in quotes, such as "at 0 s: walk 0.1 m/s"')
        return value

    def __get_pydantic_core_schema__(self, source: object, handler: object) -> Any:
        return core_schema.no_info_plain_validator_function(self.check)


_AT: dict[str, Any] = {
    "time_s": (Annotated[Decimal, Number(0, LATEST, "s")], Field(description="Time of the commands [s].")),
    "do": (Annotated[str | None, Choice(WORDS)], Field(default=None, description="What takes no numbers.")),
    "gait": (Annotated[str | None, Choice(GAIT_NAMES)], Field(default=None, description="Another gait.")),
    **{kind.word: (_table(kind) | None, None) for kind in TABLES},
    **{each.key: _number(each) for kind in SCALARS for each in takes(kind).values()},
    **{table.key: (Annotated[dict[str, Any] | None, _ByLeg(table)], None) for table in LEG_TABLES},
}

At = cast("type[Table]", create_model("At", __base__=Table, __doc__="What is told at a moment.", **_AT))
"""One ``[[at]]``: a moment and the commands that are given then."""

_GIVING_WAY: dict[str, Any] = {each.key: _number(each, needed=each.needed) for each in ADMITTANCE}

GivingWay = cast("type[Table]", create_model("GivingWay", __base__=Table, __doc__="How feet give way.", **_GIVING_WAY))
"""How feet give way to the forces on them."""

_SETTINGS: dict[str, Any] = {
    "name": (Annotated[str, Text(empty=True)], Field(default="", description="Name.")),
    "robot": (
        Annotated[str | None, Text()],
        Field(default=None, description="Name of a robot, or path of a robot file."),
    ),
    "start": (Annotated[str | None, Choice(STARTS)], Field(default=None, description="Initial state of the robot.")),
    "gait": (Annotated[str | None, Choice(GAIT_NAMES)], Field(default=None, description="Gait at the start.")),
    **{each.key: _number(each) for each in NUMBERS},
    "levelling": (
        Annotated[str | None, Choice(LEVELLINGS)],
        Field(default=None, description="Body attitude on slopes: level, halfway, along the slope, or not controlled."),
    ),
    "admittance": (
        GivingWay | None,
        Field(default=None, description="Compliance of the feet; left out, the feet are rigid."),
    ),
    "timeline": (Annotated[str | None, _Lines()], Field(default=None, description="Commands as text.")),
    "at": (list[At], Field(default=[], description="Commands as tables.")),  # type: ignore[valid-type]
}

ScenarioFile = cast("type[Table]", create_model("ScenarioFile", __base__=Table, __doc__="A scenario.", **_SETTINGS))
"""A scenario file."""
