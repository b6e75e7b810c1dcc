"""Greatest speed and acceleration of each joint, from the data of its servo."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.arrays import Array, read_only
from tarsus.errors import InputError
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["STOPPING_TIME", "UNKNOWN_SPEED", "JointLimits", "joint_limits", "per_joint", "servo_speeds"]

UNKNOWN_SPEED = 5.0
"""Speed limit of a joint whose servo or servo speed is unknown [rad/s]: 60 deg in 0.21 s, as a slow hobby servo."""

STOPPING_TIME = 0.05
"""Default time in which a joint reaches its speed limit from rest, or stops from it [s]."""


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


def joint_limits(
    robot: Robot,
    speed: Float[Array, "..."] | None = None,
    acceleration: Float[Array, "..."] | None = None,
    *,
    share: float = 1.0,
) -> JointLimits:
    """Return the greatest speed and acceleration of each joint.

    Parameters
    ----------
    robot : Robot
        A single robot.
    speed : array, optional
        One number for all joints, one for each joint of a leg, shape (3,), or one for each joint, shape (legs, 3)
        [rad/s]. Default: the no-load speed of each servo, 5 rad/s where that is unknown, times `share`.
    acceleration : array, optional
        In the same shapes [rad/s^2]. Default: that which reaches the speed limit in 0.05 s.
    share : float
        Share of the servos' no-load speed that is used by default.

    Raises
    ------
    InputError
        If a shape is wrong, or a number is not finite or not greater than 0.
    """
    if speed is None:
        speed = share * np.array([[found or UNKNOWN_SPEED for found in row] for row in servo_speeds(robot)])
    speeds = per_joint("joint_speed", speed, robot.legs)
    accelerations = speeds / STOPPING_TIME if acceleration is None else acceleration
    return JointLimits(speeds, per_joint("joint_acceleration", accelerations, robot.legs))


def per_joint(name: str, values: Float[Array, "..."], legs: int) -> Float[np.ndarray, "n 3"]:
    """Return positive numbers as a read-only array, one for each joint.

    Parameters
    ----------
    name : str
        Their name in messages.
    values : array
        One number for all joints, one for each joint of a leg, shape (3,), or one for each joint, shape (legs, 3).
    legs : int
        Number of legs.

    Raises
    ------
    InputError
        If the shape is wrong, or a number is not finite or not greater than 0.
    """
    try:
        array = np.array(np.broadcast_to(np.asarray(values, dtype=np.float64), (legs, 3)))
    except (TypeError, ValueError):
        raise InputError(
            f"{name} is {values!r:.80}; expected a number or an array of shape (3,) or {(legs, 3)}"
        ) from None
    if not (np.isfinite(array).all() and (array > 0).all()):
        raise InputError(f"{name} contains {array.min():g}; every number must be finite and greater than 0")
    return read_only(array)
