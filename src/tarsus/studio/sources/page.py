"""A source document as a message: its equations with live numbers, and its errata."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tarsus.studio.encoding import or_null
from tarsus.studio.messages.general import Equation, Erratum, MathNode, SourceMessage
from tarsus.studio.messages.state import SourceChoice, WalkOptions
from tarsus.studio.sources import doc000, doc001, doc002, doc003, doc004
from tarsus.studio.sources.document import Document, Given, Line, Slip
from tarsus.studio.sources.errata import Row, errata
from tarsus.studio.sources.expression import Expression, Quantity, symbol_node
from tarsus.studio.sources.live import Live, WalkValues
from tarsus.studio.sources.torques import FEET_DOWN, torque_equations, torque_slips
from tarsus.studio.standing import OnFootholds

__all__ = ["DOCUMENTS", "source_message"]

DOCUMENTS: dict[str, Document] = {
    module.DOCUMENT.number: module.DOCUMENT for module in (doc000, doc001, doc002, doc003, doc004)
}
"""The five documents, by their numbers."""

_SIDEWAYS = "Note: the femur axis of this robot lies {:.1f} mm beside its coxa axis; the document has no such offset."
_OURS_DIFFERS = "Tarsus has {}: {}"
_AGREES = 1e-6


def source_message(
    standing: OnFootholds, choice: SourceChoice, walk: WalkOptions | None = None, *, id: int
) -> SourceMessage:
    """Return a document with the numbers of a leg of the standing robot.

    Parameters
    ----------
    standing : OnFootholds
        The standing robot.
    choice : SourceChoice
        The document and the leg.
    walk : WalkOptions, optional
        Options of the view Walk, which equations of walks use.
    id : int
        Id of the message that is answered.
    """
    document, leg = (
        DOCUMENTS[choice.number],
        Live.of(standing, choice.leg, None if walk is None else WalkValues.of(walk)),
    )
    symbols: dict[str, Quantity] = {}
    equations = [_equation(f"{index}.{line.symbol}", line, leg, symbols) for index, line in enumerate(document.lines)]
    if choice.number == "004":
        for feet_down in FEET_DOWN:
            equations += torque_equations(leg.robot, leg.leg, feet_down=feet_down)
    return SourceMessage(
        type="source",
        id=id,
        number=document.number,
        title=document.title,
        about=" ".join((document.about, *_caveats(document, leg))),
        leg=choice.leg,
        equations=equations,
        errata=list(_errata(document, leg, symbols)),
    )


def _caveats(document: Document, leg: Live) -> Iterator[str]:
    beside = leg.offset[0] * 1000
    if beside and not document.sideways:
        yield _SIDEWAYS.format(beside)


def _equation(key: str, line: Line, leg: Live, symbols: dict[str, Quantity]) -> Equation:
    """Evaluate a line, and store its result in `symbols` for later lines."""
    if isinstance(line, Given):
        quantity = Quantity(float(line.number(leg)), line.unit)
        formula = numbers = ours = note = None
    else:
        expression = Expression(line.formula)
        quantity = Quantity(_within_a_turn(expression.value(symbols), line.unit), line.unit)
        formula, numbers = expression.formula(), expression.numbers(symbols)
        ours = line.ours or None
        note = None if line.number is None else _difference(line.ours, quantity, float(line.number(leg)))
    symbols[line.symbol] = quantity
    return Equation(
        key=key,
        name=line.name,
        symbol=symbol_node(line.symbol),
        formula=formula,
        numbers=numbers,
        plain=_plain(line, quantity),
        value=_shown(quantity),
        unit=line.unit,
        ours=ours,
        printed_value=None,
        note=note,
    )


def _within_a_turn(value: float, unit: str) -> float:
    return math.remainder(value, 2 * math.pi) if unit == "deg" and math.isfinite(value) else value


def _difference(name: str, quantity: Quantity, ours: float) -> str | None:
    """Return a note with the value of Tarsus if the document's differs, as with the knee down; None if it agrees."""
    apart = quantity.value - ours
    if quantity.unit == "deg":
        apart = math.remainder(apart, 2 * math.pi) if math.isfinite(apart) else apart
    if abs(apart) < _AGREES:
        return None
    unit = "" if quantity.unit == "deg" else f" {quantity.unit}"
    return _OURS_DIFFERS.format(name, Quantity(ours, quantity.unit).text + unit)


def _shown(quantity: Quantity) -> float | None:
    return or_null(quantity.shown, decimals=6)


def _plain(line: Line, quantity: Quantity) -> str:
    unit = "" if quantity.unit in ("deg", "") else f" {quantity.unit}"
    value = f"{quantity.text}{unit}" if np.isfinite(quantity.value) else "no number"
    formula = "" if isinstance(line, Given) else f" = {line.formula.replace(' ** 2', '²').replace(' * ', ' ')}"
    return f"{line.symbol}{formula} = {value}"


def _errata(document: Document, leg: Live, symbols: dict[str, Quantity]) -> Iterator[Erratum]:
    torques = torque_slips(leg.robot, leg.leg) if document.number == "004" else {}
    for row in errata():
        if row.number == document.number:
            slip = document.slips.get(row.test)
            yield torques.get(row.test) or _erratum(row, slip, symbols)


def _erratum(row: Row, slip: Slip | None, symbols: dict[str, Quantity]) -> Erratum:
    formulas: list[MathNode | None] = [None, None]
    values: list[float | None] = [None, None]
    if slip is not None:
        both = [Expression(slip.printed), Expression(slip.correct)]
        formulas = [expression.formula() for expression in both]
        values = [_shown(Quantity(expression.value(symbols), slip.unit)) for expression in both]
    return Erratum(
        printed=row.printed,
        correct=row.correct,
        reason=row.reason,
        printed_formula=formulas[0],
        correct_formula=formulas[1],
        printed_value=values[0],
        correct_value=values[1],
        unit="" if slip is None else slip.unit,
    )
