"""Tables on pages, between ``<!-- table: NAME -->`` and ``<!-- end -->``."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

__all__ = ["replace_tables"]


def replace_tables(page: Path, tables: Mapping[str, str]) -> None:
    """Write tables onto a page, in place of those with their names."""
    text = page.read_text(encoding="utf-8")
    for name, table in tables.items():
        before, start, rest = text.partition(f"<!-- table: {name} -->\n")
        text = f"{before}{start}{table.rstrip()}\n<!-- end -->{rest.partition('<!-- end -->')[2]}"
    page.write_text(text, encoding="utf-8")
