"""Sums that show their work: a number that remembers how it was come by, and the sheet that such lines stand on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

__all__ = ["Line", "Sheet", "Term", "plain_number"]

_SUM, _PRODUCT, _SINGLE = 1, 2, 3  # how firmly a text holds together; less firm ones get brackets


def plain_number(value: float, unit: str = "") -> str:
    """Return a number as one writes it by hand: six digits, no exponent; lengths to a tenth of a millimetre.

    Parameters
    ----------
    value : float
        The number.
    unit : str
        Its unit; ``"m"`` for a length.
    """
    rounded = round(value, 4) if unit == "m" else value
    return str(np.format_float_positional(rounded, precision=6, fractional=False, trim="-"))


@dataclass(frozen=True)
class Term:
    """A number with the formula that it comes from, in symbols and in numbers.

    Attributes
    ----------
    value : float
        The number, in SI units.
    symbols : str
        The formula in symbols.
    numbers : str
        The formula with the numbers put in.
    level : int
        How firmly the texts hold together: 1 a sum, 2 a product, 3 a single symbol.
    """

    value: float
    symbols: str
    numbers: str
    level: int = _SINGLE

    @classmethod
    def number(cls, value: float) -> Term:
        """Return a bare number.

        Parameters
        ----------
        value : float
            The number.
        """
        return cls(value, plain_number(value), plain_number(value))

    def __add__(self, other: Term) -> Term:
        return self._join(" + ", other, self.value + other.value, _SUM, _SUM)

    def __mul__(self, other: Term) -> Term:
        return self._join(" × ", other, self.value * other.value, _PRODUCT, _PRODUCT)

    def __truediv__(self, other: Term) -> Term:
        return self._join(" / ", other, self.value / other.value, _PRODUCT, _SINGLE)

    def squared(self) -> Term:
        """Return the square."""
        symbols, numbers = self._texts(_SINGLE)
        return Term(self.value**2, f"{symbols}²", f"{numbers}²")

    def _join(self, sign: str, other: Term, value: float, level: int, right: int) -> Term:
        mine, theirs = self._texts(level), other._texts(right)
        return Term(value, mine[0] + sign + theirs[0], mine[1] + sign + theirs[1], level)

    def _texts(self, level: int) -> tuple[str, str]:
        if self.level < level:
            return f"({self.symbols})", f"({self.numbers})"
        return self.symbols, self.numbers


@dataclass(frozen=True, kw_only=True)
class Line:
    """One line of the calculation.

    Attributes
    ----------
    key : str
        What it is called here, such as ``"stance.femur"``.
    symbol : str
        Its symbol, such as ``"τ_femur"``.
    formula : str
        Its formula in symbols; empty for a given number.
    substitution : str
        The formula with the numbers put in; empty for a given number.
    value : float
        What comes out, in SI units.
    unit : str
        The unit.
    printed : str or None
        What source 004 prints, to its digits; None where it has no such line, or for any other robot than its own.
    note : str
        What is to be said of it: a slip in the source, or what the line leaves out.
    """

    key: str
    symbol: str
    formula: str
    substitution: str
    value: float
    unit: str
    printed: str | None = None
    note: str = ""

    @property
    def agrees(self) -> bool | None:
        """Whether the value, rounded or cut off, is the printed number; None where none is printed."""
        if self.printed is None:
            return None
        digits = len(self.printed.partition(".")[2])
        return abs(self.value - float(self.printed)) < 10.0**-digits


@dataclass(frozen=True)
class Sheet:
    """Lines in the order in which they are worked out.

    Attributes
    ----------
    printed : mapping
        For each key, the number that source 004 prints.
    notes : mapping
        For each key, what is to be said of the line.
    carry_printed : bool
        Whether later lines go on with the printed numbers, as the source does, or with the full ones.
    lines : list of Line
        The lines so far.
    """

    printed: Mapping[str, str]
    notes: Mapping[str, str]
    carry_printed: bool
    lines: list[Line] = field(default_factory=list)

    def give(self, key: str, symbol: str, unit: str, value: float) -> Term:
        """Note a given number, and return it for later lines."""
        return self._write(key, symbol, unit, Term(value, "", ""))

    def work(self, key: str, symbol: str, unit: str, result: Term) -> Term:
        """Note a result, and return it for later lines."""
        return self._write(key, symbol, unit, result)

    def _write(self, key: str, symbol: str, unit: str, term: Term) -> Term:
        printed = self.printed.get(key)
        line = Line(
            key=key,
            symbol=symbol,
            formula=term.symbols,
            substitution=term.numbers,
            value=term.value,
            unit=unit,
            printed=printed,
            note=self.notes.get(key, ""),
        )
        self.lines.append(line)
        value = float(printed) if self.carry_printed and printed is not None else term.value
        return Term(value, symbol, plain_number(value, unit))
