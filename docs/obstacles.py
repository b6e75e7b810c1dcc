"""Write the table of obstacles of ground.md: walks to a wall or a post in physics, and back.

python docs/obstacles.py --robots strider --print
"""

from __future__ import annotations

import argparse
import itertools
import math
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple
from unittest.mock import patch

import mujoco
import numpy as np

import tarsus
from page_tables import Several, measured, write_tables
from tarsus.control.terrain import ground_contact
from tarsus.simulation import SensorSuite, SimulatedPlant, terrain
from tarsus.simulation.sensors.suite import FootSwitch, Sensor
from tarsus.simulation.terrain.surface import surface

PAGE = Path(__file__).parent / "ground.md"
ROBOTS = ("strider", "phantomx", "makeyourpet")
# Where obstacles begin, half the width of a post, and what is walked ahead and back [m].
EDGES, HALF, AHEAD, BACK = (0.5, 0.53, 0.56), 0.02, 0.9, 0.4
# Shares of the top speed; heights of a wall that no robot climbs, and of a post in the way of a middle leg [m].
PACES, WALL, POST = (0.25, 0.5), 0.15, 0.08
# A leg that has not touched the obstacle for longer has let go of it [s].
_GONE = 0.03
SENSORS = {
    "switches": SensorSuite(name="switches", contacts=FootSwitch(), attitude=Sensor()),
    "switches and joint angles": SensorSuite(
        name="angles", contacts=FootSwitch(), attitude=Sensor(), joint_angles=Sensor()
    ),
}


@dataclass(frozen=True)
class Post:
    """A square post on level ground, in the way of one leg."""

    x: float
    y: float
    friction: float = 0.8

    def height(self, x: Any, y: Any) -> np.ndarray:
        """Return the height of the ground [m]."""
        away = np.maximum(np.abs(np.asarray(x) - self.x), np.abs(np.asarray(y) - self.y))
        return np.where(away < HALF, POST, 0.0)

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model."""
        terrain.Flat(friction=self.friction).add_to(spec)
        size, pos = (HALF, HALF, POST / 2), (self.x, self.y, POST / 2)
        kind = mujoco.mjtGeom.mjGEOM_BOX
        spec.worldbody.add_geom(name="ground 1", type=kind, size=size, pos=pos, **surface(self.friction))


class Job(NamedTuple):
    """One walk: robot, sensors, whether to a post, where it is [m], share of the top speed."""

    robot: str
    sensors: str
    post: bool
    edge: float
    pace: float


class Outcome(NamedTuple):
    """What became of a walk, its greatest tilt [deg], and how soon swings that were stopped were noticed [s]."""

    kind: str
    tilt: float
    noticed: list[float]


def walk(job: Job) -> Outcome:
    """Return what became of a walk."""
    robot = tarsus.load_robot(job.robot)
    walker = tarsus.WalkController(robot)
    speed, feet = job.pace * walker.top_speed((1, 0, 0)), walker.feet
    middle = max(range(robot.legs), key=lambda leg: feet[leg, 1])
    ground = Post(job.edge, float(feet[middle, 1])) if job.post else terrain.Step(rise=WALL, start=job.edge)
    plant = SimulatedPlant(robot, terrain=ground, sensors=SENSORS[job.sensors], servos="catalogue")
    controller = tarsus.RobotController(robot)
    output, dt, tilt, furthest, named = controller.output, 0.01, 0.0, 0.0, False
    met, touched, noticed, reacted = dict[int, float](), dict[int, float](), list[float](), set[int]()

    def noting(function: Any) -> Any:
        def noted(state: Any, leg: int, *arguments: Any) -> Any:
            reacted.add(leg)
            return function(state, leg, *arguments)

        return noted

    names = ("_rising_again", "_trying_again")
    with patch.multiple(ground_contact, **{name: noting(getattr(ground_contact, name)) for name in names}):
        plant.start(output)
        for twist, way in ((speed, AHEAD), (-speed, BACK)):
            for _ in range(round(way / speed / dt)):
                readings = plant.step(output, dt)
                roll, pitch, _ = np.asarray(plant.state.body.rpy).tolist()
                tilt = max(tilt, math.degrees(math.hypot(roll, pitch)))
                now = plant.mj_data.time
                for leg in stopped_legs(plant, robot):
                    touched[leg] = now
                    met.setdefault(leg, now)
                # Swings alone; a leg that has let go for a moment is not stopped.
                met = {leg: at for leg, at in met.items() if not output.contacts[leg] and now - touched[leg] < _GONE}
                output = controller.step((twist, 0.0, 0.0), dt, readings)
                noticed += [now - met.pop(leg) for leg in reacted & set(met)]
                reacted.clear()
                furthest = max(furthest, float(plant.state.body.position[0]))
                named = named or any(limit.leg and "obstacle" in str(limit.cause) for limit in output.limitations)
    if furthest > job.edge + 0.1:
        return Outcome("passed", tilt, noticed)
    came_back = float(plant.state.body.position[0]) < furthest - BACK / 4
    return Outcome(
        f"{'named the leg' if named else 'said nothing'}, {'back' if came_back else 'stayed'}", tilt, noticed
    )


def stopped_legs(plant: SimulatedPlant, robot: tarsus.Robot) -> set[int]:
    """Return the legs that the side of the obstacle touches."""
    data, model, found = plant.mj_data, plant.mj_model, set[int]()
    for number, pair in enumerate(data.contact.geom.tolist()):
        names = [model.geom(geom).name for geom in pair]
        if "ground 1" in names and abs(float(data.contact.frame[number, 0])) > 0.7:
            found |= {leg for leg, name in enumerate(robot.leg_names) if any(part.startswith(name) for part in names)}
    return found


def table(outcomes: dict[Job, Outcome]) -> str:
    """Return how often each robot did what, and what it noticed."""
    kinds = sorted({outcome.kind for outcome in outcomes.values()})
    lines = [
        f"| walk | {' | '.join(kinds)} | tilt | noticed after: median, 90 % |",
        f"|---|{'---|' * (len(kinds) + 2)}",
    ]
    for key in dict.fromkeys(job[:3] for job in outcomes):
        found = [outcome for job, outcome in outcomes.items() if job[:3] == key]
        counts = " | ".join(f"{sum(each.kind == kind for each in found)} of {len(found)}" for kind in kinds)
        times = sorted(1e3 * time for each in found for time in each.noticed)
        late = f"{median(times):.0f}, {times[math.ceil(0.9 * len(times)) - 1]:.0f} ms" if times else "-"
        tilt = median(each.tilt for each in found)
        name = f"{key[0]}, {'post' if key[2] else 'wall'}, {key[1]}"
        lines.append(f"| {name} | {counts} | {tilt:.0f} deg | {late} |")
    return "\n".join(lines)


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table."""
    jobs = [Job(*job) for job in itertools.product(asked.robots, SENSORS, (False, True), EDGES, PACES)]
    return {"obstacles": table(dict(zip(jobs, measured(walk, jobs, asked.jobs), strict=True)))}


if __name__ == "__main__":
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), jobs=1)
