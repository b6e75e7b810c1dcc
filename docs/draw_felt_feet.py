"""The picture of a foot that feels its way over blocks in physics: blind and felt."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import tarsus
from rough_ground import CLEAR
from tarsus.report.style import INK, PALE, WARNING, leg_colours, new_figure, tidy_axes
from tarsus.simulation import SimulatedPlant, terrain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

DT, DURATION, LEG = 0.01, 9.0, 0
# A foot that touches something and is this high over the ground under it has met an obstacle [m].
RISEN = 0.005
GROUND = terrain.Blocks(rise=0.06, clear=CLEAR, seed=5)


class Walked(NamedTuple):
    """A walk, at each tick: the lowest point of a foot, the body, its tilt, whether the foot should stand, and does."""

    foot: NDArray[np.float64]
    body: NDArray[np.float64]
    tilt: NDArray[np.float64]
    commanded: NDArray[np.bool_]
    felt: NDArray[np.bool_]


def walked(robot: tarsus.Robot, sensors: str) -> Walked:
    """Return a walk at half the top speed."""
    speed = 0.5 * tarsus.WalkController(robot).top_speed((1, 0, 0))
    plant, controller = SimulatedPlant(robot, terrain=GROUND, sensors=sensors), tarsus.RobotController(robot)
    output, rows = controller.output, list[tuple[Any, ...]]()
    plant.start(output)
    for _ in range(round(DURATION / DT)):
        readings, state = plant.step(output, DT), plant.state
        feet = state.body @ tarsus.forward_kinematics(robot, state.joint_angles)[:, -1]
        roll, pitch, _ = np.asarray(state.body.rpy).tolist()
        down = bool(output.contacts[LEG])
        rows.append((feet[LEG], state.body.position, np.hypot(roll, pitch), down, state.foot_forces[LEG, 2] > 0.5))
        output = controller.step((speed, 0.0, 0.0), DT, readings)
    foot, body, tilt, commanded, felt = (np.array(part) for part in zip(*rows, strict=True))
    foot[:, 2] -= robot.foot_radius[LEG]
    return Walked(foot, body, tilt, commanded, felt)


def draw(axes: Axes, robot: tarsus.Robot, sensors: str, how: str) -> None:
    """Draw the foot over the ground that is under it, and the body."""
    seen, name = walked(robot, sensors), robot.leg_names[LEG]
    tidy_axes(axes, y="height (mm)")
    x, y, z = seen.foot.T
    order = np.argsort(x)
    along = np.linspace(x.min() - 0.05, x.max() + 0.05, 1200)
    ground = 1000 * GROUND.height(along, np.interp(along, x[order], y[order]))
    axes.fill_between(along, ground, -10, color="#e4e4e4", linewidth=0)
    searches, stands = seen.commanded & ~seen.felt, seen.commanded & seen.felt
    meets = ~seen.commanded & seen.felt & (z > GROUND.height(x, y) + RISEN)
    axes.plot(x, 1000 * z, color=leg_colours(robot)[LEG], linewidth=1, label=f"{name} foot")
    for which, colour, size, label in (
        (stands, leg_colours(robot)[LEG], 4, "stands"),
        (searches, WARNING, 4, "looks for the ground"),
        (meets, INK, 6, "meets an obstacle"),
    ):
        axes.plot(x[which], 1000 * z[which], ".", color=colour, markersize=size, label=label)
    axes.plot(seen.body[:, 0], 1000 * seen.body[:, 2], color=PALE, linewidth=1.5, label="middle of the body")
    rms = np.degrees(np.sqrt(np.mean(seen.tilt**2)))
    way = seen.body[-1, 0] - seen.body[0, 0]
    axes.set_title(f"{how}: {way:.2f} m, tilt {rms:.1f} deg RMS", loc="left", color=INK, fontsize="medium")


def plot_felt_feet() -> Figure:
    """Return the picture."""
    robot = tarsus.load_robot("strider")
    figure = new_figure(width=9.0, height=5.2)
    upper, lower = figure.subplots(2, 1, sharex=True, sharey=True)
    draw(upper, robot, "blind", "blind")
    draw(lower, robot, "ideal", "felt")
    upper.legend(loc="lower right", frameon=False)
    lower.set_xlabel("forward (m)", color=INK)
    figure.suptitle("strider over blocks of up to 60 mm in physics: a foot and the body", x=0.01, ha="left", color=INK)
    return figure
