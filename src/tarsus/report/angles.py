"""Figure of the joint angles over time, with the limits that they approach."""

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

# A limit is drawn if an angle comes within this distance of it [deg].
_NEAR = 10.0


def plot_angles(motion: Motion) -> Figure:
    """Draw the joint angles over time, with a panel for each joint and the contacts below.

    Lines are thick while the foot is on the ground. A joint limit is drawn if an angle comes within 10 degrees of it,
    with the legs that have it unless all do.

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
    figure, panels = joint_panels(
        motion,
        np.degrees(motion.angles),
        unit="°",
        title=f"{motion.robot.name}: joint angles (thick: foot on the ground)",
    )
    for joint, axes in enumerate(panels):
        _draw_limits(axes, motion, joint)
    return figure


def _draw_limits(axes: Axes, motion: Motion, joint: int) -> None:
    """Draw each limit that an angle approaches, once for all legs with that limit."""
    robot = motion.robot
    angles = np.degrees(motion.angles[:, :, joint])
    legs_at: dict[float, list[str]] = {}
    for leg, code in enumerate(robot.leg_codes):
        for limit in np.round(np.degrees(np.asarray(robot.limits)[leg, joint]), 3).tolist():
            if np.abs(angles[:, leg] - limit).min() <= _NEAR:
                legs_at.setdefault(limit, []).append(code)
    for limit, legs in legs_at.items():
        axes.axhline(limit, color=WARNING, linewidth=1.1, linestyle=(0, (6, 3)))
        suffix = "" if len(legs) == robot.legs else f" of {', '.join(legs)}"
        axes.annotate(
            f"limit {limit:g}°{suffix}",
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
