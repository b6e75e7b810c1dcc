"""The hand calculation of a robot's joint torques, as printed by `tarsus handbook`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from tarsus.load.handbook.comparison import Comparison
from tarsus.load.handbook.lines import plain_number
from tarsus.load.handbook.method import Handbook
from tarsus.report.tables import table_of
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from rich.table import Table

__all__ = ["hand_table", "handbook_notes", "handbook_summary"]

_SECTIONS = {
    "given": "given (lengths in m, masses in kg)",
    "weight": "weights",
    "swing": "leg in swing, stretched out",
    "inertia": "inertia of that leg about the coxa axis",
    "stance": "stance leg",
    "walk": "acceleration of the body",
}


def handbook_summary(hand: Handbook, comparison: Comparison | None) -> dict[str, Any]:
    """Return the lines of the calculation, and its comparison with statics, with units.

    Parameters
    ----------
    hand : Handbook
        The calculation.
    comparison : Comparison or None
        Its comparison with the torques of a planned walk.
    """
    rows = () if comparison is None else comparison.rows
    return {
        "robot": hand.robot.name,
        "title": hand.title,
        "leg": hand.robot.leg_codes[hand.leg],
        "feet_down": hand.feet_down,
        "safety_factor": hand.safety_factor,
        "corrected": hand.corrected,
        "lines": [
            {
                "key": line.key,
                "symbol": line.symbol,
                "formula": line.formula,
                "with_numbers": line.substitution,
                "value": line.value,
                "unit": line.unit,
                "printed": line.printed,
                "note": line.note,
            }
            for line in hand.lines
        ],
        "torque_nm": {joint: hand.torque(joint) for joint in JOINTS},
        "torque_with_factor_nm": {joint: hand.torque(joint, factor=True) for joint in JOINTS},
        "statics": [
            {
                "case": row.case,
                "joint": row.quantity,
                "hand_nm": row.hand,
                "statics_nm": row.statics,
                "hand_over_statics": None if math.isinf(row.ratio) else row.ratio,
                "leg": row.leg,
                "verdict": row.verdict,
            }
            for row in rows
        ],
        "sentences": [] if comparison is None else list(comparison.sentences),
    }


def hand_table(summary: dict[str, Any]) -> Table:
    """Return the lines of the calculation as a table, with numbers for the notes.

    Parameters
    ----------
    summary : dict
        Summary from `handbook_summary`.
    """
    printed = any(line["printed"] for line in summary["lines"])
    table = table_of("line", "value", *(["source 004"] if printed else []), "note", right=("value", "source 004"))
    notes = _numbered(summary)
    section, seen = None, set[str]()
    for line in summary["lines"]:
        name = line["key"].partition(".")[0]
        if name != section:
            if section is not None:
                table.add_section()
            table.add_row(_SECTIONS[name] + (", continued" if name in seen else ""), style="bold")
            section = name
            seen.add(name)
        formula = f" = {line['formula']}\n  = {line['with_numbers']}" if line["formula"] else ""
        table.add_row(
            line["symbol"] + formula,
            f"{plain_number(line['value'], line['unit'])} {line['unit']}",
            *([line["printed"] or ""] if printed else []),
            f"({notes[line['note']]})" if line["note"] else "",
        )
    return table


def handbook_notes(summary: dict[str, Any]) -> list[str]:
    """Return the notes, numbered as in the table.

    Parameters
    ----------
    summary : dict
        Summary from `handbook_summary`.
    """
    return [f"({number}) {note}" for note, number in _numbered(summary).items()]


def _numbered(summary: dict[str, Any]) -> dict[str, int]:
    notes = dict.fromkeys(line["note"] for line in summary["lines"] if line["note"])
    return {note: number for number, note in enumerate(notes, start=1)}
