"""Lowering of a robot whose commands are rejected: swing feet are set down, then the body is lowered vertically."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.feet_monitor import FeetMonitor
from tarsus.control.safety.joint_monitor import JointMonitor
from tarsus.kinematics.leg import forward_kinematics, leg_jacobian
from tarsus.kinematics.rest import CORNERS
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["SitDown"]

# Time to accelerate to the sitting speed and to decelerate from it [s].
_ACCELERATION_TIME = 0.5
# Position tolerance at the end of a motion [m].
_TOLERANCE = 1e-4
# Fractions of the planned speed to try in turn before the motion ends.
_SPEED_FRACTIONS = (1.0, 0.5, 0.25)


class SitDown:
    """Lowers the body step by step.

    The joint angles follow the feet by the inverse Jacobian of each leg. This keeps to the current one of the solutions
    of inverse kinematics, and the motion ends where a leg cannot follow.

    Parameters
    ----------
    robot : Robot
        A single robot.
    bounds, joints : GuardBounds, JointMonitor
        The guard's bounds; the joints, at rest.
    feet : FeetMonitor
        The feet in stance, all of them where contacts were not given; the upward direction.
    """

    def __init__(self, robot: Robot, bounds: GuardBounds, joints: JointMonitor, feet: FeetMonitor) -> None:
        self._robot, self._bounds, self._joints = robot, bounds, joints
        self._up = np.array(feet.up)
        # Points of the body in B that include its lowest point in any attitude.
        corners = robot.mount_position if robot.body_size is None else CORNERS * robot.body_size
        self._underside = float((corners @ self._up).min())
        # Commanded feet in B, and the heights of the swing feet over the ground.
        self._feet = self._points()[:, 3]
        heights = self._feet @ self._up
        stands = np.ones(robot.legs, dtype=bool) if feet.stance is None else np.array(feet.stance)
        self._ground = float(heights[stands].mean()) if stands.any() else math.inf
        self._swing_heights = np.where(stands, 0.0, heights - self._ground) if stands.any() else np.zeros(robot.legs)
        self._speed = 0.0

    def step(self, dt: float) -> bool:
        """Move the joints by one step; return False if the motion has ended.

        Parameters
        ----------
        dt : float
            Time step [s].
        """
        highest = float(np.abs(self._swing_heights).max())
        if highest > _TOLERANCE:
            if self._move(-self._swing_heights / highest, highest, dt):
                self._swing_heights *= 1 - self._speed * dt / highest
                return True
            # Feet that cannot be set down keep their height in B.
            self._swing_heights, self._speed = np.zeros_like(self._swing_heights), 0.0
        # The lowest point of body and legs, feet excluded.
        lowest = min(self._underside, float((self._points()[:, :3] @ self._up).min()))
        if not self._move(np.ones(self._robot.legs), lowest - self._ground - self._bounds.sit_height, dt):
            return False
        self._ground += self._speed * dt
        return True

    def _move(self, direction: Float[np.ndarray, "legs"], remaining: float, dt: float) -> bool:
        """Move the feet in B along the vertical; return False if nothing remains or the bounds do not permit it."""
        if remaining <= _TOLERANCE:
            return False
        max_speed = self._bounds.sit_speed
        acceleration = max_speed / _ACCELERATION_TIME
        planned = min(self._speed + acceleration * dt, max_speed, math.sqrt(2 * acceleration * remaining))
        planned = min(planned, remaining / dt)
        for speed in (fraction * planned for fraction in _SPEED_FRACTIONS):
            feet = self._feet + (speed * dt * direction)[:, None] * self._up
            if self._send(feet, dt):
                self._feet, self._speed = feet, speed
                return True
        return False

    def _send(self, feet: Float[np.ndarray, "legs 3"], dt: float) -> bool:
        """Move the feet to points in B, if the bounds permit."""
        current, offsets = self._angles(), feet - self._points()[:, 3]
        try:
            change = np.linalg.solve(leg_jacobian(self._robot, current), offsets[..., None])[..., 0]
        except np.linalg.LinAlgError:
            return False
        if not (np.abs(change) <= self._bounds.recovery_speed * self._bounds.speed * dt).all():
            return False
        angles: list[float] = (current + change).ravel().tolist()
        if self._joints.limit_violations(angles) or self._joints.motion_violations(angles, dt):
            return False
        self._joints.send(angles, dt)
        return True

    def _angles(self) -> Float[np.ndarray, "n 3"]:
        return np.array(self._joints.angles).reshape(self._robot.legs, 3)

    def _points(self) -> Float[np.ndarray, "m n 3"]:
        return np.asarray(forward_kinematics(self._robot, self._angles()))
