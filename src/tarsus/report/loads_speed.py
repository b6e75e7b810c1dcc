"""Figure of torque over speed for every sample, with the servos' torque-speed lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.load.loads import JointLoads
from tarsus.load.verdict import CONTINUOUS_FRACTION, SAFETY_FACTOR
from tarsus.report.style import INK, PALE, WARNING, decimation, halo, leg_colours, new_figure, tidy_axes
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["plot_torque_speed"]


def plot_torque_speed(loads: JointLoads) -> Figure:
    """Draw torque over speed for coxa, femur and tibia, with the torque-speed line of the weakest servo.

    Speed is positive in the direction of the torque: on the right the servo drives the joint, on the left it is driven.

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
    figure = new_figure(width=11, height=4.2)
    panels = figure.subplots(1, 3)
    for joint, name in enumerate(JOINTS):
        tidy_axes(panels[joint], x="speed in the direction of the torque (°/s)", y="torque (N m)")
        panels[joint].set_title(name, color=INK, fontsize=10, loc="left")
        _draw_demand(panels[joint], loads, joint)
        _draw_servo(panels[joint], loads, joint)
        panels[joint].set_ylim(bottom=0)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right upper", frameon=False, markerscale=3)
    figure.suptitle(
        f"{loads.robot.name}: required torque and speed, and torque-speed lines of the servos",
        x=0.01,
        ha="left",
        color=INK,
    )
    return figure


def _draw_demand(axes: Axes, loads: JointLoads, joint: int) -> None:
    shown = decimation(loads.motion)
    for leg, colour in enumerate(leg_colours(loads.robot)):
        torque = loads.torques[shown, leg, joint]
        speed = np.degrees(np.sign(torque) * loads.speeds[shown, leg, joint])
        axes.plot(
            speed, np.abs(torque), ".", markersize=3, color=colour, label=loads.robot.leg_codes[leg], linestyle="none"
        )


def _draw_servo(axes: Axes, loads: JointLoads, joint: int) -> None:
    """Draw the torque-speed line of the weakest servo, and 1/3 and 1/5 of its stall torque."""
    stalls = loads.stall_torque[:, joint]
    left = min(axes.get_xlim()[0], 0.0)
    if np.isnan(stalls).all():
        known = any(row[joint] is not None for row in loads.robot.servos)
        note = "no ratings at this supply" if known else "no servo in the robot file"
    else:
        weakest = int(np.nanargmin(stalls))
        stall, no_load = float(stalls[weakest]), float(np.degrees(loads.no_load_speed[weakest, joint]))
        servo = loads.robot.servos[weakest][joint]
        note = "" if servo is None else servo.name
        if np.isnan(no_load):
            axes.plot([left, 0], [stall, stall], color=WARNING, linewidth=1.4)
            note += ": no-load speed unknown"
        else:
            axes.plot([left, 0, no_load], [stall, stall, 0], color=WARNING, linewidth=1.4)
        for fraction, style, name in ((1 / SAFETY_FACTOR, "--", "1/3"), (CONTINUOUS_FRACTION, ":", "1/5")):
            axes.axhline(fraction * stall, color=WARNING, linewidth=1.0, linestyle=style)
            axes.annotate(
                name,
                (1, fraction * stall),
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
