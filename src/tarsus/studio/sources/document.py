"""A source document: given values, equations in order, and errata."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from tarsus.studio.sources.live import Live

__all__ = ["Document", "Given", "Line", "Slip", "Step"]

Number = Callable[[Live], float]


@dataclass(frozen=True)
class Given:
    """A given quantity of the document.

    Attributes
    ----------
    symbol, name, unit : str
        Symbol in the document, quantity, and unit of display.
    number : callable
        Returns the value for a leg, in SI units.
    """

    symbol: str
    name: str
    unit: str
    number: Number


@dataclass(frozen=True)
class Step:
    """An equation.

    Attributes
    ----------
    symbol, name, unit : str
        Symbol in the document, quantity, and unit of display.
    formula : str
        See `tarsus.studio.sources.expression`.
    ours : str
        The same quantity in Tarsus; empty if there is none.
    number : callable, optional
        Value of that quantity in Tarsus, in SI units; a test compares both.
    """

    symbol: str
    name: str
    unit: str
    formula: str
    ours: str = ""
    number: Number | None = None


Line = Given | Step


@dataclass(frozen=True)
class Slip:
    """An erratum that can be evaluated.

    Attributes
    ----------
    printed, correct : str
        Printed and corrected formula.
    unit : str
        Unit of the result.
    """

    printed: str
    correct: str
    unit: str


@dataclass(frozen=True, kw_only=True)
class Document:
    """A source document.

    Attributes
    ----------
    number, title, about : str
        Number in this project, title, and subject.
    lines : tuple of Given or Step
        In the order of evaluation.
    slips : mapping
        Errata by the names of their tests, as in the table of errata.
    sideways : bool
        Whether it supports a femur axis with a sideways offset from the coxa axis.
    """

    number: str
    title: str
    about: str
    lines: tuple[Line, ...]
    slips: Mapping[str, Slip] = field(default_factory=dict)
    sideways: bool = False
