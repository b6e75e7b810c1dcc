"""The exact state of a simulated robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.kinematics.pose import Pose
from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["PlantState"]


@represented()
class PlantState(NamedTuple):
    """The exact state of a simulated robot.

    Attributes
    ----------
    time : float
        Time since the start [s].
    body : Pose
        Pose of B in G.
    joint_angles, joint_speeds : array, shape (legs, 3)
        Angles and speeds of the joints [rad, rad/s].
    torques : array, shape (legs, 3)
        Torques of the servos in the last physics step; means over the last tick with `SimulatedPlant.average_torques`
        [N m].
    saturated : array of bool, shape (legs, 3)
        Whether the servos gave all the torque that they can at their speed.
    foot_forces : array, shape (legs, 3)
        Forces of the ground on the feet in the last physics step, in G [N].
    slip_speeds : array, shape (legs,)
        Speeds of the feet's contact points over the ground; 0 for a foot that rolls, or is in the air [m/s].
    body_touches : bool
        Whether the body is in contact with the ground.
    """

    time: float
    body: Pose
    joint_angles: Float[np.ndarray, "legs 3"]
    joint_speeds: Float[np.ndarray, "legs 3"]
    torques: Float[np.ndarray, "legs 3"]
    saturated: Bool[np.ndarray, "legs 3"]
    foot_forces: Float[np.ndarray, "legs 3"]
    slip_speeds: Float[np.ndarray, "legs"]
    body_touches: bool
