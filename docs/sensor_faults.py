"""Write the table of faults in ground-measured.md: what bad readings cost.

python docs/sensor_faults.py --seeds 5 --jobs 2
python docs/sensor_faults.py --robots strider --faults 'hobby sensors' --print
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

import tarsus
from page_tables import Several, measured, write_tables
from rough_ground import GROUNDS, PAGE, RANDOM, ROBOTS, WAY
from tarsus import SensorReadings
from tarsus.simulation import SensorSuite, SimulatedPlant
from tarsus.simulation.sensors.suite import FootSwitch, Sensor

GROUND = ("flat", "blocks40")
IDEAL = SensorSuite.named("ideal")


def with_sensors(**sensors: Any) -> SensorSuite:
    """Return the ideal sensors with others in some of their places."""
    return dataclasses.replace(IDEAL, **sensors)


LATE = with_sensors(contacts=FootSwitch(delay=0.05), attitude=Sensor(delay=0.05), joint_angles=Sensor(delay=0.05))
CONTINUOUS = ("attitude", "angular_rates", "joint_angles", "torques")
ONE_DEGREE = Sensor(noise=math.radians(1), bias=math.radians(1))
SUITES: dict[str, Any] = {
    "hobby sensors": "hobby",
    "50 ms late": LATE,
    "1 % of contacts wrong": with_sensors(contacts=FootSwitch(flips=0.01)),
    "5 % of contacts wrong": with_sensors(contacts=FootSwitch(flips=0.05)),
    "attitude with 1 deg of noise and bias": with_sensors(attitude=ONE_DEGREE),
}
LOAD_CELLS = "load cells with offsets of 1 N and no switches"
LOST = {"contacts": FootSwitch(dropout=0.3), **{name: Sensor(dropout=0.3) for name in CONTINUOUS}}
SUITES |= {
    LOAD_CELLS: with_sensors(contacts=None, forces=Sensor(noise=0.1, bias=1.0)),
    "30 % of readings lost and the last given again": with_sensors(**LOST),
    "joint angles measured 16 times a second": with_sensors(joint_angles=Sensor(rate=16)),
}


class Stuck:
    """A switch that is stuck from a time on [s]."""

    def __init__(self, leg: int, closed: bool, since: float = 0.0) -> None:
        self.leg, self.closed, self.since = leg, closed, since

    def __call__(self, readings: SensorReadings, time: float) -> SensorReadings:
        """Return what is read."""
        if time < self.since:
            return readings
        contacts = np.array(readings.contacts)
        contacts[self.leg] = self.closed
        return dataclasses.replace(readings, contacts=contacts)


class InTurn:
    """Servos that are asked leg by leg, one in each tick; the angles of the others are those of before."""

    def __init__(self) -> None:
        self.angles, self.times, self.leg = np.zeros((6, 3)), np.full((6, 3), -math.inf), 0

    def __call__(self, readings: SensorReadings, time: float) -> SensorReadings:
        """Return what is read."""
        asked = [self.leg] if np.isfinite(self.times).all() else slice(None)
        self.angles[asked], self.times[asked], self.leg = readings.joint_angles[asked], time, (self.leg + 1) % 6
        ages = {"joint_angles": time - self.times}
        return dataclasses.replace(readings, joint_angles=self.angles.copy(), age=ages)


class Missing:
    """Channels of which 30 % of the readings are missing."""

    def __init__(self) -> None:
        self.random = np.random.default_rng(0)

    def __call__(self, readings: SensorReadings, time: float) -> SensorReadings:  # noqa: ARG002 - as the others
        """Return what is read."""
        channels = ("contacts", *CONTINUOUS)
        lost: dict[str, Any] = {name: None for name in channels if self.random.random() < 0.3}
        return dataclasses.replace(readings, **lost)


# What is wrong with readings; a name with a comma begins with that of the sensors.
CHANGES: dict[str, Callable[[], Callable[[SensorReadings, float], SensorReadings]]] = {
    "30 % of readings missing": Missing,
    "joint angles of one leg in each tick": InTurn,
    "switch of the front left foot open": partial(Stuck, 0, False),
    "switch of the middle left foot open": partial(Stuck, 1, False),
    "switch of the front left foot open after 3 s": partial(Stuck, 0, False, 3.0),
    "switch of the front left foot closed": partial(Stuck, 0, True),
    "switch of the middle left foot closed after 3 s": partial(Stuck, 1, True, 3.0),
    "50 ms late, switch of the front left foot open": partial(Stuck, 0, False),
    "50 ms late, switch of the middle right foot open": partial(Stuck, 4, False),
}
LAG = "50 ms of servo lag"
FAULTS = ("none", *SUITES, LAG, *CHANGES)


def walk(name: str, ground: str, fault: str, seed: int, *, servos: Any = "catalogue") -> tuple[float, float]:
    """Return the way of one walk at half the top speed, over the commanded one, and the RMS of its tilt [deg]."""
    robot = tarsus.load_robot(name)
    speed, dt = 0.5 * tarsus.WalkController(robot).top_speed((1, 0, 0)), 0.01
    sensors = SUITES.get(fault.partition(",")[0], IDEAL)
    setup: dict[str, Any] = {"terrain": GROUNDS[ground](seed), "sensors": sensors, "seed": seed}
    plant = SimulatedPlant(robot, servos=servos, **setup)
    if fault == LAG:
        late = [[dataclasses.replace(each, delay=each.delay + 0.05) for each in row] for row in plant.servos]
        plant = SimulatedPlant(robot, servos=late, **setup)
    controller = tarsus.RobotController(robot)
    output = controller.output
    plant.start(output)
    start, tilts, ticks = plant.state.body.position[0], [], round(WAY / speed / dt)
    change = CHANGES[fault]() if fault in CHANGES else lambda readings, _: readings
    for tick in range(ticks):
        readings = change(plant.step(output, dt), tick * dt)
        tilts.append(math.hypot(*np.asarray(plant.state.body.rpy).tolist()[:2]))
        output = controller.step((speed, 0.0, 0.0), dt, readings)
    way = float(plant.state.body.position[0] - start)
    return way / (speed * dt * ticks), math.degrees(math.sqrt(np.mean(np.square(tilts))))


def fault_tables(asked: argparse.Namespace) -> str:
    """Return the tables of robots, one row a fault: medians of way and tilt on each ground."""
    cells = list(itertools.product(asked.robots, asked.faults, GROUND))
    seeds = [asked.seeds if cell[2].startswith(RANDOM) or cell[1] in SUITES else 1 for cell in cells]
    walks = [(*cell, seed) for cell, draws in zip(cells, seeds, strict=True) for seed in range(draws)]
    found: dict[tuple[str, str, str], list[tuple[float, float]]] = {cell: [] for cell in cells}
    for (*cell, _), outcome in zip(walks, measured(_walk, walks, asked.jobs), strict=True):
        found[tuple(cell)].append(outcome)
    return "\n\n".join(_fault_table(robot, asked.faults, found) for robot in asked.robots)


def _walk(job: tuple[str, str, str, int]) -> tuple[float, float]:
    robot, fault, ground, seed = job
    return walk(robot, ground, fault, seed)


def _fault_table(robot: str, faults: list[str], found: dict[tuple[str, str, str], list[tuple[float, float]]]) -> str:
    lines = [f"| {robot} | {' | '.join(GROUND)} |", f"|---|{'---|' * len(GROUND)}"]
    for fault in faults:
        lines.append(f"| {fault} | {' | '.join(medians(found[robot, fault, ground]) for ground in GROUND)} |")
    return "\n".join(lines)


def medians(found: list[tuple[float, float]]) -> str:
    """Return the medians of way and tilt."""
    way, tilt = np.median(found, axis=0).tolist()
    return f"{way:.2f}, {tilt:.1f}"


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table."""
    return {"sensor faults": fault_tables(asked)}


if __name__ == "__main__":
    faults = Several(FAULTS, choices=FAULTS)
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), faults=faults, seeds=3, jobs=1)
