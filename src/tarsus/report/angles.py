"""The joint angles over time, beside the limits that they come near to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.report.gait_diagram import draw_stance
from tarsus.report.style import INK, WARNING, leg_colours, new_figure, thinned, tidy_axes
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["plot_angles"]

# A limit is drawn where an angle comes within this many degrees of it.
_NEAR = 10.0


def plot_angles(motion: Motion) -> Figure:
    """Draw every joint angle over time: a panel for each joint, and below it when each foot is down.

    Lines are thick while the foot is on the ground. A joint's limit is drawn where an angle comes within 10 degrees
    of it, and names the legs that have it where not all do.

    Parameters
    ----------
    motion : Motion
        The motion.

    Returns
    -------
    Figure
        To be saved by `tarsus.report.style.save_figure`, or shown in a notebook.

    Raises
    ------
    TarsusError
        If matplotlib is not installed.
    """
    figure = new_figure(width=9.6, height=8)
    axes = figure.subplots(4, 1, sharex=True, height_ratios=[3, 3, 3, 1.3])
    for joint, name in enumerate(JOINTS):
        tidy_axes(axes[joint], y=f"{name} (°)")
        _draw_joint(axes[joint], motion, joint)
        _draw_limits(axes[joint], motion, joint)
    tidy_axes(axes[3], x="time (s)", y="foot down")
    draw_stance(axes[3], motion)
    axes[3].set_xlim(0, motion.duration)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right upper", frameon=False)
    figure.suptitle(f"{motion.robot.name}: joint angles, thick while the foot is down", x=0.01, ha="left", color=INK)
    return figure


def _draw_joint(axes: Axes, motion: Motion, joint: int) -> None:
    shown = thinned(motion)
    time = motion.time[shown]
    for leg, colour in enumerate(leg_colours(motion.robot)):
        angles = np.degrees(motion.angles[shown, leg, joint])
        axes.plot(time, angles, color=colour, linewidth=1.0)
        standing = np.where(motion.contacts[shown, leg], angles, np.nan)
        axes.plot(time, standing, color=colour, linewidth=2.6, label=motion.robot.leg_codes[leg])


def _draw_limits(axes: Axes, motion: Motion, joint: int) -> None:
    """Draw each limit that an angle comes near to, once for all legs that share it."""
    robot = motion.robot
    angles = np.degrees(motion.angles[:, :, joint])
    legs_at: dict[float, list[str]] = {}
    for leg, code in enumerate(robot.leg_codes):
        for limit in np.round(np.degrees(np.asarray(robot.limits)[leg, joint]), 3).tolist():
            if np.abs(angles[:, leg] - limit).min() <= _NEAR:
                legs_at.setdefault(limit, []).append(code)
    for limit, legs in legs_at.items():
        axes.axhline(limit, color=WARNING, linewidth=1.1, linestyle=(0, (6, 3)))
        whose = "" if len(legs) == robot.legs else f" of {', '.join(legs)}"
        axes.annotate(
            f"limit {limit:g}°{whose}",
            (1, limit),
            xycoords=("axes fraction", "data"),
            xytext=(-3, 2),
            textcoords="offset points",
            ha="right",
            va="bottom",
            fontsize=8,
            color=WARNING,
        )
    axes.margins(y=0.12)
