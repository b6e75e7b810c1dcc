"""The picture of the terrains, with a simulated robot at their start."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.patches import Polygon

import tarsus
from tarsus.report.drawing import RobotDrawing
from tarsus.report.relief import relief_of
from tarsus.report.sample import sample_of
from tarsus.report.style import INK, new_figure
from tarsus.report.view import View
from tarsus.simulation import SimulatedPlant
from tarsus.simulation.terrain import Blocks, Box, Flat, Gaps, HeightField, Ramp, Smooth, Stairs, Step, Terrain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# From behind on the right, where steps that rise are seen.
_VIEW = View(azimuth=-122.0, elevation=30.0)
# The piece of ground in a panel: x and y, least and greatest, its underside and its cells [m].
_X, _Y, _BOTTOM, _CELL = (-0.4, 1.7), (-0.45, 0.45), -0.14, 0.025
_GROUND, _CUT = np.array([0.93, 0.94, 0.92]), "#b9b4a8"
_CRATER = np.hypot(*np.meshgrid(*[np.linspace(-1, 1, 81)] * 2))
_TERRAINS: dict[str, Terrain] = {
    "Flat()": Flat(),
    "Ramp(slope=radians(10))": Ramp(slope=np.radians(10)),
    "Step(rise=0.04)": Step(rise=0.04),
    "Stairs(rise=0.04)": Stairs(rise=0.04),
    "Blocks(rise=0.04, seed=1)": Blocks(seed=1),
    "Smooth(amplitude=0.05, clear=0.3)": Smooth(amplitude=0.05, clear=0.3),
    "Gaps(depth=0.1)": Gaps(depth=0.1),
    "Box(width=0.3, length=0.2, aside=0.1)": Box(width=0.3, length=0.2, aside=0.1),
    "HeightField(heights, size=(4, 4))": HeightField(
        heights=0.15 * np.exp(-(((_CRATER - 0.55) / 0.12) ** 2)), size=(4.0, 4.0)
    ),
}


def plot_terrains() -> Figure:
    figure = new_figure(width=10.0, height=12.0, manual_layout=True)
    rows = (len(_TERRAINS) + 1) // 2
    for number, (name, terrain) in enumerate(_TERRAINS.items()):
        left, row = 0.5 * (number % 2), rows - 1 - number // 2
        axes = figure.add_axes((left + 0.005, row / rows + 0.005, 0.49, 1 / rows - 0.035))
        draw(axes, terrain)
        axes.set_title(name, loc="left", color=INK, fontsize=10, pad=4)
    return figure


def draw(axes: Axes, terrain: Terrain) -> None:
    axes.set_axis_off()
    axes.set_aspect("equal", adjustable="box")
    corners = np.array([(x, y, z) for x in _X for y in _Y for z in (_BOTTOM, 0.22)]) * 1000
    low, high = _VIEW.project(corners).min(axis=0), _VIEW.project(corners).max(axis=0)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    draw_ground(axes, terrain)
    robot = tarsus.load_robot("strider")
    plant = SimulatedPlant(robot, terrain=terrain, sensors="blind")
    plant.start(tarsus.RobotController(robot).output)
    state = plant.state
    sample = sample_of(robot, state.joint_angles, body=state.body, contacts=state.foot_forces[:, 2] > 0)
    RobotDrawing(axes, robot, view=_VIEW, shadows=False).update(sample)


def draw_ground(axes: Axes, terrain: Terrain) -> None:
    """Draw a piece of ground, with its section on the near sides."""
    low, high = np.array([_X[0], _Y[0]]), np.array([_X[1], _Y[1]])
    relief = relief_of(terrain.height, low, high, step=_CELL, view=_VIEW)
    colours = relief.brightness[:, None] * _GROUND
    faces = list(_VIEW.project(relief.corners * 1000))
    axes.add_collection(PolyCollection(faces, facecolors=colours, edgecolors=colours, linewidths=0.4), autolim=False)
    for axis, at in ((0, _Y[0]), (1, _X[0])):
        along = np.linspace(low[axis], high[axis], 1500)
        points = np.full((len(along), 3), at)
        points[:, axis] = along
        points[:, 2] = terrain.height(points[:, 0] + 1e-6, points[:, 1] + 1e-6)
        ends = points[[-1, 0]] * [1.0, 1.0, 0.0] + [0.0, 0.0, _BOTTOM]
        outline = _VIEW.project(np.concatenate([points, ends]) * 1000)
        axes.add_patch(Polygon(outline, closed=True, facecolor=_CUT, edgecolor=INK, linewidth=0.6))
