"""Write the tables of how-true.md: all presets with masses, gaits and kinds of walk, in physics beside the plan."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np

from page_tables import write_tables
from tarsus.control.command import Command
from tarsus.control.compensated_plant import CompensatedPlant
from tarsus.control.loop.run import run
from tarsus.control.robot_controller import RobotController
from tarsus.control.walk_controller import WalkController
from tarsus.gait.gait import Gait
from tarsus.gait.path import BodyPath, curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.load.deflection import compensate_deflection
from tarsus.robot.file import list_robots, load_robot
from tarsus.robot.robot import Robot
from tarsus.simulation.simulated_plant import SimulatedPlant
from tarsus.simulation.truth.comparison import Truth, compare
from tarsus.simulation.truth.outcome import Outcome
from tarsus.simulation.truth.traced_plant import TracedPlant

PAGE = Path(__file__).parent / "how-true.md"
WALKS: dict[str, BodyPath] = {
    "straight": straight_path(0.3),
    "sideways": straight_path(0.3, math.pi / 2),
    "curve": curved_path(math.radians(40), (0.0, 0.4)),
    "turn": curved_path(math.radians(60)),
}
SIX_LEGGED = ("tripod", "tetrapod", "ripple", "wave")
SHARE = 0.95
HEADER = (
    "| robot | gait | straight | sideways | curve | turn | tilt | slip | coxa | femur | tibia |\n"
    "|---|---|---|---|---|---|---|---|---|---|---|\n"
)


def truths(robot: Robot, gait: str, kind: str) -> dict[str, Truth]:
    """Return all kinds of walk of a robot in physics."""
    plans = {name: plan_walk(robot, Gait.named(gait), path, rate=100.0) for name, path in WALKS.items()}
    if kind == "compensated":
        plans = {name: compensate_deflection(motion) for name, motion in plans.items()}
    servos = "ideal" if kind == "ideal" else "catalogue"
    return {name: compare(motion, servos=servos) for name, motion in plans.items()}


def row(robot: Robot, gait: str, kind: str) -> str:
    """Return a row of the table: ratios of the way and the turn, greatest tilt and slip, torques over statics."""
    found = truths(robot, gait, kind)
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


def table(kind: str) -> str:
    """Return the table of all presets with masses."""
    return HEADER + "".join(row(robot, gait, kind) for robot, gait in itertools.product(able_robots(), SIX_LEGGED))


def able_robots() -> list[Robot]:
    """Return the presets with six legs and masses."""
    robots = [load_robot(name) for name in list_robots()]
    return [robot for robot in robots if robot.has_masses and robot.legs == 6]


def fast_row(robot: Robot, gait: str) -> str:
    """Return a row of the table at 0.95 of the top speed of live walking: ratios of the way and the turn."""
    controller = WalkController(robot, Gait.named(gait))
    feet = np.asarray(controller.feet) * [1.0, 1.0, 0.0]
    cells: list[str] = []
    problems: list[str] = []
    for name, path in WALKS.items():
        longer = BodyPath(tuple(2 * np.asarray(path.displacement)))
        speed = SHARE * controller.top_speed(path.displacement) * float(path.travel(feet).max())
        plan = plan_walk(robot, Gait.named(gait), longer, speed=speed, cycle_time=controller.cycle_time, rate=100.0)
        outcome = compare(plan, servos="ideal").outcome
        problems += outcome.problems
        cells.append(f"{outcome.turn_ratio if name == 'turn' else outcome.way_ratio:.3f}")
    note = f" ({'; '.join(problems)})" if problems else ""
    return f"| {robot.name} | {gait} | {' | '.join(cells)} |{note}\n"


def fast_table() -> str:
    """Return the table at 0.95 of the top speed."""
    header = "| robot | gait | straight | sideways | curve | turn |\n|---|---|---|---|---|---|\n"
    return header + "".join(fast_row(robot, gait) for robot, gait in itertools.product(able_robots(), SIX_LEGGED))


def live_ratio(robot: Robot, gait: str, path: BodyPath, share: float, kind: str = "ideal") -> float:
    """Return the ratio of the way, or of the turn in place, of live walking at a share of the top speed."""
    controller = RobotController(robot, Gait.named(gait))
    walk = WalkController(robot, Gait.named(gait))
    speed = share * walk.top_speed(path.displacement)
    twist = tuple(speed * np.asarray(path.displacement))
    walked = max(2 * walk.cycle_time, 1 / speed)
    servos = "ideal" if kind == "ideal" else "catalogue"
    traced = TracedPlant(SimulatedPlant(robot, servos=servos, sensors="blind"))
    plant = CompensatedPlant(traced) if kind == "compensated" else traced
    commands = [(0.0, Command(twist=twist)), (walked, Command(twist=(0.0, 0.0, 0.0)))]
    run(controller, plant, commands, duration=walked + 1.5 * walk.cycle_time)
    outcome = Outcome.of(traced.trace)
    return outcome.turn_ratio if path == WALKS["turn"] else outcome.way_ratio


def live_row(robot: Robot, gait: str) -> str:
    """Return a row of the table of live walking: ratios at half the top speed and at 0.95 of it."""
    cells = [[f"{live_ratio(robot, gait, path, share):.3f}" for share in (0.5, SHARE)] for path in WALKS.values()]
    return f"| {robot.name} | {gait} | {' | '.join(', '.join(cell) for cell in cells)} |\n"


def live_table() -> str:
    """Return the table of live walking."""
    header = "| robot | gait | straight | sideways | curve | turn |\n|---|---|---|---|---|---|\n"
    return header + "".join(live_row(robot, gait) for robot, gait in itertools.product(able_robots(), SIX_LEGGED))


def soft_row(robot: Robot, gait: str) -> str:
    """Return a row of the table of live walking on servos of the catalogue: ratios without and with compensation."""
    kinds = ("catalogue", "compensated")
    cells = [[f"{live_ratio(robot, gait, path, 0.5, kind):.3f}" for kind in kinds] for path in WALKS.values()]
    return f"| {robot.name} | {gait} | {' | '.join(', '.join(cell) for cell in cells)} |\n"


def soft_table() -> str:
    """Return the table of live walking on servos of the catalogue."""
    header = "| robot | gait | straight | sideways | curve | turn |\n|---|---|---|---|---|---|\n"
    return header + "".join(
        soft_row(robot, gait) for robot, gait in itertools.product(able_robots(), ("tripod", "wave"))
    )


def tables(_: object) -> dict[str, str]:
    """Measure, and return the tables."""
    kinds = {kind: table(kind) for kind in ("ideal", "catalogue", "compensated")}
    return {"fast": fast_table(), "live": live_table(), "soft": soft_table(), **kinds}


if __name__ == "__main__":
    write_tables(__doc__, PAGE, tables)
