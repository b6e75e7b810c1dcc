"""Greatest speed and acceleration of each joint, from the data of its servo."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["STOPPING_TIME", "UNKNOWN_SPEED", "JointLimits", "joint_limits", "servo_speeds"]

UNKNOWN_SPEED = 5.0
"""Speed limit of a joint whose servo, or its speed, is unknown [rad/s]: 60 deg in 0.21 s, as of a slow hobby servo."""

STOPPING_TIME = 0.05
"""Time in which a joint reaches its speed limit from rest, or stops from there, by default [s]."""


class JointLimits(NamedTuple):
    """Limits of the joints' motion.

    Attributes
    ----------
    speed : array, shape (legs, 3)
        Greatest speed of each joint [rad/s].
    acceleration : array, shape (legs, 3)
        Greatest acceleration of each joint [rad/s^2].
    """

    speed: Float[np.ndarray, "legs 3"]
    acceleration: Float[np.ndarray, "legs 3"]


def servo_speeds(robot: Robot) -> list[list[float | None]]:
    """Return the no-load speed of each joint's servo, by leg; None where it is unknown [rad/s].

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    return [[(servo.no_load_speed or None) if servo else None for servo in row] for row in robot.servos]


def joint_limits(robot: Robot, speed: float | None = None, acceleration: float | None = None) -> JointLimits:
    """Return the greatest speed and acceleration of each joint.

    Parameters
    ----------
    robot : Robot
        A single robot.
    speed : float, optional
        For all joints [rad/s]. Default: the no-load speed of each servo, 5 rad/s where that is unknown.
    acceleration : float, optional
        For all joints [rad/s^2]. Default: that which reaches the speed limit in 0.05 s.
    """
    known = [[found or UNKNOWN_SPEED for found in row] for row in servo_speeds(robot)]
    speeds = np.array(known) if speed is None else np.full((robot.legs, 3), float(speed))
    accelerations = speeds / STOPPING_TIME if acceleration is None else np.full((robot.legs, 3), float(acceleration))
    return JointLimits(speeds, accelerations)
