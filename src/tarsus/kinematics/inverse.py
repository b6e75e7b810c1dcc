"""From where the feet should be to the joint angles, with a verdict on every leg."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple, Self

import numpy as np

from tarsus.arrays import (
    BLOCK,
    SMALL,
    Array,
    Namespace,
    as_floats,
    batch_blocks,
    block_shape,
    broadcast_shapes,
    columns,
    namespace,
    require_finite,
    require_shape,
    stack_last,
)
from tarsus.errors import InputError
from tarsus.kinematics.leg import point_parts
from tarsus.kinematics.nearest import nearest_angles
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import IKSolution, Reach
from tarsus.kinematics.triangle import Triangle, solve_triangle, to_leg_frame
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

__all__ = ["inverse_kinematics"]

# What rounding may add: a foot this much beyond the leg's reach [m], a joint this much beyond its limit [rad].
LENGTH_TOLERANCE = 1e-13
ANGLE_TOLERANCE = 1e-9


def inverse_kinematics(
    robot: Robot, feet: Array, body: Pose | None = None, *, knee: Literal["up", "down"] = "up"
) -> IKSolution:
    """Return the joint angles that put the feet where they should be, and which of them can't be there.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    feet : array, shape (..., legs, 3)
        Where the feet should be: in the ground frame G where `body` is given, else in the body frame B [m].
    body : Pose, optional
        The body's place in G. Left out, nothing is below ground.
    knee : {"up", "down"}
        Which of the two solutions: the knee above or below the line from femur axis to foot.

    Returns
    -------
    IKSolution
        Angles, reach codes, and what explains them. Where a foot can't be reached, the angles are those of the
        nearest point that the leg reaches within its limits. A foot that the leg can't reach with its plane
        turned towards it, but can with the plane turned away (a foot behind the coxa axis), is reached so.

    Raises
    ------
    InputError
        If the feet have another shape, or are not finite.
    """
    if knee not in ("up", "down"):
        raise InputError(f"knee is {knee!r}; it can be 'up' or 'down'")
    xp = namespace(feet, robot.geometry.coxa, *(() if body is None else (body.rotation, body.position)))
    p = as_floats(xp, feet, name="feet")
    require_shape("feet", p, (robot.legs, 3))
    require_finite("feet", p)
    branch = 1 if knee == "up" else -1
    geometry = robot.geometry.to(xp)
    batches = (robot.batch_shape, p.shape[:-2], () if body is None else body.batch_shape)
    batch = broadcast_shapes("the robot, the feet and the body's poses", *batches)
    if xp is not np:
        angles, reach = _solve_everywhere(xp, geometry, p, body, branch)
    elif p.size <= SMALL and batch == p.shape[:-2] and not robot.batch_shape:
        angles, reach = _solve_small(geometry, p, body, branch)
    else:
        angles, reach = np.empty((*batch, robot.legs, 3)), np.empty((*batch, robot.legs), dtype=np.int8)
        same = geometry.take((), ())
        for index in batch_blocks(batch, max(BLOCK // robot.legs, 1)):
            block = block_shape(batch, index)
            x, y, z = columns(p, index, block, tail=2)
            part = None if body is None else _Body.columns(body, index, block)
            g = geometry.take(index, block) if robot.batch_shape else same
            *joints, codes = _solve_where_needed(g, x, y, z, part, branch)
            view = angles[index].reshape(-1, robot.legs, 3)
            for i, joint in enumerate(joints):
                view[..., i] = joint.T
            reach[index].reshape(-1, robot.legs)[...] = codes.T
    return IKSolution(robot=robot, feet=p, body=body, knee=knee, angles=angles, reach=reach)


class _Body(NamedTuple):
    """A body's pose taken apart, in a layout that fits the geometry's: ``rotation[row][column]`` and position."""

    rotation: tuple[tuple[Array, ...], ...]
    position: tuple[Array, ...]

    @classmethod
    def columns(cls, body: Pose, index: tuple[slice, ...], block: tuple[int, ...]) -> Self:
        rotation, position = (
            columns(body.rotation, index, block, tail=2),
            columns(body.position, index, block, tail=1),
        )
        return cls(tuple(tuple(rotation[j, i] for j in range(3)) for i in range(3)), tuple(position))

    @classmethod
    def rows(cls, xp: Namespace, body: Pose) -> Self:
        rotation, position = xp.asarray(body.rotation)[..., None], xp.asarray(body.position)[..., None]
        elements = tuple(tuple(rotation[..., i, j, :] for j in range(3)) for i in range(3))
        return cls(elements, tuple(position[..., i, :] for i in range(3)))

    def into_body(self, x: Array, y: Array, z: Array) -> tuple[Array, ...]:
        """Carry points of G into B."""
        (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = self.rotation
        x, y, z = x - self.position[0], y - self.position[1], z - self.position[2]
        return xx * x + yx * y + zx * z, xy * x + yy * y + zy * z, xz * x + yz * y + zz * z

    def height(self, x: Array, y: Array, z: Array) -> Array:
        """Return the height over the ground of points of B."""
        zx, zy, zz = self.rotation[2]
        return zx * x + zy * y + zz * z + self.position[2]


def _codes(xp: Namespace, g: LegGeometry, solution: Triangle) -> Array:
    """Return the reach code of every leg."""
    slack = 2 * LENGTH_TOLERANCE * (g.femur + g.tibia)
    codes = xp.zeros(solution.coxa.shape, dtype=xp.int8)
    limits = (
        (solution.tibia, g.tibia_lower, g.tibia_upper, Reach.TIBIA_LIMIT),
        (solution.femur, g.femur_lower, g.femur_upper, Reach.FEMUR_LIMIT),
        (solution.coxa, g.coxa_lower, g.coxa_upper, Reach.COXA_LIMIT),
    )
    for angle, lower, upper, code in limits:
        broken = (angle < lower - ANGLE_TOLERANCE) | (angle > upper + ANGLE_TOLERANCE)
        codes = _mark(xp, codes, broken, code)
    codes = _mark(xp, codes, (solution.near < -slack) | (solution.beside < -slack), Reach.TOO_NEAR)
    return _mark(xp, codes, solution.far < -slack, Reach.TOO_FAR)


def _mark(xp: Namespace, codes: Array, broken: Array, code: Reach) -> Array:
    return xp.where(broken, xp.asarray(int(code), dtype=xp.int8), codes)


def _all_within(g: LegGeometry, s: Triangle) -> bool:
    """Return whether every leg is within reach and limits: the common case, told in a few passes."""
    broken = (s.far < 0) | (s.near < 0) | (s.beside < 0)
    broken |= (s.coxa < g.coxa_lower) | (s.coxa > g.coxa_upper)
    broken |= (s.femur < g.femur_lower) | (s.femur > g.femur_upper)
    broken |= (s.tibia < g.tibia_lower) | (s.tibia > g.tibia_upper)
    return not broken.any()


def _with_ground(xp: Namespace, g: LegGeometry, joints: tuple[Array, ...], codes: Array, body: _Body) -> Array:
    """Mark the legs whose attachment is below the ground, and those within reach whose femur axis or knee is."""
    parts = point_parts(xp, g, *joints)
    attachment, axis, knee = (body.height(*parts[i : i + 3]) < -LENGTH_TOLERANCE for i in (0, 3, 6))
    return _mark(xp, codes, attachment | ((codes == 0) & (axis | knee)), Reach.BELOW_GROUND)


def _solve_everywhere(xp: Namespace, g: LegGeometry, feet: Array, body: Pose | None, knee: int) -> tuple[Array, Array]:
    """Solve without looking at values, as `jax.jit` needs it: all ways for every leg, then the right one of them."""
    x, y, z = feet[..., 0], feet[..., 1], feet[..., 2]
    place = None if body is None else _Body.rows(xp, body)
    if place is not None:
        x, y, z = place.into_body(x, y, z)
    x, y, z = to_leg_frame(g, x, y, z)
    towards = solve_triangle(xp, g, x, y, z, knee=knee)
    codes = _codes(xp, g, towards)
    away = solve_triangle(xp, g, x, y, z, knee=knee, facing=-1)
    turned = (codes != 0) & (_codes(xp, g, away) == 0)
    codes = xp.where(turned, xp.zeros_like(codes), codes)
    nearest = nearest_angles(xp, g, x, y, z, knee=knee)
    joints = tuple(
        xp.where(codes != 0, last, xp.where(turned, second, first))
        for first, second, last in zip(towards[:3], away[:3], nearest, strict=True)
    )
    if place is not None:
        codes = _with_ground(xp, g, joints, codes, place)
    return stack_last(xp, joints), codes


def _solve_small(g: LegGeometry, feet: Array, body: Pose | None, knee: int) -> tuple[Array, Array]:
    """Solve a few NumPy legs with as few calls as possible: one robot in a control loop."""
    place = None if body is None else _Body.rows(np, body)
    x, y, z = feet[..., 0], feet[..., 1], feet[..., 2]
    *joints, codes = _solve_where_needed(g, x, y, z, place, knee)
    return stack_last(np, tuple(joints)), codes


def _solve_where_needed(
    g: LegGeometry, x: Array, y: Array, z: Array, body: _Body | None, knee: int
) -> tuple[Array, ...]:
    """Solve NumPy legs in any layout; the rarer ways only for the legs that need them."""
    if body is not None:
        x, y, z = body.into_body(x, y, z)
    x, y, z = to_leg_frame(g, x, y, z)
    solution = solve_triangle(np, g, x, y, z, knee=knee)
    joints = solution[:3]
    if _all_within(g, solution):
        codes = np.zeros(x.shape, dtype=np.int8)
    else:
        codes = _codes(np, g, solution)
        bad = codes != 0
        if bad.any():
            *second, codes[bad] = _second_tries(g.pick(bad), x[bad], y[bad], z[bad], codes[bad], knee)
            for joint, values in zip(joints, second, strict=True):
                joint[bad] = values
    if body is not None and not _surely_above(g, joints[1], body):
        codes = _with_ground(np, g, joints, codes, body)
    return *joints, codes


def _second_tries(g: LegGeometry, x: Array, y: Array, z: Array, codes: Array, knee: int) -> tuple[Array, ...]:
    """Solve the legs that can't reach their foot turned towards it: turned away, or as near as they get."""
    away = solve_triangle(np, g, x, y, z, knee=knee, facing=-1)
    turned = _codes(np, g, away) == 0
    nearest = nearest_angles(np, g, x, y, z, knee=knee)
    joints = (np.where(turned, second, last) for second, last in zip(away[:3], nearest, strict=True))
    return *joints, np.where(turned, np.int8(0), codes)


def _surely_above(g: LegGeometry, femur: Array, body: _Body) -> bool:
    """Return whether all bodies are so high that no point of a leg but the foot can be below the ground."""
    zx, zy, zz = body.rotation[2]
    if zz.min() < 0:
        return False
    lean = math.sqrt(float((zx * zx + zy * zy).max()))
    # Between -pi/2 and pi/2 the sine is least at an end of the femurs' range; a femur that points up helps nothing.
    low = max(-float(femur.min()), 0.0)
    drop = math.sin(low) if low < math.pi / 2 and float(femur.max()) < math.pi else 1.0
    lowest = lean * g.knee_span + drop * g.femur + g.axis_depth
    return bool(body.position[2].min() > lowest.max())
