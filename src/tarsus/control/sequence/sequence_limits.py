"""Joint speeds and accelerations within which motion sequences are planned."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array
from tarsus.errors import InputError
from tarsus.robot.joint_limits import STOPPING_TIME, JointLimits, joint_limits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["SERVO_SPEED_FRACTION", "sequence_limits"]

SERVO_SPEED_FRACTION = 0.5
"""Default joint speed as a fraction of the servo's no-load speed."""


def sequence_limits(
    robot: Robot, joint_speed: Float[Array, "..."] | None = None, joint_acceleration: Float[Array, "..."] | None = None
) -> JointLimits:
    """Return the joint limits of a motion sequence; defaults come from the servos.

    Parameters
    ----------
    robot : Robot
        A single robot.
    joint_speed : array, optional
        Greatest joint speed: one number, one for each joint of a leg, shape (3,), or one for each joint, shape
        (legs, 3) [rad/s]. By default half of each servo's no-load speed.
    joint_acceleration : array, optional
        Greatest joint acceleration, in the same shapes [rad/s^2]. By default the speed is reached within 0.05 s.

    Raises
    ------
    InputError
        If a shape is wrong, or a number is not finite or not greater than 0.
    """
    shape = (robot.legs, 3)
    if joint_speed is None:
        joint_speed = SERVO_SPEED_FRACTION * joint_limits(robot, None, None).speed
    speed = _positive("joint_speed", joint_speed, shape)
    if joint_acceleration is None:
        joint_acceleration = speed / STOPPING_TIME
    return JointLimits(speed, _positive("joint_acceleration", joint_acceleration, shape))


def _positive(name: str, values: Float[Array, "*batch"], shape: tuple[int, int]) -> Float[np.ndarray, "legs 3"]:
    """Return positive numbers as a read-only array of the shape."""
    try:
        array = np.array(np.broadcast_to(np.asarray(values, dtype=np.float64), shape))
    except (TypeError, ValueError):
        raise InputError(f"{name} is {values!r:.80}; expected a number or an array of shape (3,) or {shape}") from None
    if not (np.isfinite(array).all() and (array > 0).all()):
        raise InputError(f"{name} contains {array.min():g}; every number must be finite and greater than 0")
    array.setflags(write=False)
    return array
