"""Write the table of ground-measured.md of robots with random proportions that feel the ground, in physics.

python docs/random_robots.py --jobs 2
python docs/random_robots.py --robots 4 --print
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from typing import Any

import numpy as np

import tarsus
from page_tables import measured, write_tables
from rough_ground import PAGE, Outcome, mishaps, walked_on
from tarsus.simulation import SimulatedPlant, terrain

# Way that is commanded and where ground begins, in lengths of femur and tibia; share of the top speed.
WAY, START, PACE = 6.0, 2.0, 0.5
LIMITS = {"coxa": [-50, 50], "femur": [-80, 85], "tibia": [-145, -5]}

# By length of femur and tibia, body height [m], and seed.
GROUNDS: dict[str, Callable[[float, float, int], Any]] = {
    "flat": lambda *_: terrain.Flat(),
    "smooth": lambda leg, height, seed: terrain.Smooth(
        amplitude=height / 2, wavelength=2 * leg, clear=1.7 * leg, seed=seed
    ),
    "blocks": lambda leg, height, seed: terrain.Blocks(rise=height / 2, size=0.7 * leg, clear=1.7 * leg, seed=seed),
    "step up": lambda leg, height, seed: terrain.Step(rise=0.35 * height, start=START * leg + 0.004 * seed),
    "ramp": lambda leg, *_: terrain.Ramp(slope=math.radians(10), start=START * leg),
    "drop": lambda leg, height, seed: terrain.Step(rise=-3 * height, start=START * leg + 0.01 * seed),
}


def random_robot(seed: int) -> tarsus.Robot:
    """Return a robot whose legs, body and masses are drawn, without servos, in its default stance."""
    random = np.random.default_rng(seed)
    leg, ratio, share = random.uniform(0.12, 0.3), random.uniform(0.55, 1.0), random.uniform(0.1, 0.3)
    femur, ahead, aside = leg * ratio / (1 + ratio), leg * random.uniform(0.35, 0.7), leg * random.uniform(0.2, 0.45)
    middle, corner, mass = aside * random.uniform(1.0, 1.4), random.uniform(30, 60), leg**2 * random.uniform(25, 90)
    yaws = {"LF": 90 - corner, "LM": 90, "LR": 90 + corner, "RR": -90 - corner, "RM": -90, "RF": corner - 90}
    places = {"LF": (ahead, aside), "LM": (0.0, middle), "LR": (-ahead, aside)}
    places |= {"RR": (-ahead, -aside), "RM": (0.0, -middle), "RF": (ahead, -aside)}
    lengths = {"coxa_mm": 1e3 * share * leg, "femur_mm": 1e3 * femur, "tibia_mm": 1e3 * (leg - femur)}
    legs = [
        {"name": name, "position_mm": [1e3 * x, 1e3 * y, 0.0], "yaw_deg": yaws[name]} for name, (x, y) in places.items()
    ]
    robot = tarsus.robot_from_dict({"name": f"random {seed}", "leg": {**lengths, "limits_deg": LIMITS}, "legs": legs})
    return robot.replace(
        body_mass=0.6 * mass,
        body_size=np.array([2 * ahead, 2 * aside, 0.25 * leg]),
        link_mass=np.tile(np.array([0.48, 0.4, 0.32]) * mass / 18, (6, 1)),
        foot_radius=np.full(6, 0.03 * leg),
    )


def walk(job: tuple[int, str]) -> Outcome:
    """Return the outcome of one walk."""
    seed, ground = job
    robot = random_robot(seed)
    leg, height = float((robot.femur + robot.tibia)[0]), float(tarsus.default_body_height(robot))
    speed = PACE * tarsus.WalkController(robot).top_speed((1.0, 0.0, 0.0))
    plant = SimulatedPlant(robot, terrain=GROUNDS[ground](leg, height, seed % 10), servos="ideal", seed=seed)
    controller = tarsus.RobotController(robot)
    plant.start(controller.output)
    return walked_on(plant, controller, np.array([speed, 0.0, 0.0]), WAY * leg / speed)


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table: a row for each ground."""
    jobs = [(seed, ground) for ground in GROUNDS for seed in range(asked.robots)]
    found = dict(zip(jobs, measured(walk, jobs, asked.jobs), strict=True))
    lines = [
        "| ground | way: median, least | slip: median, greatest | tilt: median, greatest | |",
        "|---|---|---|---|---|",
    ]
    for ground in GROUNDS:
        outcomes = [found[seed, ground] for seed in range(asked.robots)]
        ways, slips, tilts = zip(*((each.way, 1e3 * each.slip, each.steepest) for each in outcomes), strict=True)
        cells = f"{np.median(ways):.2f}, {min(ways):.2f} | {np.median(slips):.0f}, {max(slips):.0f}"
        lines.append(f"| {ground} | {cells} | {np.median(tilts):.1f}, {max(tilts):.1f} |{mishaps(outcomes)} |")
    return {"random robots": "\n".join(lines)}


if __name__ == "__main__":
    write_tables(__doc__, PAGE, tables, robots=30, jobs=1)
