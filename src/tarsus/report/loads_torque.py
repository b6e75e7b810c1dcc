"""The torque of every joint over time, against what its servo bears."""

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

# A limit is drawn where it is at most so many times as high as the greatest torque: else the torques were flat lines.
_IN_SIGHT = 3.5


def servo_limits(found: JointLoads, joint: int) -> list[tuple[str, float]]:
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
        ("1/5: lasting", least * CONTINUOUS_FRACTION),
    ]


def plot_torques(found: JointLoads) -> Figure:
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
    figure, panels = joint_panels(
        found.motion,
        np.abs(found.torques),
        unit="N m",
        title=f"{found.motion.robot.name}: torques, thick while the foot is down, and what the servos bear",
    )
    for joint, axes in enumerate(panels):
        _draw_limits(axes, found, joint)
    return figure


def _draw_limits(axes: Axes, found: JointLoads, joint: int) -> None:
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
