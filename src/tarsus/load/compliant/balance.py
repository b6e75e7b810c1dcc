"""Values of the search for an equilibrium: the last one, the demand, a configuration, and its balance of forces."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.load.compliant.vibration import Vibration

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["Balance", "Configuration", "Demand", "Past"]


class Past(NamedTuple):
    """State after the last equilibrium: pose, angles, contact points, friction forces, feet that held, vibration."""

    rotation: Float[np.ndarray, "3 3"]
    position: Float[np.ndarray, "3"]
    angles: Float[np.ndarray, "legs 3"]
    bottoms: Float[np.ndarray, "legs 3"]
    friction: Float[np.ndarray, "legs 2"]
    held: Bool[np.ndarray, "legs"]
    vibration: Vibration | None = None


class Demand(NamedTuple):
    """Commands and loads at a sample, with the terms of the inertial forces.

    Attributes
    ----------
    targets : array, shape (legs, 3)
        Angles that the servos aim at, `JointSprings.targets` [rad].
    forces : array, shape (legs, 12)
        For each leg the forces of `AppliedLoads.points`, one after the other, then three zeros [N].
    loads : array, shape (6 + 3 legs,)
        Force and moment on the body, and torques on the joints other than those due to `forces` [N, N m].
    angles, rotation, position : array
        Commanded joint angles and pose of B in G.
    inertia : array, shape (6, 6)
        `rigid_inertia`, rotated into G's axes.
    step : float
        Time since the last sample [s].
    ahead : array, shape (6 + 3 legs,)
        `Vibration.ahead` of the last equilibrium.
    resistance : array, shape (6 + 3 legs, 6 + 3 legs)
        `Compliant.resistance`.
    """

    targets: Float[np.ndarray, "legs 3"]
    forces: Float[np.ndarray, "legs 12"]
    loads: Float[np.ndarray, "unknowns"]
    angles: Float[np.ndarray, "legs 3"]
    rotation: Float[np.ndarray, "3 3"]
    position: Float[np.ndarray, "3"]
    inertia: Float[np.ndarray, "6 6"]
    step: float
    ahead: Float[np.ndarray, "unknowns"]
    resistance: Float[np.ndarray, "unknowns unknowns"]


class Configuration(NamedTuple):
    """A pose of B in G with joint angles, and the contacts there, as if no foot slid.

    Attributes
    ----------
    offset : array, shape (6 + 3 legs,)
        Offset of body and joints from their commands, as in `Vibration`.
    rotation, position : array
        Pose of B in G.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    turned : array, shape (legs, 3)
        Changes of the joint angles since the last equilibrium [rad].
    points : array, shape (legs, 10, 12)
        `LegDerivatives.at`, with the contact points in place of the feet.
    bottoms : array, shape (legs, 3)
        Contact points, at the bottom of the foot balls, in G [m].
    normal : array, shape (legs,)
        Normal forces [N].
    displacement : array, shape (legs, 2)
        Displacements of the contact points since the last equilibrium [m].
    trial : array, shape (legs, 2)
        Tangential forces that the feet would have if they did not slide [N].
    """

    offset: Float[np.ndarray, "unknowns"]
    rotation: Float[np.ndarray, "3 3"]
    position: Float[np.ndarray, "3"]
    angles: Float[np.ndarray, "legs 3"]
    turned: Float[np.ndarray, "legs 3"]
    points: Float[np.ndarray, "legs 10 12"]
    bottoms: Float[np.ndarray, "legs 3"]
    normal: Float[np.ndarray, "legs"]
    displacement: Float[np.ndarray, "legs 2"]
    trial: Float[np.ndarray, "legs 2"]


class Balance(NamedTuple):
    """Forces in a configuration, and how far they are from equilibrium.

    Attributes
    ----------
    contact : array, shape (legs, 3)
        Contact forces in G [N].
    fraction : array, shape (legs,)
        Tangential force over that of `Configuration.trial`; below 1 for a foot that slides.
    forces : array, shape (legs, 12)
        `Demand.forces` plus the contact forces on the feet; in place of the zeros, the moments of the contact forces
        about the centre of the foot ball, over its radius [N].
    generalised : array, shape (legs, 9)
        Scalar products of `forces` with the three first and the six second derivatives of `LegDerivatives.at`.
    torques, slopes : array, shape (legs, 3)
        Torques of the joint springs and their slopes, as `JointSprings.torque` returns them.
    moments : array, shape (3, 3)
        Sum of the outer products of points and forces; its antisymmetric part gives the moment [N m].
    residual : array, shape (6 + 3 legs,)
        Residual of the equilibrium: force and moment on the body, torques of the joints [N, N m].
    size : float
        Size of the residual [N m].
    """

    contact: Float[np.ndarray, "legs 3"]
    fraction: Float[np.ndarray, "legs"]
    forces: Float[np.ndarray, "legs 12"]
    generalised: Float[np.ndarray, "legs 9"]
    torques: Float[np.ndarray, "legs 3"]
    slopes: Float[np.ndarray, "legs 3"]
    moments: Float[np.ndarray, "3 3"]
    residual: Float[np.ndarray, "unknowns"]
    size: float
