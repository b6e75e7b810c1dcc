"""Closed-form inverse kinematics of many legs at a time, with reach codes and the nearest reachable points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import (
    Array,
    Namespace,
    broadcast_shapes,
    is_traced,
    namespace,
    only_where_needed,
    stack_last,
)
from tarsus.blocks import BLOCK, SMALL, batch_blocks, block_shape, columns
from tarsus.kinematics.ground import PoseComponents, certainly_above_ground, mark_below_ground, points_in_body
from tarsus.kinematics.nearest import nearest_angles, tibia_bend
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import LENGTH_TOLERANCE, Reach, all_within, reach_codes
from tarsus.kinematics.triangle import solve_triangle, to_leg_frame
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["solve_legs"]

# Legs per block of the second pass; each has ten candidates.
_AGAIN = BLOCK // 8


def solve_legs(
    robot: Robot, feet: Float[Array, "*#batch legs 3"], body: Pose | None, *, knee: int
) -> tuple[Float[Array, "*batch legs 3"], Int[Array, "*batch legs"]]:
    """Return the joint angles for given feet, and the reach code of every leg.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    feet : array, shape (..., legs, 3)
        Finite floats: in G where `body` is given, else in B [m].
    body : Pose or None
        Pose of B in G.
    knee : int
        Knee branch, 1 up or -1 down.

    Returns
    -------
    angles : array, shape (..., legs, 3)
        Joint angles [rad]; of the nearest reachable point where the foot can't be reached.
    reach : array of int8, shape (..., legs)
        Codes of `Reach`.
    """
    xp = namespace(feet, robot.geometry.coxa, *(() if body is None else (body.rotation, body.position)))
    batches = (robot.batch_shape, feet.shape[:-2], () if body is None else body.batch_shape)
    batch = broadcast_shapes("the robot, the feet and the body's poses", *batches)
    if xp is not np:
        return _solve_everywhere(xp, robot, xp.broadcast_to(feet, (*batch, *feet.shape[-2:])), body, knee)
    angles, reach = _solve_first(robot, feet, body, knee, batch)
    # After the first pass over all legs, so that a few failing legs cost little, however they are scattered.
    if np.count_nonzero(reach):
        _try_again(robot, feet, body, knee, angles, reach)
    return angles, reach


def _solve_everywhere(
    xp: Namespace, robot: Robot, feet: Float[Array, "*#batch legs 3"], body: Pose | None, knee: int
) -> tuple[Float[Array, "... legs 3"], Int[Array, "... legs"]]:
    """Solve without branches on values, for `jax.jit`."""
    g = robot.geometry.to(xp)
    offset = robot.femur_axis_offset[..., 0]  # the geometry is traced as a whole as soon as one of its arrays is
    sideways = is_traced(offset) or bool(namespace(offset).any(offset != 0))
    feet = xp.astype(feet, xp.result_type(feet, *g))
    x, y, z = feet[..., 0], feet[..., 1], feet[..., 2]
    place = None if body is None else PoseComponents.of(xp, body)
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
    robot: Robot, feet: Float[Array, "*#batch legs 3"], body: Pose | None, knee: int, batch: tuple[int, ...]
) -> tuple[Float[Array, "... legs 3"], Int[Array, "... legs"]]:
    """Solve NumPy legs with their planes facing their feet; large batches in blocks that fit the cache."""
    sideways = bool(np.count_nonzero(robot.geometry.side))
    if feet.size <= SMALL and batch == feet.shape[:-2] and not robot.batch_shape:
        place = None if body is None else PoseComponents.of(np, body)
        points = feet if body is None else points_in_body(body, feet)
        x, y, z = points[..., 0], points[..., 1], points[..., 2]
        *joints, codes = _first_tries(robot.geometry, x, y, z, place, knee=knee, sideways=sideways)
        return stack_last(np, tuple(joints)), codes
    angles, reach = np.empty((*batch, robot.legs, 3)), np.empty((*batch, robot.legs), dtype=np.int8)
    same = robot.geometry if robot.batch_shape else robot.geometry.take((), ())
    for index in batch_blocks(batch, max(BLOCK // robot.legs, 1)):
        block = block_shape(batch, index)
        place = None if body is None else PoseComponents.of_block(body, index, block)
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
    g: LegGeometry,
    x: Float[Array, "*#batch legs"],
    y: Float[Array, "*#batch legs"],
    z: Float[Array, "*#batch legs"],
    body: PoseComponents | None,
    *,
    knee: int,
    sideways: bool,
) -> tuple[Float[Array, "..."] | Int[Array, "..."], ...]:
    """Solve NumPy legs in any layout, with feet in B and the legs' planes facing them."""
    solution = solve_triangle(np, g, *to_leg_frame(g, x, y, z), knee=knee, sideways=sideways)
    joints = solution[:3]
    within = all_within(g, solution)
    codes = np.zeros(solution.far.shape, dtype=np.int8) if within else reach_codes(np, g, solution)
    if body is not None and not certainly_above_ground(g, solution.femur, body):
        # Legs that go through the second pass are checked there.
        codes = np.where(codes == 0, mark_below_ground(np, g, joints, codes, body), codes)
    return *joints, codes


def _try_again(
    robot: Robot,
    feet: Float[Array, "*#batch legs 3"],
    body: Pose | None,
    knee: int,
    angles: Float[Array, "*#batch legs 3"],
    reach: Int[Array, "*#batch legs"],
) -> None:
    """Solve the NumPy legs that failed in the first pass, and write them into its results."""
    legs = reach.shape
    failed = np.nonzero((reach != 0) & (reach != Reach.BELOW_GROUND))
    sideways = bool(robot.geometry.side.any())
    for start in range(0, len(failed[0]), _AGAIN):
        where = tuple(indices[start : start + _AGAIN] for indices in failed)
        g = robot.geometry.pick(where, legs)
        place = None if body is None else PoseComponents.of_picked(body, where[:-1], legs[:-1])
        x, y, z = np.broadcast_to(feet, angles.shape)[where].T
        if place is not None:
            x, y, z = place.into_body(x, y, z)
        x, y, z = to_leg_frame(g, x, y, z)
        *joints, codes = _second_tries(np, g, x, y, z, reach[where], knee=knee, sideways=sideways)
        if place is not None:
            codes = mark_below_ground(np, g, tuple(joints), codes, place)
        angles[where], reach[where] = stack_last(np, tuple(joints)), codes


def _second_tries(
    xp: Namespace,
    g: LegGeometry,
    x: Float[Array, "*#batch legs"],
    y: Float[Array, "*#batch legs"],
    z: Float[Array, "*#batch legs"],
    codes: Int[Array, "... legs"],
    *,
    knee: int,
    sideways: bool,
) -> tuple[Float[Array, "..."] | Int[Array, "..."], ...]:
    """Solve legs that failed in the first pass: facing away from the foot, or at the nearest reachable point."""
    away = solve_triangle(xp, g, x, y, z, knee=knee, facing=-1, sideways=sideways)
    turned = reach_codes(xp, g, away) == 0
    excluded = tibia_bend(xp, g, knee=knee) * knee > 0
    if xp is not np or excluded.any():
        # Where a leg's limits allow the other knee branch only, that branch tells why the leg fails.
        other = reach_codes(xp, g, solve_triangle(xp, g, x, y, z, knee=-knee, sideways=sideways))
        codes = xp.where(excluded, other, codes)
    miss2, *nearest = nearest_angles(xp, g, x, y, z, knee=knee, sideways=sideways)
    # Where a joint angle has no effect (foot on its axis) or little (straight leg), the first solution may violate the
    # limits although an angle within them reaches the foot.
    solved = turned | (miss2 <= LENGTH_TOLERANCE * LENGTH_TOLERANCE)
    joints = (xp.where(turned, second, last) for second, last in zip(away[:3], nearest, strict=True))
    return *joints, xp.where(solved, xp.zeros_like(codes), codes)
