"""Write the tables of servos that fail in ground-measured.md: how a robot walks on without a leg, and what is found.

python docs/leg_failures.py --jobs 2
python docs/leg_failures.py --robots strider --seeds 1 --print
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import math
from typing import Any, NamedTuple

import numpy as np

import tarsus
from page_tables import Several, measured, write_tables
from rough_ground import GROUNDS, PAGE, ROBOTS, WAY, Watch
from tarsus.robot.robot import JOINTS
from tarsus.simulation import SensorSuite, SimulatedPlant

DT, FAILURE_AT, FAILURE_TIME = 0.01, 2.0, 15.0
FAILURES = [(1, 1, "limp"), (0, 1, "limp"), (2, 1, "limp"), (1, 1, "stuck"), (0, 0, "stuck"), (0, 2, "limp")]
# What is found where torques are not measured: of servos that go limp, each at these times [s] and within another, and
# of those that work, on the ground on which legs are caught most.
UNTOLD = dataclasses.replace(SensorSuite.named("ideal"), torques=None, currents=None, forces=None)
SUITES = {"switches and joint angles": UNTOLD, "joint angles alone": dataclasses.replace(UNTOLD, contacts=None)}
LIMP, TIMES, WITHIN = tuple(itertools.product((0, 1, 2), (1, 2))), (2.0, 2.5), 6.0
GROUND = ("smooth100", "blocks60", "blocks100")


class Walk(NamedTuple):
    """A walk: with its seed, and the leg and the joint whose servo fails, how, and when [s]."""

    robot: str
    sensors: Any = "ideal"
    ground: str = "flat"
    seed: int = 0
    leg: int = 0
    joint: int = 0
    kind: str = ""  # none fails
    at: float = FAILURE_AT
    time: float = FAILURE_TIME  # [s]; 0: the usual way


class Found(NamedTuple):
    """What has come of it: after what time the servo is found [s], and others; speed from then on; tilt, touches."""

    after: float
    others: bool
    speed: float
    tilt: float
    touched: bool


def walk(job: Walk) -> Found:
    """Return what comes of a walk."""
    robot = tarsus.load_robot(job.robot)
    speed = 0.5 * tarsus.WalkController(robot).top_speed((1, 0, 0))
    plant = SimulatedPlant(robot, terrain=GROUNDS[job.ground](job.seed), sensors=job.sensors, seed=job.seed)
    controller = tarsus.RobotController(robot)
    plant.start(controller.output)
    found, watch, start, time = math.inf, Watch(plant), (0.0, 0.0), job.time or WAY / speed
    for tick in range(round(time / DT)):
        if job.kind and tick == round(job.at / DT):
            break_servo(plant, 3 * job.leg + job.joint, limp=job.kind == "limp")
        readings = plant.step(controller.output, DT)
        watch.look(DT)
        controller.step((speed, 0.0, 0.0), DT, readings)
        if job.leg in controller.leg_failures.failed and math.isinf(found):
            found, start = tick * DT - job.at, (tick * DT, float(plant.state.body.position[0]))
    others = bool(controller.leg_failures.failed.keys() - ({job.leg} if job.kind else set()))
    pace = (float(plant.state.body.position[0]) - start[1]) / (time - start[0])
    return Found(found, others, pace, max(watch.tilts), watch.touched > 0.0)


def break_servo(plant: SimulatedPlant, number: int, *, limp: bool) -> None:
    """Let the servo of a joint go limp, or jam the joint."""
    if limp:
        drives = len(plant.mj_model.actuator_gainprm) // (3 * plant.robot.legs)
        servo = slice(drives * number, drives * (number + 1))
        plant.mj_model.actuator_gainprm[servo] = plant.mj_model.actuator_biasprm[servo] = 0.0
    else:
        plant.mj_model.dof_frictionloss[6 + number] = 50.0


def failure_table(asked: argparse.Namespace) -> str:
    """Return the table of servos that fail."""
    lines = ["| robot | servo | found after | speed then | tilt | body touches |", "|---|---|---|---|---|---|"]
    jobs = [Walk(name, leg=leg, joint=joint, kind=kind) for name in asked.robots for leg, joint, kind in FAILURES]
    for job, found in zip(jobs, measured(walk, jobs, asked.jobs), strict=True):
        code = tarsus.load_robot(job.robot).leg_codes[job.leg]
        then = f"{found.after:.1f} s | {1e3 * found.speed:.0f} mm/s | {math.degrees(found.tilt):.0f} deg"
        told = "not found | | |" if math.isinf(found.after) else f"{then} | {'yes' if found.touched else 'no'} |"
        lines.append(f"| {job.robot} | {code} {JOINTS[job.joint]} {job.kind} | {told}")
    return "\n".join(lines)


def untold_table(asked: argparse.Namespace) -> str:
    """Return the table of what is found where torques are not measured: servos that fail, and that work."""
    lines = [
        f"| robot | {' | '.join(f'{name}: limp | working' for name in SUITES)} |",
        f"|---|{'---|' * 2 * len(SUITES)}",
    ]
    for name in (*asked.robots, "ch3r"):
        cells = []
        for suite in SUITES.values():
            limp = [
                Walk(name, suite, leg=leg, joint=joint, kind="limp", at=at, time=at + WITHIN)
                for at, (leg, joint) in itertools.product(TIMES, LIMP)
            ]
            after = np.array([found.after for found in measured(walk, limp, asked.jobs)])
            works = [
                Walk(name, suite, ground, 1000 + seed, time=0.0) for ground in GROUND for seed in range(asked.seeds)
            ]
            called = sum(found.others for found in measured(walk, works, asked.jobs))
            cells.append(f"{np.median(after):.1f} s, {np.isfinite(after).sum()} of {len(limp)}")
            cells.append(f"{called} of {len(works)}")
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(lines)


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the tables."""
    return {"leg failures": failure_table(asked), "leg failures without torques": untold_table(asked)}


if __name__ == "__main__":
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), seeds=3, jobs=1)
