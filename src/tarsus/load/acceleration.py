"""Accelerations of the leg points, from the rates of the joints and of the body.

A point at ``p`` in the moving body frame B, with velocity ``p'`` and acceleration ``p''`` relative to B, has the
acceleration

    a = a_B + alpha x p + omega x (omega x p) + 2 omega x p' + p''

in B's axes: origin, Euler, centripetal, Coriolis and relative acceleration (any textbook of mechanics).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.arrays import Array, Namespace, as_array, as_floats, require_finite, require_shape, stack_last
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["BodyRates", "JointRates", "angular_matrix", "differences", "point_accelerations"]


def _zeros() -> Float[Array, "..."]:
    return np.zeros(3)


@dataclass(frozen=True, eq=False, kw_only=True)
class BodyRates:
    """Angular rates and acceleration of B in G; forces do not depend on its linear velocity.

    Attributes
    ----------
    angular_velocity : array, shape (..., 3)
        Angular velocity, in G [rad/s].
    angular_acceleration : array, shape (..., 3)
        Angular acceleration, in G [rad/s^2].
    acceleration : array, shape (..., 3)
        Linear acceleration of B's origin, in G [m/s^2].
    """

    angular_velocity: Float[Array, "*#batch 3"] = field(default_factory=_zeros)
    angular_acceleration: Float[Array, "*#batch 3"] = field(default_factory=_zeros)
    acceleration: Float[Array, "*#batch 3"] = field(default_factory=_zeros)

    @classmethod
    def of(cls, time: Float[Array, "n"], body: Pose) -> Self:
        """Differentiate sampled body poses with `differences`.

        Parameters
        ----------
        time : array, shape (n,)
            Sample times [s].
        body : Pose
            Poses of B in G, ``(n,)``.

        Notes
        -----
        For a rotation R, ``R' R^T`` is the skew matrix of the angular velocity, and the skew part of ``R'' R^T`` is
        that of the angular acceleration.
        """
        first, second = differences(time, np.broadcast_to(body.rotation, (len(time), 3, 3)))
        inverse = np.swapaxes(body.rotation, -1, -2)
        return cls(
            angular_velocity=_axis(first @ inverse),
            angular_acceleration=_axis(second @ inverse),
            acceleration=differences(time, np.broadcast_to(body.position, (len(time), 3)))[1],
        )

    def within(
        self, xp: Namespace, rotation: Float[Array, "*#batch 3 3"]
    ) -> tuple[Float[Array, "... 3"], Float[Array, "... 3"], Float[Array, "... 3"]]:
        """Return angular velocity, angular acceleration and acceleration in B's axes, for rotations of B in G."""
        rotated = []
        for name in ("angular_velocity", "angular_acceleration", "acceleration"):
            value = as_floats(xp, getattr(self, name), name=name)
            require_shape(name, value, (3,))
            require_finite(name, value)
            rotated.append(xp.matmul(value[..., None, :], rotation)[..., 0, :])
        return rotated[0], rotated[1], rotated[2]


@dataclass(frozen=True, eq=False, kw_only=True)
class JointRates:
    """Velocities and accelerations of the joints.

    Attributes
    ----------
    velocity, acceleration : array, shape (..., legs, 3)
        First and second derivative of the joint angles [rad/s, rad/s^2].
    """

    velocity: Float[Array, "*#batch legs 3"]
    acceleration: Float[Array, "*#batch legs 3"]


def differences(
    time: Float[Array, "n"], values: Float[Array, "n *batch"]
) -> tuple[Float[Array, "n *batch"], Float[Array, "n *batch"]]:
    """Return first and second time derivatives by central differences; the time steps may be uneven.

    The derivatives are those of the parabola through each sample and its two neighbours. With even steps h, the errors
    are ``h^2/6`` times the third derivative for the first, and ``h^2/12`` times the fourth for the second. The first
    and last sample use their neighbour's parabola; two samples give a straight line, a single sample zero.

    Parameters
    ----------
    time : array, shape (n,)
        Sample times [s].
    values : array, shape (n, ...)
        Sampled values.

    Returns
    -------
    first, second : array, shape (n, ...)
        Derivatives per second and per second squared.
    """
    if len(time) == 1:
        return np.zeros_like(values), np.zeros_like(values)
    step = np.diff(time).reshape(-1, *(1,) * (values.ndim - 1))
    slope = np.diff(values, axis=0) / step
    if len(time) == 2:
        return np.concatenate([slope, slope]), np.zeros_like(values)
    before, after = step[:-1], step[1:]
    second = 2 * np.diff(slope, axis=0) / (before + after)
    middle = slope[:-1] + before / 2 * second
    first = np.concatenate([middle[:1] - before[:1] * second[:1], middle, middle[-1:] + after[-1:] * second[-1:]])
    return first, np.concatenate([second[:1], second, second[-1:]])


def _axis(matrix: Float[Array, "... 3 3"]) -> Float[Array, "... 3"]:
    """Return the axial vectors of the skew parts of matrices ``(..., 3, 3)``."""
    skew = (matrix - np.swapaxes(matrix, -1, -2)) / 2
    return np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)


def angular_matrix(
    xp: Namespace, omega: Float[Array, "... 3"], alpha: Float[Array, "... 3"]
) -> Float[Array, "*batch 3 3"]:
    """Return the matrix ``(..., 3, 3)`` that maps r to ``alpha x r + omega x (omega x r)``."""
    x, y, z = (omega[..., i] for i in range(3))
    u, v, w = (alpha[..., i] for i in range(3))
    rows = (-y * y - z * z, x * y - w, x * z + v, x * y + w, -x * x - z * z, y * z - u, x * z - v, y * z + u)
    flat = stack_last(xp, (*rows, -x * x - y * y))
    return xp.reshape(flat, (*flat.shape[:-1], 3, 3))


def point_accelerations(
    xp: Namespace,
    robot: Robot,
    angles: Float[Array, "*#batch legs 3"],
    points: Float[Array, "*#batch legs 4 3"],
    joints: JointRates,
    body: tuple[Float[Array, "*#batch 3"], Float[Array, "*#batch 3"], Float[Array, "*#batch 3"]],
) -> Float[Array, "*batch legs 4 3"]:
    """Return the accelerations of the leg points relative to G, in B's axes.

    Parameters
    ----------
    xp : namespace
        The array library.
    robot : Robot
        The robot, or a batch of designs.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    points : array, shape (..., legs, 4, 3)
        Leg points in B [m].
    joints : JointRates
        Joint velocities and accelerations.
    body : tuple of array, shape (..., 3)
        Angular velocity, angular acceleration and acceleration of the body in B's axes: `BodyRates.within`.

    Returns
    -------
    array, shape (..., legs, 4, 3)
        Accelerations of coxa axis, femur axis, knee and foot [m/s^2].

    Raises
    ------
    InputError
        If a rate is not finite or has the wrong shape.
    """
    rates = []
    for name, value in (("velocity", joints.velocity), ("acceleration", joints.acceleration)):
        rate = as_floats(xp, value, name=f"joint {name}")
        require_shape(f"joint {name}", rate, (robot.legs, 3))
        require_finite(f"joint {name}", rate)
        rates.append(rate)
    omega, alpha, linear = body
    first, second = _relative(xp, robot, as_array(xp, angles), rates[0], rates[1])
    flat = [xp.reshape(values, (*values.shape[:-3], 4 * robot.legs, 3)) for values in (points, first, second)]
    coriolis = 2 * angular_matrix(xp, xp.zeros_like(omega), omega)
    total = xp.matmul(flat[0], xp.matrix_transpose(angular_matrix(xp, omega, alpha)))
    total = total + xp.matmul(flat[1], xp.matrix_transpose(coriolis)) + flat[2] + linear[..., None, :]
    return xp.reshape(total, (*total.shape[:-2], robot.legs, 4, 3))


def _relative(
    xp: Namespace,
    robot: Robot,
    angles: Float[Array, "*#batch legs 3"],
    velocity: Float[Array, "*#batch legs 3"],
    acceleration: Float[Array, "... 3"],
) -> tuple[Float[Array, "... legs 4 3"], Float[Array, "... legs 4 3"]]:
    """Return the velocities and accelerations of the leg points relative to B.

    With the leg's plane at heading h, a point r outward, s sideways and z up has the velocity ``r' - s h'`` outward,
    ``r h'`` sideways and ``z'`` up. Differentiating once more gives `second` below.
    """
    heading = as_array(xp, robot.mount_yaw) + angles[..., 0]
    cos, sin = xp.cos(heading), xp.sin(heading)
    yaw1, yaw2 = velocity[..., 0], acceleration[..., 0]
    side = as_array(xp, robot.femur_axis_offset)[..., 0]
    r, z = as_array(xp, robot.coxa), xp.zeros_like(yaw1)
    r1 = r2 = z1 = z2 = z
    slope = slope1 = slope2 = z
    first, second = [z, z, z], [z, z, z]
    for joint, length in enumerate((None, robot.femur, robot.tibia)):
        if length is not None:
            slope, slope1 = slope + angles[..., joint], slope1 + velocity[..., joint]
            slope2 = slope2 + acceleration[..., joint]
            out, up = as_array(xp, length) * xp.cos(slope), as_array(xp, length) * xp.sin(slope)
            square = slope1 * slope1
            r, r1, r2 = r + out, r1 - up * slope1, r2 - out * square - up * slope2
            z1, z2 = z1 + out * slope1, z2 - up * square + out * slope2
        outward, sideways = r1 - side * yaw1, r * yaw1
        first += [outward * cos - sideways * sin, outward * sin + sideways * cos, z1]
        outward = r2 - r * yaw1 * yaw1 - side * yaw2
        sideways = r * yaw2 + 2 * r1 * yaw1 - side * yaw1 * yaw1
        second += [outward * cos - sideways * sin, outward * sin + sideways * cos, z2]
    both = (stack_last(xp, tuple(columns)) for columns in (first, second))
    shaped = [xp.reshape(flat, (*flat.shape[:-1], 4, 3)) for flat in both]
    return shaped[0], shaped[1]
