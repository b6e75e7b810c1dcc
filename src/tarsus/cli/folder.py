"""Outputs of commands, checked before any computation: folders, files and the packages that write them."""

from __future__ import annotations

import errno
import importlib
import tempfile
from pathlib import Path

import click

__all__ = ["make_folder", "require_folder"]


def make_folder(out: Path, *packages: str) -> None:
    """Create an output folder, and check that it is writable.

    Parameters
    ----------
    out : Path
        Value of ``--out``.
    *packages : str
        Packages that write files of the folder.

    Raises
    ------
    UsageError
        If the folder can't be created or is not writable.
    ModuleNotFoundError
        If a package is missing.
    """
    _require(packages)
    try:
        out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=out):
            pass
    except OSError as error:
        raise click.UsageError(f"--out {out} is not writable: {error.strerror}") from None


def require_folder(file: Path, option: str, *packages: str) -> None:
    """Check that an output file can be written where it belongs.

    Parameters
    ----------
    file : Path
        The file.
    option : str
        Option that names it.
    *packages : str
        Packages that write it.

    Raises
    ------
    UsageError
        If it is a folder, or its folder does not exist or is not writable.
    ModuleNotFoundError
        If a package is missing.
    """
    _require(packages)
    try:
        if file.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder")
        with tempfile.TemporaryFile(dir=file.parent):
            pass
    except OSError as error:
        raise click.UsageError(f"{option} {file} can't be written: {error.strerror}") from None


def _require(packages: tuple[str, ...]) -> None:
    for package in packages:
        importlib.import_module(package)
