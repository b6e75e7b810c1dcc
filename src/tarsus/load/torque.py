"""Joint torques in static equilibrium."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tarsus.arrays import Array, Namespace, as_array, as_floats, namespace, require_finite, require_shape, stack_last
from tarsus.kinematics.leg import checked_angles, forward_kinematics
from tarsus.kinematics.mass import point_masses
from tarsus.kinematics.pose import Pose
from tarsus.load.contact import GRAVITY, contact_forces, upward
from tarsus.load.payload import Payload
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["checked_forces", "joint_torques", "torques_of"]


def joint_torques(
    robot: Robot,
    angles: Float[Array, "*#batch legs 3"],
    body: Pose,
    contacts: Bool[Array, "*#batch legs"],
    payload: Payload | float = 0.0,
    *,
    gravity: Sequence[float] = GRAVITY,
    forces: Float[Array, "*#batch legs 3"] | None = None,
) -> tuple[Float[Array, "... legs 3"], Float[Array, "... legs 3"]]:
    """Return the joint torques that hold the robot, and the contact forces.

    Quasi-static: the moments of the link weights, and ``-J^T f`` for the contact forces `f`. A positive torque acts in
    the joint's positive direction; a standing leg pushes its foot down with a negative femur torque.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; its masses must be known.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    body : Pose
        Pose of B in G.
    contacts : array of bool, shape (..., legs)
        Which feet are on the ground.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2].
    forces : array, shape (..., legs, 3), optional
        Ground on foot in G [N], if known; `contacts` and `payload` are then ignored. Default: `contact_forces`.

    Returns
    -------
    torques : array, shape (..., legs, 3)
        Torques of coxa, femur and tibia [N m].
    forces : array, shape (..., legs, 3)
        Ground on foot, in G [N].

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If a shape is wrong, a value is not finite, no foot is on the ground, or gravity is 0.
    """
    require_robot(robot)
    robot.require_masses()
    strength, axes = upward(gravity)
    points = forward_kinematics(robot, angles)
    if forces is None:
        solved = contact_forces(robot, angles, body, contacts, payload=payload, gravity=gravity, points=points)
        forces = solved.forces
    q = checked_angles(robot, angles)[1]
    masses = point_masses(namespace(points, robot.link_mass, robot.link_com), robot)
    xp = namespace(points, forces, body.rotation, masses)
    rotation = as_array(xp, body.rotation)
    forces = checked_forces(xp, robot, forces)
    weight = xp.matmul(as_array(xp, -strength * axes[0]), rotation)
    weights = as_array(xp, masses)[..., None] * weight[..., None, None, :]
    contact = xp.matmul(forces, rotation)
    return torques_of(xp, robot, as_array(xp, q), as_array(xp, points), weights, contact), forces


def checked_forces(
    xp: Namespace, robot: Robot, forces: Float[Array, "*#batch legs 3"]
) -> Float[Array, "*batch legs 3"]:
    """Validate forces on the feet.

    Parameters
    ----------
    xp : namespace
        The array library.
    robot : Robot
        The robot.
    forces : array, shape (..., legs, 3)
        Ground on foot in G [N].

    Returns
    -------
    array, shape (..., legs, 3)
        The same, as floats.

    Raises
    ------
    InputError
        If the shape is wrong, or a force is NaN or infinite.
    """
    forces = as_floats(xp, forces, name="forces")
    require_shape("forces", forces, (robot.legs, 3))
    require_finite("forces", forces)
    return forces


def torques_of(
    xp: Namespace,
    robot: Robot,
    angles: Float[Array, "*#batch legs 3"],
    points: Float[Array, "*#batch legs 4 3"],
    loads: Float[Array, "*#batch legs 4 3"],
    contact: Float[Array, "*#batch legs 3"],
) -> Float[Array, "*batch legs 3"]:
    """Return the joint torques that balance forces on the leg points, all in B.

    Parameters
    ----------
    xp : namespace
        The array library.
    robot : Robot
        The robot, or a batch of designs.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    points : array, shape (..., legs, 4, 3)
        Leg points [m].
    loads : array, shape (..., legs, 4, 3)
        Forces on the leg points: weight and inertia [N].
    contact : array, shape (..., legs, 3)
        Contact forces on the feet [N].

    Returns
    -------
    array, shape (..., legs, 3)
        Torques of coxa, femur and tibia [N m].
    """
    heading = as_array(xp, robot.mount_yaw) + angles[..., 0]
    cos, sin = xp.cos(heading), xp.sin(heading)
    foot = loads[..., 3, :] + contact
    forces = ((loads[..., 1, 0], loads[..., 1, 1], loads[..., 1, 2]), *_components(loads[..., 2, :], foot))
    at = [tuple(points[..., i, axis] for axis in range(3)) for i in range(4)]
    coxa = femur = tibia = 0.0
    for point, (fx, fy, fz) in enumerate(forces, start=1):
        arm = [at[point][axis] - at[0][axis] for axis in range(2)]
        coxa = coxa - (arm[0] * fy - arm[1] * fx)
        radial = fx * cos + fy * sin
        if point > 1:
            femur = femur - _lifting_moment(at[1], at[point], cos, sin, radial, fz)
        if point > 2:
            tibia = tibia - _lifting_moment(at[2], at[point], cos, sin, radial, fz)
    return stack_last(xp, (coxa, femur, tibia))


def _components(
    *vectors: Float[Array, "... legs 3"],
) -> list[tuple[Float[Array, "... legs"], Float[Array, "... legs"], Float[Array, "... legs"]]]:
    return [(v[..., 0], v[..., 1], v[..., 2]) for v in vectors]


def _lifting_moment(
    axis: tuple[Float[Array, "... legs"], ...],
    point: tuple[Float[Array, "... legs"], ...],
    cos: Float[Array, "... legs"],
    sin: Float[Array, "... legs"],
    radial: Float[Array, "... legs"],
    up: Float[Array, "... legs"],
) -> Float[Array, "... legs"]:
    """Return the moment, positive when lifting, of a force in the leg's plane about a joint axis normal to it."""
    distance = (point[0] - axis[0]) * cos + (point[1] - axis[1]) * sin
    return distance * up - (point[2] - axis[2]) * radial
