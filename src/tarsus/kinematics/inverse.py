"""From where the feet should be to the joint angles, with a verdict on every leg."""

from __future__ import annotations

from typing import Literal

import numpy as np

from tarsus.arrays import (
    Array,
    Namespace,
    as_floats,
    broadcast_shapes,
    is_traced,
    namespace,
    only_where_needed,
    require_finite,
    require_shape,
    stack_last,
)
from tarsus.blocks import BLOCK, SMALL, batch_blocks, block_shape, columns
from tarsus.errors import InputError
from tarsus.kinematics.ground import BodyPlace, mark_below_ground, points_in_body, surely_above
from tarsus.kinematics.nearest import nearest_angles
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import IKSolution, Reach
from tarsus.kinematics.triangle import solve_triangle, to_leg_frame
from tarsus.kinematics.verdict import LENGTH_TOLERANCE, all_within, reach_codes
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

__all__ = ["inverse_kinematics"]

# Legs tried again at a time; each has ten candidates.
_AGAIN = BLOCK // 8


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
        Which of the two solutions: the tibia bent down or up from the femur, so that the knee is above or below
        the line from the femur axis to a foot in front of it. A leg whose limits allow only the other one takes that.

    Returns
    -------
    IKSolution
        Angles, reach codes, and what explains them. Where a foot can't be reached, the angles are those of the
        nearest point that the leg reaches within its limits, with that knee. A foot that the leg can't reach with
        its plane turned towards it, but can with the plane turned away (a foot behind the coxa axis), is reached so.

    Raises
    ------
    InputError
        If the feet have another shape, or are not finite; or if `knee` is neither of its two values.
    """
    if knee not in ("up", "down"):
        raise InputError(f"knee is {knee!r}; it can be 'up' or 'down'")
    xp = namespace(feet, robot.geometry.coxa, *(() if body is None else (body.rotation, body.position)))
    p = as_floats(xp, feet, name="feet")
    require_shape("feet", p, (robot.legs, 3))
    require_finite("feet", p)
    branch = 1 if knee == "up" else -1
    batches = (robot.batch_shape, p.shape[:-2], () if body is None else body.batch_shape)
    batch = broadcast_shapes("the robot, the feet and the body's poses", *batches)
    if xp is not np:
        angles, reach = _solve_everywhere(xp, robot, xp.broadcast_to(p, (*batch, *p.shape[-2:])), body, branch)
    else:
        angles, reach = _solve_first(robot, p, body, branch, batch)
        # After the first pass over all legs, so that few that can't reach cost little, however they are scattered.
        if reach.any():
            _try_again(robot, p, body, branch, angles, reach)
    return IKSolution(robot=robot, feet=_kept(p), body=body, knee=knee, angles=angles, reach=reach)


def _kept(feet: Array) -> Array:
    """Return a locked copy of what the caller may write to."""
    if isinstance(feet, np.ndarray):
        feet = feet.copy()
        feet.setflags(write=False)
    return feet


def _solve_everywhere(xp: Namespace, robot: Robot, feet: Array, body: Pose | None, knee: int) -> tuple[Array, Array]:
    """Solve without branching on values, as `jax.jit` needs it."""
    g = robot.geometry.to(xp)
    offset = robot.femur_axis_offset[..., 0]  # not the geometry's, which is traced as soon as any of its numbers is
    sideways = is_traced(offset) or bool(namespace(offset).any(offset != 0))
    feet = xp.astype(feet, xp.result_type(feet, *g))
    x, y, z = feet[..., 0], feet[..., 1], feet[..., 2]
    place = None if body is None else BodyPlace.of(xp, body)
    if place is not None:
        x, y, z = place.into_body(x, y, z)
    x, y, z = to_leg_frame(g, x, y, z)
    solution = solve_triangle(xp, g, x, y, z, knee=knee, sideways=sideways)
    codes = reach_codes(xp, g, solution)

    def try_again() -> tuple[Array, ...]:
        second = _second_tries(xp, g, x, y, z, codes, knee=knee, sideways=sideways)
        return tuple(xp.where(codes == 0, a, b) for a, b in zip((*solution[:3], codes), second, strict=True))

    *joints, codes = only_where_needed(xp.any(codes != 0), try_again, (*solution[:3], codes))
    if place is not None:
        codes = mark_below_ground(xp, g, tuple(joints), codes, place)
    return stack_last(xp, tuple(joints)), codes


def _solve_first(
    robot: Robot, feet: Array, body: Pose | None, knee: int, batch: tuple[int, ...]
) -> tuple[Array, Array]:
    """Solve NumPy legs with their planes turned towards their feet; many in blocks that fit the cache."""
    sideways = bool(robot.geometry.side.any())
    if feet.size <= SMALL and batch == feet.shape[:-2] and not robot.batch_shape:
        place = None if body is None else BodyPlace.of(np, body)
        points = feet if body is None else points_in_body(body, feet)
        x, y, z = points[..., 0], points[..., 1], points[..., 2]
        *joints, codes = _first_tries(robot.geometry, x, y, z, place, knee=knee, sideways=sideways)
        return stack_last(np, tuple(joints)), codes
    angles, reach = np.empty((*batch, robot.legs, 3)), np.empty((*batch, robot.legs), dtype=np.int8)
    same = robot.geometry if robot.batch_shape else robot.geometry.take((), ())
    for index in batch_blocks(batch, max(BLOCK // robot.legs, 1)):
        block = block_shape(batch, index)
        place = None if body is None else BodyPlace.of_block(body, index, block)
        g = robot.geometry.take(index, block) if robot.batch_shape else same
        x, y, z = columns(feet, index, block, tail=2)
        if place is not None:
            x, y, z = place.into_body(x, y, z)
        *joints, codes = _first_tries(g, x, y, z, place, knee=knee, sideways=sideways)
        view = angles[index].reshape(-1, robot.legs, 3)
        for i, joint in enumerate(joints):
            view[..., i] = joint.T
        reach[index].reshape(-1, robot.legs)[...] = codes.T
    return angles, reach


def _first_tries(
    g: LegGeometry, x: Array, y: Array, z: Array, body: BodyPlace | None, *, knee: int, sideways: bool
) -> tuple[Array, ...]:
    """Solve NumPy legs in any layout, their feet in B, with their planes turned towards them."""
    solution = solve_triangle(np, g, *to_leg_frame(g, x, y, z), knee=knee, sideways=sideways)
    joints = solution[:3]
    within = all_within(g, solution)
    codes = np.zeros(solution.far.shape, dtype=np.int8) if within else reach_codes(np, g, solution)
    if body is not None and not surely_above(g, solution.femur, body):
        # Of the legs that are to be tried again, nothing is known yet.
        codes = np.where(codes == 0, mark_below_ground(np, g, joints, codes, body), codes)
    return *joints, codes


def _try_again(robot: Robot, feet: Array, body: Pose | None, knee: int, angles: Array, reach: Array) -> None:
    """Solve the NumPy legs that the first pass could not, and write them into its results."""
    legs = reach.shape
    failed = np.nonzero((reach != 0) & (reach != Reach.BELOW_GROUND))
    sideways = bool(robot.geometry.side.any())
    for start in range(0, len(failed[0]), _AGAIN):
        where = tuple(indices[start : start + _AGAIN] for indices in failed)
        g = robot.geometry.pick(where, legs)
        place = None if body is None else BodyPlace.of_picked(body, where[:-1], legs[:-1])
        x, y, z = np.broadcast_to(feet, angles.shape)[where].T
        if place is not None:
            x, y, z = place.into_body(x, y, z)
        x, y, z = to_leg_frame(g, x, y, z)
        *joints, codes = _second_tries(np, g, x, y, z, reach[where], knee=knee, sideways=sideways)
        if place is not None:
            codes = mark_below_ground(np, g, tuple(joints), codes, place)
        angles[where], reach[where] = stack_last(np, tuple(joints)), codes


def _second_tries(
    xp: Namespace, g: LegGeometry, x: Array, y: Array, z: Array, codes: Array, *, knee: int, sideways: bool
) -> tuple[Array, ...]:
    """Solve the legs that can't reach their foot turned towards it: turned away, or as near as they get."""
    away = solve_triangle(xp, g, x, y, z, knee=knee, facing=-1, sideways=sideways)
    turned = reach_codes(xp, g, away) == 0
    miss2, *nearest = nearest_angles(xp, g, x, y, z, knee=knee, sideways=sideways)
    # Where a joint's angle makes no difference (a foot on its axis) or little (a straight leg), the first solution may
    # be out of the limits, and yet an angle within them reaches the foot.
    solved = turned | (miss2 <= LENGTH_TOLERANCE * LENGTH_TOLERANCE)
    joints = (xp.where(turned, second, last) for second, last in zip(away[:3], nearest, strict=True))
    return *joints, xp.where(solved, xp.zeros_like(codes), codes)
