"""Gait diagram: contacts of each foot over time, with the stability margin."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.report.style import INK, WARNING, decimation, leg_colours, new_figure, stance_spans, tidy_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from tarsus.robot.robot import Robot

__all__ = ["diagram_rows", "draw_stance", "plot_gait"]


def plot_gait(motion: Motion) -> Figure:
    """Draw the gait diagram, with a bar for each stance and the stability margin below.

    Parameters
    ----------
    motion : Motion
        The motion.

    Returns
    -------
    Figure
        Figure to save with `tarsus.report.style.save_figure` or to show in a notebook.

    Raises
    ------
    TarsusError
        If matplotlib is not installed.
    """
    figure = new_figure(width=9, height=3.2 + 0.28 * motion.robot.legs)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[0.3 * motion.robot.legs, 2])
    tidy_axes(above, y="leg")
    draw_stance(above, motion)
    tidy_axes(below, x="time (s)", y="stability margin (mm)")
    _draw_margin(below, motion)
    below.set_xlim(0, motion.duration)
    gait = motion.gait
    name = f"{motion.robot.name}: {gait.name} gait"
    timing = f"duty factor {gait.duty_factor:.3g}, cycle time {motion.cycle_time:.3g} s"
    figure.suptitle(f"{name}, {timing}. Bars: foot on the ground", x=0.01, ha="left", color=INK)
    return figure


def diagram_rows(robot: Robot) -> list[int]:
    """Return the order of the legs in a gait diagram: the left side from front to rear, then the right side.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    mounts = np.asarray(robot.mount_position)
    return sorted(range(robot.legs), key=lambda leg: (mounts[leg, 1] <= 0, -mounts[leg, 0]))


def draw_stance(axes: Axes, motion: Motion) -> None:
    """Draw a row for each leg, with a bar for each stance.

    Parameters
    ----------
    axes : Axes
        Target axes; the x axis is time [s].
    motion : Motion
        The motion.
    """
    rows, colours = diagram_rows(motion.robot), leg_colours(motion.robot)
    for row, leg in enumerate(rows):
        axes.broken_barh(stance_spans(motion, leg), (row - 0.38, 0.76), facecolor=colours[leg], linewidth=0)
    axes.set_yticks(range(len(rows)), [motion.robot.leg_codes[leg] for leg in rows], fontsize=8)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.grid(visible=False, axis="y")


def _draw_margin(axes: Axes, motion: Motion) -> None:
    shown = decimation(motion)
    # Without a foot on the ground the margin is minus infinity, drawn as a gap.
    margin = np.where(np.isfinite(motion.margin), motion.margin, np.nan) * 1000
    axes.plot(motion.time[shown], margin[shown], color=INK, linewidth=1.5)
    axes.axhline(0, color=WARNING, linewidth=1.1, linestyle=(0, (6, 3)))
    if not np.isfinite(margin).any():
        return
    axes.fill_between(motion.time[shown], 0, np.minimum(margin[shown], 0), color=WARNING, alpha=0.25, linewidth=0)
    worst = int(np.nanargmin(margin))
    axes.plot(motion.time[worst], margin[worst], "o", color=INK, markersize=5)
    high = float(np.nanmax(margin))
    low, high = min(0.0, float(margin[worst])), max(high, 5.0)
    # Space for the label below the minimum.
    axes.set_ylim(low - 0.17 * (high - low), high + 0.1 * (high - low))
    late = motion.time[worst] > 0.7 * motion.duration
    axes.annotate(
        f"minimum: {margin[worst]:.1f} mm at {motion.time[worst]:.2f} s",
        (float(motion.time[worst]), float(margin[worst])),
        xytext=(-8 if late else 8, -11),
        textcoords="offset points",
        ha="right" if late else "left",
        va="center",
        color=INK,
        fontsize=9,
    )
