"""What is known and demanded at a sample, and what is found there."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.load.compliant.vibration import Vibration

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["Balance", "Configuration", "Demand", "Past"]


class Past(NamedTuple):
    """What counts of the last equilibrium: pose, angles, contact points, friction forces, feet that held, vibration."""

    rotation: Float[np.ndarray, "3 3"]
    position: Float[np.ndarray, "3"]
    angles: Float[np.ndarray, "legs 3"]
    bottoms: Float[np.ndarray, "legs 3"]
    friction: Float[np.ndarray, "legs 2"]
    held: Bool[np.ndarray, "legs"]
    vibration: Vibration | None = None


class Demand(NamedTuple):
    """What is demanded at a sample.

    Attributes
    ----------
    targets : array, shape (legs, 3)
        Angles that the servos aim at [rad].
    forces : array, shape (legs, 12)
        Forces of `AppliedLoads.points`, one after the other, and three zeros [N].
    loads : array, shape (6 + 3 legs,)
        Force and moment on the body, and torques on the joints but for those of `forces` [N, N m].
    angles, rotation, position : array
        Commanded joint angles and pose of B in G.
    inertia : array, shape (6, 6)
        `rigid_inertia` along G's axes.
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
    """A pose of B in G with joint angles, and what the contacts would do there.

    Attributes
    ----------
    offset : array, shape (6 + 3 legs,)
        From what is commanded, as in `Vibration`.
    rotation, position : array
        Pose of B in G.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    turned : array, shape (legs, 3)
        Their changes since the last equilibrium [rad].
    points : array, shape (legs, 10, 12)
        `LegDerivatives.at`, with the contact points in place of the feet.
    bottoms : array, shape (legs, 3)
        Contact points, at the bottom of the foot balls, in G [m].
    normal : array, shape (legs,)
        Normal forces [N].
    displacement : array, shape (legs, 2)
        Displacements of the contact points since the last equilibrium [m].
    trial : array, shape (legs, 2)
        Tangential forces without sliding [N].
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
        Tangential force over the one without sliding; below 1 for a foot that slides.
    forces : array, shape (legs, 12)
        `Demand.forces` with the contact forces on the feet, and the moments of these per radius of the foot [N].
    generalised : array, shape (legs, 9)
        Work of `forces` by the first and second derivatives of `LegDerivatives.at`.
    torques, slopes : array, shape (legs, 3)
        `JointSprings.torque`.
    moments : array, shape (3, 3)
        Sum of the products of point and force, whose antisymmetric part is the moment [N m].
    residual : array, shape (6 + 3 legs,)
        Force and moment on the body, torques of the joints [N, N m].
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
