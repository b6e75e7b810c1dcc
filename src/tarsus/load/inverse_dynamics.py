"""Joint torques of a moving robot: inverse dynamics with ground contacts.

A link is a slender uniform rod with its own centre of mass: of mass m and length L, it has the moment of inertia
``m L^2 / 12`` across its axis and none about it. The body is a homogeneous box of `body_size`, or a point mass if its
size is unknown; the payload is a point mass. Rotor inertia is neglected.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tarsus.arrays import Array, as_array, broadcast_shapes, namespace
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.load.acceleration import BodyRates, JointRates, differences
from tarsus.load.contact import GRAVITY, checked_contacts, contact_forces
from tarsus.load.inertial_loads import inertial_loads
from tarsus.load.payload import Payload
from tarsus.load.torque import checked_forces, joint_torques, torques_of
from tarsus.load.zero_moment import ground_forces
from tarsus.representation import represented
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

    from tarsus.gait.motion import Motion

__all__ = ["MotionTorques", "dynamic_torques", "motion_torques"]


@represented()
@dataclass(frozen=True, eq=False, kw_only=True)
class MotionTorques:
    """Joint torques and contact forces of a motion.

    Attributes
    ----------
    torques : array, shape (..., legs, 3)
        Joint torques [N m].
    forces : array, shape (..., legs, 3)
        Ground on foot, in G [N].
    margin : array, shape (...)
        Distance of the centre of mass, or with inertia of the zero-moment point, from the nearest edge of the support
        polygon [m]; negative outside: the robot tips.
    assumed : tuple of str
        Assumptions made.
    """

    torques: Float[Array, "*#batch legs 3"]
    forces: Float[Array, "*#batch legs 3"]
    margin: Float[Array, "*#batch"]
    assumed: tuple[str, ...] = ()


def motion_torques(
    robot: Robot,
    motion: Motion,
    *,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    inertial: bool = True,
) -> MotionTorques:
    """Return the joint torques along a motion, with or without the inertia of legs, body and payload.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs ``(..., 1)`` whose last axis is time; its masses must be known.
    motion : Motion
        The motion, on flat ground.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2]; tilted, it represents a slope.
    inertial : bool
        Whether inertial forces are included; without them the torques are quasi-static.

    Returns
    -------
    MotionTorques
        Over the motion's samples ``(n,)``.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If a value is not finite or out of its range, or no foot is down.

    Notes
    -----
    Velocities and accelerations are central differences of the samples (`differences`): with steps h the error of an
    acceleration is ``h^2/12`` times the fourth derivative.
    """
    angles, body, contacts = motion.angles, motion.body, motion.contacts
    if not inertial:
        statics = contact_forces(robot, angles, body, contacts, payload=payload, gravity=gravity)
        torques, forces = joint_torques(robot, angles, body, contacts, gravity=gravity, forces=statics.forces)
        return MotionTorques(torques=torques, forces=forces, margin=statics.margin)
    velocity, acceleration = differences(motion.time, angles)
    joints = JointRates(velocity=velocity, acceleration=acceleration)
    rates = BodyRates.of(motion.time, body)
    return dynamic_torques(robot, angles, body, contacts, joints, rates, payload=payload, gravity=gravity)


def dynamic_torques(
    robot: Robot,
    angles: Float[Array, "*#batch legs 3"],
    body: Pose,
    contacts: Bool[Array, "*#batch legs"],
    joints: JointRates,
    rates: BodyRates,
    *,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    forces: Float[Array, "*#batch legs 3"] | None = None,
) -> MotionTorques:
    """Return the joint torques for given joint and body accelerations.

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
    joints : JointRates
        Joint velocities and accelerations.
    rates : BodyRates
        Angular rates and acceleration of the body.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2].
    forces : array, shape (..., legs, 3), optional
        Ground on foot in G [N], if known; `margin` is still that of the zero-moment point.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If a shape is wrong, a value is not finite, or no foot is down.
    """
    points = forward_kinematics(robot, angles)
    loads = inertial_loads(robot, angles, body, joints, rates, payload=payload, gravity=gravity, points=points)
    xp = namespace(points, loads.force, contacts, forces)
    contacts = checked_contacts(xp, robot, contacts)
    points, rotation = as_array(xp, points), as_array(xp, body.rotation)
    to_ground = xp.matrix_transpose(rotation)
    feet = xp.matmul(points[..., 3, :], to_ground)
    batch = broadcast_shapes(
        "robot, angles, body, rates and contacts", feet.shape[:-2], loads.force.shape[:-1], contacts.shape[:-1]
    )
    ground_wrench = [
        -xp.matmul(as_array(xp, v)[..., None, :], to_ground)[..., 0, :] for v in (loads.force, loads.moment)
    ]
    solved, margin = ground_forces(xp, feet, contacts, ground_wrench[0], ground_wrench[1], batch)
    forces = solved if forces is None else checked_forces(xp, robot, forces)
    contact = xp.matmul(forces, rotation)
    torques = torques_of(xp, robot, as_array(xp, angles), points, as_array(xp, loads.points), contact)
    return MotionTorques(torques=torques, forces=forces, margin=margin, assumed=_assumed(robot))


def _assumed(robot: Robot) -> tuple[str, ...]:
    """Return the assumptions of inverse dynamics."""
    body = "a homogeneous box" if robot.body_size is not None else "a point mass, as its size is unknown"
    return (f"inertia: each link is a slender uniform rod, the body {body}; rotor inertia is neglected",)
