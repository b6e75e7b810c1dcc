"""Axonometric figure of a robot with its links, joints and body."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.kinematics.pose import Pose
from tarsus.report.drawing import RobotDrawing
from tarsus.report.ground import Ground
from tarsus.report.sample import Sample, sample_of
from tarsus.report.style import INK, new_figure
from tarsus.report.view import View
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["frame_axes", "plot_robot"]

_VIEW = View()


def plot_robot(
    robot: Robot,
    angles: Float[np.ndarray, "legs 3"],
    *,
    body: Pose | None = None,
    contacts: Sequence[bool] | Bool[np.ndarray, "legs"] | None = None,
    support: Float[np.ndarray, "k 3"] | None = None,
    view: View = _VIEW,
    title: str = "",
) -> Figure:
    """Draw the robot with its support polygon and its centre of mass.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    body : Pose, optional
        Pose of B in G. Default: level, with the lowest foot on the ground.
    contacts : sequence of bool, optional
        Which feet bear load. Default: those within 1 mm of the ground.
    support : array, shape (k, 3), optional
        Points that support the robot, in G [m]. Default: the feet that bear load.
    view : View
        Direction of view.
    title : str
        Title of the figure. Default: the name of the robot.

    Returns
    -------
    Figure
        Figure to save with `tarsus.report.style.save_figure` or to show in a notebook.

    Raises
    ------
    InputError
        If the angles have the wrong shape, or are not finite.
    TarsusError
        If matplotlib is not installed.
    """
    sample = sample_of(robot, angles, body=body, contacts=contacts, support=support)
    figure = new_figure(width=7.2, height=5.2, manual_layout=True)
    axes = figure.add_axes((0.0, 0.06, 1.0, 0.86))
    frame_axes(axes, [sample], view=view)
    Ground(axes, view).update()
    RobotDrawing(axes, robot, view=view, names=True).update(sample)
    stability = f"stability margin {sample.margin * 1000:.1f} mm" if len(sample.support) else "no ground contact"
    figure.text(0.015, 0.975, title or robot.name, color=INK, fontsize=12, va="top")
    figure.text(0.015, 0.02, f"{stability}; grid 100 mm", color=INK, fontsize=9)
    return figure


def frame_axes(axes: Axes, samples: Sequence[Sample], *, view: View) -> None:
    """Set the limits of the axes so that they show all samples, each relative to its body.

    Parameters
    ----------
    axes : Axes
        Target axes; their unit becomes the millimetre of the projection.
    samples : sequence of Sample
        States to draw.
    view : View
        Direction of view.
    """
    extents = [view.project((s.points - s.centre) * 1000).reshape(-1, 2) for s in samples]
    low, high = np.min([a.min(0) for a in extents], axis=0), np.max([a.max(0) for a in extents], axis=0)
    middle = (low + high) / 2 + view.project(samples[0].centre * 1000)
    box = axes.get_window_extent()
    required = 1.16 * (high - low) + 20
    # Equal scale on both axes.
    scale = max(required[0] / box.width, required[1] / box.height)
    half = scale * np.array([box.width, box.height]) / 2
    axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
    axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
    axes.set_axis_off()
