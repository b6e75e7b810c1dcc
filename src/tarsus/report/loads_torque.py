"""The torque of every joint over time, against what its servo bears."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.load.loads import Loads
from tarsus.load.verdict import CONTINUOUS_SHARE, SAFETY_FACTOR
from tarsus.report.gait_diagram import draw_stance
from tarsus.report.style import INK, PALE, WARNING, halo, leg_colours, new_figure, thinned, tidy_axes
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["plot_torques", "servo_limits"]

# A limit is drawn where it is at most so many times as high as the greatest torque: else the torques were flat lines.
_IN_SIGHT = 3.5


def servo_limits(found: Loads, joint: int) -> list[tuple[str, float]]:
    """Return the limits of a kind of joint's weakest servo, with their names [N m]; none where no servo is known.

    Parameters
    ----------
    found : Loads
        The loads.
    joint : int
        0 coxa, 1 femur, 2 tibia.
    """
    stall = found.stall_torque[:, joint]
    if np.isnan(stall).all():
        return []
    least = float(np.nanmin(stall))
    return [
        (f"stall {least:.2f} N m", least),
        ("1/3: factor 3", least / SAFETY_FACTOR),
        ("1/5: lasting", least * CONTINUOUS_SHARE),
    ]


def plot_torques(found: Loads) -> Figure:
    """Draw how much torque every joint bears over time: a panel for each kind, and below it when each foot is down.

    Parameters
    ----------
    found : Loads
        The loads.

    Returns
    -------
    Figure
        To be saved by `tarsus.report.style.save_figure`, or shown in a notebook.

    Raises
    ------
    TarsusError
        If matplotlib is not installed.
    """
    motion = found.motion
    figure = new_figure(width=9.6, height=8)
    axes = figure.subplots(4, 1, sharex=True, height_ratios=[3, 3, 3, 1.3])
    for joint, name in enumerate(JOINTS):
        tidy_axes(axes[joint], y=f"{name} (N m)")
        _draw_joint(axes[joint], found, joint)
        _draw_limits(axes[joint], found, joint)
    tidy_axes(axes[3], x="time (s)", y="foot down")
    draw_stance(axes[3], motion)
    axes[3].set_xlim(0, motion.duration)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right upper", frameon=False)
    figure.suptitle(
        f"{motion.robot.name}: torques, thick while the foot is down, and what the servos bear",
        x=0.01,
        ha="left",
        color=INK,
    )
    return figure


def _draw_joint(axes: Axes, found: Loads, joint: int) -> None:
    motion = found.motion
    shown = thinned(motion)
    time = motion.time[shown]
    for leg, colour in enumerate(leg_colours(motion.robot)):
        torque = np.abs(found.torques[shown, leg, joint])
        axes.plot(time, torque, color=colour, linewidth=1.0)
        standing = np.where(motion.contacts[shown, leg], torque, np.nan)
        axes.plot(time, standing, color=colour, linewidth=2.6, label=motion.robot.leg_codes[leg])


def _draw_limits(axes: Axes, found: Loads, joint: int) -> None:
    """Draw the limits that are in sight, and name those that are not."""
    greatest = float(found.peak[:, joint].max())
    limits = servo_limits(found, joint)
    in_sight = [(name, value) for name, value in limits if value <= _IN_SIGHT * greatest]
    axes.set_ylim(0, 1.12 * max([greatest, *(value for _, value in in_sight)], default=1.0) or 1.0)
    for name, value in in_sight:
        whole = name.startswith("stall")
        axes.axhline(value, color=WARNING, linewidth=1.4 if whole else 1.0, linestyle="-" if whole else (0, (6, 3)))
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
    beyond = [
        f"{name} ({value:.2f} N m)" if "N m" not in name else name
        for name, value in limits
        if (name, value) not in in_sight
    ]
    note = "no servo in the robot file" if not limits else f"far above: {', '.join(beyond)}" if beyond else ""
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
