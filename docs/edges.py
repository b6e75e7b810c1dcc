"""Write the tables of edges of ground-measured.md: walks in physics to steps down, trenches and the end of blocks.

python docs/edges.py --jobs 2
python docs/edges.py --robots strider --sensors switches camera --print
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import mujoco
import numpy as np

import tarsus
from estimated_contacts import JOINTS
from page_tables import Several, measured, write_tables
from rough_ground import PAGE, ROBOTS, Watch, blocks, switches
from tarsus.simulation import Sensor, SimulatedPlant, terrain
from tarsus.simulation.terrain.surface import surface

# Depth of steps down and of trenches, widths of trenches, where their first edge is, what is walked ahead and back [m].
DOWN, DEPTH, WIDTHS, EDGES, AHEAD, BACK = 0.3, 0.15, (0.08, 0.2), (0.5, 0.53, 0.56), 0.9, 0.4
# Shares of the top speed.
PACES = (0.25, 0.5, 0.9)
SENSORS: dict[str, Any] = {
    "joint angles": JOINTS,
    "switches": switches(),
    "switches, joint angles": dataclasses.replace(switches(), angular_rates=Sensor(), joint_angles=Sensor()),
    "hobby": "hobby",
    "all but camera": "ideal",
    "camera": "camera",
    "20 ms ticks": "ideal",
}
# Length of a tick, and where it is another one [s].
TICK, TICKS = 0.01, {"20 ms ticks": 0.02}
# Walks that turn at an edge: shares of the twist's parts, and how long [s]; half of the top speed, edges there [m].
TURNS: dict[str, tuple[tuple[tuple[float, float, float], float], ...]] = {
    "stop, turn left, ahead": (((1, 0, 0), 6), ((0, 0, 0), 1), ((0, 0, 1), 10), ((1, 0, 0), 3)),
    "turn right, ahead": (((1, 0, 0), 6), ((0, 0, -1), 10), ((1, 0, 0), 3)),
    "turn left before it, back": (((1, 0, 0), 3.4), ((0, 0, 1), 10), ((-1, 0, 0), 5)),
    "turn left a little, back": (((1, 0, 0), 6), ((0, 0, 1), 4), ((-1, 0, 0), 6)),
    "aside, turn left, ahead": (((1, 0, 0), 6), ((0, 1, 0), 4), ((0, 0, 1), 6), ((1, 0, 0), 4)),
    "arcs left and right, back": (((1, 0, 0.3), 8), ((1, 0, -0.3), 6), ((-1, 0, 0), 4)),
}
TURNS_PACE, TURNS_EDGES = 0.5, (0.49, 0.52)
# Heights of blocks that end at a step down [mm], where [m], how many fields of each, and the share of the top speed.
BLOCKS, ENDS, FIELDS, ENDS_PACE = (60, 100), (0.62, 0.66, 0.7), 4, 0.5


class Job(NamedTuple):
    """One walk: robot, width of the trench, 0 for a step down, sensors, where the edge is [m], share of top speed."""

    robot: str
    width: float
    sensors: str
    edge: float
    pace: float


class Turn(NamedTuple):
    """One walk that turns at a step down: robot, the name of its commands, where the edge is [m]."""

    robot: str
    commands: str
    edge: float


class End(NamedTuple):
    """One walk over blocks that end at a step down: robot, their height [mm], seed, where the edge is [m]."""

    robot: str
    height: int
    seed: int
    edge: float


class Outcome(NamedTuple):
    """What a robot did, how long its body touched the ground [s], its greatest tilt and how far it turned [deg]."""

    kind: str
    touched: float
    tilt: float
    turned: float = 0.0


class BlocksToEdge:
    """Blocks that end at a step down."""

    def __init__(self, field: terrain.Blocks, edge: float) -> None:
        self.field, self.step = field, terrain.Step(rise=-DOWN, start=edge)
        self.friction = field.friction

    def height(self, x: Any, y: Any) -> np.ndarray:
        """Return the height of the ground [m]."""
        return np.where(np.asarray(x) < self.step.start, self.field.height(x, y), self.step.height(x, y))

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model."""
        self.step.add_to(spec)
        box = mujoco.mjtGeom.mjGEOM_BOX
        for (column, row), height in np.ndenumerate(self.field.heights):
            x, y = ((np.array([column, row]) - self.field.side / 2) * self.field.size).tolist()
            end = min(x + self.field.size, self.step.start)
            if height > 0 and end > x:
                size, pos = ((end - x) / 2, self.field.size / 2, height / 2), ((x + end) / 2, y + self.field.size / 2)
                spec.worldbody.add_geom(type=box, size=size, pos=(*pos, height / 2), **surface(self.friction))


def drive(
    robot: tarsus.Robot,
    ground: Any,
    sensors: Any,
    commands: Iterable[tuple[tuple[float, float, float], float]],
    dt: float = TICK,
) -> tuple[Outcome, list[float]]:
    """Drive a robot by twists for some time each; return the outcome, a fall or none, and where it was along x [m]."""
    plant, controller = SimulatedPlant(robot, terrain=ground, sensors=sensors), tarsus.RobotController(robot)
    plant.start(controller.output)
    watch, way = Watch(plant), [0.0]
    for twist, time in commands:
        for _ in range(round(time / dt)):
            readings = plant.step(controller.output, dt)
            watch.look(dt)
            way.append(float(plant.state.body.position[0]))
            if watch.fell:
                return Outcome("fell", watch.touched, math.degrees(max(watch.tilts))), way
            controller.step(twist, dt, readings)
    return Outcome("", watch.touched, math.degrees(max(watch.tilts)), math.degrees(abs(watch.turned))), way


def walk(job: Job) -> Outcome:
    """Return what became of a walk: a fall, a crossing, or a stop, after which the robot came back or stayed."""
    robot = tarsus.load_robot(job.robot)
    speed = job.pace * tarsus.WalkController(robot).top_speed((1, 0, 0))
    ground: Any = terrain.Step(rise=-DOWN, start=job.edge)
    if job.width:
        ground = terrain.Gaps(width=job.width, depth=DEPTH, start=job.edge, count=1)
    return ahead_and_back(robot, ground, job.sensors, speed, job.edge + job.width)


def ahead_and_back(robot: tarsus.Robot, ground: Any, sensors: str, speed: float, far: float) -> Outcome:
    """Return what became of a walk ahead, where beyond so far it has crossed an edge [m], and back."""
    commands = (((speed, 0.0, 0.0), AHEAD / speed), ((-speed, 0.0, 0.0), BACK / speed))
    found, way = drive(robot, ground, SENSORS[sensors], commands, TICKS.get(sensors, TICK))
    if found.kind:
        return found
    if max(way) > far:
        return found._replace(kind="crossed")
    return found._replace(kind="back" if way[-1] < max(way) - BACK / 4 else "stayed")


def turn(job: Turn) -> Outcome:
    """Return what became of a walk that turns at an edge."""
    robot = tarsus.load_robot(job.robot)
    walker = tarsus.WalkController(robot)
    speed, rate = (TURNS_PACE * walker.top_speed(twist) for twist in ((1, 0, 0), (0, 0, 1)))
    commands = [((x * speed, y * speed, z * rate), time) for (x, y, z), time in TURNS[job.commands]]
    return drive(robot, terrain.Step(rise=-DOWN, start=job.edge), "ideal", commands)[0]


def end(job: End) -> Outcome:
    """Return what became of a walk over blocks to where they end."""
    robot = tarsus.load_robot(job.robot)
    speed = ENDS_PACE * tarsus.WalkController(robot).top_speed((1, 0, 0))
    ground = BlocksToEdge(blocks(job.seed, job.height), job.edge)
    return ahead_and_back(robot, ground, "all but camera", speed, job.edge)


def edges_table(outcomes: dict[Job, Outcome], sensors: list[str]) -> str:
    """Return what each robot did how often; in the last lines, how bodies touched the ground and tilted in all."""
    lines = [f"| walk | {' | '.join(sensors)} |", f"|---|{'---|' * len(sensors)}"]
    for robot, width in dict.fromkeys(job[:2] for job in outcomes):
        cells = []
        for key in sensors:
            found = [outcome for job, outcome in outcomes.items() if job[:3] == (robot, width, key)]
            cells.append(ended(found))
        lines.append(f"| {robot}, {f'trench {1e3 * width:.0f}' if width else 'step down'} | {' | '.join(cells)} |")
    every = [[outcome for job, outcome in outcomes.items() if job.sensors == key] for key in sensors]
    touches = [[each.touched for each in found] for found in every]
    tilts = [[each.tilt for each in found] for found in every]
    rows = {
        "all: touched": [f"{np.count_nonzero(each)} of {len(each)}" for each in touches],
        "all: touched, longest in one walk": [f"{max(each):.2f} s" for each in touches],
        "all: tilt, median and greatest": [f"{np.median(each):.0f}, {max(each):.0f} deg" for each in tilts],
    }
    return "\n".join((*lines, *(f"| {name} | {' | '.join(cells)} |" for name, cells in rows.items())))


def turns_table(outcomes: dict[Turn, Outcome], robots: list[str]) -> str:
    """Return the greatest tilt, and how far robots turned, least and most."""
    lines = [f"| at a step down | {' | '.join(robots)} |", f"|---|{'---|' * len(robots)}"]
    for name in TURNS:
        cells = []
        for robot in robots:
            found = [outcome for job, outcome in outcomes.items() if job[:2] == (robot, name)]
            turns = sorted(each.turned for each in found)
            fell = "".join(f", {each.kind}" for each in found if each.kind)
            tilt = max(each.tilt for each in found)
            cells.append(f"{tilt:.0f}, {turns[0]:.0f} to {turns[-1]:.0f}{fell}{touching(found)}")
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(lines)


def ends_table(outcomes: dict[End, Outcome], robots: list[str]) -> str:
    """Return what each robot did how often over blocks of each height, and its greatest tilts."""
    lines = [f"| blocks that end | {' | '.join(robots)} |", f"|---|{'---|' * len(robots)}"]
    for height in BLOCKS:
        cells = []
        for robot in robots:
            found = [outcome for job, outcome in outcomes.items() if job[:2] == (robot, height)]
            tilts = [each.tilt for each in found]
            cells.append(f"{ended(found)}, {np.median(tilts):.0f} and {max(tilts):.0f} deg")
        lines.append(f"| {height} mm high | {' | '.join(cells)} |")
    return "\n".join(lines)


def ended(found: list[Outcome]) -> str:
    """Return how many walks ended in which way, and how many bodies touched the ground."""
    kinds = [each.kind for each in found]
    return ", ".join(f"{kinds.count(kind)} {kind}" for kind in sorted(set(kinds))) + touching(found)


def touching(found: list[Outcome]) -> str:
    """Return how many bodies touched the ground, if any."""
    count = sum(each.touched > 0 for each in found)
    return f" ({count} touched)" if count else ""


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the tables."""
    jobs = [Job(*job) for job in itertools.product(asked.robots, (0.0, *WIDTHS), asked.sensors, EDGES, PACES)]
    turns = [Turn(*job) for job in itertools.product(asked.robots, TURNS, TURNS_EDGES)]
    ends = [End(*job) for job in itertools.product(asked.robots, BLOCKS, range(FIELDS), ENDS)]
    edges = dict(zip(jobs, measured(walk, jobs, asked.jobs), strict=True))
    turned = dict(zip(turns, measured(turn, turns, asked.jobs), strict=True))
    ended_there = dict(zip(ends, measured(end, ends, asked.jobs), strict=True))
    return {
        "edges": edges_table(edges, asked.sensors),
        "turns at edges": turns_table(turned, asked.robots),
        "blocks that end": ends_table(ended_there, asked.robots),
    }


if __name__ == "__main__":
    sensors = Several(tuple(SENSORS), choices=SENSORS)
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), sensors=sensors, jobs=1)
