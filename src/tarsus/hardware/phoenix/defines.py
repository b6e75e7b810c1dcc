"""The constants of a C header: `#define` with whole numbers, names and arithmetic, and conditions on names."""

from __future__ import annotations

import ast
import operator
import re
import warnings
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from tarsus.errors import InputError

__all__ = ["Defines", "read_defines"]

_DEEPEST = 50
_OPERATORS: dict[type, Callable[[Any, Any], int]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    # C rounds towards zero.
    ast.Div: lambda a, b: int(a / b),
}


class _Define(NamedTuple):
    text: str
    line: int


class Defines:
    """The names that a header defines.

    Parameters
    ----------
    found : mapping of str to (str, int)
        Text and line of each.
    where : str
        Name of the header in messages.
    """

    def __init__(self, found: Mapping[str, _Define], where: str) -> None:
        self._found, self._where = found, where

    def __contains__(self, name: object) -> bool:
        """Return whether a name is defined."""
        return name in self._found

    def number(self, name: str, default: int | None = None) -> int:
        """Return the value of a name.

        Parameters
        ----------
        name : str
            The name.
        default : int, optional
            Value where it is not defined.

        Raises
        ------
        InputError
            If it is not defined and has no default, or is no whole number.
        """
        return self._number(name, default, 0)

    def _number(self, name: str, default: int | None, depth: int) -> int:
        if name not in self._found:
            if default is None:
                raise InputError(f"{self._where} does not define {name}")
            return default
        text, line = self._found[name]
        try:
            if depth > _DEEPEST:
                raise ValueError
            with warnings.catch_warnings():
                # Python warns of text that it only just accepts, such as "1or 2": not of use to the caller.
                warnings.simplefilter("ignore")
                parsed = ast.parse(text.strip() or "?", mode="eval")
            return self._value(parsed.body, depth)
        except InputError:
            raise
        except (SyntaxError, ValueError, ZeroDivisionError, RecursionError, MemoryError):
            raise InputError(
                f"{self._where}, line {line}: {name} is {text.strip()[:40]!r}; it must be a whole number"
            ) from None

    def _value(self, node: ast.expr, depth: int) -> int:
        match node:
            case ast.Constant(value=int(value)) if abs(value) <= 2**31:
                return value
            case ast.Name(id=name):
                return self._number(name, None, depth + 1)
            case ast.UnaryOp(op=ast.USub(), operand=inner):
                return -self._value(inner, depth)
            case ast.UnaryOp(op=ast.UAdd(), operand=inner):
                return self._value(inner, depth)
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
                return _OPERATORS[type(op)](self._value(left, depth), self._value(right, depth))
        raise ValueError


def read_defines(text: str, *, where: str) -> Defines:
    """Return what a header defines; code and macros with arguments are passed over.

    Conditions on whether a name is defined before are evaluated, and ``#if 1`` holds; other conditions don't hold.

    Parameters
    ----------
    text : str
        Text of the header.
    where : str
        Its name in messages.
    """
    found: dict[str, _Define] = {}
    # For each enclosing condition: whether its present branch holds, and whether one of its branches has held.
    open_conditions: list[tuple[bool, bool]] = []
    without_comments = re.sub(r"/\*.*?\*/", lambda comment: "\n" * comment[0].count("\n"), text, flags=re.DOTALL)
    for number, line in enumerate(without_comments.splitlines(), 1):
        directive = re.match(r"\s*#\s*(\w+)\s*(.*?)\s*(//.*)?$", line)
        if directive is None:
            continue
        word, rest = directive[1], directive[2]
        if word in ("if", "ifdef", "ifndef"):
            holds = _holds(word, rest, found)
            open_conditions.append((holds, holds))
        elif word in ("else", "elif") and open_conditions:
            _, held = open_conditions.pop()
            holds = not held and (word == "else" or _holds("if", rest, found))
            open_conditions.append((holds, held or holds))
        elif word == "endif" and open_conditions:
            open_conditions.pop()
        elif all(holds for holds, _ in open_conditions):
            name = re.match(r"(\w+)(?![\w(])\s*(.*)", rest)
            if word == "define" and name:
                found[name[1]] = _Define(name[2], number)
            elif word == "undef":
                found.pop(rest, None)
    return Defines(found, where)


def _holds(word: str, rest: str, found: Mapping[str, _Define]) -> bool:
    if word == "ifdef":
        return rest in found
    if word == "ifndef":
        return rest not in found
    name = re.fullmatch(r"(not|!)?\s*defined\s*\(?\s*(\w+)\s*\)?", rest)
    if name is None:
        return rest == "1"
    return (name[2] in found) is (name[1] is None)
