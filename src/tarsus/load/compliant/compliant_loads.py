"""Joint loads of a robot with elastic joints: compliant statics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.pose import Pose
from tarsus.load.compliant.applied_loads import applied_loads
from tarsus.load.compliant.equilibrium import Compliant
from tarsus.load.compliant.foot_contact import FootContact
from tarsus.load.compliant.history import History, equilibria
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.compliant.result import CompliantLoads
from tarsus.load.compliant.vibration import rigid_inertia
from tarsus.load.contact import GRAVITY, upward
from tarsus.load.loads import JointLoads, joint_loads
from tarsus.load.payload import Payload, as_payload
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["RATE", "compliant_loads"]

RATE = 50.0
"""Samples solved per second [1/s]; four times as many change the torques by 1 %, those of the coxae by 6 %."""


def compliant_loads(
    robot: Robot,
    motion: Motion,
    *,
    springs: JointSprings | float | None = None,
    contact: FootContact | None = None,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    inertial: bool = True,
    supply: float | None = None,
    rate: float = RATE,
) -> CompliantLoads:
    """Return the loads of a robot whose joints give way like springs and whose feet hold by friction.

    Position-controlled legs press against each other through the feet. How hard they press depends on the stiffness of
    the joints, and on where each foot touched down, how it rolled and where it slipped. The loads are those of the
    equilibria along the motion, one after the other. Soft joints also let the body swing when feet take over its
    weight; its inertia is included.

    Parameters
    ----------
    robot : Robot
        A single robot with masses. It may differ from the motion's robot in masses and servos.
    motion : Motion
        Commanded angles over time; touch-down follows from the achieved pose, not from the plan.
    springs : JointSprings or float, optional
        Elasticity of the joints; a number is the stiffness of every joint [N m/rad]. Default: the robot's servos.
    contact : FootContact, optional
        Friction and stiffness of feet and ground.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2]; tilted, it represents a slope.
    inertial : bool
        Whether inertial forces are included: those of the commanded motion, and those of the body and the rotors where
        they deviate from it.
    supply : float, optional
        Supply voltage of the servos [V]. Default: that of their ratings.
    rate : float
        Samples per second to solve [1/s]; values at the motion's samples between them are interpolated.

    Raises
    ------
    MissingDataError
        If the robot's masses, or without `springs` a servo, are unknown.
    InputError
        If the robot is a batch, or a value is out of its range.
    """
    require_robot(robot)
    if robot.batch_shape:
        raise InputError(f"robot {robot.name!r} is a batch of designs {robot.batch_shape}; expected one robot")
    if not 0 < rate < math.inf:
        raise InputError(f"rate is {rate:g} 1/s; it must be a finite number greater than 0")
    carried = as_payload(payload)
    rigid = joint_loads(robot, motion, payload=carried, gravity=gravity, inertial=inertial, supply=supply)
    if springs is None:
        springs = JointSprings.of(robot, supply=supply)
    elif not isinstance(springs, JointSprings):
        springs = JointSprings.uniform(robot, float(springs))
    contact = contact or FootContact()
    samples = _samples(motion, rate)
    loads = applied_loads(
        robot,
        motion,
        samples,
        payload=carried,
        gravity=gravity,
        inertial=inertial,
        rotor_inertia=springs.rotor_inertia,
    )
    weight = (float(total_mass(robot)) + carried.mass) * upward(gravity)[0]
    inertia = rigid_inertia(robot, motion.angles[0], carried) if inertial else None
    compliant, targets = Compliant(robot, springs, contact, inertia), springs.targets(motion.angles)
    solved = equilibria(compliant, motion, targets, loads, samples, weight)
    return _result(rigid, springs, contact, solved, samples)


def _samples(motion: Motion, rate: float) -> Int[np.ndarray, "k"]:
    """Return the samples to solve: evenly spaced, the first and the last among them."""
    stride = max(int(1.0 / (rate * float(np.median(np.diff(motion.time)))) + 1e-6), 1)
    chosen = np.arange(0, len(motion.time), stride)
    last = len(motion.time) - 1
    return chosen if chosen[-1] == last else np.append(chosen, last)


def _result(
    rigid: JointLoads, springs: JointSprings, contact: FootContact, solved: History, samples: Int[np.ndarray, "k"]
) -> CompliantLoads:
    motion = rigid.motion
    known = motion.time[samples]
    row = np.clip(np.searchsorted(known, motion.time, side="right") - 1, 0, len(known) - 2)
    share = (motion.time - known[row]) / (known[row + 1] - known[row])

    def between(values: Float[np.ndarray, "k *shape"]) -> Float[np.ndarray, "n *shape"]:
        at = share.reshape(-1, *(1,) * (values.ndim - 1))
        filled = (1 - at) * values[row] + at * values[row + 1]
        filled.setflags(write=False)
        return np.asarray(filled)

    left, _, right = np.linalg.svd(between(solved.rotation))  # the nearest rotations
    creep = "no creep" if math.isinf(contact.creep_time) else f"friction creeps with {contact.creep_time:g} s"
    assumed = (
        *rigid.assumed,
        *springs.assumed,
        (
            f"feet: friction {contact.friction:g}, stiffness {contact.normal_stiffness / 1000:g} N/mm down and "
            f"{contact.tangential_stiffness / 1000:g} N/mm sideways, {creep}"
        ),
    )
    loads = JointLoads(
        robot=rigid.robot,
        motion=motion,
        payload=rigid.payload,
        torques=between(solved.torques),
        forces=between(solved.forces),
        margin=rigid.margin,
        gravity=rigid.gravity,
        inertial=rigid.inertial,
        supply=rigid.supply,
        assumed=assumed,
    )
    return CompliantLoads(
        loads=loads,
        springs=springs,
        contact=contact,
        body=Pose(left @ right, between(solved.position)),
        angles=between(solved.angles),
        slip=between(solved.slip),
        residual=between(solved.residual),
        converged=solved.converged[row] & solved.converged[row + 1],
    )
