"""Loads of the feet: contacts and forces from whichever sensors a robot has, and how compliant feet yield to them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.pose.admittance import Admittance, AdmittanceFilter
from tarsus.control.readings import ValidReadings, Vector
from tarsus.control.sensing.joint_contacts import JointContacts
from tarsus.control.walk.state import GaitState
from tarsus.kinematics.mass import known_weight
from tarsus.load.foot_force import FootForceEstimator, balanced_forces
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["FootLoads"]

# A foot that bears this share of the robot's weight is on the ground.
_CONTACT_SHARE = 0.04
# Joint angles tell of contacts once nothing else has for so long [s].
_UNTOLD = 0.15
# Greatest speed of feet that go down; where contacts are estimated, feet press on the ground before they are known to
# touch it [m/s].
_DESCENT, _ESTIMATED_DESCENT = 0.4, 0.25


class FootLoads:
    """Contacts from foot switches, load cells or joint angles, and compliance from load cells or joint torques.

    Parameters
    ----------
    robot : Robot
        A single robot.
    admittance : Admittance, optional
        Compliance of the feet; left out, they are stiff.

    Attributes
    ----------
    estimated : bool
        Whether contacts are estimated by joint angles.
    """

    def __init__(self, robot: Robot, admittance: Admittance | None) -> None:
        self._weight = known_weight(robot)
        self._torques = FootForceEstimator(robot) if robot.has_masses else None
        self._joints = JointContacts(robot) if robot.has_masses and all(map(all, robot.servos)) else None
        self.estimated, self._untold = False, math.inf
        self._filter = AdmittanceFilter(admittance, robot.legs) if admittance else None

    @property
    def compliant(self) -> bool:
        """Whether the feet yield to forces; only then are forces of use."""
        return self._filter is not None

    @property
    def fastest_descent(self) -> float:
        """Greatest speed with which feet may go down in search of the ground [m/s]."""
        return _ESTIMATED_DESCENT if self.estimated else _DESCENT

    def contacts(
        self, valid: ValidReadings, angles: Float[np.ndarray, "legs 3"], state: GaitState, dt: float
    ) -> Sequence[bool | None] | None:
        """Return which feet touch the ground: from switches, else load cells, else joint angles; None where unknown.

        Joint torques do not tell: position-controlled legs press against each other, and a swinging leg is accelerated.

        Parameters
        ----------
        valid : ValidReadings
            The readings.
        angles : array, shape (legs, 3)
            Joint angles that were commanded in the last tick [rad].
        state, dt : GaitState, float
            The gait state; time since the last tick [s].
        """
        self.estimated, found, untold = False, None, self._untold + dt
        self._untold = 0.0
        if valid.contacts is not None:
            return valid.contacts
        if valid.forces is not None and self._weight:
            least = _CONTACT_SHARE * self._weight
            return [None if force is None else force[2] > least for force in valid.forces]
        self._untold = untold
        if valid.joint_angles is not None and self._joints is not None and untold > _UNTOLD:
            found = self._joints.contacts(valid, angles, state, dt)
            self.estimated = found is not None
        return found

    def offsets(
        self, valid: ValidReadings, angles: Float[np.ndarray, "legs 3"], state: GaitState, dt: float, *, out: list[int]
    ) -> Float[np.ndarray, "legs"] | None:
        """Return the upward offsets of compliant feet by measured forces, or by joint torques [m]; None of stiff ones.

        Parameters
        ----------
        valid : ValidReadings
            The readings.
        angles : array, shape (legs, 3)
            Joint angles [rad].
        state, dt, out : GaitState, float, list of int
            The gait state; length of the tick [s]; legs that are taken out of the gait: they bear no load.
        """
        if self._filter is None:
            return None
        forces: Sequence[Vector | None] | None = valid.forces
        if forces is None and valid.torques is not None and self._torques is not None:
            forces = self._torques.forces(angles.tolist(), valid.torques)
        if forces is None or not self._weight:
            return self._filter.step((None,) * len(state.foot), dt)
        places = [[foot.real, foot.imag, 0.0] for foot in (state.foot - state.foot.mean()).tolist()]
        stands = [on and leg not in out for leg, on in enumerate(state.down.tolist())]
        expected = zip(forces, balanced_forces(places, stands, [0.0, 0.0], self._weight), stands, strict=True)
        errors = [force[2] - share if force is not None and down else None for force, share, down in expected]
        return self._filter.step(errors, dt)
