"""Benchmarks of joint loads: torques of a walk, and gait cycles of a batch of designs against Python loops."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from functools import partial
from typing import Any

# Must be imported before NumPy: it sets the number of threads.
from measure import Row, medians  # isort: split

import numpy as np

from tarsus import (
    Gait,
    Pose,
    Robot,
    compliant_loads,
    cycle_feet,
    cycle_torques,
    default_body_height,
    default_stance,
    inverse_kinematics,
    joint_loads,
    joint_torques,
    plan_walk,
    straight_path,
)
from tarsus.load.compliant.compliant_loads import RATE as COMPLIANT_RATE

__all__ = ["load_rows"]

DESIGNS, PHASES = 10_000, 32
LOOPED = 50
"""Number of designs in the loops; their times are scaled to the batch."""

STROKE = 0.06
MIN_SPEED_UP = 50


def load_rows(robot: Robot) -> Iterator[Row]:
    """Measure joint loads of a walk and of a batch of designs."""
    yield from walk_rows(robot)
    yield compliant_row(robot)
    yield from cycle_rows(robot)


def compliant_row(robot: Robot) -> Row:
    """Measure compliant statics of a walk of 1 m, without planning; a sample is one that is solved."""
    walk = plan_walk(robot, Gait.named("tripod"), straight_path(1.0))
    seconds = medians({"compliant": partial(compliant_loads, robot, walk)})["compliant"]
    samples = round(walk.duration * COMPLIANT_RATE) + 1
    each = seconds / samples
    return Row(
        what=f"compliant statics of a walk of 1 m ({samples} samples, {each * 1e3:.2f} ms each)",
        measured=f"{seconds:.2f} s",
        target="<= 0.5 s, 0.5 ms a sample",
        met=seconds <= 0.5 and each <= 5e-4,
    )


def walk_rows(robot: Robot) -> Iterator[Row]:
    """Measure the loads of a walk of 1 m at 100 Hz, without planning."""
    walk = plan_walk(robot, Gait.named("tripod"), straight_path(1.0))
    contestants = {
        name: partial(peak_torques, robot, walk, inertial=inertial)
        for name, inertial in (("with inertia", True), ("quasi-static", False))
    }
    for name, seconds in medians(contestants).items():
        yield Row(
            what=f"loads of a walk of 1 m at 100 Hz, {name} ({len(walk.time)} samples)",
            measured=f"{seconds * 1e3:.1f} ms",
            target="<= 100 ms",
            met=seconds <= 0.1,
        )


def peak_torques(robot: Robot, walk: Any, *, inertial: bool) -> object:
    """Return the peak torques, so that nothing is evaluated lazily."""
    return joint_loads(robot, walk, inertial=inertial).peak


def designs_of(robot: Robot) -> Robot:
    """Return designs with random link lengths."""
    scale = np.random.default_rng(4).uniform(0.95, 1.05, (3, DESIGNS, 1))
    return robot.replace(**{name: getattr(robot, name) * scale[i] for i, name in enumerate(("coxa", "femur", "tibia"))})


def by_steps(robot: Robot, gait: Gait, swing_height: float) -> object:
    """Return the torques of a design with the general functions, without `cycle_torques`."""
    body_height = default_body_height(robot)
    rest = default_stance(robot, body_height, swing_height=swing_height)
    phases = np.arange(PHASES) / PHASES
    feet, contacts = cycle_feet(gait, rest, (STROKE, 0.0, 0.0), swing_height=np.asarray(swing_height), phases=phases)
    body = Pose(position=(0, 0, body_height))
    angles = inverse_kinematics(robot, feet + np.array([0, 0, body_height]), body).angles
    return joint_torques(robot, angles, body, contacts)


def cycle_rows(robot: Robot) -> Iterator[Row]:
    """Measure a tripod cycle of a batch of designs in one call, against Python loops."""
    gait, swing_height, batch = Gait.named("tripod"), 0.03, designs_of(robot)
    singles = [batch.item((i,)) for i in range(LOOPED)]
    for single in singles:
        _ = single.geometry  # cached by every design
    times = medians(
        {
            "batch": lambda: cycle_torques(batch, gait, stroke=STROKE, swing_height=swing_height, phases=PHASES),
            "alone": lambda: [
                cycle_torques(one, gait, stroke=STROKE, swing_height=swing_height, phases=PHASES) for one in singles
            ],
            "steps": lambda: [by_steps(one, gait, swing_height) for one in singles],
        },
        rounds=7,
    )
    each = {name: seconds / (DESIGNS if name == "batch" else LOOPED) for name, seconds in times.items()}
    for name, loop in (("alone", "the same function"), ("steps", "the general functions")):
        ratio = each[name] / each["batch"]
        yield Row(
            what=f"torques of {DESIGNS} designs x {PHASES} phases of a tripod cycle, one call",
            measured=f"{1 / each['batch']:.0f} designs/s",
            compared=f"a loop with {loop}: {1 / each[name]:.0f} designs/s; {ratio:.0f} times as fast",
            target=f">= {MIN_SPEED_UP} times a loop",
            met=ratio >= MIN_SPEED_UP,
        )
    if importlib.util.find_spec("jax") is not None:
        yield jitted_row(robot, batch, gait, swing_height, each["batch"])


def jitted_row(robot: Robot, batch: Robot, gait: Gait, swing_height: float, numpy_time: float) -> Row:
    """Measure the same with `jax.jit` on the same core."""
    import jax

    jax.config.update("jax_enable_x64", True)

    def torques(coxa: Any, femur: Any, tibia: Any) -> Any:
        design = robot.replace(coxa=coxa, femur=femur, tibia=tibia)
        return cycle_torques(design, gait, stroke=STROKE, swing_height=swing_height, phases=PHASES).torques

    compiled = jax.jit(torques)
    arrays = [jax.numpy.asarray(getattr(batch, name)) for name in ("coxa", "femur", "tibia")]
    seconds = medians({"jit": lambda: compiled(*arrays).block_until_ready()}, rounds=3)["jit"] / DESIGNS
    return Row(
        what=f"torques of {DESIGNS} designs x {PHASES} phases of a tripod cycle, jax.jit",
        measured=f"{1 / seconds:.0f} designs/s",
        compared=f"NumPy: {1 / numpy_time:.0f} designs/s; {numpy_time / seconds:.2f} of it",
    )
