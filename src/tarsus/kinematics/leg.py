"""Forward kinematics of the legs: positions of their points, and the Jacobian of the foot.

In the leg's plane, with `r` outward and `z` up from the femur axis (the two equations of source 002, with the signs
of this project: positive femur and tibia angles lift the foot)::

    r = femur cos(q_femur) + tibia cos(q_femur + q_tibia)
    z = femur sin(q_femur) + tibia sin(q_femur + q_tibia)

The femur axis is at distance `coxa` from the coxa axis, offset by source 001's `Dec_Y2` (sideways) and `Dec_Z2` (up),
and the plane turns with the coxa joint about the vertical.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tarsus.arrays import (
    Array,
    Namespace,
    as_floats,
    broadcast_shapes,
    namespace,
    require_finite,
    require_shape,
    stack_last,
)
from tarsus.blocks import BLOCK, SMALL, batch_blocks, block_shape, columns
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["checked_angles", "forward_kinematics", "leg_jacobian", "point_parts"]


def forward_kinematics(robot: Robot, angles: Float[Array, "*#batch legs 3"]) -> Float[Array, "*batch legs 4 3"]:
    """Return the points of every leg in the body frame.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    angles : array, shape (..., legs, 3)
        Coxa, femur and tibia angle of each leg [rad].

    Returns
    -------
    array, shape (..., legs, 4, 3)
        Coxa axis, femur axis, knee and foot of each leg in B [m].

    Raises
    ------
    InputError
        If the angles have the wrong shape or are not finite.
    """
    require_robot(robot)
    return _by_blocks(point_parts, robot, angles, (4, 3))


def leg_jacobian(robot: Robot, angles: Float[Array, "*#batch legs 3"]) -> Float[Array, "*batch legs 3 3"]:
    """Return the Jacobian of each foot in the body frame with respect to its joint angles.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    angles : array, shape (..., legs, 3)
        Coxa, femur and tibia angle of each leg [rad].

    Returns
    -------
    array, shape (..., legs, 3, 3)
        ``d(foot in B) / d(angles)``: rows x, y, z, columns coxa, femur, tibia [m/rad].

    Raises
    ------
    InputError
        If the angles have the wrong shape or are not finite.
    """
    require_robot(robot)
    return _by_blocks(_jacobian_parts, robot, angles, (3, 3))


def checked_angles(
    robot: Robot, angles: Float[Array, "*#batch legs 3"]
) -> tuple[Namespace, Float[Array, "... legs 3"]]:
    """Return the namespace and the angles as floats, refusing anything but finite numbers ``(..., legs, 3)``."""
    xp = namespace(angles, robot.geometry.coxa)
    q = as_floats(xp, angles, name="angles")
    require_shape("angles", q, (robot.legs, 3))
    require_finite("angles", q)
    return xp, q


Parts: TypeAlias = tuple[Array, ...]


def _by_blocks(
    kernel: Callable[[Namespace, LegGeometry, Array, Array, Array], Parts],
    robot: Robot,
    angles: Float[Array, "*#batch legs 3"],
    tail: tuple[int, int],
) -> Float[Array, "... 3"]:
    """Apply a kernel to the batch; NumPy arrays in blocks that fit the cache."""
    xp, q = checked_angles(robot, angles)
    geometry = robot.geometry.to(xp)
    batch = broadcast_shapes("the robot and the angles", robot.batch_shape, q.shape[:-2])
    if xp is not np or (q.size <= SMALL and not robot.batch_shape):
        q = q if xp is np else xp.broadcast_to(q, (*batch, robot.legs, 3))
        flat = stack_last(xp, kernel(xp, geometry, q[..., 0], q[..., 1], q[..., 2]))
        return xp.reshape(flat, (*flat.shape[:-1], *tail))
    out = np.empty((*batch, robot.legs, tail[0] * tail[1]))
    same = geometry if robot.batch_shape else geometry.take((), ())
    for index in batch_blocks(batch, max(BLOCK // robot.legs, 1)):
        block = block_shape(batch, index)
        g = geometry.take(index, block) if robot.batch_shape else same
        parts = kernel(np, g, *columns(q, index, block, tail=2))
        view = out[index].reshape(-1, robot.legs, len(parts))
        for i, part in enumerate(parts):
            view[..., i] = part.T
    return out.reshape(*batch, robot.legs, *tail)


def _sines(
    xp: Namespace, g: LegGeometry, coxa: Float[Array, "..."], femur: Float[Array, "..."], tibia: Float[Array, "..."]
) -> Parts:
    """Return cosines and sines of the heading of the leg's plane in B, and of the slopes of femur and tibia."""
    coxa_cos, coxa_sin = xp.cos(coxa), xp.sin(coxa)
    heading_cos = g.cos_yaw * coxa_cos - g.sin_yaw * coxa_sin
    heading_sin = g.sin_yaw * coxa_cos + g.cos_yaw * coxa_sin
    slope = femur + tibia
    return heading_cos, heading_sin, xp.cos(femur), xp.sin(femur), xp.cos(slope), xp.sin(slope)


def point_parts(
    xp: Namespace, g: LegGeometry, coxa: Float[Array, "..."], femur: Float[Array, "..."], tibia: Float[Array, "..."]
) -> Parts:
    """Return x, y, z in B of coxa axis, femur axis, knee and foot, in any layout that broadcasts with the geometry."""
    heading_cos, heading_sin, femur_cos, femur_sin, tibia_cos, tibia_sin = _sines(xp, g, coxa, femur, tibia)
    zero = xp.zeros_like(heading_cos)
    knee_r = g.coxa + g.femur * femur_cos
    foot_r = knee_r + g.tibia * tibia_cos
    axis_z = g.mount_z + g.up + zero
    knee_z = axis_z + g.femur * femur_sin
    foot_z = knee_z + g.tibia * tibia_sin
    side_x, side_y = g.mount_x - g.side * heading_sin, g.mount_y + g.side * heading_cos
    parts = [g.mount_x + zero, g.mount_y + zero, g.mount_z + zero]
    for r, z in ((g.coxa, axis_z), (knee_r, knee_z), (foot_r, foot_z)):
        parts += [side_x + r * heading_cos, side_y + r * heading_sin, z]
    return tuple(parts)


def _jacobian_parts(
    xp: Namespace,
    g: LegGeometry,
    coxa: Float[Array, "*#batch legs"],
    femur: Float[Array, "*#batch legs"],
    tibia: Float[Array, "*#batch legs"],
) -> Parts:
    heading_cos, heading_sin, femur_cos, femur_sin, tibia_cos, tibia_sin = _sines(xp, g, coxa, femur, tibia)
    tibia_r, tibia_z = g.tibia * tibia_cos, g.tibia * tibia_sin
    leg_r, leg_z = g.femur * femur_cos + tibia_r, g.femur * femur_sin + tibia_z
    foot_r = g.coxa + leg_r
    # A joint moves the foot perpendicularly to its lever arm (r, z): outward by -z, upward by +r.
    return (
        *(-foot_r * heading_sin - g.side * heading_cos, -leg_z * heading_cos, -tibia_z * heading_cos),
        *(foot_r * heading_cos - g.side * heading_sin, -leg_z * heading_sin, -tibia_z * heading_sin),
        *(xp.zeros_like(foot_r), leg_r, tibia_r),
    )
