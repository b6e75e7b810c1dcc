"""Folders that commands write to."""

from __future__ import annotations

import tempfile
from pathlib import Path

import click

__all__ = ["make_folder"]


def make_folder(out: Path) -> None:
    """Find out before the work, not after it, that nothing can be written.

    Parameters
    ----------
    out : Path
        What ``--out`` names.

    Raises
    ------
    UsageError
        If it can't be made, or nothing can be written there.
    """
    try:
        out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=out):
            pass
    except OSError as error:
        raise click.UsageError(f"--out {out}: nothing can be written there: {error.strerror}") from None
