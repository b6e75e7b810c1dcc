"""Output folders of commands."""

from __future__ import annotations

import tempfile
from pathlib import Path

import click

__all__ = ["make_folder"]


def make_folder(out: Path) -> None:
    """Create an output folder, and check that it is writable before any computation.

    Parameters
    ----------
    out : Path
        Value of ``--out``.

    Raises
    ------
    UsageError
        If the folder can't be created or is not writable.
    """
    try:
        out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=out):
            pass
    except OSError as error:
        raise click.UsageError(f"--out {out} is not writable: {error.strerror}") from None
