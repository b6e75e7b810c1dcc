"""The last motion before servos are released: the robot lowers its body to the ground."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.sequence import SequencePlayer
from tarsus.control.startup import sit_down
from tarsus.robot.joint_limits import joint_limits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["SITTING_TICK", "sitting_angles"]

SITTING_TICK = 0.02
"""Duration of a tick while the robot sits down [s]."""

# Share of the joints' greatest speed: slow, but the motion ends before an overheating servo switches itself off.
_SPEED = 0.25


def sitting_angles(robot: Robot, angles: Float[np.ndarray, "legs 3"]) -> Iterator[Float[np.ndarray, "legs 3"]]:
    """Yield joint angles, tick by tick, that lower the body to the ground from any pose.

    Parameters
    ----------
    robot : Robot
        The robot, with the limits of its calibration.
    angles : array, shape (legs, 3)
        Joint angles at the start [rad].

    Raises
    ------
    TarsusError
        If the legs can't do it, or the robot has fallen over.
    """
    low, high = np.asarray(robot.limits)[..., 0], np.asarray(robot.limits)[..., 1]
    speed = joint_limits(robot).speed * _SPEED
    player = SequencePlayer(sit_down(robot, np.clip(angles, low, high), joint_speed=speed))
    while not player.done:
        yield player.step(SITTING_TICK)
