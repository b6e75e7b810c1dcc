"""The picture of walks over a hill in physics, level and along the slope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

import tarsus
from tarsus.report.style import INK, PALE, leg_colours, new_figure, tidy_axes
from tarsus.simulation import SimulatedPlant, terrain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from tarsus.simulation.plant_state import PlantState

DT, SPEED = 0.01, 0.12
# Up, a plateau, and down [m].
CORNERS, HEIGHTS = (0.4, 1.0, 1.5, 2.1), (0.0, 0.13, 0.13, 0.0)
LENGTH, POINTS = 8.0, 401
# Load of a foot that stands [N].
TOUCH = 0.5


def hill(x: Any) -> Any:
    """Return the height of the ground [m]."""
    return np.interp(x, CORNERS, HEIGHTS)


def walked(robot: tarsus.Robot, levelling: Any) -> list[PlantState]:
    """Return the state of the robot in physics at each tick."""
    heights = np.tile(hill(np.linspace(-LENGTH / 2, LENGTH / 2, POINTS)), (2, 1))
    plant = SimulatedPlant(robot, terrain=terrain.HeightField(heights=heights, size=(LENGTH, 2.0)), sensors="ideal")
    controller, seen = tarsus.RobotController(robot, levelling=levelling), []
    output = controller.output
    plant.start(output)
    for _ in range(round((CORNERS[-1] + 0.6) / SPEED / DT)):
        readings = plant.step(output, DT)
        seen.append(plant.state)
        output = controller.step((SPEED, 0.0, 0.0), DT, readings)
    return seen


def draw(axes: Axes, robot: tarsus.Robot, seen: list[PlantState], how: str) -> None:
    """Draw body, feet and ground of a walk."""
    tidy_axes(axes, y="height (mm)")
    along = np.linspace(-0.3, CORNERS[-1] + 0.9, 800)
    axes.fill_between(along, 1000 * hill(along), -30, color="#e4e4e4", linewidth=0)
    angles = np.array([state.joint_angles for state in seen])
    points = tarsus.forward_kinematics(robot, angles)
    feet = np.array([state.body @ feet for state, feet in zip(seen, points[:, :, -1], strict=True)])
    feet[..., 2] -= robot.foot_radius
    down = np.array([state.foot_forces[:, 2] > TOUCH for state in seen])
    for leg in (0, 4):
        x, z = feet[:, leg, 0], 1000 * feet[:, leg, 2]
        axes.plot(x, z, color=leg_colours(robot)[leg], linewidth=1, label=f"{robot.leg_names[leg]} foot")
        axes.plot(x[down[:, leg]], z[down[:, leg]], ".", color=leg_colours(robot)[leg], markersize=3)
    body = np.array([state.body.position for state in seen])
    axes.plot(body[:, 0], 1000 * body[:, 2], color=INK, linewidth=1.5, label="body")
    for state in seen[:: max(1, len(seen) // 14)]:
        ends = state.body @ np.array([[-0.12, 0.0, 0.0], [0.12, 0.0, 0.0]])
        axes.plot(ends[:, 0], 1000 * ends[:, 2], color=PALE, linewidth=3, solid_capstyle="round")
    axes.set_xlim(-0.3, CORNERS[-1] + 0.9)
    axes.set_title(how, loc="left", color=INK, fontsize="medium")


def plot_hill() -> Figure:
    """Return the picture."""
    robot = tarsus.load_robot("strider")
    figure = new_figure(width=9.0, height=5.2)
    upper, lower = figure.subplots(2, 1, sharex=True, sharey=True)
    draw(upper, robot, walked(robot, "level"), "levelling = level")
    draw(lower, robot, walked(robot, "follow"), "levelling = follow")
    upper.legend(loc="upper right", frameon=False)
    lower.set_xlabel("forward (m)", color=INK)
    figure.suptitle("strider over a hill in physics, felt by its feet", x=0.01, ha="left", color=INK)
    return figure
