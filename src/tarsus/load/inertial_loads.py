"""Weight and inertial forces on the leg points, and on the whole robot.

The inertial forces of a rod follow from the accelerations of its two ends. With a fraction s of its mass m at the outer
end, which places the centre of mass, and ``k = m (1/12 - s (1 - s))``, the forces on the inner and the outer end

    -m (1 - s) a_inner + k (a_outer - a_inner)        -m s a_outer - k (a_outer - a_inner)

have exactly the resultant and the moment of the rod. For s = 1/2 these are the consistent masses m/3 and m/6 of the
finite element method.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, Namespace, as_array, namespace, stack_last
from tarsus.kinematics.leg import checked_angles, forward_kinematics
from tarsus.kinematics.mass import point_masses
from tarsus.kinematics.pose import Pose
from tarsus.load.acceleration import BodyRates, JointRates, angular_matrix, point_accelerations
from tarsus.load.contact import GRAVITY, upward
from tarsus.load.payload import Payload, as_payload
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["InertialLoads", "inertial_loads"]

_ROD = 1 / 12  # moment of inertia of a uniform rod about its centre, over m L^2; also of a box, for each side


@dataclass(frozen=True, eq=False, kw_only=True)
class InertialLoads:
    """Weight and inertial forces, in B's axes.

    Attributes
    ----------
    points : array, shape (..., legs, 4, 3)
        Forces on the leg points [N].
    force : array, shape (..., 3)
        Resultant of legs, body and payload [N].
    moment : array, shape (..., 3)
        Moment of legs, body and payload about B's origin [N m].
    """

    points: Float[Array, "*#batch legs 4 3"]
    force: Float[Array, "*#batch 3"]
    moment: Float[Array, "*#batch 3"]


def inertial_loads(
    robot: Robot,
    angles: Float[Array, "*#batch legs 3"],
    body: Pose,
    joints: JointRates,
    rates: BodyRates,
    *,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    points: Float[Array, "*#batch legs 4 3"] | None = None,
) -> InertialLoads:
    """Return the weight and inertial forces on the leg points, and the resultant with body and payload.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; its masses must be known.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    body : Pose
        Pose of B in G.
    joints : JointRates
        Joint velocities and accelerations.
    rates : BodyRates
        Angular rates and acceleration of the body.
    payload : Payload or float
        What the body carries; a number is a mass at its origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2].
    points : array, shape (..., legs, 4, 3), optional
        Leg points in B [m], if already computed.

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
    rate_arrays = (joints.velocity, joints.acceleration, *vars(rates).values())
    robot_arrays = (robot.body_mass, robot.link_mass, robot.link_com, robot.body_com, robot.body_size)
    xp = namespace(points, body.rotation, *rate_arrays, *robot_arrays)
    points, rotation = as_array(xp, points), as_array(xp, body.rotation)
    omega, alpha, linear = rates.within(xp, rotation)
    # Gravity is equivalent to an upward acceleration of the whole robot.
    linear = linear + xp.matmul(as_array(xp, strength * axes[0]), rotation)
    accelerations = point_accelerations(xp, robot, as_array(xp, q), points, joints, (omega, alpha, linear))
    on_points = _rod_forces(xp, robot, accelerations)
    force = xp.sum(on_points, axis=(-3, -2))
    moment = xp.sum(xp.linalg.cross(xp.broadcast_to(points, on_points.shape), on_points), axis=(-3, -2))
    angular = angular_matrix(xp, omega, alpha)
    for mass, com in ((robot.body_mass, robot.body_com), (carried.mass, np.asarray(carried.position))):
        arm = as_array(xp, com)
        acceleration = linear + xp.matmul(angular, arm[..., None])[..., 0]
        inertial_force = -xp.asarray(as_array(xp, mass))[..., None] * acceleration
        force, moment = force + inertial_force, moment + _cross(xp, arm, inertial_force)
    if robot.body_size is not None:
        box = _box(xp, robot)
        moment = moment - box * alpha - _cross(xp, omega, box * omega)
    return InertialLoads(points=on_points, force=force, moment=moment)


def _rod_forces(
    xp: Namespace, robot: Robot, accelerations: Float[Array, "... legs 4 3"]
) -> Float[Array, "*batch legs 4 3"]:
    """Return the weight and inertial forces of the links on the leg points ``(..., legs, 4, 3)``."""
    ends, masses = point_masses(xp, robot), as_array(xp, robot.link_mass)
    # Only the first link contributes to the first point mass, so the outer masses follow link by link.
    outer = []
    remainder = xp.zeros_like(masses[..., 0])
    for link in range(3):
        remainder = masses[..., link] - ends[..., link] + remainder
        outer.append(remainder)
    outer_mass = stack_last(xp, tuple(outer))
    has_mass = masses > 0
    coupling = xp.where(
        has_mass, masses * _ROD - outer_mass * (masses - outer_mass) / xp.where(has_mass, masses, 1.0), 0.0
    )
    relative = coupling[..., None] * (accelerations[..., 1:, :] - accelerations[..., :-1, :])
    on_inner = relative - (masses - outer_mass)[..., None] * accelerations[..., :-1, :]
    on_outer = -relative - outer_mass[..., None] * accelerations[..., 1:, :]
    zeros = xp.zeros_like(on_inner[..., :1, :])
    return xp.concat((on_inner, zeros), axis=-2) + xp.concat((zeros, on_outer), axis=-2)


def _box(xp: Namespace, robot: Robot) -> Float[Array, "*batch 3"]:
    """Return the body's moments of inertia about its centre of mass ``(..., 3)`` [kg m^2]."""
    squares = as_array(xp, robot.body_size) ** 2
    return as_array(xp, robot.body_mass)[..., None] * (xp.sum(squares, axis=-1)[..., None] - squares) * _ROD


def _cross(xp: Namespace, left: Float[Array, "... 3"], right: Float[Array, "... 3"]) -> Float[Array, "... 3"]:
    shape = np.broadcast_shapes(left.shape, right.shape)
    return xp.linalg.cross(xp.broadcast_to(left, shape), xp.broadcast_to(right, shape))
