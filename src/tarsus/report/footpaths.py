"""Figure of the paths of body and feet, from above and from the side."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.report.solid import body_outline
from tarsus.report.style import INK, PALE, decimation, halo, leg_colours, new_figure, tidy_axes

if TYPE_CHECKING:
    from jaxtyping import Float, Int
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["footholds", "plot_footpaths", "walking_direction"]

_WIDTH = 9.0


def plot_footpaths(motion: Motion) -> Figure:
    """Draw the paths of body and feet from above, to scale, and the foot heights from the side.

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
    span = np.ptp(motion.feet[..., :2].reshape(-1, 2), axis=0)
    # The top view is to scale: its height follows from its width, within the limits of a page.
    top = float(np.clip((_WIDTH - 1) * span[1] / span[0], 2.5, 8.0)) + 0.8
    figure = new_figure(width=_WIDTH, height=top + 2.6)
    axes = figure.subplots(3, 1, height_ratios=[top, 1.0, 1.0])
    _draw_top(axes[0], motion)
    axes[2].sharex(axes[1])
    axes[2].sharey(axes[1])
    left = np.asarray(motion.robot.mount_position)[:, 1] > 0
    for on_side, name, panel in ((left, "left", axes[1]), (~left, "right", axes[2])):
        tidy_axes(panel, y=f"{name} feet:\nheight (mm)")
        _draw_side(panel, motion, np.flatnonzero(on_side))
    axes[1].tick_params(labelbottom=False)
    axes[2].set_xlabel(_side_label(motion), color=INK)
    figure.suptitle(f"{motion.robot.name}: foot paths (dots: footholds)", x=0.01, ha="left", color=INK)
    return figure


def footholds(motion: Motion, leg: int) -> Float[np.ndarray, "stances 3"]:
    """Return the footholds of a leg, one for each stance.

    Parameters
    ----------
    motion : Motion
        The motion.
    leg : int
        Index of the leg.

    Returns
    -------
    array, shape (stances, 3)
        Footholds in G [m].
    """
    down = motion.contacts[:, leg]
    first = down & ~np.concatenate([[False], down[:-1]])
    points: np.ndarray = motion.feet[first, leg]
    return points


def walking_direction(motion: Motion) -> Float[np.ndarray, "2"]:
    """Return the walking direction, the horizontal axis of the side view.

    Parameters
    ----------
    motion : Motion
        The motion.

    Returns
    -------
    array, shape (2,)
        Unit vector from the body's start to its end in G's xy plane; x if they are within 10 mm of each other.
    """
    displacement: np.ndarray = (motion.body.position[-1] - motion.body.position[0])[:2]
    length = float(np.hypot(*displacement))
    return displacement / length if length > 0.010 else np.array([1.0, 0.0])


def _side_label(motion: Motion) -> str:
    x, y = walking_direction(motion)
    angle = np.degrees(np.arctan2(y, x))
    return "forward, x (mm)" if abs(angle) < 0.05 else f"walking direction, {angle:.0f}° from x (mm)"


def _draw_top(axes: Axes, motion: Motion) -> None:
    robot, shown = motion.robot, decimation(motion)
    tidy_axes(axes, x="x, forward at the start (mm)", y="y, left (mm)")
    path = motion.body.position[shown] * 1000
    axes.plot(path[:, 0], path[:, 1], color=PALE, linewidth=1.6, label="body", zorder=2)
    outline = body_outline(robot)
    for index, style, fill in ((0, (0, (4, 2)), 0.05), (-1, "-", 0.12)):
        corners = (motion.body[index] @ outline)[:, :2] * 1000
        axes.fill(corners[:, 0], corners[:, 1], facecolor=INK, alpha=fill, zorder=1)
        axes.plot(*np.vstack([corners, corners[:1]]).T, color=INK, linewidth=1.1, linestyle=style, zorder=2)
        _draw_heading(axes, motion, index)
    for leg, colour in enumerate(leg_colours(robot)):
        feet = motion.feet[shown, leg] * 1000
        axes.plot(feet[:, 0], feet[:, 1], color=colour, linewidth=1.4, zorder=3, label=robot.leg_codes[leg])
        leg_footholds = footholds(motion, leg) * 1000
        axes.plot(leg_footholds[:, 0], leg_footholds[:, 1], "o", color=colour, markersize=5, zorder=4)
        _name_leg(axes, motion, leg, colour)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)


def _draw_heading(axes: Axes, motion: Motion, index: int) -> None:
    """Draw an arrow from the body's origin in its forward direction."""
    length = 0.5 * float(np.ptp(np.asarray(motion.robot.mount_position)[:, 0]))
    ends = motion.body[index] @ np.array([[0.0, 0.0, 0.0], [length, 0.0, 0.0]]) * 1000
    axes.annotate(
        "",
        (ends[1, 0], ends[1, 1]),
        (ends[0, 0], ends[0, 1]),
        arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 1.2, "shrinkA": 0, "shrinkB": 0},
        zorder=5,
    )


def _name_leg(axes: Axes, motion: Motion, leg: int, colour: str) -> None:
    """Label a leg outside its first foothold, with a line to the body."""
    foot = motion.feet[0, leg, :2] * 1000
    mount = (motion.body[0] @ np.asarray(motion.robot.mount_position)[leg])[:2] * 1000
    axes.plot([mount[0], foot[0]], [mount[1], foot[1]], color=PALE, linewidth=0.8, linestyle=":", zorder=1)
    outward = (foot - mount) / max(float(np.hypot(*(foot - mount))), 1e-9)
    # Above or below the foot path, which usually runs along x.
    axes.annotate(
        motion.robot.leg_codes[leg],
        (float(foot[0]), float(foot[1])),
        xytext=(14 * float(outward[0]), 11 if outward[1] >= 0 else -11),
        textcoords="offset points",
        ha="center",
        va="center",
        color=colour,
        fontweight="bold",
        fontsize=10,
        path_effects=halo(),
        zorder=6,
    )


def _draw_side(axes: Axes, motion: Motion, legs: Int[np.ndarray, "legs"]) -> None:
    shown, colours = decimation(motion), leg_colours(motion.robot)
    distance = motion.feet[..., :2] @ walking_direction(motion) * 1000
    height = motion.feet[..., 2] * 1000
    axes.axhline(0, color=PALE, linewidth=1.0)
    for leg in legs:
        name = motion.robot.leg_codes[leg]
        axes.plot(distance[shown, leg], height[shown, leg], color=colours[leg], linewidth=1.4, label=name)
    axes.margins(y=0.15)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.05), frameon=False, fontsize=8, handlelength=1.2)
