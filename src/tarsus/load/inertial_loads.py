"""Forces of weight and inertia on the points of the legs, and of the whole robot.

A rod's inertia needs no more than how its two ends accelerate. With its mass shared out to them (s of it at the outer
end, so that the centre of mass is right) and ``k = m (1/12 - s (1 - s))``, the forces of inertia on inner and outer end

    -m (1 - s) a_inner + k (a_outer - a_inner)        -m s a_outer - k (a_outer - a_inner)

have exactly the rod's resultant and moment; for s = 1/2 these are the finite element's consistent masses m/3, m/6.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tarsus.arrays import Array, Namespace, as_array, namespace, stack_last
from tarsus.kinematics.leg import checked_angles, forward_kinematics
from tarsus.kinematics.mass import point_masses
from tarsus.kinematics.pose import Pose
from tarsus.load.acceleration import BodyRates, JointRates, point_accelerations, turning
from tarsus.load.contact import GRAVITY, upward
from tarsus.load.payload import Payload, as_payload
from tarsus.robot.robot import Robot

__all__ = ["InertialLoads", "inertial_loads"]

_ROD = 1 / 12  # moment of inertia of a uniform rod across its middle, over m L^2; a box has it for each side


@dataclass(frozen=True, eq=False, kw_only=True)
class InertialLoads:
    """Forces of weight and inertia, in B's axes.

    Attributes
    ----------
    points : array, shape (..., legs, 4, 3)
        On the leg points [N].
    force, moment : array, shape (..., 3)
        Of all of it, body and payload included; the moment about B's origin [N, N m].
    """

    points: Array
    force: Array
    moment: Array


def inertial_loads(
    robot: Robot,
    angles: Array,
    body: Pose,
    joints: JointRates,
    rates: BodyRates,
    *,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    points: Array | None = None,
) -> InertialLoads:
    """Return the forces of weight and inertia on the leg points, and with body and payload in all.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; its masses must be known.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    body : Pose
        Places of B in G.
    joints : JointRates
        How the angles change.
    rates : BodyRates
        How the body's place changes.
    payload : Payload or float
        What the body carries; a number is a mass at its origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2].
    points : array, shape (..., legs, 4, 3), optional
        Leg points in B, where they are known already.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If a shape is wrong, or a value is not finite.
    """
    robot.require_masses()
    carried = as_payload(payload)
    strength, axes = upward(gravity)
    q = checked_angles(robot, angles)[1]
    points = forward_kinematics(robot, angles) if points is None else points
    moves = (joints.velocity, joints.acceleration, *vars(rates).values())
    makes = (robot.body_mass, robot.link_mass, robot.link_com, robot.body_com, robot.body_size)
    xp = namespace(points, body.rotation, *moves, *makes)
    points, rotation = as_array(xp, points), as_array(xp, body.rotation)
    omega, alpha, along = rates.within(xp, rotation)
    # Gravity is felt as an acceleration of everything upward.
    along = along + xp.matmul(as_array(xp, strength * axes[0]), rotation)
    moving = point_accelerations(xp, robot, as_array(xp, q), points, joints, (omega, alpha, along))
    on_points = _rod_forces(xp, robot, moving)
    force = xp.sum(on_points, axis=(-3, -2))
    moment = xp.sum(xp.linalg.cross(xp.broadcast_to(points, on_points.shape), on_points), axis=(-3, -2))
    turns = turning(xp, omega, alpha)
    for mass, place in ((robot.body_mass, robot.body_com), (carried.mass, np.asarray(carried.position))):
        arm = as_array(xp, place)
        felt = along + xp.matmul(turns, arm[..., None])[..., 0]
        pull = -xp.asarray(as_array(xp, mass))[..., None] * felt
        force, moment = force + pull, moment + _cross(xp, arm, pull)
    if robot.body_size is not None:
        box = _box(xp, robot)
        moment = moment - box * alpha - _cross(xp, omega, box * omega)
    return InertialLoads(points=on_points, force=force, moment=moment)


def _rod_forces(xp: Namespace, robot: Robot, moving: Array) -> Array:
    """Return what weight and inertia of the links exert on the leg points ``(..., legs, 4, 3)``."""
    ends, masses = point_masses(xp, robot), as_array(xp, robot.link_mass)
    # The first link alone has a part at the first point; what is left at the second is the second's; and so on.
    outer = []
    rest = xp.zeros_like(masses[..., 0])
    for link in range(3):
        rest = masses[..., link] - ends[..., link] + rest
        outer.append(rest)
    out = stack_last(xp, tuple(outer))
    some = masses > 0
    bend = xp.where(some, masses * _ROD - out * (masses - out) / xp.where(some, masses, 1.0), 0.0)
    stretch = bend[..., None] * (moving[..., 1:, :] - moving[..., :-1, :])
    on_inner = stretch - (masses - out)[..., None] * moving[..., :-1, :]
    on_outer = -stretch - out[..., None] * moving[..., 1:, :]
    none = xp.zeros_like(on_inner[..., :1, :])
    return xp.concat((on_inner, none), axis=-2) + xp.concat((none, on_outer), axis=-2)


def _box(xp: Namespace, robot: Robot) -> Array:
    """Return the body's moments of inertia about its centre of mass ``(..., 3)`` [kg m^2]."""
    squares = as_array(xp, robot.body_size) ** 2
    return as_array(xp, robot.body_mass)[..., None] * (xp.sum(squares, axis=-1)[..., None] - squares) * _ROD


def _cross(xp: Namespace, left: Array, right: Array) -> Array:
    shape = np.broadcast_shapes(left.shape, right.shape)
    return xp.linalg.cross(xp.broadcast_to(left, shape), xp.broadcast_to(right, shape))
