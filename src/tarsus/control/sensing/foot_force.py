"""What the ground pushes on the feet with: felt in the joints' torques, and as it should be when standing well.

A leg's weight and the ground's force f on its foot turn its joints by ``w + J^T f``, which the servos' torques tau
balance: ``f = -J^-T (tau + w)``. In the leg's own plane, with outward r, sideways t (to the left, seen outward) and
up z, and from each joint's axis to the foot::

    coxa    r f_t - side f_r     = -(tau + w)
    femur   r f_z - z f_r        = -(tau + w)
    tibia   r f_z - z f_r        = -(tau + w)
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tarsus.arrays import Array, as_floats, require_finite
from tarsus.control.readings import Vector
from tarsus.errors import InputError
from tarsus.kinematics.leg import checked_angles
from tarsus.kinematics.mass import point_masses
from tarsus.robot.robot import Robot

__all__ = ["STANDARD_GRAVITY", "FootForceEstimator", "balanced_forces", "foot_forces_from_torques"]

STANDARD_GRAVITY = 9.80665
"""[m/s^2]"""

# A leg is singular where its knee is this near to straight or folded (as the sine), or its foot, as a share of the
# leg's length, this near to the coxa's axis: a torque's error would be magnified twentyfold.
_SINGULAR = 0.05


class FootForceEstimator:
    """The forces on one robot's feet as its joints' torques tell them.

    Parameters
    ----------
    robot : Robot
        One robot. Where its file gives no masses, its links count as weightless.

    Raises
    ------
    InputError
        If the robot is a batch of designs.
    """

    def __init__(self, robot: Robot) -> None:
        if robot.batch_shape:
            raise InputError(f"robot {robot.name!r} is a batch of designs {robot.batch_shape}; this serves one robot")
        g = robot.geometry
        masses = point_masses(np, robot) if robot.has_masses else np.zeros((robot.legs, 4))
        columns = (robot.mount_yaw, g.coxa, g.femur, g.tibia, g.side, *(STANDARD_GRAVITY * masses[:, 1:]).T)
        self._legs = np.stack(columns, axis=-1).tolist()

    def forces(
        self, angles: Sequence[Sequence[float]], torques: Sequence[Sequence[float] | None], up: Vector = (0.0, 0.0, 1.0)
    ) -> tuple[Vector | None, ...]:
        """Return the ground's forces on the feet; None for a leg that is singular, or whose torques are unknown.

        Parameters
        ----------
        angles : sequence of (coxa, femur, tibia)
            Joint angles of each leg, finite [rad].
        torques : sequence of ((coxa, femur, tibia) or None)
            What the servos exert, finite [N m].
        up : (x, y, z)
            The direction opposite to gravity in B, of length 1.

        Returns
        -------
        tuple of ((x, y, z) or None)
            Ground on foot in B [N].
        """
        return tuple(
            None if tau is None else _foot_force(leg, q, tau, up)
            for leg, q, tau in zip(self._legs, angles, torques, strict=True)
        )


def _foot_force(leg: Sequence[float], q: Sequence[float], tau: Sequence[float], up: Vector) -> Vector | None:
    yaw, coxa, femur, tibia, side, hip_weight, knee_weight, foot_weight = leg
    cos, sin = math.cos(yaw + q[0]), math.sin(yaw + q[0])
    slope = q[1] + q[2]
    femur_r, femur_z = femur * math.cos(q[1]), femur * math.sin(q[1])
    tibia_r, tibia_z = tibia * math.cos(slope), tibia * math.sin(slope)
    leg_r, leg_z = femur_r + tibia_r, femur_z + tibia_z
    foot_r = coxa + leg_r
    across = leg_r * tibia_z - leg_z * tibia_r
    if abs(across) < _SINGULAR * femur * tibia or abs(foot_r) < _SINGULAR * (coxa + femur + tibia):
        return None
    # Weights act along -up: its parts in the leg's axes.
    up_r, up_t, up_z = up[0] * cos + up[1] * sin, up[1] * cos - up[0] * sin, up[2]
    weight = hip_weight + knee_weight + foot_weight
    outward = hip_weight * coxa + knee_weight * (coxa + femur_r) + foot_weight * foot_r
    turn_coxa = -tau[0] + outward * up_t - weight * side * up_r
    turn_femur = (
        -tau[1] + _moment(knee_weight, femur_r, femur_z, up_r, up_z) + _moment(foot_weight, leg_r, leg_z, up_r, up_z)
    )
    turn_tibia = -tau[2] + _moment(foot_weight, tibia_r, tibia_z, up_r, up_z)
    force_r = (turn_femur * tibia_r - turn_tibia * leg_r) / across
    force_z = (turn_femur * tibia_z - turn_tibia * leg_z) / across
    force_t = (turn_coxa + side * force_r) / foot_r
    return force_r * cos - force_t * sin, force_r * sin + force_t * cos, force_z


def _moment(weight: float, r: float, z: float, up_r: float, up_z: float) -> float:
    return weight * (r * up_z - z * up_r)


def foot_forces_from_torques(
    robot: Robot, angles: Array, torques: Array, *, up: Vector = (0.0, 0.0, 1.0)
) -> tuple[Vector | None, ...]:
    """Return the ground's forces on the feet that the joints' torques tell; None for a leg that is singular.

    Statics only: what accelerates a leg counts as the ground's force, so that a swinging foot's is no measure.
    For one robot tick by tick, a `FootForceEstimator` does the same without looking at the robot anew.

    Parameters
    ----------
    robot : Robot
        One robot. Where its file gives no masses, its links count as weightless.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    torques : array, shape (legs, 3)
        What the servos exert [N m].
    up : (x, y, z)
        The direction opposite to gravity in B, of length 1.

    Returns
    -------
    tuple of ((x, y, z) or None)
        Ground on foot in B [N].

    Raises
    ------
    InputError
        If the robot is a batch of designs, a shape is wrong, or a value is not finite.
    """
    sense = FootForceEstimator(robot)
    angles = checked_angles(robot, angles)[1]
    torques = as_floats(np, torques, name="torques")
    require_finite("torques", torques)
    for name, values in (("angles", angles), ("torques", torques)):
        if values.shape != (robot.legs, 3):
            raise InputError(f"{name} has shape {values.shape}; expected ({robot.legs}, 3)")
    return sense.forces(angles.tolist(), torques.tolist(), up)


def balanced_forces(
    feet: Sequence[Sequence[float]], contacts: Sequence[bool], centre: Sequence[float], weight: float
) -> tuple[float, ...]:
    """Return the vertical forces with which the feet carry a weight, the sum of their squares least.

    Statics leave a choice with more than three feet; the one with the least squares is linear in the feet's places:
    ``f = weight / n + a (x - x_mean) + b (y - y_mean)``, a and b from the moments about the mean.

    Parameters
    ----------
    feet : sequence of (x, y, ...)
        Feet on the ground plane [m].
    contacts : sequence of bool
        Which bear load.
    centre : (x, y)
        The centre of mass over the ground plane, in the same frame [m].
    weight : float
        What is to be carried [N].

    Returns
    -------
    tuple of float
        Ground on foot, upward [N]; 0 for feet in the air, and never negative: where the centre is not over the
        support, or the feet are in a line, the moments are not balanced.
    """
    down = [foot for foot, touch in zip(feet, contacts, strict=True) if touch]
    if not down:
        return (0.0,) * len(feet)
    count = len(down)
    mean_x, mean_y = sum(f[0] for f in down) / count, sum(f[1] for f in down) / count
    xx = sum((f[0] - mean_x) ** 2 for f in down)
    yy = sum((f[1] - mean_y) ** 2 for f in down)
    xy = sum((f[0] - mean_x) * (f[1] - mean_y) for f in down)
    off_x, off_y = weight * (centre[0] - mean_x), weight * (centre[1] - mean_y)
    spread = xx * yy - xy * xy
    across = spread > 1e-6 * (xx + yy) ** 2
    a = (yy * off_x - xy * off_y) / spread if across else 0.0
    b = (xx * off_y - xy * off_x) / spread if across else 0.0
    return tuple(
        max(weight / count + a * (foot[0] - mean_x) + b * (foot[1] - mean_y), 0.0) if touch else 0.0
        for foot, touch in zip(feet, contacts, strict=True)
    )
