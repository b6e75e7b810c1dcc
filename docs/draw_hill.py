"""The picture of a walk over a hill that the robot knows by its feet alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import tarsus
from tarsus.report.style import INK, PALE, leg_colours, new_figure, tidy_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DT = 0.02
TOUCH = 1e-4
# Up, a plateau, and down [m].
CORNERS, HEIGHTS = (0.5, 1.5, 2.1, 3.1), (0.0, 0.12, 0.12, 0.0)


def hill(x: Any) -> Any:
    return np.interp(x, CORNERS, HEIGHTS)


def walked(robot: tarsus.Robot, levelling: Any) -> list[Any]:
    """Return heading, feet, contacts and body at each tick."""
    controller, seen = tarsus.WalkController(robot, tarsus.Gait.named("tripod"), levelling=levelling), []
    while controller.place[0] < CORNERS[-1] + 0.5 and controller.time < 60:
        rotation = controller.body.rotation
        attitude = (float(np.arctan2(rotation[2, 1], rotation[2, 2])), float(np.arcsin(-rotation[2, 0])))
        contacts = tuple((controller.feet[:, 2] <= hill(controller.feet[:, 0]) + TOUCH).tolist())
        controller.step((0.12, 0.0, 0.0), DT, readings=tarsus.SensorReadings(contacts=contacts, attitude=attitude))
        seen.append((controller.feet, controller.contacts, controller.body))
    return seen


def draw(axes: Axes, robot: tarsus.Robot, seen: list[Any], how: str) -> None:
    tidy_axes(axes, y="height (mm)")
    feet, down = np.array([row[0] for row in seen]), np.array([row[1] for row in seen])
    along = np.linspace(-0.3, CORNERS[-1] + 0.9, 800)
    axes.fill_between(along, 1000 * hill(along), -30, color="#e4e4e4", linewidth=0)
    for leg in (0, 4):
        x, z = feet[:, leg, 0], 1000 * feet[:, leg, 2]
        axes.plot(x, z, color=leg_colours(robot)[leg], linewidth=1, label=f"{robot.leg_names[leg]} foot")
        landed = down[:, leg] & ~np.roll(down[:, leg], 1)
        axes.plot(x[landed], z[landed], ".", color=leg_colours(robot)[leg])
    body = np.array([row[2].position for row in seen])
    axes.plot(body[:, 0], 1000 * body[:, 2], color=INK, linewidth=1.5, label="body")
    for _, _, pose in seen[:: max(1, len(seen) // 14)]:
        ends = pose @ np.array([[-0.12, 0.0, 0.0], [0.12, 0.0, 0.0]])
        axes.plot(ends[:, 0], 1000 * ends[:, 2], color=PALE, linewidth=3, solid_capstyle="round")
    axes.set_xlim(-0.3, CORNERS[-1] + 0.9)
    axes.set_title(how, loc="left", color=INK, fontsize="medium")


def plot_hill() -> Figure:
    robot = tarsus.load_robot("strider")
    figure = new_figure(width=9.0, height=5.2)
    upper, lower = figure.subplots(2, 1, sharex=True, sharey=True)
    draw(upper, robot, walked(robot, "level"), "levelling = level")
    draw(lower, robot, walked(robot, "follow"), "levelling = follow")
    upper.legend(loc="upper right", frameon=False)
    lower.set_xlabel("forward (m)", color=INK)
    figure.suptitle("strider over a hill that its feet feel: dots where they come down", x=0.01, ha="left", color=INK)
    return figure
