"""Write the table of cross slopes of ground-measured.md: walks on slopes that are not ahead of the body, in physics.

python docs/cross_slopes.py --jobs 2
python docs/cross_slopes.py --robots strider --print
"""

from __future__ import annotations

import argparse
import itertools
import math
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from page_tables import Several, measured, write_tables
from rough_ground import CASES, GROUNDS, PAGE, ROBOTS, Case, Outcome, mishaps, walk
from tarsus.simulation import terrain
from tarsus.simulation.engine import mujoco_module

# Of the slopes [deg], where those begin that robots walk onto, and how far those reach on which they start [m].
SLOPES, EDGE, FAR = (10, 15, 20), 0.4, 3.0
# Shares of the top speed.
PACES = (0.4, 0.5, 0.6)
# How long a robot stands until it is level, on a slope on which it starts [s].
STANDS = 3.0
# Course and direction of the slope, from ahead to the left [deg], its sign, and whether the robot starts on it.
WALKS = {
    "sideways up": (90, 90, 1, False),
    "sideways down": (90, 90, -1, False),
    "at 45 deg up": (45, 45, 1, False),
    "ahead, slope at 45 deg": (0, 45, 1, False),
    "sideways up, started on it": (90, 90, 1, True),
    "ahead along it, started on it": (0, 90, 1, True),
}


@dataclass(frozen=True)
class Turned:
    """Ground turned to the left about the origin, by an angle [rad]."""

    ground: Any
    angle: float

    @property
    def friction(self) -> float:
        """Coefficient of friction."""
        return float(self.ground.friction)

    def height(self, x: Any, y: Any) -> np.ndarray:
        """Return the height of the ground [m]."""
        place = (np.asarray(x) + 1j * np.asarray(y)) * np.exp(-1j * self.angle)
        return np.asarray(self.ground.height(place.real, place.imag))

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model."""
        known = len(spec.worldbody.geoms)
        self.ground.add_to(spec)
        turn = np.array([math.cos(self.angle / 2), 0.0, 0.0, math.sin(self.angle / 2)])
        for geom in spec.worldbody.geoms[known:]:
            place, turned = complex(*geom.pos[:2]) * np.exp(1j * self.angle), np.empty(4)
            mujoco_module().mju_mulQuat(turned, turn, geom.quat)
            geom.pos, geom.quat = (place.real, place.imag, geom.pos[2]), turned


def slope(_: int, degrees: float, turned: float, on_it: bool) -> Turned:
    """Return a ramp that rises in a direction [deg], and on which the robot starts or not."""
    start, length = (-FAR, 2 * FAR) if on_it else (EDGE, FAR)
    return Turned(terrain.Ramp(slope=math.radians(degrees), start=start, length=length), math.radians(turned))


GROUNDS.update(
    {
        f"{name}, {degrees}": partial(slope, degrees=sign * degrees, turned=turned, on_it=on_it)
        for name, (_, turned, sign, on_it) in WALKS.items()
        for degrees in SLOPES
    }
)
CASES.update(
    {
        f"{name}, {pace}": Case(course=course, pace=pace, stands=STANDS if on_it else 0.0)
        for name, (course, _, _, on_it) in WALKS.items()
        for pace in PACES
    }
)


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table."""
    places = list(itertools.product(asked.robots, WALKS, SLOPES))
    jobs = [(robot, f"{name}, {degrees}", f"{name}, {pace}", 0) for robot, name, degrees in places for pace in PACES]
    found = measured(walk, jobs, asked.jobs)
    outcomes = {place: [next(found) for _ in PACES] for place in places}
    lines = [f"| walk | {' | '.join(f'{degrees} deg' for degrees in SLOPES)} |", f"|---|{'---|' * len(SLOPES)}"]
    for robot, name in itertools.product(asked.robots, WALKS):
        shown = " | ".join(cell(outcomes[robot, name, degrees]) for degrees in SLOPES)
        lines.append(f"| {robot}, {name} | {shown} |")
    return {"cross slopes": "\n".join(lines)}


def cell(found: list[Outcome]) -> str:
    """Return the least and the greatest way, and the greatest tilt, with how often bodies touched and robots fell."""
    ways = sorted(round(each.way, 2) + 0.0 for each in found)  # no -0.00
    return f"{ways[0]:.2f} to {ways[-1]:.2f}, {max(each.steepest for each in found):.0f}{mishaps(found)}"


if __name__ == "__main__":
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), jobs=1)
