"""SitDown down: the feet in the air are set down, then the body is lowered straight onto its belly."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.joint_monitor import JointMonitor
from tarsus.kinematics.leg import forward_kinematics, leg_jacobian
from tarsus.robot.robot import Robot

__all__ = ["SitDown"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Time in which the body gets up to speed, and from there to rest [s].
_STARTING_TIME = 0.5
# How near to its height the body has arrived [m].
_ARRIVED = 1e-4
# How much slower than it would be the body is tried to be lowered, before it is left where it is.
_SHARES = (1.0, 0.5, 0.25)


class SitDown:
    """Lowers the body step by step.

    The angles go after the feet by the inverse of each leg's Jacobian: from the angles the legs have, whichever way
    their knees are bent, and to where they can't go on.

    Parameters
    ----------
    robot : Robot
        The robot.
    bounds : GuardBounds
        How fast, how far.
    joints : JointMonitor
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
        joints: JointMonitor,
        *,
        down: list[bool] | None,
        up: tuple[float, float, float],
    ) -> None:
        self._robot, self._bounds, self._joints = robot, bounds, joints
        self._slow = bounds.recovery * bounds.speed
        self._up = np.array(up)
        self._belly = float((_lowest_of_body(robot) @ self._up).min())
        # Where the feet are to be, and how high over the ground those are that are not on it.
        self._feet = self._points()[:, 3]
        heights = self._feet @ self._up
        standing = heights if down is None else heights[np.array(down)]
        self._ground = float(standing.mean()) if standing.size else math.inf
        self._in_air = np.zeros(robot.legs)
        if down is not None and standing.size:
            self._in_air = np.where(down, 0.0, heights - self._ground)
        self._speed = 0.0

    def step(self, dt: float) -> bool:
        """Send the joints to where the body is a little lower; return whether there was anywhere to send them.

        Parameters
        ----------
        dt : float
            The time step [s].
        """
        points = self._points()
        highest = float(np.abs(self._in_air).max())
        if highest > _ARRIVED:
            if self._move(points, -self._in_air / highest, highest, dt):
                self._in_air *= 1 - self._speed * dt / highest
                return True
            # A foot that can't be set down stays as high over the ground as it is.
            self._in_air, self._speed = np.zeros_like(self._in_air), 0.0
        if not self._move(points, np.ones(len(points)), self._height(points) - self._bounds.sit_height, dt):
            return False
        self._ground += self._speed * dt
        return True

    def _move(self, points: Floats, direction: Floats, remaining: float, dt: float) -> bool:
        """Move the feet in B along up, by shares of a speed, if anything remains and the bounds permit."""
        if remaining <= _ARRIVED:
            return False
        most = self._bounds.sit_speed
        gain = most / _STARTING_TIME
        fastest = min(self._speed + gain * dt, most, math.sqrt(2 * gain * remaining), remaining / dt)
        for speed in (share * fastest for share in _SHARES):
            feet = self._feet + (speed * dt * direction)[:, None] * self._up
            if self._send(feet - points[:, 3], dt):
                self._feet, self._speed = feet, speed
                return True
        return False

    def _send(self, miss: Floats, dt: float) -> bool:
        """Send the joints to where the feet are moved by `miss`, if the bounds permit."""
        now = self._angles()
        try:
            turn = np.linalg.solve(leg_jacobian(self._robot, now), miss[..., None])[..., 0]
        except np.linalg.LinAlgError:
            return False
        if not (np.abs(turn) <= self._slow * dt).all():
            return False
        angles: list[float] = (now + turn).ravel().tolist()
        if self._joints.within(angles) or self._joints.too_rash(angles, dt):
            return False
        self._joints.send(angles, dt)
        return True

    def _angles(self) -> Floats:
        return np.array(self._joints.angles).reshape(self._robot.legs, 3)

    def _points(self) -> Floats:
        points: Floats = forward_kinematics(self._robot, self._angles())
        return points

    def _height(self, points: Floats) -> float:
        """Return how high the lowest point of body and legs, but the feet, is over the ground."""
        lowest = min(self._belly, float((points[:, :3] @ self._up).min()))
        return lowest - self._ground


def _lowest_of_body(robot: Robot) -> Floats:
    """Return the points of B one of which is the body's lowest, however it is turned."""
    if robot.body_size is None:
        corners: Floats = np.asarray(robot.mount_position)
    else:
        corners = np.array(list(product((-0.5, 0.5), repeat=3))) * np.asarray(robot.body_size)
    return corners
