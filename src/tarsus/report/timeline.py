"""Figure of a recording over time: commands, gait, speeds, body pose and stability margin."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.loop.recording import Event, Recording
from tarsus.report.gait_diagram import draw_stance
from tarsus.report.style import INK, PALE, WARNING, decimation, leg_colours, new_figure, tidy_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["plot_timeline"]

_ACTUAL, _OTHER = "#0072B2", "#D55E00"
_SHADE, _LIMITED = "#e9e9e9", "#f6d58a"
# Width of the panels, and width of a character of their labels [inches].
_WIDTH, _CHARACTER_WIDTH = 9.6, 0.062
_MAX_LABEL = 44


def plot_timeline(recording: Recording) -> Figure:
    """Draw commands, contacts, commanded and actual speed, the body pose, and the stability margin over time.

    With admittance, the heights of the stance feet are drawn as well.

    Parameters
    ----------
    recording : Recording
        From `tarsus.run` or `tarsus.run_scenario`.

    Returns
    -------
    Figure
        Figure to save with `tarsus.report.style.save_figure` or to show in a notebook.

    Raises
    ------
    TarsusError
        If matplotlib is not installed.
    """
    motion = recording.motion
    labels = _rows(recording)
    command_height = 0.19 * (1 + max((row for _, row, _ in labels), default=0)) + 0.1
    compliant = recording.compliant
    heights = [command_height, 0.24 * motion.robot.legs, 1.25, 1.0, 1.25, *([1.15] if compliant else []), 1.15]
    figure = new_figure(width=_WIDTH + 1, height=sum(heights) + 1.9)
    axes = figure.subplots(len(heights), 1, sharex=True, height_ratios=heights)
    for panel in axes:
        panel.set_xlim(0, motion.duration)
    _draw_commands(axes[0], labels)
    tidy_axes(axes[1], y="leg")
    draw_stance(axes[1], motion)
    _draw_gaits(axes[1], recording)
    tidy_axes(axes[2], y="speed\n(mm/s)")
    _draw_speed(axes[2], recording)
    tidy_axes(axes[3], y="yaw rate\n(deg/s)")
    _draw_commanded(axes[3], recording, np.degrees(recording.twist_commanded[:, 2]), np.degrees(recording.twist[:, 2]))
    tidy_axes(axes[4], y="body height\n(mm)")
    _draw_body(axes[4], recording)
    if compliant:
        tidy_axes(axes[5], y="stance feet\n(mm)")
        _draw_feet(axes[5], recording)
    tidy_axes(axes[-1], x="time (s)", y="stability\nmargin (mm)")
    _draw_margin(axes[-1], recording)
    for panel in axes[1:]:
        _shade(panel, recording)
        for event in _of(recording, "command"):
            panel.axvline(event.time, color=PALE, linewidth=0.6, linestyle=":", zorder=0)
    figure.align_ylabels(axes[1:])
    figure.suptitle(_title(recording), x=0.01, ha="left", color=INK)
    return figure


def _title(recording: Recording) -> str:
    name = recording.name
    text = f"{recording.robot.name}: {name}" if name else recording.robot.name
    number = sum(recording.interventions.values())
    guard = f"{number} intervention{'s' * (number != 1)} of the guard" if recording.guard else "no guard"
    return f"{text}. Grey: lying, rising, sitting down; yellow: limited; {guard}"


def _of(recording: Recording, *kinds: str) -> list[Event]:
    return [event for event in recording.events if event.kind in kinds]


def _rows(recording: Recording) -> list[tuple[Event, int, str]]:
    """Return an entry for each label: its event, the first row that has space for it, and its text."""
    scale = recording.motion.duration / _WIDTH
    ends: list[float] = []
    labels = []
    for event in _of(recording, "command", "refused", "power"):
        # The first clause says what happened; a list of what falls, which may follow, is longer than the figure.
        text = textwrap.shorten(event.text.partition(";")[0], _MAX_LABEL, placeholder=" ...")
        width = (len(text) + 2) * _CHARACTER_WIDTH * scale
        start = _label_start(event.time, width, recording.motion.duration)
        row = next((row for row, end in enumerate(ends) if end <= start), len(ends))
        ends[row : row + 1] = [start + width]
        labels.append((event, row, text))
    return labels


def _label_start(time: float, width: float, duration: float) -> float:
    """Return the start of a label: at the time of its event, or earlier if it would not fit."""
    return time if time + width <= duration else max(time - width, 0.0)


def _draw_commands(axes: Axes, labels: list[tuple[Event, int, str]]) -> None:
    rows = 1 + max((row for _, row, _ in labels), default=0)
    axes.set_ylim(rows - 0.4, -0.6)
    axes.axis("off")
    scale = float(axes.get_xlim()[1]) / _WIDTH
    for event, row, text in labels:
        colour = WARNING if event.kind == "refused" else INK
        right = (
            _label_start(event.time, (len(text) + 2) * _CHARACTER_WIDTH * scale, float(axes.get_xlim()[1])) < event.time
        )
        axes.plot([event.time] * 2, [row - 0.35, rows - 0.4], color=PALE, linewidth=0.6, linestyle=":")
        axes.plot([event.time] * 2, [row - 0.35, row + 0.35], color=colour, linewidth=1.6)
        axes.annotate(
            text,
            (event.time, row),
            xytext=(-4 if right else 4, 0),
            textcoords="offset points",
            ha="right" if right else "left",
            va="center",
            fontsize=8,
            color=colour,
            annotation_clip=False,
        )


def _draw_gaits(axes: Axes, recording: Recording) -> None:
    """Label each gait above the contacts, at its start."""
    time, gaits = recording.motion.time, np.array(recording.gaits)
    changes = [0, *(1 + np.flatnonzero(gaits[1:] != gaits[:-1]))]
    top = axes.get_ylim()[1]
    for start in changes:
        if start:
            axes.axvline(float(time[start]), color=INK, linewidth=1.2)
        axes.annotate(
            str(gaits[start]),
            (float(time[start]), top),
            xytext=(3, 2),
            textcoords="offset points",
            fontsize=8,
            color=INK,
            annotation_clip=False,
        )


def _draw_speed(axes: Axes, recording: Recording) -> None:
    commanded, actual = (np.hypot(*twist[:, :2].T) * 1000 for twist in (recording.twist_commanded, recording.twist))
    _draw_commanded(axes, recording, commanded, actual)
    for event in _of(recording, "limit"):
        axes.axvspan(event.time, event.until, color=_LIMITED, alpha=0.6, linewidth=0, zorder=0)
    # A command far above the limits would compress the actual speed to a flat line.
    high = max(float(actual.max()) * 1.6, 10.0)
    if commanded.max() > high:
        axes.set_ylim(-0.05 * high, high)
        axes.annotate(
            f"commanded: up to {commanded.max():.0f}",
            (1, 1),
            xycoords="axes fraction",
            xytext=(-4, -4),
            textcoords="offset points",
            ha="right",
            va="top",
            fontsize=8,
            color=PALE,
        )


def _draw_commanded(axes: Axes, recording: Recording, commanded: Any, actual: Any) -> None:
    shown, time = decimation(recording.motion), recording.motion.time
    axes.plot(time[shown], commanded[shown], color=PALE, linewidth=1.3, linestyle=(0, (4, 2)), label="commanded")
    axes.plot(time[shown], actual[shown], color=_ACTUAL, linewidth=1.6, label="actual")
    axes.legend(loc="upper left", fontsize=8, frameon=False, ncols=2, borderaxespad=0.1)
    low, high = axes.get_ylim()
    # Space for the legend.
    axes.set_ylim(low, high + 0.25 * (high - low))


def _draw_body(axes: Axes, recording: Recording) -> None:
    motion, shown = recording.motion, decimation(recording.motion)
    axes.plot(motion.time[shown], motion.body.position[shown, 2] * 1000, color=INK, linewidth=1.5, label="height")
    tilt_axes = axes.twinx()
    tilt_axes.spines["top"].set_visible(False)
    roll, pitch, _ = np.degrees(motion.body.rpy).T
    tilt_axes.plot(motion.time[shown], roll[shown], color=_ACTUAL, linewidth=1.2, label="roll")
    tilt_axes.plot(motion.time[shown], pitch[shown], color=_OTHER, linewidth=1.2, label="pitch")
    limit = max(float(np.abs([roll, pitch]).max()) * 1.4, 2.0)
    tilt_axes.set_ylim(-limit, limit)
    tilt_axes.set_ylabel("tilt (deg)", color=INK)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.35 * (high - low))
    lines = [*axes.get_lines(), *tilt_axes.get_lines()]
    axes.legend(
        lines, ["height", "roll", "pitch"], loc="upper left", fontsize=8, frameon=False, ncols=3, borderaxespad=0.1
    )


def _draw_feet(axes: Axes, recording: Recording) -> None:
    """Draw the height of each stance foot, relative to the ground at the start."""
    motion, shown = recording.motion, decimation(recording.motion)
    in_stance, colours = motion.contacts & recording.upright[:, None], leg_colours(motion.robot)
    height = np.where(in_stance, motion.feet[..., 2] * 1000, np.nan)
    for leg, code in enumerate(motion.robot.leg_codes):
        axes.plot(motion.time[shown], height[shown, leg], color=colours[leg], linewidth=1.3, label=code)
    limit = max(float(np.nanmax(np.abs(height), initial=0.0)) * 1.2, 2.0)
    axes.set_ylim(-limit, 1.4 * limit)
    axes.legend(loc="upper left", fontsize=8, frameon=False, ncols=motion.robot.legs, borderaxespad=0.1)


def _draw_margin(axes: Axes, recording: Recording) -> None:
    motion, shown = recording.motion, decimation(recording.motion)
    usable = np.isfinite(motion.margin) & ~recording.belly
    margin = np.where(usable, motion.margin, np.nan) * 1000
    axes.plot(motion.time[shown], margin[shown], color=INK, linewidth=1.2)
    axes.axhline(0, color=WARNING, linewidth=1.1, linestyle=(0, (6, 3)))
    for event in _of(recording, "guard"):
        axes.axvline(event.time, color=WARNING, linewidth=1.4)
    if usable.any():
        high = max(float(np.nanmax(margin)), 5.0)
        axes.set_ylim(min(-0.1 * high, float(np.nanmin(margin)) * 1.1), 1.1 * high)


def _shade(axes: Axes, recording: Recording) -> None:
    """Shade the times at which the robot does not stand on its feet."""
    lying: np.ndarray = np.concatenate([[False], ~recording.upright, [False]])
    edges = np.flatnonzero(np.diff(lying.astype(int))).reshape(-1, 2)
    time = recording.motion.time
    for start, end in edges:
        axes.axvspan(float(time[start]), float(time[min(end, len(time) - 1)]), color=_SHADE, linewidth=0, zorder=0)
