"""Rows on the live walker: a tick while the commands change, the guard's check, planning to stand up; top speeds."""

from __future__ import annotations

import gc
import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

# Before NumPy is loaded: this one chooses the number of threads.
from measure import Row, medians  # isort: split

import numpy as np

from tarsus import GAITS, Gait, Robot, list_robots, load_robot
from tarsus.control.command import Command
from tarsus.control.readings import SensorReadings
from tarsus.control.safety import Guard
from tarsus.control.startup import folded_pose, stand_up
from tarsus.control.walk_controller import WalkController

__all__ = ["speed_table", "top_speed", "walker_rows"]

TICKS = 100_000
RUNS = 5
"""The same ticks so often, the same to the bit: what a tick takes each time is its own, what it takes once isn't."""
DT = 0.02
ROUGH_TICKS, ROUGH, TOUCH = 20_000, 0.004, 1e-4
"""Ticks on rough ground, how rough it is, and how near to it a foot touches [m]."""
NEW_WISH = 50
"""A new twist so many ticks after the last; every fifth time, how to walk changes too."""

MEDIAN, WORST = 150e-6, 1e-3
DIRECTIONS = {"forward": (1.0, 0.0, 0.0), "sideways": (0.0, 1.0, 0.0), "turning": (0.0, 0.0, 1.0)}
PAGE = Path(__file__).parent.parent / "docs" / "walking-live.md"
BEGIN, END = "<!-- top speeds -->", "<!-- end -->"
FAR = 10.0
"""More than any robot can do [m/s], [rad/s]."""


def walker_rows(robot: Robot) -> Iterator[Row]:
    """One robot that is walked live."""
    yield from tick_rows(robot)
    yield from rough_rows(robot)
    yield from guard_rows(robot)
    yield from rise_rows(robot)


@contextmanager
def control_loop() -> Iterator[None]:
    """Keep the garbage collector out, as a control loop does: what exists is frozen, and nothing is looked for."""
    gc.collect()
    gc.freeze()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
        gc.unfreeze()


def commands(rng: np.random.Generator, controller: WalkController) -> Iterator[Command]:
    """Yield commands that change everything in turn."""
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


def ticks(robot: Robot, count: int) -> np.ndarray[Any, Any]:
    """Return how long each of so many ticks takes [s], on the processor's clock."""
    controller = WalkController(robot, Gait.named("tripod"))
    asked = commands(np.random.default_rng(4), controller)
    times, command = np.empty(count), next(asked)
    with control_loop():
        for tick in range(count):
            if tick % NEW_WISH == NEW_WISH - 1:
                command = next(asked)
            start = time.thread_time_ns()
            controller.step(command, DT)
            times[tick] = (time.thread_time_ns() - start) * 1e-9
    return times


def tick_rows(robot: Robot) -> Iterator[Row]:
    """Every tick of a walk in which the commands change."""
    runs = np.array([ticks(robot, TICKS) for _ in range(RUNS)])
    times = runs.min(axis=0)
    what = (
        f"a tick of the live walker, {TICKS:,} of them, a new wish every {NEW_WISH}, each from the best of {RUNS} runs"
    )
    median, worst = float(np.median(times)), float(times.max())
    single = ", ".join(f"{np.median(run) * 1e6:.0f}" for run in runs)
    yield Row(
        what=f"{what}: median",
        measured=f"{median * 1e6:.0f} us",
        compared=f"in single runs {single} us",
        target=f"<= {MEDIAN * 1e6:.0f} us",
        met=median <= MEDIAN,
    )
    over = ", ".join(str(int((run > WORST).sum())) for run in runs)
    yield Row(
        what="the same: worst",
        measured=f"{worst * 1e6:.0f} us",
        compared=f"over {WORST * 1e3:.0f} ms in single runs: {over}; 99.9 %: {np.quantile(times, 0.999) * 1e6:.0f} us",
        target=f"<= {WORST * 1e6:.0f} us",
        met=worst <= WORST,
    )


def rough_rows(robot: Robot) -> Iterator[Row]:
    """Every tick of a walk over rough ground, which the feet feel, the body held level."""
    rng, controller = np.random.default_rng(4), WalkController(robot, Gait.named("tripod"), levelling="level")
    times, command, ground = np.empty(ROUGH_TICKS), (0.0, 0.0, 0.0), np.zeros(robot.legs)
    with control_loop():
        for tick in range(ROUGH_TICKS):
            if tick % NEW_WISH == 0:
                forward, left, turning = (rng.uniform(-1, 1, 3) * (0.3, 0.3, 1.0)).tolist()
                command, ground = (forward, left, turning), rng.normal(size=robot.legs) * ROUGH
            readings = SensorReadings(contacts=estimate(controller, ground), attitude=(0.0, 0.0))
            start = time.thread_time_ns()
            controller.step(command, DT, readings=readings)
            times[tick] = (time.thread_time_ns() - start) * 1e-9
    yield Row(
        what=f"a tick on ground {ROUGH * 1e3:.0f} mm rough, felt, {ROUGH_TICKS:,} of them: median",
        measured=f"{np.median(times) * 1e6:.0f} us",
        compared=f"99.9 %: {np.quantile(times, 0.999) * 1e6:.0f} us",
    )


def estimate(controller: WalkController, ground: Any) -> tuple[bool, ...]:
    """Return which feet touch a ground that is so high under each [m]."""
    return tuple((controller.feet[:, 2] <= ground + TOUCH).tolist())


def guard_rows(robot: Robot) -> Iterator[Row]:
    """The guard's check of a tick, with contacts and the body."""
    controller = WalkController(robot, Gait.named("tripod"))
    seen = [(controller.step((0.1, 0.0, 0.2), DT), controller.contacts, controller.body) for _ in range(500)]
    guard = Guard(robot)
    for angles, contacts, body in seen:
        guard.check(angles, DT, contacts, body)
    angles, contacts, body = seen[-1]
    seconds = medians({"check": lambda: guard.check(angles, DT, contacts, body)}, loops=300)["check"]
    yield Row(what="the guard's check of a tick", measured=f"{seconds * 1e6:.0f} us")


def rise_rows(robot: Robot) -> Iterator[Row]:
    """Planning to stand up from the folded pose."""
    angles = folded_pose(robot)
    seconds = medians({"rise": lambda: stand_up(robot, angles)}, rounds=5)["rise"]
    yield Row(what="planning to stand up from the folded pose", measured=f"{seconds * 1e3:.0f} ms")


def top_speed(robot: Robot, gait: str, direction: str, *, feeling: bool = False) -> float:
    """Return the speed that a robot reaches when more is asked of it [m/s], [rad/s]; on level ground, felt or not."""
    controller = WalkController(robot, Gait.named(gait))
    twist = [FAR * speed for speed in DIRECTIONS[direction]]

    def walk(ticks: int) -> None:
        for _ in range(ticks):
            controller.step(twist, DT, readings=SensorReadings(contacts=estimate(controller, 0.0)) if feeling else None)

    walk(math.ceil(6 * controller.cycle_time / DT))
    before, begun = controller.place, controller.time
    walk(math.ceil(controller.cycle_time / DT))
    x, y, turned = np.subtract(controller.place, before) / (controller.time - begun)
    return float(turned if direction == "turning" else math.hypot(x, y))


def speed_table() -> str:
    """Return the top speeds of every preset and gait, as the page on live walking shows them."""
    lines = [
        "| robot | gait | cycle (s) | forward (m/s) | sideways (m/s) | turning (rad/s) | forward, feeling (m/s) |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in list_robots():
        robot = load_robot(name)
        for gait in GAITS:
            cycle = WalkController(robot, Gait.named(gait)).cycle_time
            reached = " | ".join(f"{top_speed(robot, gait, direction):.3f}" for direction in DIRECTIONS)
            feeling = top_speed(robot, gait, "forward", feeling=True)
            lines.append(f"| {name} | {gait} | {cycle:.2f} | {reached} | {feeling:.3f} |")
    return "\n".join(lines)


def write_speeds() -> None:
    """Write the table of top speeds to the page on live walking."""
    text = PAGE.read_text(encoding="utf-8")
    begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    PAGE.write_text(f"{text[:begin]}\n{speed_table()}\n{text[end:]}", encoding="utf-8")


if __name__ == "__main__":
    if "--write" in sys.argv[1:]:
        write_speeds()
    else:
        for row in walker_rows(load_robot("strider")):
            print(row.what, "|", row.measured, "|", row.compared, "|", row.target, "|", row.verdict)
