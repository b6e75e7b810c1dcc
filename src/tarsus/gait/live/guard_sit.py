"""Sitting down: the body is lowered straight onto its belly, every foot staying where it is over the ground."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np

from tarsus.gait.live.guard_bounds import GuardBounds
from tarsus.gait.live.guard_joints import JointTrack
from tarsus.kinematics.leg import forward_kinematics, leg_jacobian
from tarsus.robot.robot import Robot

__all__ = ["Sitting"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Time in which the body gets up to speed, and from there to rest [s].
_STARTING_TIME = 0.5
# How near to its height the body has arrived [m].
_ARRIVED = 1e-4
# How much slower than it would be the body is tried to be lowered, before it is left where it is.
_SHARES = (1.0, 0.5, 0.25)


class Sitting:
    """Lowers the body step by step.

    The angles go after the feet by the inverse of each leg's Jacobian: from the angles the legs have, whichever way
    their knees are bent, and to where they can't go on.

    Parameters
    ----------
    robot : Robot
        The robot.
    bounds : GuardBounds
        How fast, how far.
    joints : JointTrack
        The joints, at rest.
    down : list of bool or None
        Which feet are on the ground; None for all.
    up : tuple of float
        Direction of up in B.
    """

    def __init__(
        self,
        robot: Robot,
        bounds: GuardBounds,
        joints: JointTrack,
        *,
        down: list[bool] | None,
        up: tuple[float, float, float],
    ) -> None:
        self._robot, self._bounds, self._joints = robot, bounds, joints
        self._shape = (robot.legs, 3)
        self._slow = bounds.recovery * bounds.speed
        self._feet = self._points()[:, 3]
        standing = self._feet[np.ones(robot.legs, bool) if down is None else np.array(down)]
        self._up = np.array(up)
        self._ground = float((standing @ self._up).mean()) if standing.size else math.inf
        self._belly = float((_lowest_of_body(robot) @ self._up).min())
        self._lowered = 0.0
        self._speed = 0.0

    def step(self, dt: float) -> bool:
        """Send the joints to where the body is a little lower; return whether there was anywhere to send them.

        Parameters
        ----------
        dt : float
            The time step [s].
        """
        points = self._points()
        remaining = self._height(points) - self._bounds.sit_height
        if remaining <= _ARRIVED:
            return False
        most = self._bounds.sit_speed
        gain = most / _STARTING_TIME
        speed = min(self._speed + gain * dt, most, math.sqrt(2 * gain * remaining), remaining / dt)
        return any(self._lower(points[:, 3], share * speed, dt) for share in _SHARES)

    def _lower(self, feet: Floats, speed: float, dt: float) -> bool:
        """Lower the body at a speed if the joints' bounds permit."""
        lowered = self._lowered + speed * dt
        miss = self._feet + lowered * self._up - feet
        try:
            turn = np.linalg.solve(leg_jacobian(self._robot, self._angles()), miss[..., None])[..., 0]
        except np.linalg.LinAlgError:
            return False
        if not (np.abs(turn) <= self._slow * dt).all():
            return False
        angles: list[float] = (self._angles() + turn).ravel().tolist()
        if self._joints.within(angles) or self._joints.too_rash(angles, dt):
            return False
        self._joints.send(angles, dt)
        self._lowered, self._speed = lowered, speed
        return True

    def _angles(self) -> Floats:
        return np.array(self._joints.angles).reshape(self._shape)

    def _points(self) -> Floats:
        points: Floats = forward_kinematics(self._robot, self._angles())
        return points

    def _height(self, points: Floats) -> float:
        """Return how high the lowest point of body and legs, but the feet, is over the ground."""
        lowest = min(self._belly, float((points[:, :3] @ self._up).min()))
        return lowest - self._ground - self._lowered


def _lowest_of_body(robot: Robot) -> Floats:
    """Return the points of B one of which is the body's lowest, however it is turned."""
    if robot.body_size is None:
        corners: Floats = np.asarray(robot.mount_position)
    else:
        corners = np.array(list(product((-0.5, 0.5), repeat=3))) * np.asarray(robot.body_size)
    return corners
