"""The scenario file's tables and keys, as pydantic models made from the commands; imported where a file is read."""

from __future__ import annotations

from decimal import Decimal
from typing import Annotated, Any, cast

from pydantic import BaseModel, ConfigDict, Field, create_model
from pydantic_core import PydanticCustomError, core_schema

from tarsus.drive.commands import COMMANDS, GAIT_NAMES, LATEST, Command, MoveBody, Sway, Tilt, Walk
from tarsus.drive.quantities import Quantity
from tarsus.drive.scenario import LEVELLINGS, STARTS
from tarsus.drive.wording import takes
from tarsus.robot.fields import Choice, Number, Numbers, Text, refuse

__all__ = ["RATES", "SCALARS", "TABLES", "WORDS", "At", "ScenarioFile"]

RATES = (20.0, 1000.0)
"""The least and the greatest rate [1/s]."""

TABLES: tuple[type[Command], ...] = (Walk, MoveBody, Sway, Tilt)
"""Commands that are a table of numbers under their word."""

SCALARS = tuple(COMMANDS[word] for word in ("clearance", "lift", "stance_width", "cycle_time"))
"""Commands of one number, under its key."""

WORDS = ("stand_up", "stop", "sit", "fold", "power_off")
"""Commands that take nothing, under ``do``."""

_HAND = Numbers(3, Number(-1000, 1000, "mm"))
_HEIGHT = Number(-1000, 1000, "mm")


class Table(BaseModel):
    """Any table of the file: a key that it does not know is refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def _number(each: Quantity) -> Any:
    field = Field(default=None, description=f"{each.text} [{each.shown}]")
    return Annotated[Decimal | None, Number(each.low, each.high, each.shown)], field


def _table(kind: type[Command]) -> type[Table]:
    """Return the model of a command that is a table."""
    fields: dict[str, Any] = {each.key: _number(each) for each in takes(kind).values()}
    return cast("type[Table]", create_model(kind.__name__, __base__=Table, __doc__=kind.__doc__, **fields))


class _ByLeg:
    """A table of legs: a value for each, checked by `each`."""

    def __init__(self, each: Number | Numbers, *, back: bool) -> None:
        self._each, self._back = each, back

    def check(self, value: object) -> dict[str, Any]:
        """Return the table; refuse what is none."""
        if not isinstance(value, dict):
            raise refuse("must be a table of legs, such as { RF = ... }")
        return {str(leg): self._one(str(leg), item) for leg, item in value.items()}

    def _one(self, leg: str, value: object) -> Any:
        if self._back and value == "back":
            return "back"
        try:
            return self._each.check(value)
        except PydanticCustomError as error:
            more = ', or "back"' if self._back else ""
            raise refuse(f"{leg}: {error.message()}{more}") from None

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
    "time_s": (Annotated[Decimal, Number(0, LATEST, "s")], Field(description="When [s].")),
    "do": (Annotated[str | None, Choice(WORDS)], Field(default=None, description="What takes no numbers.")),
    "gait": (Annotated[str | None, Choice(GAIT_NAMES)], Field(default=None, description="Another gait.")),
    **{kind.word: (_table(kind) | None, None) for kind in TABLES},
    **{each.key: _number(each) for kind in SCALARS for each in takes(kind).values()},
    "hands_mm": (Annotated[dict[str, Any] | None, _ByLeg(_HAND, back=True)], None),
    "ground_mm": (Annotated[dict[str, Any] | None, _ByLeg(_HEIGHT, back=False)], None),
}

At = cast("type[Table]", create_model("At", __base__=Table, __doc__="What is told at a moment.", **_AT))
"""One ``[[at]]``: a moment and the commands that are given then."""


class ScenarioFile(Table):
    """A scenario."""

    name: Annotated[str, Text(empty=True)] = Field(default="", description="What it is called.")
    robot: Annotated[str, Text()] | None = Field(default=None, description="A robot's name, or the path of its file.")
    rate_hz: Annotated[Decimal, Number(*RATES, "Hz")] | None = Field(default=None, description="Ticks per second.")
    jitter_ms: Annotated[Decimal, Number(0, 25, "ms")] | None = Field(
        default=None, description="By how much a tick may be longer or shorter, at random [ms]."
    )
    seed: Annotated[Decimal, Number(0, 2**53, "")] | None = Field(default=None, description="Of what is random.")
    start: Annotated[str, Choice(STARTS)] | None = Field(default=None, description="How the robot is found.")
    duration_s: Annotated[Decimal, Number(0.1, LATEST, "s")] | None = Field(default=None, description="How long [s].")
    gait: Annotated[str, Choice(GAIT_NAMES)] | None = Field(default=None, description="The gait it starts with.")
    clearance_mm: Annotated[Decimal, Number(0.001, 1000, "mm")] | None = Field(
        default=None, description="Height of the body's origin at the start [mm]."
    )
    lift_mm: Annotated[Decimal, Number(0, 1000, "mm")] | None = Field(
        default=None, description="Lift of swinging feet at the start [mm]."
    )
    levelling: Annotated[str, Choice(LEVELLINGS)] | None = Field(
        default=None, description="Whether the body stays level on ground that is not, or follows it."
    )
    timeline: Annotated[str, _Lines()] | None = Field(default=None, description="Commands as text.")
    at: list[At] = Field(default=[], description="Commands as tables.")  # type: ignore[valid-type]
