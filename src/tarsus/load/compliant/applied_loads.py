"""Weight and inertial forces on a robot along a commanded motion, in G."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.kinematics.leg import forward_kinematics
from tarsus.load.acceleration import BodyRates, JointRates, differences
from tarsus.load.inertial_loads import inertial_loads
from tarsus.load.payload import Payload
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["AppliedLoads", "applied_loads"]


class AppliedLoads(NamedTuple):
    """Loads at samples of a motion, all in G.

    Attributes
    ----------
    points : array, shape (k, legs, 3, 3)
        Forces on femur axis, knee and foot of each leg [N].
    force, moment : array, shape (k, 3)
        Force on the body, coxa axes included, and its moment about B's origin [N, N m].
    rotors : array, shape (k, legs, 3)
        Torques that accelerate the rotors of the servos [N m].
    """

    points: Float[np.ndarray, "k legs 3 3"]
    force: Float[np.ndarray, "k 3"]
    moment: Float[np.ndarray, "k 3"]
    rotors: Float[np.ndarray, "k legs 3"]


def applied_loads(
    robot: Robot,
    motion: Motion,
    samples: Int[np.ndarray, "k"],
    *,
    payload: Payload,
    gravity: Sequence[float],
    inertial: bool,
    rotor_inertia: Float[np.ndarray, "legs 3"],
) -> AppliedLoads:
    """Return the loads at samples of a motion, for its commanded poses, as compliance changes the loads little.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    motion : Motion
        The motion.
    samples : array of int, shape (k,)
        The samples.
    payload : Payload
        Payload on the body.
    gravity : sequence of float
        Gravity in G [m/s^2].
    inertial : bool
        Whether inertial forces are included.
    rotor_inertia : array, shape (legs, 3)
        Inertias of the servos' rotors, reflected to the joints [kg m^2].
    """
    angles, body, rates = motion.angles[samples], motion.body[samples], BodyRates()
    velocity, acceleration = np.zeros_like(angles), np.zeros_like(angles)
    if inertial:
        velocity, acceleration = (each[samples] for each in differences(motion.time, motion.angles))
        every = BodyRates.of(motion.time, motion.body)
        rates = BodyRates(**{each.name: np.asarray(getattr(every, each.name))[samples] for each in fields(every)})
    points = np.asarray(forward_kinematics(robot, angles))
    joints = JointRates(velocity=velocity, acceleration=acceleration)
    loads = inertial_loads(robot, angles, body, joints, rates, payload=payload, gravity=gravity, points=points)
    moving, at = np.asarray(loads.points)[:, :, 1:], points[:, :, 1:]
    to_ground = np.swapaxes(body.rotation, -1, -2)
    force = loads.force - moving.sum((1, 2))
    moment = loads.moment - np.cross(at, moving).sum((1, 2))
    return AppliedLoads(
        points=np.ascontiguousarray(moving @ to_ground[:, None]),
        force=(force[:, None] @ to_ground)[:, 0],
        moment=(moment[:, None] @ to_ground)[:, 0],
        rotors=acceleration * rotor_inertia,
    )
