"""The files of a walk: its table, its pictures, its animation."""

from __future__ import annotations

from pathlib import Path

from tarsus.cli.output import Progress
from tarsus.gait.motion import Motion
from tarsus.report.angles import plot_angles
from tarsus.report.animation import animate
from tarsus.report.footpaths import plot_footpaths
from tarsus.report.gait_diagram import plot_gait
from tarsus.report.style import save_figure

__all__ = ["write_walk"]

_PICTURES = {"angles.png": plot_angles, "footpaths.png": plot_footpaths, "gait.png": plot_gait}


def write_walk(motion: Motion, folder: Path, *, animation: bool, progress: Progress) -> list[Path]:
    """Write a walk's files and return where they are.

    Parameters
    ----------
    motion : Motion
        The walk.
    folder : Path
        A folder that is there.
    animation : bool
        Whether to write the animation too.
    progress : callable
        Told what is being written.

    Raises
    ------
    InputError
        If a file can't be written.
    TarsusError
        If matplotlib is not installed.
    """
    table = folder / "walk.csv"
    progress("table", 0.0)
    motion.to_csv(table)
    written = [table]
    for name, plot in _PICTURES.items():
        progress(name, 0.05 * len(written))
        save_figure(plot(motion), folder / name)
        written.append(folder / name)
    if animation:
        film = folder / "walk.gif"
        animate(motion, film, progress=lambda share: progress(film.name, 0.2 + 0.8 * share))
        written.append(film)
    return written
