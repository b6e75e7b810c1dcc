"""Servos as actuators of the physics engine, which then computes their torques itself in every step.

The torque of a servo (`tarsus.simulation.servos.torque_law`) is, with the target c, the joint angle q, its speed w,
half the backlash p and the slope s of the torque-speed line, the sum of three actuators within the stall torque::

    forward    stiffness * (c - p - q)   within  0 and stall
    backward   stiffness * (c + p - q)   within  -stall and 0
    back-EMF   -s * w

Forward and backward together are ``stiffness * dead_zone(c - q, p)`` within the stall torque. The joint limits the sum
of all three to the stall torque. Further damping is the joint's own; the implicit integrator treats both kinds of
damping alike.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.servos.servo_model import ServoModel

__all__ = ["ACTUATORS", "add_servo"]

ACTUATORS = ("forward", "backward", "back-EMF")
"""Names of a joint's actuators, each of which follows the name of the joint."""

# Stands for a torque without limit, as the engine takes only finite ranges [N m].
_UNLIMITED = 1e10


def add_servo(spec: Any, joint: Any, servo: ServoModel) -> None:
    """Add the actuators of a servo to a model, and the limit of their torque to its joint.

    Parameters
    ----------
    spec : mujoco.MjSpec
        The model; it is changed.
    joint : mujoco.MjsJoint
        The joint that the servo moves.
    servo : ServoModel
        The servo.
    """
    mujoco, stall = mujoco_module(), min(servo.stall_torque, _UNLIMITED)
    joint.actfrcrange = (-stall, stall)
    for name, (gain, bias, limits) in zip(ACTUATORS, _actuators(servo, stall), strict=True):
        actuator = spec.add_actuator(
            name=f"{joint.name} {name}",
            target=joint.name,
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            gaintype=mujoco.mjtGain.mjGAIN_FIXED,
            biastype=mujoco.mjtBias.mjBIAS_AFFINE,
        )
        actuator.gainprm[0] = gain
        actuator.biasprm[:3] = bias
        if limits:
            actuator.forcerange = limits


def _actuators(servo: ServoModel, stall: float) -> Iterator[tuple[float, tuple[float, float, float], Any]]:
    """Yield for each actuator its gain, its bias (constant, position gain, velocity gain) and its limits."""
    stiffness, play = servo.stiffness, servo.backlash / 2
    yield stiffness, (-stiffness * play, -stiffness, 0.0), (0.0, stall)
    yield stiffness, (stiffness * play, -stiffness, 0.0), (-stall, 0.0)
    yield 0.0, (0.0, 0.0, -servo.torque_speed_slope), None
