"""How the points of the legs accelerate, from how joints and body move: the rigid-body recursion, exactly.

A point at ``p`` in the moving body frame B, with joints that move it by ``p'`` and ``p''`` in B, accelerates by

    a = a_B + alpha x p + omega x (omega x p) + 2 omega x p' + p''

all in B's axes: of the origin, Euler, centripetal, Coriolis and relative acceleration (any textbook of mechanics).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Self

import numpy as np

from tarsus.arrays import Array, Namespace, as_array, as_floats, require_finite, require_shape, stack_last
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

__all__ = ["BodyRates", "JointRates", "differences", "point_accelerations", "turning"]


def _still() -> Array:
    return np.zeros(3)


@dataclass(frozen=True, eq=False, kw_only=True)
class BodyRates:
    """How the pose of B in G changes; its speed has no bearing on forces.

    Attributes
    ----------
    angular_velocity : array, shape (..., 3)
        In G [rad/s].
    angular_acceleration : array, shape (..., 3)
        In G [rad/s^2].
    acceleration : array, shape (..., 3)
        Of B's origin, in G [m/s^2].
    """

    angular_velocity: Array = field(default_factory=_still)
    angular_acceleration: Array = field(default_factory=_still)
    acceleration: Array = field(default_factory=_still)

    @classmethod
    def of(cls, time: Array, body: Pose) -> Self:
        """Differentiate poses sampled in time, as `differences` does.

        Parameters
        ----------
        time : array, shape (n,)
            Moments [s].
        body : Pose
            Places of B in G, ``(n,)``.

        Notes
        -----
        With a rotation R, ``R' R^T`` is the angular velocity's matrix, and the skew part of ``R'' R^T`` that of
        the angular acceleration.
        """
        first, second = differences(time, np.broadcast_to(body.rotation, (len(time), 3, 3)))
        back = np.swapaxes(body.rotation, -1, -2)
        return cls(
            angular_velocity=_axis(first @ back),
            angular_acceleration=_axis(second @ back),
            acceleration=differences(time, np.broadcast_to(body.position, (len(time), 3)))[1],
        )

    def within(self, xp: Namespace, rotation: Array) -> tuple[Array, Array, Array]:
        """Return the three in B's axes, for rotations ``(..., 3, 3)`` of B in G."""
        turned = []
        for name in ("angular_velocity", "angular_acceleration", "acceleration"):
            value = as_floats(xp, getattr(self, name), name=name)
            require_shape(name, value, (3,))
            require_finite(name, value)
            turned.append(xp.matmul(value[..., None, :], rotation)[..., 0, :])
        return turned[0], turned[1], turned[2]


@dataclass(frozen=True, eq=False, kw_only=True)
class JointRates:
    """How the joint angles change.

    Attributes
    ----------
    velocity, acceleration : array, shape (..., legs, 3)
        First and second derivative of the joint angles [rad/s, rad/s^2].
    """

    velocity: Array
    acceleration: Array


def differences(time: Array, values: Array) -> tuple[Array, Array]:
    """Return first and second derivatives of samples, by central differences; steps in time may differ.

    Those of the parabola through each sample and its neighbours: with even steps h the errors are ``h^2/6`` times
    the third and ``h^2/12`` times the fourth derivative. The first and last sample take their neighbour's parabola,
    two samples a straight line, and a single one stands still.

    Parameters
    ----------
    time : array, shape (n,)
        Moments [s].
    values : array, shape (n, ...)
        What is sampled.
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


def _axis(matrix: Array) -> Array:
    """Return the vectors of the skew parts of matrices ``(..., 3, 3)``."""
    skew = (matrix - np.swapaxes(matrix, -1, -2)) / 2
    return np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)


def turning(xp: Namespace, omega: Array, alpha: Array) -> Array:
    """Return the matrix ``(..., 3, 3)`` that takes an arm to ``alpha x arm + omega x (omega x arm)``."""
    x, y, z = (omega[..., i] for i in range(3))
    u, v, w = (alpha[..., i] for i in range(3))
    rows = (-y * y - z * z, x * y - w, x * z + v, x * y + w, -x * x - z * z, y * z - u, x * z - v, y * z + u)
    flat = stack_last(xp, (*rows, -x * x - y * y))
    return xp.reshape(flat, (*flat.shape[:-1], 3, 3))


def point_accelerations(
    xp: Namespace, robot: Robot, angles: Array, points: Array, joints: JointRates, turns: tuple[Array, Array, Array]
) -> Array:
    """Return the accelerations of the leg points against G, in B's axes.

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
        How the angles change.
    turns : tuple of array, shape (..., 3)
        The body's angular velocity, angular acceleration and acceleration in B's axes: `BodyRates.within`.

    Returns
    -------
    array, shape (..., legs, 4, 3)
        Accelerations of coxa axis, femur axis, knee and foot [m/s^2].

    Raises
    ------
    InputError
        If a rate is not finite or not of the angles' kind.
    """
    rates = []
    for name, value in (("velocity", joints.velocity), ("acceleration", joints.acceleration)):
        rate = as_floats(xp, value, name=f"joint {name}")
        require_shape(f"joint {name}", rate, (robot.legs, 3))
        require_finite(f"joint {name}", rate)
        rates.append(rate)
    omega, alpha, along = turns
    first, second = _relative(xp, robot, as_array(xp, angles), rates[0], rates[1])
    flat = [xp.reshape(part, (*part.shape[:-3], 4 * robot.legs, 3)) for part in (points, first, second)]
    coriolis = 2 * turning(xp, xp.zeros_like(omega), omega)
    total = xp.matmul(flat[0], xp.matrix_transpose(turning(xp, omega, alpha)))
    total = total + xp.matmul(flat[1], xp.matrix_transpose(coriolis)) + flat[2] + along[..., None, :]
    return xp.reshape(total, (*total.shape[:-2], robot.legs, 4, 3))


def _relative(xp: Namespace, robot: Robot, angles: Array, velocity: Array, acceleration: Array) -> tuple[Array, Array]:
    """Return first and second derivatives of the leg points in B.

    In the leg's plane, which turns by h, a point at r outward, s sideways and z up moves by ``r' - s h'`` outward,
    ``r h'`` sideways and ``z'`` up; once more derived, its parts are those of `second` below.
    """
    heading = as_array(xp, robot.mount_yaw) + angles[..., 0]
    cos, sin = xp.cos(heading), xp.sin(heading)
    turn, turn2 = velocity[..., 0], acceleration[..., 0]
    side = as_array(xp, robot.femur_axis_offset)[..., 0]
    r, z = as_array(xp, robot.coxa), xp.zeros_like(turn)
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
        away, across = r1 - side * turn, r * turn
        first += [away * cos - across * sin, away * sin + across * cos, z1]
        away = r2 - r * turn * turn - side * turn2
        across = r * turn2 + 2 * r1 * turn - side * turn * turn
        second += [away * cos - across * sin, away * sin + across * cos, z2]
    both = (stack_last(xp, tuple(parts)) for parts in (first, second))
    shaped = [xp.reshape(flat, (*flat.shape[:-1], 4, 3)) for flat in both]
    return shaped[0], shaped[1]
