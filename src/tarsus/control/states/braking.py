"""Braking: joints in motion come to rest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.arrays import read_only
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Braking"]

# Fraction of the joints' acceleration with which they lose the speed that they have.
_SHARE = 0.8


class Braking:
    """Joints that lose the speed that they have at constant deceleration, before their limits.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles, speeds : array, shape (legs, 3)
        Joint angles [rad] and speeds [rad/s] at the start.
    acceleration : array
        Greatest accelerations of the joints, of which the least counts [rad/s^2].

    Attributes
    ----------
    duration : float
        Time until all joints are at rest [s].
    """

    def __init__(
        self, robot: Robot, angles: Float[np.ndarray, "legs 3"], speeds: Float[np.ndarray, "legs 3"], acceleration: Any
    ) -> None:
        self._angles, self._speeds = angles, speeds
        low, high = np.moveaxis(np.asarray(robot.limits), -1, 0)
        room = np.where(speeds > 0, high - angles, angles - low).clip(0.0)
        stopping = np.abs(speeds) / (_SHARE * float(np.min(acceleration)))
        self._stopping = np.minimum(stopping, 2 * room / np.abs(speeds).clip(1e-9)).clip(1e-9)
        self.duration = float(self._stopping.max())

    def at(self, time: float) -> Float[np.ndarray, "legs 3"]:
        """Return the joint angles at a time after the start [rad]: array, shape (legs, 3), read-only."""
        share = np.minimum(time / self._stopping, 1.0)
        return read_only(self._angles + self._speeds * self._stopping * share * (1 - share / 2))
