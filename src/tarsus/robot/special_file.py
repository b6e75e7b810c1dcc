"""Files that can't be read to their end: pipes and devices."""

from __future__ import annotations

from pathlib import Path

__all__ = ["is_pipe_or_device"]


def is_pipe_or_device(path: Path) -> bool:
    """Return whether a path leads to a pipe or a device; opening a pipe would wait for a writer.

    Parameters
    ----------
    path : Path
        The path.
    """
    return path.exists() and not path.is_file() and not path.is_dir()
