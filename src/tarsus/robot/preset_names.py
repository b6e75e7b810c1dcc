"""Names of the preset robots."""

from __future__ import annotations

from functools import cache
from pathlib import Path

__all__ = ["PRESETS", "preset_names"]

PRESETS = Path(__file__).parent / "presets"
"""Folder of the presets' files."""


@cache
def preset_names() -> tuple[str, ...]:
    """Return the names of the preset robots."""
    return tuple(sorted(path.stem for path in PRESETS.glob("*.toml")))
