"""Write the table of ground-measured.md of walks in physics, and with readings, that differ from the robot file.

python docs/other_physics.py --jobs 2
python docs/other_physics.py --robots strider --grounds smooth60 --print
"""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Callable
from functools import partial
from typing import Any

import mujoco
import numpy as np

import tarsus
from page_tables import Several, measured, write_tables
from rough_ground import GROUNDS, PAGE, ROBOTS, WAY, Outcome, cell, walked_on
from tarsus.simulation import SimulatedPlant

PACE, SHOWN = 0.5, ("flat", "blocks60")
# Mass of a payload over that of the robot.
PAYLOAD = 0.2


def contact_time(model: Any, time: float) -> None:
    """Let contacts give way with another time constant than 10 ms [s]."""
    model.geom_solref[:] = time, 1.0


def friction(model: Any, coefficient: float) -> None:
    """Change the friction."""
    model.geom_friction[:, 0] = coefficient


def rolling_friction(model: Any, torsional: float, rolling: float) -> None:
    """Let feet that turn or roll be braked, too [m]."""
    model.geom_friction[:, 1:], model.geom_condim[:] = (torsional, rolling), 6


def pyramids(model: Any) -> None:
    """Approximate friction cones by pyramids, which creep."""
    model.opt.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL


def payload(model: Any, place: tuple[float, float, float]) -> None:
    """Put a payload on the body [m]."""
    own, added = model.body_mass[1], PAYLOAD * model.body_mass.sum()
    model.body_ipos[1] = (own * model.body_ipos[1] + added * np.array(place)) / (own + added)
    model.body_mass[1] = own + added
    mujoco.mj_setConst(model, mujoco.MjData(model))


def rotors(model: Any, times: float) -> None:
    """Change the inertia of the servos' rotors."""
    model.dof_armature[6:] *= times


class Dropouts:
    """A plant that loses readings: of single ticks, or of all ticks for a time that comes again."""

    def __init__(self, plant: SimulatedPlant, lost: Callable[[int, float], bool]) -> None:
        self.plant, self._lost, self._random, self._ticks = plant, lost, np.random.default_rng(1), 0

    @property
    def state(self) -> Any:
        """State of the simulation."""
        return self.plant.state

    def step(self, output: tarsus.ControlOutput, dt: float) -> tarsus.SensorReadings | None:
        """Return the readings, or none."""
        self._ticks += 1
        readings = self.plant.step(output, dt)
        return None if self._lost(self._ticks, self._random.random()) else readings


# What is changed in the model; which readings are lost, by the number of the tick and a random number.
MODELS: dict[str, Callable[[Any], None]] = {
    "as in the file": lambda _: None,
    "contacts of 60 ms": partial(contact_time, time=0.06),
    "contacts of 4 ms": partial(contact_time, time=0.004),
    "friction 0.45": partial(friction, coefficient=0.45),
    "friction 1.6": partial(friction, coefficient=1.6),
    "torsional and rolling friction of 5 mm": partial(rolling_friction, torsional=0.005, rolling=0.005),
    "pyramidal friction cones": pyramids,
    "payload 30 mm ahead and above": partial(payload, place=(0.03, 0.0, 0.03)),
    "payload 20 mm behind, 30 mm aside and above": partial(payload, place=(-0.02, 0.03, 0.03)),
    "twice the rotor inertia": partial(rotors, times=2.0),
}
DROPOUTS: dict[str, Callable[[int, float], bool]] = {
    "readings missing in 10 % of ticks": lambda _, draw: draw < 0.1,
    "readings missing in 50 % of ticks": lambda _, draw: draw < 0.5,
    "readings missing for 0.15 s in 2 s": lambda tick, _: tick % 200 < 15,
}


def walk(job: tuple[str, str, str, int]) -> Outcome:
    """Return the outcome of one walk: robot, ground, what differs, seed."""
    name, ground, differs, seed = job
    robot = tarsus.load_robot(name)
    speed = PACE * tarsus.WalkController(robot).top_speed((1, 0, 0))
    plant: Any = SimulatedPlant(robot, terrain=GROUNDS[ground](seed), sensors="ideal", servos="catalogue", seed=seed)
    controller = tarsus.RobotController(robot)
    plant.start(controller.output)
    if differs in MODELS:
        MODELS[differs](plant.mj_model)
    else:
        plant = Dropouts(plant, DROPOUTS[differs])
    return walked_on(plant, controller, np.array([speed, 0.0, 0.0]), WAY / speed)


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table: a row for each difference, a column for each robot and ground."""
    columns, rows = list(itertools.product(asked.robots, asked.grounds)), [*MODELS, *DROPOUTS]
    jobs = [(*column, row, seed) for row in rows for column in columns for seed in range(asked.seeds)]
    found: dict[tuple[str, str, str], list[Outcome]] = {}
    for (robot, ground, row, _), outcome in zip(jobs, measured(walk, jobs, asked.jobs), strict=True):
        found.setdefault((robot, ground, row), []).append(outcome)
    lines = [f"| | {' | '.join(map(', '.join, columns))} |", f"|---|{'---|' * len(columns)}"]
    lines += [f"| {row} | {' | '.join(cell(found[*column, row]) for column in columns)} |" for row in rows]
    return {"other physics": "\n".join(lines)}


if __name__ == "__main__":
    grounds, robots = Several(SHOWN, choices=GROUNDS), Several(ROBOTS, choices=tarsus.list_robots())
    write_tables(__doc__, PAGE, tables, robots=robots, grounds=grounds, seeds=3, jobs=1)
