"""What the pictures have in common: a white figure, colours that the colour-blind can tell apart, files.

matplotlib is imported when a picture is made, not before, and without `pyplot`: no window, no state shared with the
program that asks.
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
    "WARNING",
    "halo",
    "leg_colours",
    "new_figure",
    "save_figure",
    "stance_spans",
    "thinned",
    "tidy_axes",
]

INK = "#222222"
"""Text and outlines."""

PALE = "#8a8a8a"
"""What stays behind: grids, paths, notes."""

WARNING = "#b00020"
"""Limits, and what is wrong."""

# Okabe and Ito's colours (and two of Tol's for robots with more legs): cool ones left, warm ones right.
_LEFT = ("#0072B2", "#56B4E9", "#009E73", "#332288")
_RIGHT = ("#D55E00", "#E69F00", "#CC79A7", "#882255")
_MOST_POINTS = 4000


def leg_colours(robot: Robot) -> list[str]:
    """Return a colour for each leg: cool on the left, warm on the right, from front to rear.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    mounts = np.asarray(robot.mount_position)
    colours = [""] * robot.legs
    for side, choice in ((mounts[:, 1] > 0, _LEFT), (mounts[:, 1] <= 0, _RIGHT)):
        legs = sorted(np.flatnonzero(side), key=lambda leg: -mounts[leg, 0])
        for place, leg in enumerate(legs):
            colours[leg] = choice[place % len(choice)]
    return colours


def new_figure(*, width: float, height: float, dpi: int = 130, by_hand: bool = False) -> Figure:
    """Return an empty white figure that is drawn in memory.

    Parameters
    ----------
    width, height : float
        Size [inches].
    dpi : int
        Pixels per inch.
    by_hand : bool
        Whether axes are placed by hand; else so that no label is cut off.

    Raises
    ------
    TarsusError
        If matplotlib is not installed; the message says how to install it.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise TarsusError("pictures need matplotlib: pip install 'tarsus[plots]'") from None
    layout: Literal["constrained"] | None = None if by_hand else "constrained"
    figure = Figure(figsize=(width, height), dpi=dpi, layout=layout, facecolor="white")
    FigureCanvasAgg(figure)
    return figure


def tidy_axes(axes: Axes, *, x: str = "", y: str = "") -> None:
    """Label the axes, with units, and leave out what frames them.

    Parameters
    ----------
    axes : Axes
        The axes.
    x, y : str
        What they show, with the unit.
    """
    axes.set_facecolor("white")
    axes.set_xlabel(x, color=INK)
    axes.set_ylabel(y, color=INK)
    axes.grid(visible=True, color="#e6e6e6", linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def save_figure(figure: Figure, path: str | os.PathLike[str]) -> None:
    """Write a figure to a file; its ending (png, svg, pdf) says which kind.

    Parameters
    ----------
    figure : Figure
        The figure.
    path : path
        Where to write it.

    Raises
    ------
    InputError
        If it can't be written, or matplotlib has no such kind of file.
    """
    try:
        figure.savefig(path)
    except OSError as error:
        raise InputError(f"{path} can't be written: {error.strerror or error}") from None
    except ValueError as error:
        raise InputError(f"{path} can't be written: {error}") from None


def halo() -> list[Any]:
    """Return the effect that keeps words legible over lines: a white rim."""
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=2.5, foreground="white")]


def thinned(motion: Motion) -> slice:
    """Return which samples to draw: all, or so many of a long motion as a picture can show.

    Parameters
    ----------
    motion : Motion
        The motion.
    """
    return slice(None, None, max(1, len(motion.time) // _MOST_POINTS))


def stance_spans(motion: Motion, leg: int) -> list[tuple[float, float]]:
    """Return when a foot is down, as (start, duration) [s].

    Parameters
    ----------
    motion : Motion
        The motion.
    leg : int
        Which leg.
    """
    down: np.ndarray[Any, Any] = np.concatenate([[False], motion.contacts[:, leg], [False]])
    edges = np.flatnonzero(down[1:] != down[:-1])
    last = len(motion.time) - 1
    starts, ends = motion.time[edges[::2]], motion.time[np.minimum(edges[1::2], last)]
    return [(float(start), float(end - start)) for start, end in zip(starts, ends, strict=True)]
