"""Tables of docs/handbook.md, generated from the code.

A table stands between ``<!-- table: NAME -->`` and ``<!-- end -->``; `docs_page` replaces it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence

from tarsus.errors import UnknownNameError
from tarsus.load.handbook.comparison import ACCELERATING, Comparison
from tarsus.load.handbook.lines import Line, plain_number
from tarsus.load.handbook.method import Handbook, handbook
from tarsus.load.handbook.statics import compare_with_statics
from tarsus.robot.robot import Robot

__all__ = ["TABLES", "docs_page", "markdown_table"]

_BODY_HEIGHTS = (0.04, 0.06, 0.08, 0.11, 0.14)
_BLOCK = re.compile(r"(<!-- table: ([^>]*?) -->\n).*?(<!-- end -->)", flags=re.DOTALL)


def docs_page(text: str, robot: Robot) -> str:
    """Return a page with its tables regenerated.

    Parameters
    ----------
    text : str
        The page.
    robot : Robot
        The robot of the tables.

    Raises
    ------
    UnknownNameError
        If a table name is unknown.
    """

    def table(match: re.Match[str]) -> str:
        if match[2] not in TABLES:
            raise UnknownNameError.of("table", match[2], TABLES)
        return f"{match[1]}{TABLES[match[2]](robot)}\n{match[3]}"

    return _BLOCK.sub(table, text)


def markdown_table(rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table.

    Parameters
    ----------
    rows : iterable of sequence of str
        Rows, the header first.
    """
    header, *body = rows
    lines = [header, ["---"] * len(header), *body]
    return "\n".join("| " + " | ".join(row) + " |" for row in lines)


def _line_rows(lines: Iterable[Line]) -> str:
    rows = (
        (
            f"`{line.key}`",
            line.symbol + (f" = {line.formula}" if line.formula else ""),
            line.substitution,
            f"{plain_number(line.value, line.unit)} {line.unit}",
            line.printed or "",
            line.note,
        )
        for line in lines
    )
    return markdown_table([("key", "line", "with numbers", "value", "source 004", "note"), *rows])


def _section(hand: Handbook, *sections: str) -> str:
    return _line_rows(line for line in hand.lines if line.key.partition(".")[0] in sections)


def _source_errors(robot: Robot) -> str:
    """Return the table of lines whose corrected value differs from the printed one."""
    rows = [("line", "feet down", "source 004", "corrected", "unit", "note")]
    for feet_down in (3, 5):
        for line in handbook(robot, feet_down=feet_down).lines:
            if line.agrees is False and (feet_down == 3 or line.key.startswith("walk.")):
                down = str(feet_down) if line.key.startswith("walk.") else "any"
                value = plain_number(float(f"{line.value:.4g}"))
                rows.append((f"`{line.key}`", down, line.printed or "", value, line.unit, line.note))
    return markdown_table(rows)


def _statics(robot: Robot, gait: str) -> str:
    comparison = compare_with_statics(robot, gait=gait)
    return "\n\n".join(
        [
            markdown_table((*row[:8], row[9]) for row in comparison.table()),
            markdown_table((*row[:4], *row[5:8]) for row in comparison.table(reasons=True)),
            "\n".join(f"- {sentence}" for sentence in comparison.sentences),
        ]
    )


def _body_height_table(robot: Robot) -> str:
    """Return the table of the hand method over statics at several body heights."""
    rows = [
        ("body height", "gait", "femur: hand / statics", "with the factor", "tibia: hand / statics", "with the factor")
    ]
    for body_height in _BODY_HEIGHTS:
        for gait in ("tripod", "wave"):
            comparison = compare_with_statics(robot, gait=gait, body_height=body_height)
            rows.append(
                (f"{body_height * 1000:.0f} mm", gait, *_ratios(comparison, "femur"), *_ratios(comparison, "tibia"))
            )
    return markdown_table(rows)


def _ratios(comparison: Comparison, joint: str) -> tuple[str, str]:
    row = comparison.row(ACCELERATING, joint)
    return f"{row.ratio:.2f}", f"{row.reserve:.2f}"


TABLES: dict[str, Callable[[Robot], str]] = {
    "given": lambda robot: _section(handbook(robot), "given"),
    "free swing": lambda robot: _section(handbook(robot), "weight", "swing", "inertia"),
    "three feet down": lambda robot: _section(handbook(robot), "stance", "walk"),
    "five feet down": lambda robot: _section(handbook(robot, feet_down=5), "stance", "walk"),
    "errors": _source_errors,
    "tripod": lambda robot: _statics(robot, "tripod"),
    "wave": lambda robot: _statics(robot, "wave"),
    "ripple": lambda robot: _statics(robot, "ripple"),
    "body heights": _body_height_table,
}
"""Generator of each table, by name."""
