"""Write the table of ground-measured.md of walking robots that are picked up and put down elsewhere, in physics.

python docs/put_down.py --jobs 2
python docs/put_down.py --robots strider --grounds ramp+20 --print
"""

from __future__ import annotations

import argparse
import itertools
import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np

import tarsus
from page_tables import Several, measured, write_tables
from rough_ground import CLEAR, PAGE, ROBOTS, ramp
from rough_ground import GROUNDS as ROUGH
from tarsus.simulation import SensorSuite, SimulatedPlant
from tarsus.simulation.sensors.suite import Sensor

DT, GRAVITY = 0.01, 9.80665
# How the robot is held, and what it measures.
LEVEL, TILTED, ANGLES = "", ", tilted hand", ", tilted hand, no switches"
SENSORS: dict[str, SensorSuite | str] = {
    LEVEL: "ideal",
    TILTED: "ideal",
    ANGLES: SensorSuite(attitude=Sensor(), joint_angles=Sensor()),
}
GROUNDS: dict[str, Callable[[int], Any]] = {
    **{name: ROUGH[name] for name in ("flat", "smooth60", "smooth100", "blocks60", "blocks100")},
    # As near as the first blocks.
    **{f"ramp{angle:+d}": partial(ramp, degrees=angle, start=CLEAR) for angle in (10, 17, 20)},
}
# When it is picked up [s], how high, and how fast it is lifted, carried and put down [m], [m/s].
PICKED_UP, HIGH, LIFTED, CARRIED, LOWERED = 2.0, 0.22, 0.15, 0.3, 0.08
# Stiffness and damping of the grip, over mass and inertia [1/s^2], [1/s]; inertia over mass [m^2].
GRIP, TURNING_GRIP, INERTIA = (200.0, 28.0), (400.0, 40.0), 0.02
# Greatest roll and pitch of a tilted hand [rad]; grounds on which it puts the robot down.
TILT, TILTED_ON = math.radians(15.0), ("flat", "blocks60", "ramp+10")
# The hand lets go once it bears less of the weight.
LETS_GO = 0.3
# How far ahead and aside it is put down [m], and for how long it walks then [s].
AHEAD, ASIDE, WALKS = (0.75, 1.1), (-0.2, 0.2), 10.0


class Outcome(NamedTuple):
    """What a robot does that was put down: way over the commanded one, greatest tilt [deg], touch of its body."""

    way: float
    tilt: float
    touched: bool


def carried(start: np.ndarray, goal: np.ndarray) -> Iterator[np.ndarray]:
    """Yield the places of a body that is lifted and carried over a goal."""
    top = start + np.array([0.0, 0.0, HIGH])
    for there, here, speed in ((start, top, LIFTED), (top, np.append(goal, top[2]), CARRIED)):
        yield from np.linspace(there, here, math.ceil(math.dist(there, here) / (speed * DT)))


def held(plant: SimulatedPlant, place: np.ndarray, rpy: np.ndarray) -> float:
    """Hold the body at a place and an attitude for a tick, and return how much of the weight that takes."""
    body, speeds = plant.state.body, np.asarray(plant.mj_data.qvel[:6])
    off = np.remainder(rpy - body.rpy + math.pi, math.tau) - math.pi
    force = GRIP[0] * (place - body.position) - GRIP[1] * speeds[:3] + np.array([0.0, 0.0, GRAVITY])
    torque = INERTIA * (TURNING_GRIP[0] * off - TURNING_GRIP[1] * (np.asarray(body.rotation) @ speeds[3:]))
    plant.mj_data.xfrc_applied[1] = plant.mj_model.body_mass.sum() * np.concatenate([force, torque])
    return float(force[2]) / GRAVITY


def walk(job: tuple[str, str, int], how: str = LEVEL) -> Outcome:
    """Return the outcome of one walk."""
    name, ground, seed = job
    robot, draw = tarsus.load_robot(name), np.random.default_rng(seed)
    plant = SimulatedPlant(robot, terrain=GROUNDS[ground](seed), sensors=SENSORS[how], servos="catalogue", seed=seed)
    controller = tarsus.RobotController(robot)
    speed = 0.5 * tarsus.WalkController(robot).top_speed((1, 0, 0))
    goal = np.array([draw.uniform(*AHEAD), draw.uniform(*ASIDE)])
    plant.start(controller.output)

    def advance() -> None:
        controller.step((speed, 0.0, 0.0), DT, plant.step(controller.output, DT))

    for _ in range(round(PICKED_UP / DT)):
        advance()
    start, tilt = np.asarray(plant.state.body.position), draw.uniform(-TILT, TILT, 2) * (how != LEVEL)
    rpy = np.array([*tilt, plant.state.body.rpy[2]])
    for place in carried(start, goal):
        held(plant, place, rpy)
        advance()
    while held(plant, place, rpy) > LETS_GO:
        place = place - np.array([0.0, 0.0, LOWERED * DT])
        advance()
    plant.mj_data.xfrc_applied[1] = 0.0
    put_down, tilts, touched = float(plant.state.body.position[0]), [0.0], False
    for _ in range(round(WALKS / DT)):
        advance()
        tilts.append(math.degrees(math.hypot(*plant.state.body.rpy[:2])))
        touched = touched or plant.state.body_touches
    return Outcome((float(plant.state.body.position[0]) - put_down) / (speed * WALKS), max(tilts), touched)


def cell(found: list[Outcome]) -> str:
    """Return median way, greatest tilt of all, and how many stay where they are, and touch the ground."""
    counts = {"stayed": sum(each.way < 0.2 for each in found), "touched": sum(each.touched for each in found)}
    notes = [f"{count} of {len(found)} {name}" for name, count in counts.items() if count]
    way, tilt = np.median([each.way for each in found]), max(each.tilt for each in found)
    return f"{way:.2f}, {tilt:.0f}" + (f" ({', '.join(notes)})" if notes else "")


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table."""
    jobs = list(itertools.product(asked.robots, asked.grounds, range(asked.seeds)))
    lines = [f"| put down on | {' | '.join(asked.robots)} |", f"|---|{'---|' * len(asked.robots)}"]
    for how in SENSORS:
        walked = [job for job in jobs if how == LEVEL or job[1] in TILTED_ON]
        found: dict[tuple[str, str], list[Outcome]] = {}
        outcomes = measured(partial(walk, how=how), walked, asked.jobs)
        for (robot, ground, _), outcome in zip(walked, outcomes, strict=True):
            found.setdefault((ground, robot), []).append(outcome)
        for ground in dict.fromkeys(ground for ground, _ in found):
            lines.append(f"| {ground}{how} | {' | '.join(cell(found[ground, robot]) for robot in asked.robots)} |")
    return {"put down": "\n".join(lines)}


if __name__ == "__main__":
    grounds, robots = Several(GROUNDS, choices=GROUNDS), Several(ROBOTS, choices=tarsus.list_robots())
    write_tables(__doc__, PAGE, tables, grounds=grounds, robots=robots, seeds=10, jobs=1)
