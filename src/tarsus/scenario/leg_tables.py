"""Commands given in tables of legs, such as ``foot_targets_mm = { RF = [250, -150, 60], LF = "release" }``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from decimal import Decimal
from types import MappingProxyType
from typing import Any, NamedTuple

from tarsus.scenario.commands import FootRelease, FootTarget, FootVelocity, Force, Ground
from tarsus.scenario.timed_command import TimedCommand, quantities
from tarsus.scenario.wording import command_from, numbers_of

__all__ = ["LEG_TABLES", "LegTable", "commands_of_legs", "entry_of_leg"]


class LegTable(NamedTuple):
    """A key whose value is a table of legs.

    Attributes
    ----------
    key : str
        The key.
    kind : type
        The command that the number, or the list of numbers, of a leg becomes.
    words : mapping of str to type
        Words accepted in place of numbers, and the commands that they become.
    """

    key: str
    kind: type[TimedCommand]
    words: Mapping[str, type[TimedCommand]] = MappingProxyType({})


LEG_TABLES = (
    LegTable("foot_targets_mm", FootTarget, MappingProxyType({"release": FootRelease})),
    LegTable("foot_velocities_mm_s", FootVelocity),
    LegTable("ground_mm", Ground),
    LegTable("force_n", Force),
)
"""All keys of an ``[[at]]`` whose value is a table of legs."""


def commands_of_legs(table: Any, at: Decimal) -> Iterator[TimedCommand]:
    """Return the commands for legs of one ``[[at]]``.

    Parameters
    ----------
    table : At
        The ``[[at]]``.
    at : Decimal
        Time of the commands [s].
    """
    for key, kind, words in LEG_TABLES:
        for leg, value in (getattr(table, key) or {}).items():
            if isinstance(value, str):
                yield command_from(words[value], at, {}, leg=leg)
            else:
                numbers = value if isinstance(value, tuple) else (value,)
                yield command_from(kind, at, dict(zip(quantities(kind), numbers, strict=True)), leg=leg)


def entry_of_leg(command: TimedCommand) -> dict[str, Any] | None:
    """Return the key and value of a command for a leg; None for any other.

    Parameters
    ----------
    command : Command
        The command.
    """
    leg = getattr(command, "leg", "")
    for key, kind, words in LEG_TABLES:
        if isinstance(command, kind):
            numbers = list(numbers_of(command, zeros=True).values())
            return {key: {leg: numbers if len(numbers) > 1 else numbers[0]}}
        for word, other in words.items():
            if isinstance(command, other):
                return {key: {leg: word}}
    return None
