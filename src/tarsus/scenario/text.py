"""The short text form of a timeline: ``at 2 s: walk 0.1 m/s; at 5 s: gait wave``.

A statement a line, or several with semicolons between them; what follows a ``#`` is a remark::

    statement = [ "at" number unit ":" ] command
    command   = word [ leg or gait ] { [ name ] ( number unit | "auto" ) }

Without ``at`` a command comes at the time of the one before.
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

_TIME = Quantity("at", "s", 0, LATEST, "when", needed=True)
_TOKEN = re.compile(
    r"""\s*(?:(?P<string>"(?:[^"\\]|\\.)*")
    |(?P<number>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3}(?!\w))?)
    |(?P<word>[^\W\d][\w/-]*)|(?P<mark>[:;])|(?P<remark>\#.*)|(?P<other>\S))""",
    re.VERBOSE,
)
_LONGEST = 60


class _Token(NamedTuple):
    kind: str
    text: str


class _WrongError(Exception):
    """What is wrong with a statement."""


def read_timeline(text: str) -> tuple[list[tuple[int, TimedCommand]], list[str]]:
    """Return the commands of a timeline with their lines, and what is wrong with it, a line of words for each.

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
        except _WrongError as wrong:
            shown = " ".join(token.text for token in tokens)
            shown = shown if len(shown) <= _LONGEST else shown[: _LONGEST - 3] + "..."
            problems.append(f"line {line} of the timeline: {wrong}; in: {shown.replace(' :', ':')}")
    return found, problems


def _statements(text: str) -> Iterator[tuple[int, list[_Token]]]:
    """Split a text into statements, each with the number of its line."""
    for number, line in enumerate(text.splitlines(), start=1):
        statement: list[_Token] = []
        for match in _TOKEN.finditer(line):
            token = _Token(str(match.lastgroup), match[str(match.lastgroup)])
            if token.kind == "remark":
                break
            if token.text == ";":
                yield from [(number, statement)] if statement else []
                statement = []
            else:
                statement.append(token)
        yield from [(number, statement)] if statement else []


class _Reader:
    """Reads one statement from its tokens, from left to right."""

    def __init__(self, tokens: list[_Token]) -> None:
        self._tokens = list(reversed(tokens))

    def time(self, before: Decimal | None) -> Decimal:
        """Read the time; without one, it is that of the statement before."""
        if not self._next_is("word", "at"):
            if before is None:
                raise _WrongError("the first command must say when: at 0 s: ...")
            return before
        self._tokens.pop()
        number = self._quantity(_TIME)
        if not self._next_is("mark", ":"):
            raise _WrongError("after the time there must be a colon: at 2 s: ...")
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
            raise _WrongError(str(error)) from None

    def _numbers(self, kind: type[TimedCommand]) -> dict[str, Value]:
        known = takes(kind)
        numbers: dict[str, Value] = {}
        while self._tokens:
            token = self._tokens[-1]
            if token.kind == "number" or (len(known) == 1 and token.text not in known):
                name = self._bare(kind)
            elif not known:
                raise _WrongError(f"{token.text!r} is too much: {kind.word} takes no numbers")
            else:
                name = self._known(f"number of {kind.word}", tuple(known))
            if name in numbers:
                raise _WrongError(f"{name} is given twice")
            if self._tokens and self._tokens[-1].text in known[name].words:
                numbers[name] = self._tokens.pop().text
            else:
                numbers[name] = self._quantity(known[name])
        return numbers

    def _bare(self, kind: type[TimedCommand]) -> str:
        """Return which number needs no name: the only one there is, or how fast to walk."""
        own = tuple(takes(kind))
        if len(own) == 1 or (own and own[0] not in quantities(kind)):
            return own[0]
        what = f"say which number it is: {', '.join(own)}" if own else f"{kind.word} takes no numbers"
        raise _WrongError(f"{self._tokens[-1].text} stands alone; {what}")

    def _quantity(self, wanted: Quantity) -> Decimal:
        """Read a number with its unit, and return it in the unit of files."""
        others = UNITS[wanted.unit].others
        units = " or ".join(others)
        if not self._tokens or self._tokens[-1].kind != "number":
            got = f", not {self._tokens[-1].text!r}" if self._tokens else ""
            more = "".join(f", or {word}" for word in wanted.words)
            raise _WrongError(f"{wanted.name} needs a number with its unit, {units}{more}{got}")
        text = self._tokens.pop().text
        if not self._tokens or self._tokens[-1].text not in others:
            got = f"has the unit {self._tokens[-1].text!r}" if self._unit_follows() else "has no unit"
            raise _WrongError(f"{wanted.name} {text} {got}; it must have {units}")
        unit = self._tokens.pop().text
        try:
            return Number(wanted.low, wanted.high, wanted.shown).check(Decimal(text) * others[unit])
        except PydanticCustomError as error:
            raise _WrongError(f"{wanted.name} = {text} {unit}: {error.message()}") from None

    def _unit_follows(self) -> bool:
        return bool(self._tokens) and self._tokens[-1].kind == "word"

    def _known(self, what: str, names: tuple[str, ...]) -> str:
        """Read one of the names."""
        listed = ", ".join(names)
        if not self._tokens:
            raise _WrongError(f"a {what} is missing; there are: {listed}")
        token = self._tokens.pop()
        if token.text in names:
            return token.text
        nearest = nearest_name(token.text[:_LONGEST], names)
        hint = f" Did you mean {nearest!r}?" if nearest else ""
        raise _WrongError(f"no {what} is called {token.text!r}.{hint} There are: {listed}")

    def _name(self, else_say: str) -> str:
        """Read a name, in quotes or without."""
        if not self._tokens or self._tokens[-1].kind not in ("word", "string"):
            raise _WrongError(else_say)
        token = self._tokens.pop()
        if token.kind == "word":
            return token.text
        try:
            return str(json.loads(token.text))
        except ValueError:
            raise _WrongError(
                f"{token.text} is no text: a backslash in it must stand before n, t, \\ or a quote"
            ) from None

    def _next_is(self, kind: str, text: str) -> bool:
        return bool(self._tokens) and self._tokens[-1] == (kind, text)
