"""Write the table of trenches of ground-measured.md: walks to the edge of a trench in physics, and back.

python docs/holes.py --robots strider --print
"""

from __future__ import annotations

import argparse
import itertools
import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

import tarsus
from page_tables import Several, measured, write_tables
from tarsus.simulation import SimulatedPlant, terrain

PAGE = Path(__file__).parent / "ground-measured.md"
ROBOTS = ("strider", "phantomx", "makeyourpet")
# Widths and depth of the trenches, where their first edge is, and what is walked ahead and back [m].
WIDTHS, DEPTH, EDGES, AHEAD, BACK = (0.08, 0.2), 0.15, (0.5, 0.53, 0.56), 0.9, 0.4
SENSORS = {"ideal": "felt", "camera": "seen"}
# Shares of the top speed.
PACES = (0.25, 0.5, 0.9)


class Job(NamedTuple):
    """One walk: robot, its sensors, width of the trench, where it begins [m], share of the top speed."""

    robot: str
    sensors: str
    width: float
    edge: float
    pace: float


def walk(job: Job) -> str:
    """Return what became of a walk: a fall, a crossing, or a stop, after which the robot came back or stayed."""
    robot = tarsus.load_robot(job.robot)
    speed = job.pace * tarsus.WalkController(robot).top_speed((1, 0, 0))
    ground = terrain.Gaps(width=job.width, depth=DEPTH, start=job.edge, count=1)
    plant = SimulatedPlant(robot, terrain=ground, sensors=job.sensors, servos="catalogue")
    controller = tarsus.RobotController(robot)
    output, dt = controller.output, 0.01
    plant.start(output)
    furthest = 0.0
    for twist, way in ((speed, AHEAD), (-speed, BACK)):
        for _ in range(round(way / speed / dt)):
            readings = plant.step(output, dt)
            state = plant.state
            roll, pitch, _ = np.asarray(state.body.rpy).tolist()
            if state.body_touches or math.hypot(roll, pitch) > math.pi / 4:
                return "fell"
            output = controller.step((twist, 0.0, 0.0), dt, readings)
            furthest = max(furthest, float(state.body.position[0]))
    if furthest > job.edge + job.width:
        return "crossed"
    returned = float(plant.state.body.position[0]) < furthest - BACK / 4
    return "stopped, came back" if returned else "stopped, stayed"


def table(outcomes: dict[Job, str]) -> str:
    """Return how often each robot did what."""
    kinds = ("fell", "crossed", "stopped, came back", "stopped, stayed")
    lines = [f"| trench | {' | '.join(kinds)} |", f"|---|{'---|' * len(kinds)}"]
    for robot, sensors, width in dict.fromkeys(job[:3] for job in outcomes):
        found = [outcome for job, outcome in outcomes.items() if job[:3] == (robot, sensors, width)]
        counts = " | ".join(f"{found.count(kind)} of {len(found)}" for kind in kinds)
        lines.append(f"| {robot}, {1e3 * width:.0f} mm, {SENSORS[sensors]} | {counts} |")
    return "\n".join(lines)


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table."""
    jobs = [Job(*job) for job in itertools.product(asked.robots, SENSORS, WIDTHS, EDGES, PACES)]
    return {"trenches": table(dict(zip(jobs, measured(walk, jobs, asked.jobs), strict=True)))}


if __name__ == "__main__":
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), jobs=1)
