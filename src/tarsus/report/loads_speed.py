"""Torque over speed: every moment of every joint, against its servo's line from stall to running free."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.load.loads import JointLoads
from tarsus.load.verdict import CONTINUOUS_FRACTION, SAFETY_FACTOR
from tarsus.report.style import INK, PALE, WARNING, halo, leg_colours, new_figure, thinned, tidy_axes
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["plot_torque_speed"]


def plot_torque_speed(found: JointLoads) -> Figure:
    """Draw torque over speed for each kind of joint, with the line of its weakest servo.

    Speed counts in the direction of the torque: to the right the servo drives, to the left it is driven.

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
    figure = new_figure(width=11, height=4.2)
    panels = figure.subplots(1, 3)
    for joint, name in enumerate(JOINTS):
        tidy_axes(panels[joint], x="speed in the torque's direction (°/s)", y="torque (N m)")
        panels[joint].set_title(name, color=INK, fontsize=10, loc="left")
        _draw_demand(panels[joint], found, joint)
        _draw_servo(panels[joint], found, joint)
        panels[joint].set_ylim(bottom=0)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right upper", frameon=False, markerscale=3)
    figure.suptitle(f"{found.robot.name}: what is asked of the servos, and their lines", x=0.01, ha="left", color=INK)
    return figure


def _draw_demand(axes: Axes, found: JointLoads, joint: int) -> None:
    shown = thinned(found.motion)
    for leg, colour in enumerate(leg_colours(found.robot)):
        torque = found.torques[shown, leg, joint]
        speed = np.degrees(np.sign(torque) * found.speeds[shown, leg, joint])
        axes.plot(
            speed, np.abs(torque), ".", markersize=3, color=colour, label=found.robot.leg_codes[leg], linestyle="none"
        )


def _draw_servo(axes: Axes, found: JointLoads, joint: int) -> None:
    """Draw the line of the weakest servo, flat where it is driven, and a third and a fifth of its stall torque."""
    stalls = found.stall_torque[:, joint]
    left = min(axes.get_xlim()[0], 0.0)
    if np.isnan(stalls).all():
        note = "no servo in the robot file"
    else:
        weakest = int(np.nanargmin(stalls))
        stall, free = float(stalls[weakest]), float(np.degrees(found.no_load_speed[weakest, joint]))
        servo = found.robot.servos[weakest][joint]
        note = "" if servo is None else servo.name
        if np.isnan(free):
            axes.plot([left, 0], [stall, stall], color=WARNING, linewidth=1.4)
            note += ": speed unknown"
        else:
            axes.plot([left, 0, free], [stall, stall, 0], color=WARNING, linewidth=1.4)
        for share, style, name in ((1 / SAFETY_FACTOR, "--", "1/3"), (CONTINUOUS_FRACTION, ":", "1/5")):
            axes.axhline(share * stall, color=WARNING, linewidth=1.0, linestyle=style)
            axes.annotate(
                name,
                (1, share * stall),
                xycoords=("axes fraction", "data"),
                xytext=(-3, 2),
                textcoords="offset points",
                ha="right",
                fontsize=8,
                color=WARNING,
                path_effects=halo(),
            )
    axes.annotate(
        note,
        (1, 1),
        xycoords="axes fraction",
        xytext=(-3, -3),
        textcoords="offset points",
        ha="right",
        va="top",
        fontsize=8,
        color=PALE,
    )
