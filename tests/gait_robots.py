"""Robots and small helpers for the tests of the gait package."""

import functools

import numpy as np

from tarsus.robot.file import list_robots, load_robot
from tarsus.robot.robot import Robot

PRESETS = list_robots()
HEXAPOD_GAITS = ("tripod", "tetrapod", "ripple", "wave")
# Every preset with one gait, every gait with two presets.
ROBOTS_AND_GAITS = [(name, HEXAPOD_GAITS[number % len(HEXAPOD_GAITS)]) for number, name in enumerate(PRESETS)]


@functools.cache
def preset(name):
    return load_robot(name)


@functools.cache
def point_feet(name):
    """A preset whose feet are points: they stay in place while they stand, where balls roll."""
    return load_robot(name).replace(foot_radius=np.zeros(load_robot(name).legs))


def ring(legs, **changes):
    """A robot of `legs` like legs around a circle of 120 mm, every joint free in a wide range."""
    yaw = np.pi / legs + 2 * np.pi * np.arange(legs) / legs
    values = {
        "name": f"ring of {legs}",
        "leg_names": tuple(f"leg {i}" for i in range(legs)),
        "mount_position": 0.12 * np.stack([np.cos(yaw), np.sin(yaw), 0 * yaw], axis=-1),
        "mount_yaw": yaw,
        "coxa": np.full(legs, 0.05),
        "femur": np.full(legs, 0.08),
        "tibia": np.full(legs, 0.12),
        "limits": np.broadcast_to([[-1.5, 1.5], [-1.6, 1.6], [-2.8, 0.2]], (legs, 3, 2)),
        "link_mass": np.full((legs, 3), 0.05),
        "body_mass": 1.0,
    }
    return Robot(**{**values, **changes})


def in_heading_frame(motion):
    """Feet in the body's heading frame on the ground ``(n, legs, 3)``, by complex numbers."""
    x, y, _ = motion.body.position.T
    yaw = motion.body.rpy[:, 2]
    feet = motion.feet[..., 0] + 1j * motion.feet[..., 1]
    seen = (feet - (x + 1j * y)[:, None]) * np.exp(-1j * yaw)[:, None]
    return np.stack([seen.real, seen.imag, motion.feet[..., 2]], axis=-1)
