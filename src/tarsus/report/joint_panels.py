"""Figure with a panel over time for each of coxa, femur and tibia, and the contacts below."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.report.gait_diagram import draw_stance
from tarsus.report.style import INK, decimation, leg_colours, new_figure, tidy_axes
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from jaxtyping import Float
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["joint_panels"]


def joint_panels(
    motion: Motion, values: Float[np.ndarray, "n legs 3"], *, unit: str, title: str
) -> tuple[Figure, tuple[Axes, ...]]:
    """Draw a quantity of every joint over time, with thick lines in stance.

    Parameters
    ----------
    motion : Motion
        The motion.
    values : array, shape (n, legs, 3)
        Quantity to draw.
    unit : str
        Unit of the quantity.
    title : str
        Title of the figure.

    Returns
    -------
    figure : Figure
        The figure.
    panels : tuple of Axes
        Axes of coxa, femur and tibia.

    Raises
    ------
    TarsusError
        If matplotlib is not installed.
    """
    figure = new_figure(width=9.6, height=8)
    axes = figure.subplots(4, 1, sharex=True, height_ratios=[3, 3, 3, 1.3])
    for joint, name in enumerate(JOINTS):
        tidy_axes(axes[joint], y=f"{name} ({unit})")
        _draw_joint(axes[joint], motion, values[:, :, joint])
    tidy_axes(axes[3], x="time (s)", y="contact")
    draw_stance(axes[3], motion)
    axes[3].set_xlim(0, motion.duration)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right upper", frameon=False)
    figure.suptitle(title, x=0.01, ha="left", color=INK)
    return figure, tuple(axes[:3])


def _draw_joint(axes: Axes, motion: Motion, values: Float[np.ndarray, "n legs"]) -> None:
    shown = decimation(motion)
    time = motion.time[shown]
    for leg, colour in enumerate(leg_colours(motion.robot)):
        line = values[shown, leg]
        axes.plot(time, line, color=colour, linewidth=1.0)
        stance = np.where(motion.contacts[shown, leg], line, np.nan)
        axes.plot(time, stance, color=colour, linewidth=2.6, label=motion.robot.leg_codes[leg])
