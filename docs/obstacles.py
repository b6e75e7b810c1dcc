"""Write the table of obstacles of ground-measured.md: walks to a wall or a post in physics, and back.

python docs/obstacles.py --robots strider --print
"""

from __future__ import annotations

import argparse
import itertools
import math
from contextlib import ExitStack
from dataclasses import replace
from statistics import median
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np

import tarsus
from page_tables import Several, measured, write_tables
from rough_ground import PAGE, ROBOTS
from tarsus.control.felt import landing
from tarsus.simulation import SensorSuite, SimulatedPlant, terrain
from tarsus.simulation.sensors.suite import FootSwitch, Sensor

# Where obstacles begin, and what is walked ahead and back [m].
EDGES, AHEAD, BACK = (0.5, 0.53, 0.56), 0.9, 0.4
# Shares of the top speed.
PACES = (0.25, 0.5)
# Walls that no robot climbs, and posts, which are put in the way of a middle leg.
_WALL = terrain.Box(length=1.0, width=6.0, rise=0.25)
OBSTACLES = {
    "wall": _WALL,
    "oblique wall": replace(_WALL, yaw=math.radians(30)),
    "post": terrain.Box(length=0.04, width=0.04, rise=0.08),
    "tall post": terrain.Box(length=0.06, width=0.06, rise=0.3),
}
# A leg that has not touched the obstacle for longer has let go of it [s].
_GONE = 0.03
# A swing is stopped once its foot is so much farther behind its command than as its leg touched the obstacle [m].
_BEHIND = 0.005
# Length of a tick [s].
DT = 0.01
# Time until joints follow their commands, in ticks.
_LAG = 2
SENSORS = {
    "switches": SensorSuite(name="switches", contacts=FootSwitch(), attitude=Sensor()),
    "switches and joint angles": SensorSuite(
        name="angles", contacts=FootSwitch(), attitude=Sensor(), joint_angles=Sensor()
    ),
}


class Job(NamedTuple):
    """One walk: robot, sensors, obstacle, where it is [m], share of the top speed."""

    robot: str
    sensors: str
    obstacle: str
    edge: float
    pace: float


class Outcome(NamedTuple):
    """What became of a walk.

    Its greatest tilt [deg]; how soon swings that were stopped were noticed [s]; whether a servo was called failed.
    """

    kind: str
    tilt: float
    noticed: list[float]
    failed: bool


class Touches:
    """Finds swings that are stopped by an obstacle, and how soon that is noticed: NaN where it is not.

    A swing is stopped once its foot has fallen 5 mm behind its command since its leg touched the obstacle's side. It is
    noticed as the foot rises again, tries again, or is put down; before that, at once.
    """

    def __init__(self, robot: tarsus.Robot, plant: SimulatedPlant, ground: terrain.Box) -> None:
        self._robot, self._plant, self._ground = robot, plant, ground
        self.reacted, self.noticed, self._done = set[int](), list[float](), set[int]()
        self._touched, self._stopped, self._behind = dict[int, float](), dict[int, float](), dict[int, float]()
        self._commanded = list[Any]()

    def step(self, output: tarsus.ControlOutput) -> None:
        """Take in a tick of the plant; the output is that which it has followed."""
        now = self._plant.mj_data.time
        self._commanded.append(self._ahead(output.angles))
        behind = self._commanded[-1 - _LAG :][0] - self._ahead(self._plant.state.joint_angles)
        for leg in self._legs_at_side():
            self._touched[leg] = now
            if not output.contacts[leg] and behind[leg] - self._behind.setdefault(leg, behind[leg]) > _BEHIND:
                self._stopped.setdefault(leg, now)

    def react(self, output: tarsus.ControlOutput) -> None:
        """Take in what the controller has made of the tick."""
        now = self._plant.mj_data.time
        for leg in list(self._behind):
            ends = output.contacts[leg] or now - self._touched[leg] > _GONE
            if (leg in self.reacted or (ends and leg in self._stopped)) and leg not in self._done:
                self.noticed.append(now - self._stopped.get(leg, now) if leg in self.reacted else math.nan)
                self._done.add(leg)
            if ends:
                self._done.discard(leg)
                del self._behind[leg]
                self._stopped.pop(leg, None)
        self.reacted.clear()

    def _ahead(self, angles: Any) -> Any:
        feet = np.asarray(self._plant.state.body @ tarsus.forward_kinematics(self._robot, angles)[:, 3])
        return self._ground.ahead(feet[:, 0], feet[:, 1]).real

    def _legs_at_side(self) -> set[int]:
        data, model, found = self._plant.mj_data, self._plant.mj_model, set[int]()
        for number, pair in enumerate(data.contact.geom.tolist()):
            names = [model.geom(geom).name for geom in pair]
            if "box" in names and abs(float(data.contact.frame[number, 2])) < 0.7:
                legs = enumerate(self._robot.leg_names)
                found |= {leg for leg, name in legs if any(part.startswith(name) for part in names)}
        return found


def walk(job: Job) -> Outcome:
    """Return what became of a walk."""
    robot = tarsus.load_robot(job.robot)
    walker = tarsus.WalkController(robot)
    speed, feet = job.pace * walker.top_speed((1, 0, 0)), walker.feet
    aside = float(feet[:, 1].max()) if "post" in job.obstacle else 0.0
    ground = replace(OBSTACLES[job.obstacle], start=job.edge, aside=aside)
    plant = SimulatedPlant(robot, terrain=ground, sensors=SENSORS[job.sensors], servos="catalogue")
    controller, touches = tarsus.RobotController(robot), Touches(robot, plant, ground)
    output, dt, tilt, named = controller.output, DT, 0.0, False
    ahead = furthest = -math.inf

    def noting(function: Any) -> Any:
        def noted_call(state: Any, leg: int, *arguments: Any, **more: Any) -> Any:
            touches.reacted.add(leg)
            return function(state, leg, *arguments, **more)

        return noted_call

    with ExitStack() as noted:
        for name in ("_rising_again", "_trying_again", "_landed"):
            noted.enter_context(patch.object(landing, name, noting(getattr(landing, name))))
        plant.start(output)
        for twist, way in ((speed, AHEAD), (-speed, BACK)):
            for _ in range(round(way / speed / dt)):
                readings = plant.step(output, dt)
                roll, pitch, _ = np.asarray(plant.state.body.rpy).tolist()
                tilt = max(tilt, math.degrees(math.hypot(roll, pitch)))
                touches.step(output)
                output = controller.step((twist, 0.0, 0.0), dt, readings)
                touches.react(output)
                ahead = float(ground.ahead(*plant.state.body.position[:2]).real)
                furthest = max(furthest, ahead)
                named = named or any(limit.leg and "higher than" in str(limit.cause) for limit in output.limitations)
    failed = bool(controller.leg_failures.failed)
    if furthest > 0.1:
        return Outcome("passed", tilt, touches.noticed, failed)
    kind = f"{'named the leg' if named else 'said nothing'}, {'back' if ahead < furthest - BACK / 4 else 'stayed'}"
    return Outcome(kind, tilt, touches.noticed, failed)


def table(outcomes: dict[Job, Outcome]) -> str:
    """Return how often each robot did what, and what it noticed."""
    kinds = sorted({outcome.kind for outcome in outcomes.values()})
    lines = [
        f"| walk | {' | '.join(kinds)} | tilt | failed | stopped | noticed | after: median, 90 % |",
        f"|---|{'---|' * (len(kinds) + 5)}",
    ]
    for key in dict.fromkeys(job[:3] for job in outcomes):
        found = [outcome for job, outcome in outcomes.items() if job[:3] == key]
        counts = " | ".join(f"{sum(each.kind == kind for each in found)} of {len(found)}" for kind in kinds)
        stopped = [1e3 * time for each in found for time in each.noticed]
        times = sorted(time for time in stopped if not math.isnan(time))
        late = f"{median(times):.0f}, {times[math.ceil(0.9 * len(times)) - 1]:.0f} ms" if times else "-"
        tilt, failed = median(each.tilt for each in found), sum(each.failed for each in found)
        name = f"{key[0]}, {key[2]}, {key[1]}"
        lines.append(f"| {name} | {counts} | {tilt:.0f} deg | {failed} | {len(stopped)} | {len(times)} | {late} |")
    return "\n".join(lines)


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table."""
    jobs = [Job(*job) for job in itertools.product(asked.robots, SENSORS, OBSTACLES, EDGES, PACES)]
    return {"obstacles": table(dict(zip(jobs, measured(walk, jobs, asked.jobs), strict=True)))}


if __name__ == "__main__":
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), jobs=1)
