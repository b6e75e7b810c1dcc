"""The errata of docs/sources.md, as data of the package: ``python -m tarsus.studio.sources.errata docs/sources.md``.

The page is the source of ``errata.json`` beside this module; a test checks that both agree.
"""

from __future__ import annotations

import html
import json
import re
import sys
from functools import cache
from pathlib import Path
from typing import NamedTuple

__all__ = ["Row", "errata", "rows_of_page"]

_JSON = Path(__file__).with_name("errata.json")
_HEADER = ["as printed", "correct", "reason", "test"]


class Row(NamedTuple):
    """A row of a table of errata.

    Attributes
    ----------
    number : str
        Number of the document.
    printed, correct, reason : str
        Texts of the row.
    test : str
        Name of its test.
    """

    number: str
    printed: str
    correct: str
    reason: str
    test: str


@cache
def errata() -> tuple[Row, ...]:
    """Return all errata in the order of the page."""
    return tuple(Row(*row) for row in json.loads(_JSON.read_text(encoding="utf-8")))


def rows_of_page(text: str) -> tuple[Row, ...]:
    """Return the errata in the tables of a page.

    Parameters
    ----------
    text : str
        The Markdown of docs/sources.md.
    """
    rows: list[Row] = []
    number, inside = "", False
    for line in text.splitlines():
        found = re.match(r"## (\d{3}):", line)
        number = found[1] if found else number
        cells = [_plain(cell) for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if cells == _HEADER:
            inside = True
        elif not cells:
            inside = False
        elif inside and not set(cells[0]) <= {"-"}:
            printed, correct, reason, test = cells
            rows.append(Row(number, printed, correct, reason, test))
    return tuple(rows)


def _plain(cell: str) -> str:
    """Return the plain text of a cell, without Markdown and HTML."""
    return html.unescape(re.sub(r"</?code>|`", "", cell.strip()))


if __name__ == "__main__":
    found_rows = rows_of_page(Path(sys.argv[1]).read_text(encoding="utf-8"))
    _JSON.write_text(json.dumps(found_rows, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
