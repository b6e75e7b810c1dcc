"""Loads of the feet: contacts and forces from whichever sensors a robot has, and how compliant feet yield to them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.pose.admittance import Admittance, AdmittanceFilter
from tarsus.control.readings import ValidReadings, Vector
from tarsus.control.sensing.contact_estimator import TIMEOUT, Contacts
from tarsus.control.sensing.joint_contacts import JointContacts
from tarsus.control.walk.state import GaitState
from tarsus.kinematics.mass import known_weight
from tarsus.load.foot_force import FootForceEstimator, balanced_forces
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["FootLoads"]

# A foot that bears more than this share of the robot's weight is on the ground.
_CONTACT_SHARE = 0.04
# Swing phases between which a foot is in the air; how fast the zero offset of its load cell is learnt there [1/s];
# bounds on the error that is learnt from, and on the offset itself, over the robot's weight.
_RISEN, _LANDS, _RATE, _MOST_ERROR, _MOST_OFFSET = 0.2, 0.5, 5.0, 0.1, 0.15
# Time of steps in which joint angles tell no contacts after which that is reported [s].
_REPORTED = 8.0
_SILENT = "joint_angles: they tell no contacts, as the servos do not yield to loads as those of the robot file do"


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
    estimated, unborne : bool
        Whether contacts are estimated from joint angles; whether these tell that the legs have just ceased to bear the
        robot.
    compliance : AdmittanceFilter or None
        How the feet yield; None for stiff ones.
    """

    def __init__(self, robot: Robot, admittance: Admittance | None) -> None:
        self._weight = known_weight(robot)
        self._torques = FootForceEstimator(robot)
        self._joints = JointContacts(robot) if robot.has_masses and all(map(all, robot.servos)) else None
        self.estimated, self.unborne, self._untold, self._silent = False, False, math.inf, 0.0
        # Zero offset of each load cell: what it measures without load [N].
        self._zeros = [0.0] * robot.legs
        self.compliance = AdmittanceFilter(admittance, robot.legs) if admittance else None

    def contacts(self, valid: ValidReadings, commanded: list[Vector], state: GaitState, dt: float) -> Contacts:
        """Return which feet touch the ground: from switches, else load cells, else joint angles; None where unknown.

        Joint torques are not used: position-controlled legs press against each other, and swinging legs accelerate.

        Parameters
        ----------
        valid : ValidReadings
            The readings.
        commanded : list of (coxa, femur, tibia)
            Joint angles that were commanded in the last tick [rad].
        state, dt : GaitState, float
            The gait state; time since the last tick [s].
        """
        self.estimated = self.unborne = False
        found: Contacts = valid.contacts
        if found is None and valid.forces is not None and self._weight:
            least, cells = _CONTACT_SHARE * self._weight, zip(valid.forces, self._zeros, strict=True)
            found = [None if force is None else force[2] - zero > least for force, zero in cells]
        self._untold = self._untold + dt if found is None else 0.0
        if self._untold > TIMEOUT and valid.joint_angles is not None and self._joints is not None:
            found = self._joints.contacts(valid, commanded, state, dt)
            self.estimated, self.unborne = found is not None, self._joints.unborne
            self._silent = 0.0 if self.estimated else self._silent + dt * (not state.down.all())
        return found

    @property
    def limitations(self) -> list[Limitation]:
        """Joint angles that have not told contacts for long."""
        silent = self._untold > TIMEOUT and self._silent > _REPORTED
        return [Limitation(kind=LimitationKind.READINGS, cause=_SILENT)] if silent else []

    def offsets(
        self,
        valid: ValidReadings,
        commanded: list[Vector],
        state: GaitState,
        dt: float,
        *,
        out: list[int],
        centre: complex,
    ) -> Float[np.ndarray, "legs"] | None:
        """Return the upward offsets of compliant feet, from measured forces or joint torques [m]; None for stiff feet.

        The zero offsets of load cells are learnt from feet in the air.

        Parameters
        ----------
        valid : ValidReadings
            The readings.
        commanded : list of (coxa, femur, tibia)
            Joint angles that were commanded in the last tick [rad].
        state, dt, out : GaitState, float, list of int
            The gait state; length of the tick [s]; legs taken out of the gait, which bear no load.
        centre : complex
            Where the centre of mass is above the feet, x + iy in the heading frame [m]; unused for stiff feet.
        """
        forces: Sequence[Vector | None] | None = valid.forces
        if forces is not None:
            self._learn_zeros(forces, state, dt)
            cells = zip(forces, self._zeros, strict=True)
            forces = [each and (each[0], each[1], each[2] - zero) for each, zero in cells]
        if self.compliance is None:
            return None
        if forces is None and valid.torques is not None:
            forces = self._torques.forces(commanded, valid.torques)
        if forces is None or not self._weight:
            return self.compliance.step((None,) * len(state.foot), dt)
        places = [[foot.real, foot.imag, 0.0] for foot in (state.in_heading(state.foot) - centre).tolist()]
        stands = [on and leg not in out for leg, on in enumerate(state.down.tolist())]
        expected = zip(forces, balanced_forces(places, stands, [0.0, 0.0], self._weight), stands, strict=True)
        errors = [force[2] - share if force is not None and down else None for force, share, down in expected]
        return self.compliance.step(errors, dt)

    def _learn_zeros(self, forces: Sequence[Vector | None], state: GaitState, dt: float) -> None:
        """Learn load cells' zero offsets from swinging feet, in bounded steps: a foot may briefly meet an obstacle."""
        most, share = _MOST_OFFSET * self._weight, min(_RATE * dt, 1.0)
        for leg, (force, on, phase) in enumerate(zip(forces, state.down, state.swing_phase, strict=True)):
            if force is not None and not on and _RISEN < phase < _LANDS:
                error = min(max(force[2] - self._zeros[leg], -_MOST_ERROR * self._weight), _MOST_ERROR * self._weight)
                self._zeros[leg] = min(max(self._zeros[leg] + share * error, -most), most)
