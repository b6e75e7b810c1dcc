"""How fast the joints may turn while the robot gets up and lies down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from tarsus.arrays import Array
from tarsus.errors import InputError
from tarsus.robot.joint_limits import STOPPING_TIME, joint_limits
from tarsus.robot.robot import Robot

__all__ = ["SERVO_SHARE", "JointRates"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

SERVO_SHARE = 0.5
"""What share of a servo's no-load speed its joint uses unless told otherwise."""


@dataclass(frozen=True, eq=False)
class JointRates:
    """The greatest speed and acceleration of every joint.

    Attributes
    ----------
    speed : array, shape (legs, 3)
        Greatest speed [rad/s].
    acceleration : array, shape (legs, 3)
        Greatest acceleration [rad/s^2].
    """

    speed: Floats
    acceleration: Floats

    @classmethod
    def of(cls, robot: Robot, joint_speed: Array | None = None, joint_acceleration: Array | None = None) -> Self:
        """Take what is given, and the servos' own for what is not.

        Parameters
        ----------
        robot : Robot
            A single robot.
        joint_speed : array, optional
            One number, one a joint ``(3,)`` or ``(legs, 3)`` [rad/s]; half of each servo's no-load speed where left
            out, as the walker knows it, `joint_limits`.
        joint_acceleration : array, optional
            The same shapes [rad/s^2]; the speed within 0.05 s where left out.

        Raises
        ------
        InputError
            If a shape is wrong, or a number is not finite and greater than 0.
        """
        shape = (robot.legs, 3)
        if joint_speed is None:
            joint_speed = SERVO_SHARE * joint_limits(robot, None, None)[0]
        speed = _positive("joint_speed", joint_speed, shape)
        if joint_acceleration is None:
            joint_acceleration = speed / STOPPING_TIME
        return cls(speed, _positive("joint_acceleration", joint_acceleration, shape))


def _positive(name: str, values: Array, shape: tuple[int, int]) -> Floats:
    """Return the numbers as a locked array of that shape."""
    try:
        array = np.array(np.broadcast_to(np.asarray(values, dtype=np.float64), shape))
    except (TypeError, ValueError):
        raise InputError(f"{name} is {values!r:.80}; expected a number, or numbers of shape (3,) or {shape}") from None
    if not (np.isfinite(array).all() and (array > 0).all()):
        raise InputError(f"{name} holds {array.min():g}; every number must be finite and greater than 0")
    array.setflags(write=False)
    return array
