"""Write the table of long walks of ground-measured.md: minutes in a circle over rough ground in physics.

python docs/long_walks.py --jobs 2
python docs/long_walks.py --robots strider --grounds blocks100 --seeds 1 --print
"""

from __future__ import annotations

import argparse
import itertools
import math
from statistics import mean
from typing import NamedTuple

import tarsus
from page_tables import Several, measured, write_tables
from rough_ground import GROUNDS, PAGE, ROBOTS, TICK, Watch
from tarsus.simulation import SimulatedPlant

SHOWN = ("smooth60", "blocks60", "smooth100", "blocks100")
# How long robots walk [s], the radius of the circle [m], and the share of the top speed.
TIME, RADIUS, PACE = 180.0, 0.7, 0.5
# A robot has stopped that turns by less than this share of what is commanded in so many seconds.
STOPPED, WITHIN = 0.05, 24.0
# What may befall a robot, and how the table says that.
MISHAPS = {"touched": "touched", "fell": "fell", "failed": "with a servo called failed"}


class Job(NamedTuple):
    """One walk."""

    robot: str
    ground: str
    seed: int


class Outcome(NamedTuple):
    """Share of the commanded way; after what time the robot stopped for good and why, if it did [s]; what befell it."""

    way: float
    stopped: float
    cause: str
    touched: bool
    fell: bool
    failed: bool


def walk(job: Job) -> Outcome:
    """Return what became of a walk."""
    robot = tarsus.load_robot(job.robot)
    plant = SimulatedPlant(robot, terrain=GROUNDS[job.ground](job.seed), sensors="ideal", seed=job.seed)
    controller = tarsus.RobotController(robot)
    speed = PACE * tarsus.WalkController(robot).top_speed((1, 0, 0))
    rate, ticks = speed / RADIUS, round(WITHIN / TICK)
    plant.start(controller.output)
    watch, turned = Watch(plant), [0.0]
    for tick in range(round(TIME / TICK)):
        readings = plant.step(controller.output, TICK)
        watch.look(TICK)
        turned.append(watch.turned)
        controller.step((speed, 0.0, rate), TICK, readings)
        if tick > ticks and turned[-1] - turned[-ticks] < STOPPED * rate * WITHIN:
            break
    time = TICK * (len(turned) - 1)
    # What names a leg says more than what holds for the robot as a whole.
    last = sorted((each for each in controller.output.limitations if each.cause), key=lambda each: bool(each.leg))
    stopped = time < TIME - TICK / 2
    cause = str(last[-1].cause) if stopped and last else ""
    failed = bool(controller.leg_failures.failed)
    return Outcome(
        turned[-1] / (rate * time), time if stopped else math.inf, cause, watch.touched > 0.0, watch.fell, failed
    )


def table(found: dict[Job, Outcome], robots: list[str], grounds: list[str]) -> str:
    """Return the mean way, and how many robots stopped, touched the ground, fell or lost a leg."""
    lines = [f"| {TIME / 60:.0f} minutes | {' | '.join(robots)} |", f"|---|{'---|' * len(robots)}"]
    for ground in grounds:
        cells = []
        for robot in robots:
            walks = [outcome for job, outcome in found.items() if job[:2] == (robot, ground)]
            causes = [f"{each.cause} after {each.stopped:.0f} s" for each in walks if math.isfinite(each.stopped)]
            counts = {name: sum(getattr(each, name) for each in walks) for name in MISHAPS}
            notes = [f"{count} {MISHAPS[name]}" for name, count in counts.items() if count]
            way = f"{mean(each.way for each in walks):.2f} of {len(walks)}"
            cells.append("<br>".join([", ".join([way, *notes]), *causes]))
        lines.append(f"| {ground} | {' | '.join(cells)} |")
    return "\n".join(lines)


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table."""
    jobs = [Job(*job) for job in itertools.product(asked.robots, asked.grounds, range(asked.seeds))]
    found = dict(zip(jobs, measured(walk, jobs, asked.jobs), strict=True))
    return {"long walks": table(found, asked.robots, asked.grounds)}


if __name__ == "__main__":
    grounds = Several(SHOWN, choices=GROUNDS)
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), grounds=grounds, seeds=2, jobs=1)
