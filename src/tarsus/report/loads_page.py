"""Self-contained HTML page of joint loads: verdict, figures, tables."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

from tarsus.load.verdict import severity_of
from tarsus.report.loads_table import LEGEND, LOAD_COLUMNS, is_worst, load_rows, loads_lines, loads_verdict
from tarsus.report.style import SEVERITY_COLOURS

__all__ = ["loads_page"]

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 70rem; margin: 2rem auto;
       padding: 0 1rem; }
h1 { font-size: 1.5rem; margin-bottom: 0; } h2 { font-size: 1.1rem; margin-top: 2rem; }
img { max-width: 100%; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .15rem .6rem; text-align: left; white-space: nowrap; }
th { border-bottom: 1px solid #222; } tr.worst td { font-weight: bold; }
td.number { text-align: right; } td.bar { font-family: monospace; }
.verdict { font-size: 1.2rem; font-weight: bold; padding: .4rem .8rem; border-left: .4rem solid; }
.wide { overflow-x: auto; }
""" + "\n".join(
    f".{severity} {{ border-color: {colour}; }} td.{severity} {{ color: {colour}; }}"
    for severity, colour in SEVERITY_COLOURS.items()
)

_TITLES = {"torques": "Torque over time", "torque-speed": "Torque over speed"}
_NUMBERS = {"peak N m", "RMS N m", "factor", "deg/s", "utilisation", "thermal"}


def loads_page(summary: dict[str, Any], figures: Sequence[Path]) -> str:
    """Return an HTML page with embedded figures.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary`.
    figures : sequence of Path
        PNG files.
    """
    title = f"{summary['robot']}: joint loads"
    severity = severity_of(summary["class"]) if summary["balanced"] else "bad"
    sections = [
        f"<h1>{escape(title)}</h1>",
        f"<p>{escape(_walk(summary))}</p>",
        f'<p class="verdict {severity}">{escape(str(loads_verdict(summary)))}</p>',
        *(_figure(path) for path in figures),
        "<h2>Every joint</h2>",
        f'<div class="wide">{_table(summary)}</div>',
        f"<p>{escape('; '.join(LEGEND))}</p>",
        "<h2>Details</h2>",
        f"<ul>{''.join(f'<li>{escape(line)}</li>' for line in loads_lines(summary))}</ul>",
    ]
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n"
        + "\n".join(sections)
        + "\n</body>\n</html>\n"
    )


def _walk(summary: dict[str, Any]) -> str:
    payload = f", payload {summary['payload_kg']:g} kg" if summary["payload_kg"] else ""
    inertia = "with inertia" if summary["inertial"] else "quasi-static"
    return (
        f"{summary['gait']} gait, {summary['distance_m'] * 1000:.0f} mm at {summary['speed_mm_s']:.0f} mm/s, "
        f"body height {summary['body_height_mm']:.0f} mm{payload}; {inertia}."
    )


def _figure(path: Path) -> str:
    title = escape(_TITLES.get(path.stem, path.stem))
    data = base64.b64encode(path.read_bytes()).decode("ascii")
    return f'<h2>{title}</h2>\n<img alt="{title}" src="data:image/png;base64,{data}">'


def _table(summary: dict[str, Any]) -> str:
    head = "".join(f"<th>{escape(column)}</th>" for column in LOAD_COLUMNS)
    rows = []
    for row in load_rows(summary):
        cells = "".join(_cell(column, text) for column, text in zip(LOAD_COLUMNS, row, strict=True))
        rows.append(f'<tr class="worst">{cells}</tr>' if is_worst(row, summary) else f"<tr>{cells}</tr>")
    return f"<table>\n<tr>{head}</tr>\n" + "\n".join(rows) + "\n</table>"


def _cell(column: str, text: str) -> str:
    kind = ' class="number"' if column in _NUMBERS else ' class="bar"' if column == "of stall" else ""
    if column == "class":
        kind = f' class="{severity_of(text)}"'
    return f"<td{kind}>{escape(text)}</td>"
