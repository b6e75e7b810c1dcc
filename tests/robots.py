"""Robots to test the kinematics with: a plain hexapod, random ones, and strategies that draw them."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import strategies as st

from tarsus.robot.robot import Robot

RING = ("LF", "LM", "LR", "RR", "RM", "RF")
PLAIN_LIMITS = np.deg2rad([[-60, 60], [-80, 100], [-160, 10]])
FULL_TURN = np.array([[-np.pi, np.pi]] * 3)


def plain_hexapod(**changes: Any) -> Robot:
    """Six equal legs of 68, 98 and 181 mm on a circle of 86 mm."""
    yaw = np.deg2rad([30.0, 90, 150, -150, -90, -30])
    numbers: dict[str, Any] = {
        "name": "plain",
        "leg_names": RING,
        "mount_position": 0.086 * np.stack([np.cos(yaw), np.sin(yaw), 0 * yaw], axis=-1),
        "mount_yaw": yaw,
        "coxa": np.full(6, 0.068),
        "femur": np.full(6, 0.098),
        "tibia": np.full(6, 0.181),
        "limits": np.tile(PLAIN_LIMITS, (6, 1, 1)),
    }
    return Robot(**(numbers | changes))


def random_robot(
    rng: np.random.Generator, *, legs: int = 6, sideways: float = 0.03, limits: str = "random", equal: bool = False
) -> Robot:
    """A robot whose every leg differs.

    `sideways` is the most that a femur axis is off the coxa axis to the side [m]; `limits` is "random", "full" (whole
    turns) or "up" (whole turns of coxa and femur, the tibia in the knee-up branch); `equal`: femurs as long as tibias.
    """
    yaw = np.linspace(0, 2 * np.pi, legs, endpoint=False) + rng.uniform(-0.3, 0.3, legs)
    radius = rng.uniform(0.03, 0.15, legs)
    mounts = np.stack([radius * np.cos(yaw), radius * np.sin(yaw), rng.uniform(-0.03, 0.03, legs)], axis=-1)
    femur = rng.uniform(0.03, 0.2, legs)
    return Robot(
        name="random",
        leg_names=tuple(f"leg {i}" for i in range(legs)),
        mount_position=mounts,
        mount_yaw=yaw + rng.uniform(-0.4, 0.4, legs),
        coxa=rng.uniform(0, 0.1, legs) * (rng.random(legs) > 0.15),
        femur=femur,
        tibia=femur if equal else rng.uniform(0.03, 0.25, legs),
        femur_axis_offset=np.stack(
            [rng.uniform(-1, 1, legs) * sideways * (rng.random(legs) > 0.3), rng.uniform(-0.03, 0.03, legs)], axis=-1
        ),
        limits=random_limits(rng, legs, limits),
    )


def random_limits(rng: np.random.Generator, legs: int, kind: str) -> np.ndarray:
    if kind == "random":
        limits = np.empty((legs, 3, 2))
        limits[:, 0] = np.stack([rng.uniform(-2.5, 0.3, legs), rng.uniform(0.4, 2.5, legs)], axis=-1)
        limits[:, 1] = np.stack([rng.uniform(-1.8, 0.2, legs), rng.uniform(0.3, 2.2, legs)], axis=-1)
        limits[:, 2] = np.stack([rng.uniform(-np.pi, -1.0, legs), rng.uniform(-0.9, 1.0, legs)], axis=-1)
        return limits
    full = np.tile(FULL_TURN, (legs, 1, 1))
    if kind == "up":
        full[:, 2, 1] = 0.0
    return full


def random_angles(rng: np.random.Generator, robot: Robot, batch: tuple[int, ...] = ()) -> np.ndarray:
    """Angles drawn evenly within the limits."""
    low, high = robot.limits[..., 0], robot.limits[..., 1]
    shape = np.broadcast_shapes((*batch, robot.legs, 3), low.shape)
    return low + rng.random(shape) * (high - low)


def seeds() -> st.SearchStrategy[int]:
    """Seeds for the random generator, so that a failing robot can be made again."""
    return st.integers(0, 2**32 - 1)


@st.composite
def robots(draw: st.DrawFn, *, legs: st.SearchStrategy[int] | None = None, **kinds: Any) -> Robot:
    """Random robots."""
    count = draw(legs if legs is not None else st.sampled_from([4, 5, 6, 8]))
    return random_robot(np.random.default_rng(draw(seeds())), legs=count, **kinds)


def edge_angles(rng: np.random.Generator, robot: Robot, batch: tuple[int, ...] = ()) -> np.ndarray:
    """Angles within the limits of which about half are at a limit."""
    low, high = np.moveaxis(robot.limits, -1, 0)
    inside = random_angles(rng, robot, batch)
    pick = rng.integers(0, 4, inside.shape)
    return np.where(pick == 0, low, np.where(pick == 1, high, inside))


def front(robot: Robot, angles: np.ndarray) -> np.ndarray:
    """How far in front of the coxa axis each foot is, in its leg's plane [m]."""
    return robot.coxa + robot.femur * np.cos(angles[..., 1]) + robot.tibia * np.cos(angles[..., 1:].sum(-1))
