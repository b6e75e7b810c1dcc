"""Figure of commanded against measured joint angles of a real run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.report.style import INK, WARNING, leg_colours, new_figure, tidy_axes
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float
    from matplotlib.figure import Figure

__all__ = ["plot_tracking"]

_MOST_POINTS = 3000


def plot_tracking(
    robot: Robot,
    time: Float[np.ndarray, "n"],
    sent: Float[np.ndarray, "n legs 3"],
    measured: Float[np.ndarray, "n legs 3"],
    *,
    title: str,
    fault_time: float | None = None,
) -> Figure:
    """Draw the angle of every joint as commanded (thin) and as measured (thick), a panel for each joint of each leg.

    Parameters
    ----------
    robot : Robot
        The robot.
    time : array, shape (n,)
        Times [s].
    sent, measured : array, shape (n, legs, 3)
        Joint angles that were commanded and measured; NaN where nothing was measured [rad].
    title : str
        Title of the figure.
    fault_time : float, optional
        Time at which a fault was noticed [s].

    Returns
    -------
    Figure
        Figure to save with `tarsus.report.style.save_figure`.

    Raises
    ------
    TarsusError
        If matplotlib is not installed.
    """
    figure = new_figure(width=10.5, height=1.0 + 1.35 * robot.legs)
    panels = figure.subplots(robot.legs, len(JOINTS), sharex=True, squeeze=False)
    shown = slice(None, None, max(1, len(time) // _MOST_POINTS))
    for leg, colour in enumerate(leg_colours(robot)):
        for j, joint in enumerate(JOINTS):
            axes = panels[leg][j]
            last = leg == robot.legs - 1
            tidy_axes(axes, x="time (s)" if last else "", y=f"{robot.leg_codes[leg]} {joint}\n(deg)")
            axes.plot(time[shown], np.degrees(measured[shown, leg, j]), color=colour, linewidth=2.4, alpha=0.6)
            axes.plot(time[shown], np.degrees(sent[shown, leg, j]), color=INK, linewidth=0.8)
            if fault_time is not None:
                axes.axvline(fault_time, color=WARNING, linewidth=1.0)
    figure.suptitle(title, x=0.01, ha="left", color=INK)
    return figure
