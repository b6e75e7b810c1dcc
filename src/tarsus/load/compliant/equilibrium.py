"""Residual of the equilibrium of a compliant robot.

With the loads P on the leg points p and those on the body, the contact forces f at the bottom c of the foot balls, and
the spring torques tau, all in G::

    joints   -tau - sum (dp/dq)^T P - (dc/dq)^T f + rotor torque       = 0
    forces   -(sum P + sum f + load on the body)                       = 0
    moments  -(sum p x P + sum c x f + moment of the load on the body) = 0   about B's origin

Accelerations beyond those of the commanded motion add inertial forces (`tarsus.load.compliant.vibration`).
`dc/dq` is the derivative of the material point of the foot at the contact: ``axis x (c - joint)`` for each joint.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.load.compliant.balance import Balance, Configuration, Demand, Past
from tarsus.load.compliant.foot_contact import POINT_FOOT, FootContact, normal_force
from tarsus.load.compliant.friction import friction_fraction
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.compliant.leg_derivatives import LegDerivatives
from tarsus.load.compliant.offset import rotated, turned
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["ROLL", "Compliant"]

# A vector times this is its cross product with z.
ROLL = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
# Contact forces f times this are the forces f on the feet, and f x z, their moments over the radius of the foot.
_SPREAD = np.hstack([np.zeros((3, 6)), np.eye(3), ROLL])
# Lever arm by which the size of a residual weighs forces against moments, about that of a leg [m].
_LEVER = 0.2
# Stiffness of the body that keeps its equations regular where it is free to move [N/m, N m/rad].
_FLOOR = 1e-3
# Flat indices into a 3 x 3 matrix of moments: elements at the first less those at the second are the moment.
_LATER, _EARLIER = np.array([5, 6, 1]), np.array([7, 2, 3])


class Compliant:
    """A robot with elastic joints: its configurations and their balance of forces.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    springs : JointSprings
        Its joints.
    contact : FootContact
        Its feet on the ground.
    inertia : array, shape (6, 6), optional
        `rigid_inertia`; left out, nothing has inertia beyond that of the commanded motion.
    """

    def __init__(
        self,
        robot: Robot,
        springs: JointSprings,
        contact: FootContact,
        inertia: Float[np.ndarray, "6 6"] | None = None,
    ) -> None:
        self.springs, self.contact, self.legs, self.inertia = springs, contact, robot.legs, inertia
        radius = np.array(np.broadcast_to(robot.foot_radius, robot.legs), dtype=float)
        self.radius = np.where(radius > 0, radius, POINT_FOOT)
        self._legs_of = LegDerivatives(robot, self.radius)
        self.every, self._radii = np.ones(robot.legs), self.radius[:, None]
        self._rotors = np.diag(np.append(np.zeros(6), springs.rotor_inertia))
        self._floor = np.diag(np.append(np.full(6, _FLOOR), np.zeros(3 * robot.legs)))
        # 1 for the forces among the vectors of `Balance.forces`, 0 for the moments.
        self._forces = np.tile([1.0, 1.0, 1.0, 0.0], robot.legs)

    def bottoms(
        self, rotation: Float[np.ndarray, "3 3"], position: Float[np.ndarray, "3"], angles: Float[np.ndarray, "legs 3"]
    ) -> Float[np.ndarray, "legs 3"]:
        """Return the bottoms of the foot balls in G, ``(legs, 3)`` [m]."""
        bottoms: np.ndarray = self._legs_of.at(angles, rotation)[:, 0, 6:9] + position
        bottoms[:, 2] -= self.radius
        return bottoms

    def resistance(self, inertia: Float[np.ndarray, "6 6"], gain: float) -> Float[np.ndarray, "unknowns unknowns"]:
        """Return the inertial force per offset beyond `Vibration.ahead`, plus the small stiffness that holds the body.

        Parameters
        ----------
        inertia : array, shape (6, 6)
            Inertia of the body along G's axes.
        gain : float
            `Vibration.gain` [1/s^2].
        """
        resistance: np.ndarray = gain * self._rotors + self._floor
        resistance[:6, :6] += gain * inertia
        return resistance

    def configuration(self, offset: Float[np.ndarray, "unknowns"], past: Past, demand: Demand) -> Configuration:
        """Return the configuration at an offset, with its contacts as if no foot slid.

        Parameters
        ----------
        offset : array, shape (6 + 3 legs,)
            Offset of body and joints from their commands, as in `Vibration`.
        past : Past
            The last equilibrium.
        demand : Demand
            Commands and loads.
        """
        rotation, position = rotated(demand.rotation, offset[3:6]), demand.position + offset[:3]
        angles = demand.angles + offset[6:].reshape(-1, 3)
        points = self._legs_of.at(angles, rotation)
        points[:, 0, 8] -= self.radius
        bottoms = points[:, 0, 6:9].copy()
        bottoms += self.every[:, None].dot(position[None])
        change, levers = angles - past.angles, points[:, 1:4, 9:]
        rolled = (change[:, None] @ levers)[:, 0] + self._radii.dot(turned(rotation, past.rotation)[None])
        displacement = (bottoms - past.bottoms - rolled.dot(ROLL))[:, :2].copy()
        trial = self.contact.relaxation(demand.step) * (
            past.friction - self.contact.tangential_stiffness * displacement
        )
        normal = normal_force(bottoms[:, 2], self.contact.normal_stiffness)
        return Configuration(offset, rotation, position, angles, change, points, bottoms, normal, displacement, trial)

    def balance(self, at: Configuration, demand: Demand, limit: Float[np.ndarray, "legs"] | None = None) -> Balance:
        """Return the balance of a configuration.

        Parameters
        ----------
        at : Configuration
            The configuration.
        demand : Demand
            Commands and loads.
        limit : array, shape (legs,), optional
            Limits of the tangential forces [N]. Default: friction times normal force.
        """
        if limit is None:
            limit = self.contact.friction * at.normal
        contact, fraction = np.empty((self.legs, 3)), friction_fraction(at.trial, limit)
        contact[:, 0], contact[:, 1] = at.trial[:, 0] * fraction, at.trial[:, 1] * fraction
        contact[:, 2] = at.normal
        forces = demand.forces + contact.dot(_SPREAD)
        generalised = (at.points[:, 1:] @ forces[:, :, None])[:, :, 0]
        torques, slopes = self.springs.torque(demand.targets - at.angles, at.turned, demand.step)
        vectors = forces.reshape(-1, 3)
        moments = at.points[:, 0].reshape(-1, 3).T.dot(vectors)
        residual = demand.resistance.dot(at.offset - demand.ahead) - demand.loads
        residual[:3] -= self._forces.dot(vectors)
        residual[3:6] -= moments.take(_LATER) - moments.take(_EARLIER)
        residual[6:] -= torques.reshape(-1) + generalised[:, :3].reshape(-1)
        on_body = residual[:3]
        square = float(residual.dot(residual)) - (1.0 - _LEVER**2) * float(on_body.dot(on_body))
        return Balance(contact, fraction, forces, generalised, torques, slopes, moments, residual, math.sqrt(square))
