"""Stopped body: refuses a twist towards what the body pushes against, by the measured torques of the coxa joints."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest, leads_towards
from tarsus.control.readings import ValidReadings
from tarsus.kinematics.mass import known_weight
from tarsus.kinematics.scalar_solver import ScalarSolver
from tarsus.robot.robot import Robot

__all__ = ["StoppedBody"]

# Push over the weight from which on the body is stopped, the time over which it is averaged, and how long it lasts [s].
# In physics it is 0.13 at most on rough ground; where the body meets a block that it gets over, it lasts for up to 3 s.
_STOPPED, _TIME, _LASTS = 0.15, 1.0, 3.5
# Joint angles of legs that do not count [rad].
_ANY = (0.0, 0.0, 0.0)


class StoppedBody:
    """Finds obstacles that stop the body, which no foot feels, and refuses the way towards them.

    The ground pushes the robot up only, against gravity, unless something else holds it. What the standing feet push
    across their legs with follows from the torques of the coxa joints.

    Parameters
    ----------
    robot : Robot
        A single robot; one without masses is never found stopped.

    Attributes
    ----------
    push : float
        What the robot pushes with on its way, over its weight.
    """

    def __init__(self, robot: Robot) -> None:
        self.push, self._time, self._way, self._cause = 0.0, 0.0, 0j, ""
        self._weight = known_weight(robot)
        self._mounts: list[complex] = (robot.geometry.mount_x + 1j * robot.geometry.mount_y).tolist()
        self._solver = ScalarSolver(robot)

    def step(self, measured: ValidReadings, bears: Sequence[int], velocity: complex, dt: float, *, yaw: float) -> None:
        """Take in joint angles and torques.

        Parameters
        ----------
        measured : ValidReadings
            The readings; legs without joint angles or torques do not count.
        bears : sequence of int
            Legs whose feet bear load.
        velocity, dt : complex, float
            Commanded velocity of the body in the heading frame [m/s]; time since the last tick [s].
        yaw : float
            Of the body in the heading frame [rad].
        """
        push, angles, torques = 0.0, measured.joint_angles, measured.torques
        roll, pitch = measured.attitude or (0.0, 0.0)
        if angles is not None and torques is not None and velocity and self._weight:
            force = self._weight * complex(math.sin(pitch), -math.sin(roll) * math.cos(pitch))
            feet = self._solver.feet([each or _ANY for each in angles])
            for leg in bears:
                torque = torques[leg]
                if angles[leg] is not None and torque is not None:
                    force -= 1j * torque[0] / (complex(*feet[leg][:2]) - self._mounts[leg]).conjugate()
            push = (force * cmath.exp(1j * yaw) * velocity.conjugate()).real / (self._weight * abs(velocity))
        self.push += min(dt / _TIME, 1.0) * (push - self.push)
        self._time = (self._time + dt) * (self.push > _STOPPED)
        if self._time > _LASTS:
            self._cause = f"an obstacle stops the body, which pushes with {100 * self.push:.0f} % of the weight"
            self._way, self.push, self._time = velocity / (abs(velocity) or 1.0), 0.0, 0.0

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant, without a twist towards what stops the body; any other one is granted, and ends that."""
        velocity = complex(*request.twist[:2])
        if leads_towards(velocity, self._way):
            return grant.at_most(0.0, Limitation(kind=LimitationKind.GROUND, cause=self._cause))
        self._way *= not any(request.twist)
        return grant
