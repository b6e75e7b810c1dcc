"""Write the table of ground-measured.md of walks over rough ground in physics, felt and blind.

python docs/rough_ground.py --jobs 16 --seeds 10
python docs/rough_ground.py --cases felt blind --grounds flat blocks40 --robots strider --seeds 2 --print
"""

from __future__ import annotations

import argparse
import itertools
import math
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import tarsus
from page_tables import Several, measured, write_tables
from tarsus.simulation import SensorSuite, SimulatedPlant, terrain
from tarsus.simulation.sensors.suite import FootSwitch, Sensor

PAGE = Path(__file__).parent / "ground-measured.md"
ROBOTS = ("strider", "phantomx", "makeyourpet")
# Way that is commanded in each walk [m], and how near to the start the ground is level [m].
WAY, CLEAR = 1.2, 0.35
# A robot whose body is on the ground for longer has fallen [s]; time between two ticks [s].
LIES, TICK = 1.0, 0.01


def smooth(seed: int, height: float, length: float = 400) -> Any:
    return terrain.Smooth(amplitude=height / 1e3, wavelength=length / 1e3, clear=CLEAR, seed=seed)


def blocks(seed: int, height: float, size: float = 150) -> Any:
    return terrain.Blocks(rise=height / 1e3, size=size / 1e3, clear=CLEAR, seed=seed)


def step(_: int, height: float) -> Any:
    return terrain.Step(rise=height / 1e3)


def ramp(_: int, degrees: float, start: float = 0.5) -> Any:
    return terrain.Ramp(slope=math.radians(degrees), start=start)


GROUNDS: dict[str, Callable[[int], Any]] = {
    "flat": lambda _: terrain.Flat(),
    **{f"smooth{mm}": partial(smooth, height=mm) for mm in (40, 60, 100)},
    **{f"blocks{mm}": partial(blocks, height=mm) for mm in (40, 60, 100)},
    **{f"smooth{mm} long": partial(smooth, height=mm, length=1200) for mm in (60, 100)},
    **{f"blocks{mm} wide": partial(blocks, height=mm, size=300) for mm in (60, 100)},
    **{f"step{mm:+d}": partial(step, height=mm) for mm in (25, 40, -25, -40)},
    **{f"ramp{angle:+d}": partial(ramp, degrees=angle) for angle in (10, 20, 30, -10, -20)},
    "stairs": lambda _: terrain.Stairs(rise=0.035),
}
RANDOM = ("smooth", "blocks")


def switches(**faults: float) -> SensorSuite:
    """Return foot switches with faults, and an exact attitude."""
    return SensorSuite(contacts=FootSwitch(**faults), attitude=Sensor())


class Case(NamedTuple):
    """What a walk is made with."""

    sensors: Any = "ideal"
    servos: str = "catalogue"
    options: dict[str, Any] = {}  # noqa: RUF012 - never changed
    gait: str = ""  # that of the robot
    course: float = 0.0  # where it walks, from ahead to the left [deg]
    pace: float = 0.5  # share of the top speed
    stands: float = 0.0  # how long, before it walks [s]


NOT_ADAPTED = {
    "adaptation": tarsus.GroundAdaptation(
        swing_height=0.0, body_height=0.0, drawn_in=0.0, cycle_time=1.0, speed=1.0, catch_up=1.0
    )
}
CASES: dict[str, Case] = {
    "blind": Case(sensors="blind"),
    "felt": Case(),
    "felt, ideal servos": Case(servos="ideal"),
    "without levelling": Case(options={"levelling": None}),
    "without adaptation": Case(options=NOT_ADAPTED),
    "without odometry": Case(sensors=switches()),
}
# Those of the table on the page.
SHOWN = ("blind", "felt")
GAIT_CASES = {gait: Case(gait=gait) for gait in ("tetrapod", "ripple", "wave")}


class Outcome(NamedTuple):
    """What became of a walk: way over the commanded one, RMS tilt [deg], slip [m/m], the body, greatest tilt [deg]."""

    way: float
    tilt: float
    slip: float
    touched: bool
    fell: bool
    steepest: float


class Watch:
    """What befalls a robot: its tilts and how far it turns [rad], how long its body is on the ground [s], falls."""

    def __init__(self, plant: SimulatedPlant) -> None:
        self.tilts: list[float] = []
        self.turned, self.touched, self.fell, self._plant = 0.0, 0.0, False, plant
        self._lying, self._yaw = 0.0, float(plant.state.body.rpy[2])

    def look(self, dt: float) -> None:
        """Take note of a tick."""
        roll, pitch, yaw = np.asarray(self._plant.state.body.rpy).tolist()
        lies = dt * self._plant.state.body_touches
        self.tilts.append(math.hypot(roll, pitch))
        self.turned, self._yaw = self.turned + math.remainder(yaw - self._yaw, math.tau), yaw
        self.touched, self._lying = self.touched + lies, (self._lying + lies) * bool(lies)
        self.fell = self.fell or self._lying > LIES or self.tilts[-1] > math.pi / 4


def walk(job: tuple[str, str, str, int]) -> Outcome:
    """Return the outcome of one walk."""
    name, ground, key, seed = job
    robot, case = tarsus.load_robot(name), (CASES | GAIT_CASES)[key]
    gait = tarsus.Gait.named(case.gait or robot.gait.name)
    course = np.array([math.cos(math.radians(case.course)), math.sin(math.radians(case.course)), 0.0])
    speed = case.pace * tarsus.WalkController(robot, gait).top_speed(course.tolist())
    plant = SimulatedPlant(robot, terrain=GROUNDS[ground](seed), sensors=case.sensors, servos=case.servos, seed=seed)
    controller = tarsus.RobotController(robot, gait, **case.options)
    plant.start(controller.output)
    for _ in range(round(case.stands / TICK)):
        controller.step((0.0, 0.0, 0.0), TICK, plant.step(controller.output, TICK))
    return walked_on(plant, controller, speed * course, WAY / speed)


def walked_on(plant: SimulatedPlant, controller: tarsus.RobotController, twist: np.ndarray, time: float) -> Outcome:
    """Return the outcome of a straight walk, for so long, of a robot that has started."""
    speed, output, dt = float(np.linalg.norm(twist)), controller.output, TICK
    start, slip, watch, ticks = np.asarray(plant.state.body.position), 0.0, Watch(plant), round(time / dt)
    for _ in range(ticks):
        readings = plant.step(output, dt)
        watch.look(dt)
        slip += float(plant.state.slip_speeds.mean()) * dt
        if watch.fell:
            break
        output = controller.step(twist.tolist(), dt, readings)
    way = float((plant.state.body.position - start) @ twist) / speed
    return Outcome(
        way / (speed * dt * ticks),
        math.degrees(math.sqrt(np.mean(np.square(watch.tilts)))),
        slip / max(way, 1e-3),
        watch.touched > 0.0,
        watch.fell,
        math.degrees(max(watch.tilts)),
    )


def cell(found: list[Outcome]) -> str:
    """Return medians: way, tilt and slip, with how often the body touched the ground, and how often the robot fell."""
    way, tilt, slip = (float(np.median([getattr(each, name) for each in found])) for name in ("way", "tilt", "slip"))
    return f"{way:.2f}, {tilt:.1f}, {1000 * slip:.0f}{mishaps(found)}"


def mishaps(found: list[Outcome]) -> str:
    """Return how often the body touched the ground, and how often the robot fell."""
    counts = {name: sum(getattr(each, name) for each in found) for name in ("touched", "fell")}
    notes = [f"{count} of {len(found)} {name}" for name, count in counts.items() if count]
    return f" ({', '.join(notes)})" if notes else ""


def table(robot: str, grounds: list[str], cases: list[str], found: dict[tuple[str, str, str], list[Outcome]]) -> str:
    """Return the table of a robot: a row for each ground, a column for each case."""
    lines = [f"| {robot} | {' | '.join(cases)} |", f"|---|{'---|' * len(cases)}"]
    for ground in grounds:
        lines.append(f"| {ground} | {' | '.join(cell(found[robot, ground, case]) for case in cases)} |")
    return "\n".join(lines)


def walked(asked: argparse.Namespace, cases: Iterable[str]) -> dict[tuple[str, str, str], list[Outcome]]:
    """Return the outcomes of the walks of each robot over each ground in each case; several over random ground."""
    jobs = [
        (robot, ground, case, seed)
        for robot, ground, case in itertools.product(asked.robots, asked.grounds, cases)
        for seed in range(asked.seeds if ground.startswith(RANDOM) else 1)
    ]
    found: dict[tuple[str, str, str], list[Outcome]] = {}
    for (robot, ground, case, _), outcome in zip(jobs, measured(walk, jobs, asked.jobs), strict=True):
        found.setdefault((robot, ground, case), []).append(outcome)
    return found


def tables(asked: argparse.Namespace, name: str = "rough ground") -> dict[str, str]:
    """Measure, and return the table of that name."""
    found = walked(asked, asked.cases)
    return {name: "\n\n".join(table(robot, asked.grounds, asked.cases, found) for robot in asked.robots)}


if __name__ == "__main__":
    grounds, cases = Several(GROUNDS, choices=GROUNDS), Several(SHOWN, choices=CASES)
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), grounds=grounds, cases=cases, seeds=10, jobs=1)
