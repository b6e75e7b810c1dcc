"""Calculations that show their steps: numbers with their formulas, and the sheet that lists them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from tarsus.representation import represented

__all__ = ["Line", "Sheet", "Term", "plain_number"]

_SUM, _PRODUCT, _SINGLE = 1, 2, 3  # precedence of an expression; operands of lower precedence get brackets


def plain_number(value: float, unit: str = "") -> str:
    """Format a number with six significant digits and no exponent; lengths to 0.1 mm.

    Parameters
    ----------
    value : float
        The number.
    unit : str
        Unit; ``"m"`` for a length.
    """
    rounded = round(value, 4) if unit == "m" else value
    return str(np.format_float_positional(rounded, precision=6, fractional=False, trim="-"))


@represented()
@dataclass(frozen=True)
class Term:
    """A number with its formula, in symbols and in numbers.

    Attributes
    ----------
    value : float
        The number, in SI units.
    symbols : str
        The formula in symbols.
    numbers : str
        The formula with the numbers substituted.
    precedence : int
        Precedence of the expression: 1 a sum, 2 a product, 3 a single symbol.
    """

    value: float
    symbols: str
    numbers: str
    precedence: int = _SINGLE

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

    def _join(self, sign: str, other: Term, value: float, precedence: int, right: int) -> Term:
        left_text, right_text = self._texts(precedence), other._texts(right)
        return Term(value, left_text[0] + sign + right_text[0], left_text[1] + sign + right_text[1], precedence)

    def _texts(self, precedence: int) -> tuple[str, str]:
        if self.precedence < precedence:
            return f"({self.symbols})", f"({self.numbers})"
        return self.symbols, self.numbers


@represented()
@dataclass(frozen=True, kw_only=True)
class Line:
    """One line of the calculation.

    Attributes
    ----------
    key : str
        Key of the line, such as ``"stance.femur"``.
    symbol : str
        Symbol, such as ``"τ_femur"``.
    formula : str
        Formula in symbols; empty for a given number.
    substitution : str
        Formula with the numbers substituted; empty for a given number.
    value : float
        Result, in SI units.
    unit : str
        Unit of the result.
    printed : str or None
        Number printed in source 004; None if it has no such line, or for other robots.
    note : str
        Remark: an error in the source, or what the line neglects.
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
        """Whether the value, rounded or truncated, is the printed number; None if none is printed."""
        if self.printed is None:
            return None
        digits = len(self.printed.partition(".")[2])
        return abs(self.value - float(self.printed)) < 10.0**-digits


@dataclass(frozen=True)
class Sheet:
    """Lines of a calculation, in order.

    Attributes
    ----------
    printed : mapping
        Number printed in source 004, by key.
    notes : mapping
        Remark, by key.
    carry_printed : bool
        Whether later lines use the printed numbers, as the source does, or the full ones.
    lines : list of Line
        The lines so far.
    """

    printed: Mapping[str, str]
    notes: Mapping[str, str]
    carry_printed: bool
    lines: list[Line] = field(default_factory=list)

    def given(self, key: str, symbol: str, unit: str, value: float) -> Term:
        """Add a given number, and return it for later lines."""
        return self._write(key, symbol, unit, Term(value, "", ""))

    def result(self, key: str, symbol: str, unit: str, term: Term) -> Term:
        """Add a result, and return it for later lines."""
        return self._write(key, symbol, unit, term)

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
