"""The joint angles over time, beside the limits that they come near to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.report.joint_panels import joint_panels
from tarsus.report.style import WARNING

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
    figure, panels = joint_panels(
        motion,
        np.degrees(motion.angles),
        unit="°",
        title=f"{motion.robot.name}: joint angles, thick while the foot is down",
    )
    for joint, axes in enumerate(panels):
        _draw_limits(axes, motion, joint)
    return figure


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
