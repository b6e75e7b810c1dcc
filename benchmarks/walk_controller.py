"""Benchmarks of the walk controller: ticks with changing commands, guard, planning of rising; top speeds."""

from __future__ import annotations

import gc
import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

# Must be imported before NumPy: it sets the number of threads.
from measure import Row, felt_row, medians  # isort: split

import numpy as np

from tarsus import Gait, Robot, list_robots, load_robot
from tarsus.control.command import Command
from tarsus.control.readings import SensorReadings
from tarsus.control.safety import Guard
from tarsus.control.startup import stand_up
from tarsus.control.walk_controller import WalkController
from tarsus.kinematics.folded_pose import folded_pose

if TYPE_CHECKING:
    from jaxtyping import Float


__all__ = ["controller_rows", "speed_table", "top_speed"]

GAITS = ("tripod", "tetrapod", "ripple", "wave")
"""The gaits of six legs."""

TICKS = 100_000
RUNS = 5
"""Number of identical runs; a tick counts with its minimum, which excludes interference from other processes."""
DT = 0.02
ROUGH_TICKS, ROUGHNESS, CONTACT_TOLERANCE = 20_000, 0.004, 1e-4
"""Number of ticks on rough ground, its standard deviation [m], and the distance at which a foot has contact [m]."""
FELT_TICKS = 5_000
"""Number of ticks with readings."""
COMMAND_INTERVAL = 50
"""Ticks between changes of the twist; every fifth change also changes gait, body pose or other parameters."""

MEDIAN, WORST = 150e-6, 1e-3
DIRECTIONS = {"forward": (1.0, 0.0, 0.0), "sideways": (0.0, 1.0, 0.0), "turning": (0.0, 0.0, 1.0)}
PAGE = Path(__file__).parent.parent / "docs" / "walking-live.md"
BEGIN, END = "<!-- top speeds -->", "<!-- end -->"
EXCESSIVE_SPEED = 10.0
"""Commanded speed above the limits of every robot [m/s], [rad/s]."""


def controller_rows(robot: Robot) -> Iterator[Row]:
    """Measure the walk controller."""
    yield from tick_rows(robot)
    yield from felt_rows(robot)
    yield from rough_rows(robot)
    yield from guard_rows(robot)
    yield from rise_rows(robot)


@contextmanager
def control_loop() -> Iterator[None]:
    """Disable the garbage collector, as in a control loop."""
    gc.collect()
    gc.freeze()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
        gc.unfreeze()


def commands(rng: np.random.Generator, controller: WalkController) -> Iterator[Command]:
    """Yield commands that change each parameter in turn."""
    body_height, swing_height = float(controller.body.position[2]), controller.robot.gait.swing_height or 0.03
    changes: tuple[Callable[[], dict[str, Any]], ...] = (
        lambda: {"gait": str(rng.choice(list(GAITS)))},
        lambda: {"body": tuple(rng.uniform(-1, 1, 6) * (0.02, 0.02, 0.02, 0.1, 0.1, 0.1))},
        lambda: {
            "body_height": body_height * rng.uniform(0.9, 1.1),
            "swing_height": swing_height * rng.uniform(0.5, 1.2),
        },
        lambda: {"cycle_time": float(rng.uniform(1, 2)), "stance_width": float(rng.uniform(-0.01, 0.01))},
    )
    number = 0
    while True:
        twist = tuple(rng.uniform(-1, 1, 3) * (0.3, 0.3, 1.0))
        yield Command(twist=twist, **(changes[number // 5 % len(changes)]() if number % 5 == 0 else {}))
        number += 1


def ticks(robot: Robot, count: int, *, dt: float = DT, felt: bool = False) -> Float[np.ndarray, "..."]:
    """Return the processor time of each of a number of ticks, blind or with contacts, attitude and joint angles [s]."""
    controller = WalkController(robot, Gait.named("tripod"))
    command_stream = commands(np.random.default_rng(4), controller)
    times, command = np.empty(count), next(command_stream)
    with control_loop():
        for tick in range(count):
            if tick % COMMAND_INTERVAL == COMMAND_INTERVAL - 1:
                command = next(command_stream)
            readings = executed(controller) if felt else None
            start = time.thread_time_ns()
            controller.step(command, dt, readings)
            times[tick] = (time.thread_time_ns() - start) * 1e-9
    return times


def executed(controller: WalkController) -> SensorReadings:
    """Return what a robot measures that is where its controller has it."""
    roll, pitch, _ = np.asarray(controller.body.rpy).tolist()
    return SensorReadings(contacts=controller.contacts, attitude=(roll, pitch), joint_angles=controller.angles)


def tick_rows(robot: Robot) -> Iterator[Row]:
    """Measure the ticks of a walk with changing commands."""
    runs = np.array([ticks(robot, TICKS) for _ in range(RUNS)])
    times = runs.min(axis=0)
    what = (
        f"tick of the walk controller, {TICKS:,} ticks, a new command every {COMMAND_INTERVAL}, minimum of {RUNS} runs"
    )
    median, worst = float(np.median(times)), float(times.max())
    single = ", ".join(f"{np.median(run) * 1e6:.0f}" for run in runs)
    yield Row(
        what=f"{what}: median",
        measured=f"{median * 1e6:.0f} us",
        compared=f"single runs: {single} us",
        target=f"<= {MEDIAN * 1e6:.0f} us",
        met=median <= MEDIAN,
    )
    over = ", ".join(str(int((run > WORST).sum())) for run in runs)
    yield Row(
        what=f"{what}: worst",
        measured=f"{worst * 1e6:.0f} us",
        compared=f"over {WORST * 1e3:.0f} ms in single runs: {over}; 99.9 %: {np.quantile(times, 0.999) * 1e6:.0f} us",
        target=f"<= {WORST * 1e6:.0f} us",
        met=worst <= WORST,
    )


def felt_rows(robot: Robot) -> Iterator[Row]:
    """Measure ticks at 100 Hz with contacts, attitude and joint angles against blind ones, by turns."""
    what = f"tick at 100 Hz with contacts, attitude and joint angles, {FELT_TICKS:,} ticks"
    yield felt_row(what, lambda felt: ticks(robot, FELT_TICKS, dt=0.01, felt=felt).tolist(), runs=RUNS)


def rough_rows(robot: Robot) -> Iterator[Row]:
    """Measure the ticks of a walk over rough ground, with contacts and levelling."""
    rng, controller = np.random.default_rng(4), WalkController(robot, Gait.named("tripod"), levelling="level")
    times, command, ground = np.empty(ROUGH_TICKS), (0.0, 0.0, 0.0), np.zeros(robot.legs)
    with control_loop():
        for tick in range(ROUGH_TICKS):
            if tick % COMMAND_INTERVAL == 0:
                forward, left, turning = (rng.uniform(-1, 1, 3) * (0.3, 0.3, 1.0)).tolist()
                command, ground = (forward, left, turning), rng.normal(size=robot.legs) * ROUGHNESS
            readings = SensorReadings(contacts=contacts_on(controller, ground), attitude=(0.0, 0.0))
            start = time.thread_time_ns()
            controller.step(command, DT, readings=readings)
            times[tick] = (time.thread_time_ns() - start) * 1e-9
    yield Row(
        what=f"tick on ground {ROUGHNESS * 1e3:.0f} mm rough, with contacts, {ROUGH_TICKS:,} ticks: median",
        measured=f"{np.median(times) * 1e6:.0f} us",
        compared=f"99.9 %: {np.quantile(times, 0.999) * 1e6:.0f} us",
    )


def contacts_on(controller: WalkController, ground: Any) -> tuple[bool, ...]:
    """Return which feet touch a ground of the given height under each [m]."""
    return tuple((controller.feet[:, 2] <= ground + CONTACT_TOLERANCE).tolist())


def guard_rows(robot: Robot) -> Iterator[Row]:
    """Measure the guard's check of a tick, with contacts and body pose."""
    controller = WalkController(robot, Gait.named("tripod"))
    outputs = [(controller.step((0.1, 0.0, 0.2), DT), controller.contacts, controller.body) for _ in range(500)]
    guard = Guard(robot)
    for angles, contacts, body in outputs:
        guard.check(angles, DT, contacts, body)
    angles, contacts, body = outputs[-1]
    seconds = medians({"check": lambda: guard.check(angles, DT, contacts, body)}, loops=300)["check"]
    yield Row(what="guard's check of a tick", measured=f"{seconds * 1e6:.0f} us")


def rise_rows(robot: Robot) -> Iterator[Row]:
    """Measure the planning of rising from the folded pose."""
    angles = folded_pose(robot)
    seconds = medians({"rise": lambda: stand_up(robot, angles)}, rounds=5)["rise"]
    yield Row(what="planning of rising from the folded pose", measured=f"{seconds * 1e3:.0f} ms")


def top_speed(robot: Robot, gait: str, direction: str) -> float:
    """Return the top speed of a robot on level ground [m/s], [rad/s]."""
    controller = WalkController(robot, Gait.named(gait))
    twist = [EXCESSIVE_SPEED * speed for speed in DIRECTIONS[direction]]

    def walk(ticks: int) -> None:
        for _ in range(ticks):
            controller.step(twist, DT)

    walk(math.ceil(6 * controller.cycle_time / DT))
    before, begun = controller.place, controller.time
    walk(math.ceil(controller.cycle_time / DT))
    x, y, turned = np.subtract(controller.place, before) / (controller.time - begun)
    return float(turned if direction == "turning" else math.hypot(x, y))


def speed_table() -> str:
    """Return the table of top speeds of every preset and gait."""
    columns = ("forward (m/s)", "sideways (m/s)", "turning (rad/s)")
    lines = [
        f"| robot | gait | cycle (s) | {' | '.join(columns)} |",
        "|---|---|---|---|---|---|",
    ]
    for name in list_robots():
        robot = load_robot(name)
        for gait in GAITS:
            cycle = WalkController(robot, Gait.named(gait)).cycle_time
            reached = " | ".join(f"{top_speed(robot, gait, direction):.3f}" for direction in DIRECTIONS)
            lines.append(f"| {name} | {gait} | {cycle:.2f} | {reached} |")
    return "\n".join(lines)


def write_speeds() -> None:
    """Write the table of top speeds to docs/walking-live.md."""
    text = PAGE.read_text(encoding="utf-8")
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    PAGE.write_text(f"{text[:begin]}\n{speed_table()}\n{text[end:]}", encoding="utf-8")


if __name__ == "__main__":
    if "--write" in sys.argv[1:]:
        write_speeds()
    else:
        for row in controller_rows(load_robot("strider")):
            print(row.what, "|", row.measured, "|", row.compared, "|", row.target, "|", row.verdict)
