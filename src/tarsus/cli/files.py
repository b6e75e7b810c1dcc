"""Output files of a walk: table, figures, animation."""

from __future__ import annotations

from pathlib import Path

from tarsus.cli.output import Progress
from tarsus.gait.motion import Motion
from tarsus.gait.storage import motion_to_csv
from tarsus.report.angles import plot_angles
from tarsus.report.animation import animate
from tarsus.report.footpaths import plot_footpaths
from tarsus.report.gait_diagram import plot_gait
from tarsus.report.style import save_figure

__all__ = ["write_walk"]

_FIGURES = {"angles.png": plot_angles, "footpaths.png": plot_footpaths, "gait.png": plot_gait}


def write_walk(motion: Motion, folder: Path, *, animation: bool, progress: Progress) -> list[Path]:
    """Write the files of a walk and return their paths.

    Parameters
    ----------
    motion : Motion
        The walk.
    folder : Path
        Existing folder.
    animation : bool
        Whether to write the animation.
    progress : callable
        Called with the name of the current file and the completed fraction.

    Raises
    ------
    InputError
        If a file can't be written.
    TarsusError
        If matplotlib is not installed.
    """
    table = folder / "walk.csv"
    progress("table", 0.0)
    motion_to_csv(motion, table)
    written = [table]
    for name, plot in _FIGURES.items():
        progress(name, 0.05 * len(written))
        save_figure(plot(motion), folder / name)
        written.append(folder / name)
    if animation:
        gif = folder / "walk.gif"
        animate(motion, gif, progress=lambda fraction: progress(gif.name, 0.2 + 0.8 * fraction))
        written.append(gif)
    return written
