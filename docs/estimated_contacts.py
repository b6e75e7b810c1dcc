"""Write the table of ground-measured.md of walks whose contacts are estimated by joint angles.

python docs/estimated_contacts.py --seeds 5
python docs/estimated_contacts.py --robots strider --print
"""

from __future__ import annotations

import argparse
import dataclasses
from typing import Any

import numpy as np

import tarsus
from page_tables import Several, write_tables
from rough_ground import GROUNDS, PAGE, RANDOM, ROBOTS, WAY
from tarsus.simulation import SensorSuite, SimulatedPlant

GROUND, DT, TOUCHES = ("flat", "smooth60", "blocks40", "step+25", "ramp+10", "ramp-10"), 0.01, 0.5
JOINTS = dataclasses.replace(SensorSuite.named("smart"), attitude=SensorSuite.named("hobby").attitude)


def walk(name: str, ground: str, sensors: Any, seed: int) -> tuple[float, float, list[int], bool]:
    """Return way over the commanded one, share of contacts that are right, ticks until each is noticed, and falls."""
    robot = tarsus.load_robot(name)
    speed = 0.5 * tarsus.WalkController(robot).top_speed((1, 0, 0))
    plant = SimulatedPlant(robot, terrain=GROUNDS[ground](seed), sensors=sensors, seed=seed)
    controller = tarsus.RobotController(robot)
    plant.start(controller.output)
    start, ticks, touched = plant.state.body.position[0], round(WAY / speed / DT), False
    right, late, delays = [], np.zeros(robot.legs, dtype=int), list[int]()
    for _ in range(ticks):
        readings = plant.step(controller.output, DT)
        state = plant.state
        touched = touched or state.body_touches
        controller.step((speed, 0.0, 0.0), DT, readings)
        walk = getattr(controller._activity, "controller", None)
        if walk is None or not any(walk._walk.ground.contacts.estimator.known):
            continue
        felt = np.array(walk._walk.ground.contacts.estimator.touching)
        touches = state.foot_forces[:, 2] > TOUCHES
        right.append((felt == touches).mean())
        delays += late[felt & touches & (late > 0)].tolist()
        late = np.where(touches & ~felt, late + 1, 0)
    way = float(plant.state.body.position[0] - start) / (speed * DT * ticks)
    return way, float(np.mean(right)), delays, touched


def row(name: str, ground: str, seeds: int) -> str:
    """Return a line of the table: medians over seeds."""
    draws = range(seeds if ground.startswith(RANDOM) else 1)
    switched = [walk(name, ground, "ideal", seed) for seed in draws]
    found = [walk(name, ground, JOINTS, seed) for seed in draws]
    ways = [float(np.median([each[0] for each in walks])) for walks in (switched, found)]
    right, touches = np.median([each[1] for each in found]), sum(each[3] for each in found)
    half, most = np.percentile([ticks for each in found for ticks in each[2]], [50, 90]) * DT * 1e3
    without = f"{ways[1]:.2f}" + (f" ({touches} of {len(found)} touched)" if touches else "")
    return f"| {name}, {ground} | {ways[0]:.2f} | {without} | {100 * right:.0f} % | {half:.0f}, {most:.0f} ms |"


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table."""
    lines = [
        "| walk | way with switches | way without | contacts right | noticed after: median, 90 % |",
        "|---|---|---|---|---|",
        *(row(name, ground, asked.seeds) for name in asked.robots for ground in asked.grounds),
    ]
    return {"estimated contacts": "\n".join(lines)}


if __name__ == "__main__":
    grounds = Several(GROUND, choices=GROUNDS)
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), grounds=grounds, seeds=5)
