"""Weight and inertial forces on a robot along a commanded motion, in G."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.kinematics.leg import forward_kinematics
from tarsus.load.acceleration import BodyRates, JointRates, differences
from tarsus.load.inertial_loads import inertial_loads
from tarsus.load.payload import Payload
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["AppliedLoads", "applied_loads"]


class AppliedLoads(NamedTuple):
    """Loads along a motion; G is the frame of all of them.

    Attributes
    ----------
    points : array, shape (n, legs, 3, 3)
        Forces on femur axis, knee and foot of each leg [N].
    force, moment : array, shape (n, 3)
        Force on the body and its moment about B's origin [N, N m].
    rotors : array, shape (n, legs, 3)
        Torques that accelerate the rotors of the servos [N m].
    """

    points: Float[np.ndarray, "n legs 3 3"]
    force: Float[np.ndarray, "n 3"]
    moment: Float[np.ndarray, "n 3"]
    rotors: Float[np.ndarray, "n legs 3"]


def applied_loads(
    robot: Robot,
    motion: Motion,
    *,
    payload: Payload,
    gravity: Sequence[float],
    inertial: bool,
    rotor_inertia: Float[np.ndarray, "legs 3"],
) -> AppliedLoads:
    """Return the loads along a motion, in its commanded poses: compliance changes them little.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    motion : Motion
        The motion.
    payload : Payload
        Payload on the body.
    gravity : sequence of float
        Gravity in G [m/s^2].
    inertial : bool
        Whether inertial forces are included.
    rotor_inertia : array, shape (legs, 3)
        Inertias of the servos' rotors, reflected to the joints [kg m^2].
    """
    velocity, acceleration = differences(motion.time, motion.angles)
    rates = BodyRates.of(motion.time, motion.body)
    if not inertial:
        velocity, acceleration, rates = np.zeros_like(velocity), np.zeros_like(acceleration), BodyRates()
    points = np.asarray(forward_kinematics(robot, motion.angles))
    joints = JointRates(velocity=velocity, acceleration=acceleration)
    loads = inertial_loads(
        robot, motion.angles, motion.body, joints, rates, payload=payload, gravity=gravity, points=points
    )
    moving, at = np.asarray(loads.points)[:, :, 1:], points[:, :, 1:]
    to_ground = np.swapaxes(motion.body.rotation, -1, -2)
    force = loads.force - moving.sum((1, 2))
    moment = loads.moment - np.cross(at, moving).sum((1, 2))
    return AppliedLoads(
        points=np.ascontiguousarray(moving @ to_ground[:, None]),
        force=(force[:, None] @ to_ground)[:, 0],
        moment=(moment[:, None] @ to_ground)[:, 0],
        rotors=acceleration * rotor_inertia,
    )
