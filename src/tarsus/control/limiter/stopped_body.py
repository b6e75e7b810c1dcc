"""Stopped body: finds by the coxa torques that the body pushes against an obstacle, and refuses twists towards it."""

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

# Push from which the body counts as stopped, over the weight; time over which the push is averaged, and how long it has
# to last [s]. In physics it is 0.13 at most on rough ground; at a block that the body gets over, it lasts up to 3 s.
_STOPPED, _TIME, _LASTS = 0.15, 1.0, 3.5


class StoppedBody:
    """Finds obstacles that stop the body without any foot feeling them, and refuses twists towards them.

    Unless something else holds the robot, the forces of the ground on its feet only balance gravity. The force of each
    standing foot across its leg follows from the torque of the coxa joint.

    Parameters
    ----------
    robot : Robot
        A single robot; one without masses is never found stopped.

    Attributes
    ----------
    push : float
        Mean force with which the robot pushes in its direction of travel, over its weight.
    """

    def __init__(self, robot: Robot) -> None:
        self.push, self._time, self._way, self._cause = 0.0, 0.0, 0j, ""
        self._weight = known_weight(robot)
        self._mounts: list[complex] = (robot.geometry.mount_x + 1j * robot.geometry.mount_y).tolist()
        self._solver = ScalarSolver(robot)

    def step(self, measured: ValidReadings, bears: Sequence[int], velocity: complex, dt: float, *, yaw: float) -> None:
        """Update the push from measured joint angles and torques.

        Parameters
        ----------
        measured : ValidReadings
            The readings; legs without joint angles or torques do not count.
        bears : sequence of int
            Legs whose feet bear load.
        velocity, dt : complex, float
            Commanded velocity of the body in the heading frame [m/s]; time since the last tick [s].
        yaw : float
            Yaw of the body in the heading frame [rad].
        """
        push, angles, torques = 0.0, measured.joint_angles, measured.torques
        roll, pitch = measured.attitude or (0.0, 0.0)
        if angles is not None and torques is not None and velocity and self._weight:
            way = velocity / abs(velocity) * cmath.exp(-1j * yaw)
            gravity = complex(math.sin(pitch), -math.sin(roll) * math.cos(pitch))
            # Coxae bear only a part of the weight along the plane of the body: it counts where it lowers the push.
            push = min((gravity * way.conjugate()).real, 0.0)
            # Legs without measured angles do not count, whatever stands in for these.
            feet = self._solver.feet([each or (0.0, 0.0, 0.0) for each in angles])
            for leg in bears:
                torque = torques[leg]
                if angles[leg] is not None and torque is not None:
                    across = 1j * torque[0] / (complex(*feet[leg][:2]) - self._mounts[leg]).conjugate()
                    push -= (across * way.conjugate()).real / self._weight
        self.push += min(dt / _TIME, 1.0) * (push - self.push)
        self._time = (self._time + dt) * (self.push > _STOPPED)
        if self._time > _LASTS:
            self._cause = f"an obstacle stops the body, which pushes with {100 * self.push:.0f} % of the weight"
            self._way, self.push, self._time = velocity / (abs(velocity) or 1.0), 0.0, 0.0

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant, with no twist towards what stops the body; a twist elsewhere is granted and ends this."""
        velocity = complex(*request.twist[:2])
        if leads_towards(velocity, self._way):
            return grant.at_most(0.0, Limitation(kind=LimitationKind.GROUND, cause=self._cause))
        self._way *= not any(request.twist)
        return grant
