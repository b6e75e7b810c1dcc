"""The robot as links, joints and body in an axonometric picture: for itself, and for every frame of an animation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.kinematics.pose import Pose
from tarsus.report.drawing import RobotDrawing
from tarsus.report.ground import Ground
from tarsus.report.sample import Sample, sample_of
from tarsus.report.style import INK, new_figure
from tarsus.report.view import View
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["frame_axes", "plot_robot"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

_VIEW = View()


def plot_robot(
    robot: Robot,
    angles: Floats,
    *,
    body: Pose | None = None,
    contacts: Sequence[bool] | np.ndarray[Any, Any] | None = None,
    support: Floats | None = None,
    view: View = _VIEW,
    title: str = "",
) -> Figure:
    """Draw the robot, its support polygon on the ground and its centre of mass over it.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    body : Pose, optional
        The body's place in G; left out, level and so high that the lowest foot touches the ground.
    contacts : sequence of bool, optional
        Which feet bear load; left out, those within a millimetre of the ground.
    support : array, shape (k, 3), optional
        The points of G that hold the robot [m]; left out, the feet that bear load.
    view : View
        From where it is looked at.
    title : str
        What is written above it; left out, the robot's name.

    Returns
    -------
    Figure
        To be saved by `tarsus.report.style.save_figure`, or shown in a notebook.

    Raises
    ------
    InputError
        If the angles have the wrong shape, or are not finite.
    TarsusError
        If matplotlib is not installed.
    """
    sample = sample_of(robot, angles, body=body, contacts=contacts, support=support)
    figure = new_figure(width=7.2, height=5.2, by_hand=True)
    axes = figure.add_axes((0.0, 0.06, 1.0, 0.86))
    frame_axes(axes, [sample], view=view)
    Ground(axes, view).update()
    RobotDrawing(axes, robot, view=view, names=True).update(sample)
    stands = f"stability margin {sample.margin * 1000:.1f} mm" if len(sample.support) else "nothing on the ground"
    figure.text(0.015, 0.975, title or robot.name, color=INK, fontsize=12, va="top")
    figure.text(0.015, 0.02, f"{stands}; grid 100 mm", color=INK, fontsize=9)
    return figure


def frame_axes(axes: Axes, samples: Sequence[Sample], *, view: View) -> None:
    """Make the axes so large that they show all the samples, each seen from over its own body.

    Parameters
    ----------
    axes : Axes
        Where they are to be drawn; its unit will be the millimetre in the picture.
    samples : sequence of Sample
        What is to be drawn.
    view : View
        From where it is looked at.
    """
    around = [view.project((s.points - s.centre) * 1000).reshape(-1, 2) for s in samples]
    low, high = np.min([a.min(0) for a in around], axis=0), np.max([a.max(0) for a in around], axis=0)
    middle = (low + high) / 2 + view.project(samples[0].centre * 1000)
    box = axes.get_window_extent()
    needed = 1.16 * (high - low) + 20
    # One millimetre is as long upwards as across.
    scale = max(needed[0] / box.width, needed[1] / box.height)
    half = scale * np.array([box.width, box.height]) / 2
    axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
    axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
    axes.set_axis_off()
