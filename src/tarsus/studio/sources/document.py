"""What a source document is here: given numbers, lines worked out one after the other, and its mistakes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from tarsus.studio.sources.live import Live

__all__ = ["Document", "Given", "Line", "Slip", "Step"]

Number = Callable[[Live], float]


@dataclass(frozen=True)
class Given:
    """A number that the document starts from.

    Attributes
    ----------
    symbol, name, unit : str
        What it is called there, what it is, in which unit it is shown.
    number : callable
        Takes it from the leg as it stands, in SI units.
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
        What comes out, what it is, in which unit it is shown.
    formula : str
        See `tarsus.studio.sources.expression`.
    ours : str
        The same in Tarsus' words; empty where there is no such thing.
    number : callable, optional
        That number as Tarsus has it, in SI units: a test holds both against each other.
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
    """A mistake, as far as it can be put into numbers.

    Attributes
    ----------
    printed, right : str
        The two formulas.
    unit : str
        In which unit what comes out is shown.
    """

    printed: str
    right: str
    unit: str


@dataclass(frozen=True, kw_only=True)
class Document:
    """A source document.

    Attributes
    ----------
    number, title, about : str
        Its number in this project, what it is called, what it is about.
    lines : tuple of Given or Step
        In the order in which they are worked out.
    slips : mapping
        Mistakes by the name of the test that holds them, as in the table of errata.
    sideways : bool
        Whether it knows of a femur axis that lies beside the coxa axis.
    """

    number: str
    title: str
    about: str
    lines: tuple[Line, ...]
    slips: Mapping[str, Slip] = field(default_factory=dict)
    sideways: bool = False
