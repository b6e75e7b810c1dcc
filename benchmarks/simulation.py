"""Cost of physics: shares of MuJoCo, plant and controller in a simulated walk; steps of environments a second."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from typing import Any

import numpy as np

from measure import Row, felt_row
from tarsus import Command, RobotController, WalkController, load_robot
from tarsus.simulation import SimulatedPlant
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.environment import EPISODE_STEPS, WalkVectorEnv

__all__ = ["simulation_rows"]

TICKS, ROUNDS = 300, 5
STEPS, MANY = 1000, 64
MOST, MOST_ADDED = 1000 / 15, 0.4
"""Targets: processor time for a second of one robot [ms], and what the plant adds to MuJoCo's steps."""

FELT_TICKS = 900
"""Number of ticks of a walk in physics whose times are compared with those of a blind one."""

# What reading the clock twice takes [ns], taken off what is timed.
_CLOCK = 450


class _TimedEngine:
    """MuJoCo, with the time of its steps."""

    def __init__(self) -> None:
        self._mujoco = mujoco_module()
        self.spent, self.steps = 0, 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self._mujoco, name)

    def mj_step(self, model: Any, data: Any, steps: int) -> None:
        """Take physics steps."""
        start = time.thread_time_ns()
        self._mujoco.mj_step(model, data, steps)
        self.spent += time.thread_time_ns() - start - _CLOCK
        self.steps += 1


def _walk(sensors: str, *, speed: float = 0.05, ticks: int = TICKS) -> tuple[float, float, list[float]]:
    """Return the times of MuJoCo and of the plant around it in a walk, and of each tick of the controller [s]."""
    robot = load_robot("strider")
    controller, plant, engine = RobotController(robot), SimulatedPlant(robot, sensors=sensors), _TimedEngine()
    plant.start(controller.output)
    plant._mujoco = engine
    output, command, spent, times = controller.output, Command(twist=(speed, 0.0, 0.0)), 0, list[float]()
    for _ in range(ticks):
        start = time.thread_time_ns()
        readings = plant.step(output, 0.01)
        between = time.thread_time_ns()
        output = controller.step(command, 0.01, readings)
        spent += between - start
        times.append((time.thread_time_ns() - between) / 1e9)
    around = spent - engine.spent - 2 * _CLOCK * engine.steps
    return engine.spent / 1e9, around / 1e9, times


def _shares(sensors: str) -> tuple[float, float, float]:
    """Return the times of MuJoCo, of the plant around it and of the controller, for a second of walking [ms]."""
    physics, around, times = _walk(sensors)
    each = 1e3 / (TICKS / 100)
    return each * physics, each * around, each * sum(times)


def _felt_row() -> Row:
    """Measure ticks of a walk in physics at half the top speed, with all readings."""
    speed = 0.5 * WalkController(load_robot("strider")).top_speed((1, 0, 0))
    what = f"tick of the robot controller in physics, all ideal readings, {FELT_TICKS} ticks"
    return felt_row(
        what, lambda felt: _walk("ideal" if felt else "blind", speed=speed, ticks=FELT_TICKS)[2], runs=ROUNDS
    )


def _steps_a_second(envs: int, actions: str) -> float:
    """Return how many steps environments take in a second, altogether, on all cores; resets are not counted."""
    env = WalkVectorEnv(envs, max_episode_steps=EPISODE_STEPS, actions=actions)
    env.reset(seed=1)
    # With joint actions the robots stand, with residuals they walk.
    nothing, rounds = np.zeros((envs, *(env.single_action_space.shape or ()))), max(20, STEPS // envs)
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        for _ in range(rounds // ROUNDS):
            env.step(nothing)
        times.append((time.perf_counter() - start) / (rounds // ROUNDS))
    env.close()
    return envs / float(np.median(times))


def _environment_rows() -> Iterator[Row]:
    cores, threads = os.sched_getaffinity(0), os.cpu_count() or 1
    os.sched_setaffinity(0, range(threads))
    try:
        for actions in ("residual", "joint"):
            one = _steps_a_second(1, actions)
            yield Row(what=f"tarsus/Walk-v0, {actions} actions, 1 environment", measured=f"{one:.0f} steps/s")
            many = _steps_a_second(MANY, actions)
            yield Row(
                what=f"tarsus/Walk-v0, {actions} actions, {MANY} environments on {threads} threads",
                measured=f"{many:.0f} steps/s",
                compared=f"1 environment: {one:.0f} steps/s; {many / one:.1f} times as many",
            )
    finally:
        os.sched_setaffinity(0, cores)


def simulation_rows() -> Iterator[Row]:
    """Yield the rows."""
    yield from _environment_rows()
    yield _felt_row()
    for sensors in ("blind", "hobby", "smart"):
        physics, around, controller = np.median([_shares(sensors) for _ in range(ROUNDS)], axis=0).tolist()
        whole = physics + around + controller
        yield Row(
            what=f"a second of the strider in physics, {sensors}, 100 ticks",
            measured=f"{whole:.0f} ms",
            compared=f"MuJoCo {physics:.0f}, plant {around:.0f}, controller {controller:.0f} ms",
            target=f"at most {MOST:.0f} ms",
            met=whole <= MOST,
        )
        yield Row(
            what=f"the plant's own work, {sensors}",
            measured=f"{100 * around / physics:.0f} %",
            compared=f"MuJoCo's steps {physics:.0f} ms",
            target=f"at most {100 * MOST_ADDED:.0f} %",
            met=around <= MOST_ADDED * physics,
        )
