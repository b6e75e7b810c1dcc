"""The short text form of a timeline: ``at 2 s: walk 0.1 m/s; at 5 s: gait wave``.

One statement per line, or several separated by semicolons; text after a ``#`` is a comment::

    statement = [ "at" number unit ":" ] command
    command   = word [ leg or gait ] { [ name ] ( number unit | "auto" ) }

A statement without ``at`` has the time of the one before.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from decimal import Decimal
from typing import NamedTuple

from pydantic_core import PydanticCustomError

from tarsus.errors import nearest_name
from tarsus.robot.fields import Number
from tarsus.scenario.commands import COMMANDS, GaitChange
from tarsus.scenario.quantities import UNITS, Quantity
from tarsus.scenario.timed_command import GAIT_NAMES, LATEST, TimedCommand, quantities
from tarsus.scenario.wording import Value, command_from, takes

__all__ = ["read_timeline"]

_TIME = Quantity("at", "s", 0, LATEST, "time of the command", needed=True)
_TOKEN = re.compile(
    r"""\s*(?:(?P<string>"(?:[^"\\]|\\.)*")
    |(?P<number>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3}(?!\w))?)
    |(?P<word>[^\W\d][\w/-]*)|(?P<mark>[:;])|(?P<comment>\#.*)|(?P<other>\S))""",
    re.VERBOSE,
)
_LONGEST = 60


class _Token(NamedTuple):
    kind: str
    text: str


class _StatementError(Exception):
    """An error in a statement; the message says what is wrong."""


def read_timeline(text: str) -> tuple[list[tuple[int, TimedCommand]], list[str]]:
    """Return the commands of a timeline, each with its line number, and a message for each error.

    Parameters
    ----------
    text : str
        The timeline.
    """
    found: list[tuple[int, TimedCommand]] = []
    problems: list[str] = []
    time: Decimal | None = None
    for line, tokens in _statements(text):
        reader = _Reader(tokens)
        try:
            time = reader.time(time)
            found.append((line, reader.command(time)))
        except _StatementError as error:
            shown = " ".join(token.text for token in tokens)
            shown = shown if len(shown) <= _LONGEST else shown[: _LONGEST - 3] + "..."
            problems.append(f"line {line} of the timeline: {error}; in: {shown.replace(' :', ':')}")
    return found, problems


def _statements(text: str) -> Iterator[tuple[int, list[_Token]]]:
    """Yield the statements of a text, each with its line number."""
    for number, line in enumerate(text.splitlines(), start=1):
        statement: list[_Token] = []
        for match in _TOKEN.finditer(line):
            token = _Token(str(match.lastgroup), match[str(match.lastgroup)])
            if token.kind == "comment":
                break
            if token.text == ";":
                yield from [(number, statement)] if statement else []
                statement = []
            else:
                statement.append(token)
        yield from [(number, statement)] if statement else []


class _Reader:
    """Reads the tokens of one statement, from left to right."""

    def __init__(self, tokens: list[_Token]) -> None:
        self._tokens = list(reversed(tokens))

    def time(self, before: Decimal | None) -> Decimal:
        """Read the time of the statement; without one, return that of the previous statement."""
        if not self._next_is("word", "at"):
            if before is None:
                raise _StatementError("the first command needs a time: at 0 s: ...")
            return before
        self._tokens.pop()
        number = self._quantity(_TIME)
        if not self._next_is("mark", ":"):
            raise _StatementError("a colon must follow the time: at 2 s: ...")
        self._tokens.pop()
        return number

    def command(self, time: Decimal) -> TimedCommand:
        """Read the command."""
        kind = COMMANDS[self._known("command", tuple(COMMANDS))]
        names: dict[str, str] = {}
        if "leg" in kind.__dataclass_fields__:
            names["leg"] = self._name(f"{kind.word} needs a leg, such as RF")
        if kind is GaitChange:
            names["gait"] = self._known("gait", GAIT_NAMES)
        numbers = self._numbers(kind)
        try:
            return command_from(kind, time, numbers, **names)
        except ValueError as error:
            raise _StatementError(str(error)) from None

    def _numbers(self, kind: type[TimedCommand]) -> dict[str, Value]:
        known = takes(kind)
        numbers: dict[str, Value] = {}
        while self._tokens:
            token = self._tokens[-1]
            if token.kind == "number" or (len(known) == 1 and token.text not in known):
                name = self._unnamed(kind)
            elif not known:
                raise _StatementError(f"unexpected {token.text!r}: {kind.word} takes no numbers")
            else:
                name = self._known(f"number of {kind.word}", tuple(known))
            if name in numbers:
                raise _StatementError(f"{name} is given twice")
            if self._tokens and self._tokens[-1].text in known[name].words:
                numbers[name] = self._tokens.pop().text
            else:
                numbers[name] = self._quantity(known[name])
        return numbers

    def _unnamed(self, kind: type[TimedCommand]) -> str:
        """Return the name of a number given without one: the only number of the command, or the speed of a walk."""
        own = tuple(takes(kind))
        if len(own) == 1 or (own and own[0] not in quantities(kind)):
            return own[0]
        what = f"give its name: {', '.join(own)}" if own else f"{kind.word} takes no numbers"
        raise _StatementError(f"{self._tokens[-1].text} has no name; {what}")

    def _quantity(self, wanted: Quantity) -> Decimal:
        """Read a number with its unit, and return it in the unit used in files."""
        others = UNITS[wanted.unit].others
        units = " or ".join(others)
        if not self._tokens or self._tokens[-1].kind != "number":
            got = f", not {self._tokens[-1].text!r}" if self._tokens else ""
            more = "".join(f", or {word}" for word in wanted.words)
            raise _StatementError(f"{wanted.name} needs a number with its unit, {units}{more}{got}")
        text = self._tokens.pop().text
        if not self._tokens or self._tokens[-1].text not in others:
            got = f"has the unit {self._tokens[-1].text!r}" if self._unit_follows() else "has no unit"
            raise _StatementError(f"{wanted.name} {text} {got}; it must have {units}")
        unit = self._tokens.pop().text
        try:
            return Number(wanted.low, wanted.high, wanted.shown).check(Decimal(text) * others[unit])
        except PydanticCustomError as error:
            raise _StatementError(f"{wanted.name} = {text} {unit}: {error.message()}") from None

    def _unit_follows(self) -> bool:
        return bool(self._tokens) and self._tokens[-1].kind == "word"

    def _known(self, what: str, names: tuple[str, ...]) -> str:
        """Read one of the names."""
        listed = ", ".join(names)
        if not self._tokens:
            raise _StatementError(f"a {what} is missing; known: {listed}")
        token = self._tokens.pop()
        if token.text in names:
            return token.text
        nearest = nearest_name(token.text[:_LONGEST], names)
        hint = f" Did you mean {nearest!r}?" if nearest else ""
        raise _StatementError(f"no {what} is called {token.text!r}.{hint} There are: {listed}")

    def _name(self, missing: str) -> str:
        """Read a name, quoted or not."""
        if not self._tokens or self._tokens[-1].kind not in ("word", "string"):
            raise _StatementError(missing)
        token = self._tokens.pop()
        if token.kind == "word":
            return token.text
        try:
            return str(json.loads(token.text))
        except ValueError:
            raise _StatementError(
                f"{token.text} is not a valid string: a backslash must be followed by n, t, \\ or a quote"
            ) from None

    def _next_is(self, kind: str, text: str) -> bool:
        return bool(self._tokens) and self._tokens[-1] == (kind, text)
