"""Deflection of loaded joints, and commands that compensate for it."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import require_float
from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.loads import joint_loads
from tarsus.load.payload import Payload
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = [
    "SHARE",
    "TRANSFER_TIME",
    "checked_share",
    "commands_within_limits",
    "compensate_deflection",
    "joint_deflections",
    "what_is_compensated",
]

TRANSFER_TIME = 0.08
"""Time in which a foot takes over its load, centred on touch-down and lift-off [s]."""

SHARE = 0.75
"""Share of the deflection that commands compensate for. Feet lean against each other through friction, which bears a
part of the load: femur torques in physics are 0.6 to 0.9 of those of vertical forces. Where the whole deflection is
compensated for, bodies rise above their height, walks are up to 5 % too long, and the weakest servos saturate."""


def joint_deflections(
    motion: Motion,
    *,
    springs: JointSprings | None = None,
    payload: Payload | float = 0.0,
    transfer_time: float = TRANSFER_TIME,
) -> Float[np.ndarray, "n legs 3"]:
    """Return how far loads turn the joints from their commands: torque of vertical forces over stiffness.

    Loads that a plan transfers in an instant are transferred linearly within `transfer_time`.

    Parameters
    ----------
    motion : Motion
        The motion of a robot with masses.
    springs : JointSprings, optional
        Elasticity of the joints. Default: the robot's servos.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].
    transfer_time : float
        Time in which a foot takes over its load [s]; 0 for an instant.

    Returns
    -------
    array, shape (n, legs, 3)
        Command less joint angle [rad].

    Raises
    ------
    MissingDataError
        If the masses, or without `springs` a servo, are unknown.
    InputError
        If `transfer_time` is negative or not finite.
    """
    transfer_time = require_float("transfer_time", transfer_time)
    if not 0 <= transfer_time < np.inf:
        raise InputError(f"transfer_time is {transfer_time:g} s; it must be a finite number, not negative")
    springs = JointSprings.of(motion.robot) if springs is None else springs
    deflection: np.ndarray = joint_loads(motion.robot, motion, payload=payload).torques / springs.stiffness
    # The mean over the transfer time, by the trapezoidal rule: exact for any sampling, and constant where the load is.
    time = motion.time
    steps = np.diff(time)[:, None, None] * (deflection[1:] + deflection[:-1]) / 2
    total = np.concatenate([np.zeros_like(deflection[:1]), np.cumsum(steps, axis=0)])
    start = np.maximum(time - transfer_time / 2, time[0])
    end = np.minimum(time + transfer_time / 2, time[-1])
    if not (end > start).all():
        return deflection
    flat = total.reshape(time.size, -1).T
    mean = [(np.interp(end, time, each) - np.interp(start, time, each)) / (end - start) for each in flat]
    return np.stack(mean, axis=-1).reshape(deflection.shape)


def checked_share(share: float) -> float:
    """Return a share of the deflection.

    Parameters
    ----------
    share : float
        The share.

    Raises
    ------
    InputError
        If it is not between 0 and 1.
    """
    number = require_float("share", share)
    if not 0 <= number <= 1:
        raise InputError(f"share is {number:g}; it must be a number from 0 to 1")
    return number


def commands_within_limits(
    robot: Robot, angles: Float[np.ndarray, "*batch legs 3"], offsets: Float[np.ndarray, "*batch legs 3"]
) -> Float[np.ndarray, "*batch legs 3"]:
    """Return joint angles with offsets added, within the joint limits; angles beyond a limit move no further out.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    offsets : array, shape (..., legs, 3)
        What is added [rad].
    """
    limits = np.asarray(robot.limits)
    # Angles beyond a limit were already reported when the motion was planned.
    lower, upper = np.minimum(limits[..., 0], angles), np.maximum(limits[..., 1], angles)
    return np.asarray(np.clip(angles + offsets, lower, upper))


def what_is_compensated(share: float) -> str:
    """Return the line that states the compensation among the assumptions of a result.

    Parameters
    ----------
    share : float
        Share of the deflection that is compensated for.
    """
    return f"commands compensate for {100 * share:.0f} % of the deflection of the joints under vertical forces"


def compensate_deflection(
    motion: Motion,
    *,
    springs: JointSprings | None = None,
    payload: Payload | float = 0.0,
    transfer_time: float = TRANSFER_TIME,
    share: float = SHARE,
) -> Motion:
    """Return a motion whose commands compensate for the deflection of its joints under load.

    Feet that bear load are commanded lower by what the joints yield, so that the body sags less and swinging feet keep
    their clearance. The feet then lean less against each other, and as leaning takes load off the femurs, their torques
    come closer to those of vertical forces the more is compensated for. Commands stay within the joint limits.

    Parameters
    ----------
    motion : Motion
        The motion of a robot with masses.
    springs : JointSprings, optional
        Elasticity of the joints. Default: the robot's servos.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].
    transfer_time : float
        Time in which a foot takes over its load [s]; 0 for an instant.
    share : float
        Share of the deflection that is compensated for, 0 to 1.

    Returns
    -------
    Motion
        The same body and feet; its joint angles are commands.

    Raises
    ------
    MissingDataError
        If the masses, or without `springs` a servo, are unknown.
    InputError
        If `transfer_time` is negative or not finite, or the share is not between 0 and 1.
    """
    share = checked_share(share)
    deflection = joint_deflections(motion, springs=springs, payload=payload, transfer_time=transfer_time)
    return dataclasses.replace(
        motion,
        angles=commands_within_limits(motion.robot, motion.angles, share * deflection),
        assumed=(*motion.assumed, what_is_compensated(share)),
    )
