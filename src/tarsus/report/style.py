"""Style of the figures: white background, colour-blind safe colours, output files.

matplotlib is imported when a figure is created, and without `pyplot`, so that no window opens and no global state is
shared with the calling program.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tarsus.errors import InputError, TarsusError
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from tarsus.gait.motion import Motion

__all__ = [
    "INK",
    "PALE",
    "SEVERITY_COLOURS",
    "WARNING",
    "decimation",
    "halo",
    "leg_colours",
    "new_figure",
    "save_figure",
    "stance_spans",
    "tidy_axes",
]

INK = "#222222"
"""Text and outlines."""

PALE = "#8a8a8a"
"""Background elements: grids, paths, notes."""

WARNING = "#b00020"
"""Limits and faults."""

SEVERITY_COLOURS = {"good": "#17703c", "warning": "#875400", "bad": "#b3121f"}
"""Colours of the severities of `tarsus.load.verdict.severity_of`: those of the studio in its light theme."""

# Colours by Okabe and Ito, and two by Tol for robots with more legs: cool on the left side, warm on the right.
_LEFT = ("#0072B2", "#56B4E9", "#009E73", "#332288")
_RIGHT = ("#D55E00", "#E69F00", "#CC79A7", "#882255")
_MAX_POINTS = 4000


def leg_colours(robot: Robot) -> list[str]:
    """Return a colour for each leg, cool on the left and warm on the right.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    mounts = np.asarray(robot.mount_position)
    colours = [""] * robot.legs
    for side, palette in ((mounts[:, 1] > 0, _LEFT), (mounts[:, 1] <= 0, _RIGHT)):
        legs = sorted(np.flatnonzero(side), key=lambda leg: -mounts[leg, 0])
        for index, leg in enumerate(legs):
            colours[leg] = palette[index % len(palette)]
    return colours


def new_figure(*, width: float, height: float, dpi: int = 130, manual_layout: bool = False) -> Figure:
    """Return an empty white figure, rendered in memory.

    Parameters
    ----------
    width, height : float
        Size [inches].
    dpi : int
        Pixels per inch.
    manual_layout : bool
        Whether the caller places the axes; otherwise they are placed so that no label is cut off.

    Raises
    ------
    TarsusError
        If matplotlib is not installed; the message says how to install it.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise TarsusError("figures need matplotlib: pip install 'tarsus[plots]'") from None
    layout: Literal["constrained"] | None = None if manual_layout else "constrained"
    figure = Figure(figsize=(width, height), dpi=dpi, layout=layout, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def tidy_axes(axes: Axes, *, x: str = "", y: str = "") -> None:
    """Label the axes, with units, and remove the frame.

    Parameters
    ----------
    axes : Axes
        The axes.
    x, y : str
        Axis labels, with units.
    """
    axes.set_facecolor("white")
    axes.set_xlabel(x, color=INK)
    axes.set_ylabel(y, color=INK)
    axes.grid(visible=True, color="#e6e6e6", linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def save_figure(figure: Figure, path: str | os.PathLike[str]) -> None:
    """Write a figure to a file; its extension (png, svg, pdf) determines the format.

    Parameters
    ----------
    figure : Figure
        The figure.
    path : path
        Output file.

    Raises
    ------
    InputError
        If the file can't be written, or matplotlib does not support the format.
    """
    try:
        figure.savefig(path)
    except OSError as error:
        raise InputError(f"{path} can't be written: {error.strerror or error}") from None
    except ValueError as error:
        raise InputError(f"{path} can't be written: {error}") from None


def halo() -> list[Any]:
    """Return the path effect of a white outline, which keeps text legible over lines."""
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=2.5, foreground="white")]


def decimation(motion: Motion) -> slice:
    """Return the slice of samples to draw: every n-th sample of a long motion.

    Parameters
    ----------
    motion : Motion
        The motion.
    """
    return slice(None, None, max(1, len(motion.time) // _MAX_POINTS))


def stance_spans(motion: Motion, leg: int) -> list[tuple[float, float]]:
    """Return the stances of a foot as (start, duration) [s].

    Parameters
    ----------
    motion : Motion
        The motion.
    leg : int
        Index of the leg.
    """
    contact: np.ndarray = np.concatenate([[False], motion.contacts[:, leg], [False]])
    edges = np.flatnonzero(contact[1:] != contact[:-1])
    last = len(motion.time) - 1
    starts, ends = motion.time[edges[::2]], motion.time[np.minimum(edges[1::2], last)]
    return [(float(start), float(end - start)) for start, end in zip(starts, ends, strict=True)]
