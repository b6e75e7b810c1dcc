"""Residual of the equilibrium of a compliant robot.

With the loads P on the leg points p and those on the body, the contact forces f at the bottom c of the foot balls, and
the spring torques tau, in B's axes::

    joints   -tau - sum (dp/dq)^T P - (dc/dq)^T f + rotor torque       = 0
    forces   -(sum P + sum f + load on the body)                       = 0
    moments  -(sum p x P + sum c x f + moment of the load on the body) = 0

What accelerates beyond the commanded motion adds its inertial forces (`tarsus.load.compliant.vibration`).
`dc/dq` is that of the material at the contact point: ``axis x (c - joint)`` for each joint.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.load.compliant.foot_contact import POINT_FOOT, FootContact, contact_displacement, normal_force
from tarsus.load.compliant.friction import Slip, friction_force
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.compliant.leg_derivatives import LegDerivatives
from tarsus.load.compliant.vibration import Vibration
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Balance", "Compliant", "Configuration", "Demand", "Past"]

# Weights of forces [m] and moments in the size of a residual; that of forces is a lever arm of legs.
_WEIGHTS = np.array([0.2, 0.2, 0.2, 1.0, 1.0, 1.0])
# A vector times this, as a matrix of three columns, is the cross product with it from the right of row vectors.
_SKEW = np.array([[0.0, 0, 0, 0, 0, -1, 0, 1, 0], [0, 0, 1, 0, 0, 0, -1, 0, 0], [0, -1, 0, 1, 0, 0, 0, 0, 0]])
# The places in a matrix of moments whose differences are the moment.
_LATER, _EARLIER = np.array([5, 6, 1]), np.array([7, 2, 3])


class Past(NamedTuple):
    """What counts of the last equilibrium: pose, angles, centres of the feet, friction forces, vibration."""

    rotation: Float[np.ndarray, "3 3"]
    position: Float[np.ndarray, "3"]
    angles: Float[np.ndarray, "legs 3"]
    feet: Float[np.ndarray, "legs 3"]
    friction: Float[np.ndarray, "legs 2"]
    vibration: Vibration | None = None


class Demand(NamedTuple):
    """What is demanded at a sample.

    Attributes
    ----------
    targets : array, shape (legs, 3)
        Angles that the servos aim at [rad].
    points, force, moment, rotors : array
        Loads as in `AppliedLoads`.
    angles, rotation, position : array
        Commanded joint angles and pose of B in G.
    step : float
        Time since the last sample [s].
    ahead : array, shape (6 + 3 legs,)
        `Vibration.ahead` of the last equilibrium.
    gain : float
        `Vibration.gain`; 0 without inertia.
    """

    targets: Float[np.ndarray, "legs 3"]
    points: Float[np.ndarray, "legs 3 3"]
    force: Float[np.ndarray, "3"]
    moment: Float[np.ndarray, "3"]
    rotors: Float[np.ndarray, "legs 3"]
    angles: Float[np.ndarray, "legs 3"]
    rotation: Float[np.ndarray, "3 3"]
    position: Float[np.ndarray, "3"]
    step: float
    ahead: Float[np.ndarray, "unknowns"]
    gain: float = 0.0


class Configuration(NamedTuple):
    """A pose of B in G with joint angles, and what the contacts would do there.

    Attributes
    ----------
    rotation, position : array
        Pose of B in G.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    turned : array, shape (legs, 3)
        Their changes since the last equilibrium [rad].
    points, axes : array
        `LegDerivatives.at`.
    feet : array, shape (legs, 3)
        Centres of the foot balls in G [m].
    normal : array, shape (legs,)
        Normal forces [N].
    displacement : array, shape (legs, 2)
        Displacements of the contact points since the last equilibrium [m].
    trial : array, shape (legs, 2)
        Tangential forces without sliding [N].
    """

    rotation: Float[np.ndarray, "3 3"]
    position: Float[np.ndarray, "3"]
    angles: Float[np.ndarray, "legs 3"]
    turned: Float[np.ndarray, "legs 3"]
    points: Float[np.ndarray, "legs 10 9"]
    axes: Float[np.ndarray, "legs 3 3"]
    feet: Float[np.ndarray, "legs 3"]
    normal: Float[np.ndarray, "legs"]
    displacement: Float[np.ndarray, "legs 2"]
    trial: Float[np.ndarray, "legs 2"]


class Balance(NamedTuple):
    """Forces in a configuration, and how far they are from equilibrium.

    Attributes
    ----------
    slip : Slip
        Tangential forces.
    contact : array, shape (legs, 3)
        FootContact forces in G [N].
    points : array, shape (legs, 3, 3)
        Forces on the leg points in B, with the contact forces on the feet [N].
    generalised : array, shape (legs, 9)
        Work of `points` by the first and second derivatives of `LegDerivatives.at`.
    rolling : array, shape (legs, 3, 3)
        What the derivatives of the contact point lack to those of the ball's centre, by joint [m].
    torques, slopes : array, shape (legs, 3)
        `JointSprings.torque`, the slopes with the inertia of the rotors.
    moments : array, shape (3, 3)
        Sum of the products of point and force, whose antisymmetric part is the moment [N m].
    joints, body : array, shapes (legs, 3) and (6,)
        Residuals [N m]; [N] and [N m].
    size : float
        Size of the residuals [N m].
    """

    slip: Slip
    contact: Float[np.ndarray, "legs 3"]
    points: Float[np.ndarray, "legs 3 3"]
    generalised: Float[np.ndarray, "legs 9"]
    rolling: Float[np.ndarray, "legs 3 3"]
    torques: Float[np.ndarray, "legs 3"]
    slopes: Float[np.ndarray, "legs 3"]
    moments: Float[np.ndarray, "3 3"]
    joints: Float[np.ndarray, "legs 3"]
    body: Float[np.ndarray, "6"]
    size: float


class Compliant:
    """A robot on springs: its configurations and their balance.

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
        self._legs_of = LegDerivatives(robot)
        radius = np.array(np.broadcast_to(robot.foot_radius, robot.legs), dtype=float)
        self.radius = np.where(radius > 0, radius, POINT_FOOT)
        self._levers, self._ones = self.radius[:, None, None], np.ones(3 * robot.legs)

    def feet(
        self, rotation: Float[np.ndarray, "3 3"], position: Float[np.ndarray, "3"], angles: Float[np.ndarray, "legs 3"]
    ) -> Float[np.ndarray, "legs 3"]:
        """Return the centres of the foot balls in G, ``(legs, 3)`` [m]."""
        feet: np.ndarray = self._legs_of.at(angles)[0][:, 0, 6:] @ rotation.T + position
        return feet

    def offset(self, at: Configuration, demand: Demand) -> Float[np.ndarray, "unknowns"]:
        """Return the offset of a configuration from what is commanded, as in `Vibration`."""
        offset = np.empty(6 + 3 * self.legs)
        offset[:3] = at.position - demand.position
        turn = demand.rotation.T @ at.rotation
        offset[3:6] = (turn.take(_EARLIER) - turn.take(_LATER)) / 2
        offset[6:] = (at.angles - demand.angles).ravel()
        return offset

    def configuration(
        self,
        pose: tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, "3"]],
        angles: Float[np.ndarray, "legs 3"],
        past: Past,
        step: float,
    ) -> Configuration:
        """Return a configuration, and what the contacts would do there.

        Parameters
        ----------
        pose : rotation and position
            Of B in G.
        angles : array, shape (legs, 3)
            Joint angles [rad].
        past : Past
            The last equilibrium.
        step : float
            Time since then [s].
        """
        rotation, position = pose
        points, axes = self._legs_of.at(angles)
        feet = points[:, 0, 6:] @ rotation.T + position
        turn = rotation @ past.rotation.T
        body_turned = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0]]) / 2
        turned = angles - past.angles
        joints_turned = (turned[:, None, :] @ (axes @ rotation[:2].T))[:, 0]
        displacement = contact_displacement(feet[:, :2] - past.feet[:, :2], body_turned + joints_turned, self.radius)
        trial = self.contact.relaxation(step) * (past.friction - self.contact.tangential_stiffness * displacement)
        normal = normal_force(feet[:, 2], self.radius, self.contact.normal_stiffness)
        return Configuration(rotation, position, angles, turned, points, axes, feet, normal, displacement, trial)

    def balance(self, at: Configuration, demand: Demand, limit: Float[np.ndarray, "legs"] | None = None) -> Balance:
        """Return the balance of a configuration.

        Parameters
        ----------
        at : Configuration
            The configuration.
        demand : Demand
            Commanded angles and loads.
        limit : array, shape (legs,), optional
            Frozen limits of friction [N]; left out, friction times normal force.
        """
        rotation = at.rotation
        slip = friction_force(at.trial, self.contact.friction * at.normal if limit is None else limit)
        contact = np.empty((self.legs, 3))
        contact[:, :2], contact[:, 2] = slip.force, at.normal
        contact_in_body = contact @ rotation
        forces = (demand.points.reshape(-1, 3) @ rotation).reshape(-1, 3, 3)
        forces[:, 2] += contact_in_body
        generalised = (at.points[:, 1:] @ forces.reshape(-1, 9, 1))[:, :, 0]
        rolling = (at.axes.reshape(-1, 3) @ (rotation[2] @ _SKEW).reshape(3, 3)).reshape(-1, 3, 3) * self._levers
        torques, slopes = self.springs.torque(demand.targets - at.angles, at.turned, demand.step)
        rolled = (rolling @ contact_in_body[:, :, None])[:, :, 0]
        joints = demand.rotors - torques - generalised[:, :3] + rolled
        moments = at.points[:, 0].reshape(-1, 3).T @ forces.reshape(-1, 3)
        moments -= rotation[2][:, None] * (self.radius @ contact_in_body)
        on_body = np.empty(6)
        on_body[:3] = demand.force @ rotation + self._ones @ forces.reshape(-1, 3)
        on_body[3:] = demand.moment @ rotation + moments.take(_LATER) - moments.take(_EARLIER)
        if demand.gain and self.inertia is not None:
            acceleration = (self.offset(at, demand) - demand.ahead) * demand.gain
            acceleration[:3] = acceleration[:3] @ rotation
            on_body -= self.inertia @ acceleration[:6]
            joints += self.springs.rotor_inertia * acceleration[6:].reshape(-1, 3)
            slopes = slopes + demand.gain * self.springs.rotor_inertia
        weighted = on_body * _WEIGHTS
        square = float(np.vdot(joints, joints) + weighted @ weighted)
        return Balance(
            slip, contact, forces, generalised, rolling, torques, slopes, moments, joints, -on_body, math.sqrt(square)
        )
