"""TOML writer with the layout of a robot file: a header for each table, inner tables and lists on one line.

Decimals are written with exactly their digits. General TOML writers put every number of a list on a separate line.
"""

from __future__ import annotations

import datetime
import json
import re
from decimal import Decimal
from typing import Any

__all__ = ["toml_number", "toml_string", "toml_text"]

_MOST_ZEROS = 9


def toml_text(document: dict[str, Any]) -> str:
    """Return a document of at most one level of tables as TOML."""
    top = [f"{key} = {_value(value)}" for key, value in document.items() if not _is_table(value)]
    parts = ["\n".join(top)]
    for key, value in document.items():
        if isinstance(value, dict):
            parts.append(_table(f"[{key}]", value))
        elif _is_table(value):
            parts += [_table(f"[[{key}]]", item) for item in value]
    return "\n\n".join(parts) + "\n"


def toml_string(text: str) -> str:
    """Return a string in quotes, with TOML's escapes."""
    # Escapes of JSON and TOML are the same, except DEL, which TOML requires to be escaped.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def toml_number(value: Decimal) -> str:
    """Return a number with all its digits and without redundant zeros."""
    if value.is_zero():
        return "-0.0" if value.is_signed() else "0"
    text = format(value, "f")
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    small = re.match(r"-?0\.(0*)", text)
    if small and len(small[1]) > _MOST_ZEROS:
        return f"{value:e}"
    return text


def _is_table(value: object) -> bool:
    return isinstance(value, dict) or (isinstance(value, list) and bool(value) and isinstance(value[0], dict))


def _table(header: str, table: dict[str, Any]) -> str:
    return "\n".join([header, *(f"{key} = {_value(value)}" for key, value in table.items())])


def _value(value: Any) -> str:
    if isinstance(value, Decimal):
        return toml_number(value)
    if isinstance(value, str):
        return toml_string(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, datetime.date):
        return value.isoformat()
    if isinstance(value, list):
        return f"[{', '.join(_value(item) for item in value)}]"
    return f"{{ {', '.join(f'{key} = {_value(item)}' for key, item in value.items())} }}"
