"""Forces on the feet of one robot at one time, in plain floats: from joint torques, and in static equilibrium.

Joint torques tau balance a leg's weight w and the force f of the ground on its foot: ``tau + w + J^T f = 0``, so
``f = -J^-T (tau + w)``. In the vertical plane of the leg, with r outward, t sideways (to the left, seen outward) and
z upward, each measured from the joint's axis to the foot::

    coxa    r f_t - side f_r     = -(tau + w)
    femur   r f_z - z f_r        = -(tau + w)
    tibia   r f_z - z f_r        = -(tau + w)
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from tarsus.errors import InputError
from tarsus.kinematics.mass import STANDARD_GRAVITY, point_masses
from tarsus.kinematics.planar_moments import PlanarMoments
from tarsus.robot.robot import Robot

__all__ = ["FootForceEstimator", "balanced_forces"]

Vector: TypeAlias = tuple[float, float, float]

# A leg counts as singular where the sine of its tibia angle, or the distance of its foot from the coxa axis over the
# length of the leg, is below this: errors of the torques would be magnified twentyfold.
_SINGULAR = 0.05
# Relative determinant below which feet count as collinear.
_LEAST_SPREAD = 1e-6


class FootForceEstimator:
    """Estimates the forces on the feet of one robot from its joint torques.

    Quasi-static: the inertia of an accelerating leg appears as a force on its foot, so the result is meaningless for
    swinging feet.

    Parameters
    ----------
    robot : Robot
        One robot. Without masses in its file, its links count as massless.

    Raises
    ------
    InputError
        If the robot is a batch of designs.
    """

    def __init__(self, robot: Robot) -> None:
        if robot.batch_shape:
            raise InputError(f"robot {robot.name!r} is a batch of designs {robot.batch_shape}; expected one robot")
        g = robot.geometry
        masses = point_masses(np, robot) if robot.has_masses else np.zeros((robot.legs, 4))
        columns = (robot.mount_yaw, g.coxa, g.femur, g.tibia, g.side, *(STANDARD_GRAVITY * masses[:, 1:]).T)
        self._legs = np.stack(columns, axis=-1).tolist()

    def forces(
        self, angles: Sequence[Sequence[float]], torques: Sequence[Sequence[float] | None], up: Vector = (0.0, 0.0, 1.0)
    ) -> tuple[Vector | None, ...]:
        """Return the forces of the ground on the feet; None for a leg that is singular or without torques.

        Parameters
        ----------
        angles : sequence of (coxa, femur, tibia)
            Joint angles of each leg, finite [rad].
        torques : sequence of ((coxa, femur, tibia) or None)
            Torques exerted by the servos, finite [N m].
        up : (x, y, z)
            Unit vector opposite to gravity, in B.

        Returns
        -------
        tuple of ((x, y, z) or None)
            Forces of the ground on the feet in B [N].
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
    # Components of the direction opposite to gravity along the leg's axes.
    up_r, up_t, up_z = up[0] * cos + up[1] * sin, up[1] * cos - up[0] * sin, up[2]
    weight = hip_weight + knee_weight + foot_weight
    outward = hip_weight * coxa + knee_weight * (coxa + femur_r) + foot_weight * foot_r
    moment_coxa = -tau[0] + outward * up_t - weight * side * up_r
    moment_femur = (
        -tau[1]
        + _weight_moment(knee_weight, femur_r, femur_z, up_r, up_z)
        + _weight_moment(foot_weight, leg_r, leg_z, up_r, up_z)
    )
    moment_tibia = -tau[2] + _weight_moment(foot_weight, tibia_r, tibia_z, up_r, up_z)
    force_r = (moment_femur * tibia_r - moment_tibia * leg_r) / across
    force_z = (moment_femur * tibia_z - moment_tibia * leg_z) / across
    force_t = (moment_coxa + side * force_r) / foot_r
    return force_r * cos - force_t * sin, force_r * sin + force_t * cos, force_z


def _weight_moment(weight: float, r: float, z: float, up_r: float, up_z: float) -> float:
    return weight * (r * up_z - z * up_r)


def balanced_forces(
    feet: Sequence[Sequence[float]], contacts: Sequence[float], centre: Sequence[float], weight: float
) -> tuple[float, ...]:
    """Return the vertical forces with which the feet carry a weight, with the least sum of squares.

    Equilibrium does not determine them for more than three feet. The least-squares solution is linear in position:
    ``f = weight / n + a (x - x_mean) + b (y - y_mean)``, a and b from the moments about the mean. Where a foot bears
    load only in part, its square is divided by that part, and its force is multiplied by it.

    Parameters
    ----------
    feet : sequence of (x, y, ...)
        Feet on the ground plane [m].
    contacts : sequence of bool or float
        Which feet bear load, or to which part each does, 0 to 1.
    centre : (x, y)
        Projection of the centre of mass, in the same frame [m].
    weight : float
        Weight to be carried [N].

    Returns
    -------
    tuple of float
        Upward forces of the ground [N]; 0 for feet in the air, and never negative: the moments are not balanced where
        the centre is outside the support polygon or the feet are collinear.
    """
    count = sum(contacts)
    if not count:
        return (0.0,) * len(feet)
    mean_x = mean_y = xx = xy = yy = 0.0
    for foot, part in zip(feet, contacts, strict=True):
        mean_x, mean_y = mean_x + part * foot[0], mean_y + part * foot[1]
    mean_x, mean_y = mean_x / count, mean_y / count
    bearing: list[tuple[int, float, float, float]] = []
    for leg, part in enumerate(contacts):
        if part:
            x, y = feet[leg][0] - mean_x, feet[leg][1] - mean_y
            xx, xy, yy = xx + part * x * x, xy + part * x * y, yy + part * y * y
            bearing.append((leg, x, y, part))
    moments = PlanarMoments(xx, xy, yy)
    a = b = 0.0
    if moments.span_area(_LEAST_SPREAD):
        off_x, off_y = weight * (centre[0] - mean_x), weight * (centre[1] - mean_y)
        a, b = moments.slopes(off_x, off_y, determinant=moments.determinant)
    forces, mean = [0.0] * len(feet), weight / count
    for leg, x, y, part in bearing:
        forces[leg] = max(part * (mean + a * x + b * y), 0.0)
    return tuple(forces)
