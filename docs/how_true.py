"""Write the tables of how-true.md: all presets with masses, gaits and kinds of walk, in physics beside the plan."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np

from tarsus.gait.gait import Gait
from tarsus.gait.path import BodyPath, curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.robot.file import list_robots, load_robot
from tarsus.robot.robot import Robot
from tarsus.simulation.truth.comparison import Truth, compare

PAGE = Path(__file__).parent / "how-true.md"
WALKS: dict[str, BodyPath] = {
    "straight": straight_path(0.3),
    "sideways": straight_path(0.3, math.pi / 2),
    "curve": curved_path(math.radians(40), (0.0, 0.4)),
    "turn": curved_path(math.radians(60)),
}
SIX_LEGGED = ("tripod", "tetrapod", "ripple", "wave")
HEADER = (
    "| robot | gait | straight | sideways | curve | turn | tilt | slip | coxa | femur | tibia |\n"
    "|---|---|---|---|---|---|---|---|---|---|---|\n"
)


def truths(robot: Robot, gait: str, servos: str) -> dict[str, Truth]:
    """Return all kinds of walk of a robot in physics."""
    return {
        name: compare(plan_walk(robot, Gait.named(gait), path, rate=100.0), servos=servos)
        for name, path in WALKS.items()
    }


def row(robot: Robot, gait: str, servos: str) -> str:
    """Return a row of the table: ratios of the way and the turn, greatest tilt and slip, torques over statics."""
    found = truths(robot, gait, servos)
    outcomes = {name: truth.outcome for name, truth in found.items()}
    problems = [problem for outcome in outcomes.values() for problem in outcome.problems]
    cells = [f"{outcomes[name].way_ratio:.3f}" for name in ("straight", "sideways", "curve")]
    cells.append(f"{outcomes['turn'].turn_ratio:.3f}")
    cells.append(f"{math.degrees(max(outcome.tilt for outcome in outcomes.values())):.1f} deg")
    cells.append(f"{1000 * np.mean([outcome.slip for outcome in outcomes.values()]):.0f} mm")
    for joint in range(3):
        peak = max(float(outcome.peak_torque[joint]) for outcome in outcomes.values())
        planned = max(float(truth.planned_peak[joint]) for truth in found.values())
        cells.append(f"{peak:.2f} / {planned:.2f}")
    note = f" ({'; '.join(problems)})" if problems else ""
    return f"| {robot.name} | {gait} | {' | '.join(cells)} |{note}\n"


def table(servos: str) -> str:
    """Return the table of all presets with masses."""
    robots = [load_robot(name) for name in list_robots()]
    able = [robot for robot in robots if robot.has_masses and robot.legs == 6]
    return HEADER + "".join(row(robot, gait, servos) for robot, gait in itertools.product(able, SIX_LEGGED))


def main() -> None:
    """Replace the tables on the page."""
    text = PAGE.read_text(encoding="utf-8")
    for servos in ("ideal", "catalogue"):
        before, start, rest = text.partition(f"<!-- table: {servos} -->\n")
        text = f"{before}{start}{table(servos)}<!-- end -->{rest.partition('<!-- end -->')[2]}"
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
