"""The picture of the robot's states, drawn from the table of transitions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus import RobotState
from tarsus.control.robot_state import CHANGES, REQUESTABLE
from tarsus.report.style import INK, PALE, WARNING, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import FancyBboxPatch

# Centre of each state's box, in boxes.
PLACES = {
    RobotState.FOLDED: (0.0, 0.0),
    RobotState.FOLDING: (1.2, 0.0),
    RobotState.LYING: (2.4, 0.0),
    RobotState.RISING: (3.6, 0.75),
    RobotState.SITTING: (3.6, -0.55),
    RobotState.STANDING: (4.8, 0.0),
    RobotState.WALKING: (6.0, 0.0),
    RobotState.FAULT: (6.0, -0.9),
}
# Bend of the arrows that would run across a box otherwise.
BENDS = {(RobotState.FOLDED, RobotState.RISING): -0.28, (RobotState.RISING, RobotState.FOLDED): 0.38}
WIDTH, HEIGHT = 0.72, 0.34


def _transitions() -> dict[RobotState, set[RobotState]]:
    following = {state: {RobotState.FAULT} for state in RobotState}
    for (state, _), change in CHANGES.items():
        following[state].add(change)
        # A change may also return to where the robot was.
        following[change] |= {state, change.end}
    following[RobotState.STANDING].add(RobotState.WALKING)
    following[RobotState.WALKING].add(RobotState.STANDING)
    # A robot that the guard releases continues what it did.
    following[RobotState.FAULT] = set(RobotState) - {RobotState.FAULT}
    return following


# The states that may follow each state.
TRANSITIONS = _transitions()


def _box(axes: Axes, state: RobotState) -> FancyBboxPatch:
    from matplotlib.patches import FancyBboxPatch

    x, y = PLACES[state]
    asked, fault = state in REQUESTABLE, state is RobotState.FAULT
    box = FancyBboxPatch(
        (x - WIDTH / 2, y - HEIGHT / 2),
        WIDTH,
        HEIGHT,
        boxstyle="round,pad=0.02,rounding_size=0.08",
        facecolor="#dcebf7" if asked else "white",
        edgecolor=WARNING if fault else INK,
        linewidth=1.6 if asked else 1.0,
        zorder=3,
    )
    axes.add_patch(box)
    axes.text(x, y, str(state), ha="center", va="center", color=WARNING if fault else INK, zorder=4)
    return box


def _arrow(axes: Axes, boxes: dict[RobotState, FancyBboxPatch], start: RobotState, end: RobotState) -> None:
    from matplotlib.patches import FancyArrowPatch

    bend = BENDS.get((start, end), 0.16 if start in TRANSITIONS[end] else 0.0)
    axes.add_patch(
        FancyArrowPatch(
            PLACES[start],
            PLACES[end],
            arrowstyle="-|>",
            mutation_scale=11,
            patchA=boxes[start],
            patchB=boxes[end],
            shrinkA=3,
            shrinkB=3,
            connectionstyle=f"arc3,rad={bend}",
            color=PALE,
            linewidth=1.2,
            zorder=5,
        )
    )


def plot_states() -> Figure:
    figure = new_figure(width=8.8, height=3.6)
    axes = figure.subplots()
    axes.axis("off")
    corners = np.array(list(PLACES.values()))
    axes.set_xlim(corners[:, 0].min() - 0.5, corners[:, 0].max() + 0.5)
    axes.set_ylim(-1.3, 1.3)
    boxes = {state: _box(axes, state) for state in RobotState}
    for state in RobotState:
        if state is not RobotState.FAULT:
            for end in TRANSITIONS[state] - {RobotState.FAULT}:
                _arrow(axes, boxes, state, end)
    note = (
        "Blue: states that a command may ask for. From every state to fault while the guard holds the robot, and back."
    )
    axes.text(0.0, 0.02, note, transform=axes.transAxes, fontsize=8, color=PALE)
    figure.suptitle("States of the robot", x=0.01, ha="left", color=INK)
    return figure
