"""Figure of the joint torques over time, with the limits of the servos."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.load.loads import JointLoads
from tarsus.load.verdict import CONTINUOUS_FRACTION, SAFETY_FACTOR
from tarsus.report.joint_panels import joint_panels
from tarsus.report.style import PALE, WARNING, halo

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["plot_torques", "servo_limits"]

# Limits are drawn up to this multiple of the peak torque, so that the torques remain readable.
_VISIBLE_RATIO = 3.5


def servo_limits(loads: JointLoads, joint: int) -> list[tuple[str, float]]:
    """Return name and torque of each limit of a joint's weakest servo [N m]; empty if no servo is known.

    Parameters
    ----------
    loads : JointLoads
        Joint loads.
    joint : int
        0 coxa, 1 femur, 2 tibia.
    """
    stall = loads.stall_torque[:, joint]
    if np.isnan(stall).all():
        return []
    least = float(np.nanmin(stall))
    return [
        (f"stall {least:.2f} N m", least),
        ("1/3 (factor 3)", least / SAFETY_FACTOR),
        ("1/5 (continuous)", least * CONTINUOUS_FRACTION),
    ]


def plot_torques(loads: JointLoads) -> Figure:
    """Draw the absolute joint torques over time, with a panel for each of coxa, femur and tibia.

    Parameters
    ----------
    loads : JointLoads
        Joint loads.

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
        loads.motion,
        np.abs(loads.torques),
        unit="N m",
        title=f"{loads.motion.robot.name}: joint torques (thick: foot on the ground) and servo limits",
    )
    for joint, axes in enumerate(panels):
        _draw_limits(axes, loads, joint)
    return figure


def _draw_limits(axes: Axes, loads: JointLoads, joint: int) -> None:
    """Draw the limits within the visible range, and list the others."""
    peak = float(loads.peak[:, joint].max())
    limits = servo_limits(loads, joint)
    visible = [(name, value) for name, value in limits if value <= _VISIBLE_RATIO * peak]
    axes.set_ylim(0, 1.12 * max([peak, *(value for _, value in visible)], default=1.0) or 1.0)
    for name, value in visible:
        is_stall = name.startswith("stall")
        axes.axhline(
            value, color=WARNING, linewidth=1.4 if is_stall else 1.0, linestyle="-" if is_stall else (0, (6, 3))
        )
        axes.annotate(
            name,
            (1, value),
            xycoords=("axes fraction", "data"),
            xytext=(-3, 2),
            textcoords="offset points",
            ha="right",
            va="bottom",
            fontsize=8,
            color=WARNING,
            path_effects=halo(),
        )
    hidden = [
        f"{name} ({value:.2f} N m)" if "N m" not in name else name
        for name, value in limits
        if (name, value) not in visible
    ]
    note = "no servo in the robot file" if not limits else f"beyond the axis: {', '.join(hidden)}" if hidden else ""
    axes.annotate(
        note,
        (0, 1),
        xycoords="axes fraction",
        xytext=(4, -3),
        textcoords="offset points",
        ha="left",
        va="top",
        fontsize=8,
        color=PALE,
    )
