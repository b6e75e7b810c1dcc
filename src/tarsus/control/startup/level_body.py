"""Level poses of the body, standing or lying, and its motion from the initial pose to one of them.

Feet that bear load stay where they are while the body moves. A leg that cannot follow, or rests on its knee, is lifted
first if the other legs can support the body without it. Legs in the air are placed on footholds that they can keep, so
that they support the body too.
"""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.startup.builder import GROUND_TOLERANCE, BodyTarget, SequenceBuilder
from tarsus.control.startup.checks import limit_excess
from tarsus.errors import TarsusError
from tarsus.kinematics.folded_pose import folded_pose
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rotation import levelling_rotation
from tarsus.kinematics.underside import belly_depth, underside_points

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["body_targets", "level_body"]

# Number of body heights to try between lying and standing.
_HEIGHTS = 6
# How far the body may rise above its initial and its final height to make room for its legs; half of this is how far
# the lowest height tried is above lying [m].
_EXTRA_HEIGHT = 0.04
# Tolerance of an angle beyond its limit [rad].
_ANGLE_TOLERANCE = 1e-7
# Feet in the air below this height stay in place as the body lies down: joint backlash can explain such a height [m].
_NEAR_GROUND = 0.005
# Number of body poses on the path to the target at which a foothold must be within reach.
_POSES = 9
# Candidate footholds: distances from the coxa axis as fractions of the leg length, and coxa angles [rad].
_DISTANCES = np.linspace(0.3, 0.95, 14)
_COXA_ANGLES = np.deg2rad(np.linspace(-45, 45, 13))
# Number of reachable footholds to try for each leg, spread over those near to and far from the preferred one.
_CHOICES = 6


def body_targets(builder: SequenceBuilder, height: float) -> tuple[BodyTarget, ...]:
    """Return the candidate level poses for a final body height [m], the most promising one first."""
    robot, body = builder.robot, builder.body
    up = body.rotation[2]
    upright = levelling_rotation(body.rotation[:, 2]) @ body.rotation
    underside = underside_points(robot)
    on_ground = (underside @ up + builder.height) < GROUND_TOLERANCE
    lowest = belly_depth(robot)
    com = np.asarray(centre_of_mass(robot, builder.angles))
    heights = np.linspace(max(height, builder.height) + _EXTRA_HEIGHT, lowest + _EXTRA_HEIGHT / 2, _HEIGHTS)
    nearest_first = sorted(heights.tolist(), key=lambda h: abs(h - builder.height))
    standing = [BodyTarget(_pose_above(body, upright, com, h), com, belly=False) for h in (height, *nearest_first)]
    pivot = underside[on_ground].mean(0) if on_ground.any() else com
    lying = BodyTarget(_pose_above(body, upright, pivot, lowest), pivot, belly=True)
    return (lying, *standing) if on_ground.any() else (*standing, lying)


def _pose_above(body: Pose, rotation: Float[np.ndarray, "3 3"], pivot: Float[np.ndarray, "3"], height: float) -> Pose:
    """Return the pose with this rotation and height in which the pivot keeps its horizontal position."""
    position = body.position + body.rotation @ pivot - rotation @ pivot
    return Pose(rotation, np.array([position[0], position[1], height]))


def level_body(builder: SequenceBuilder, target: BodyTarget, stance: Float[np.ndarray, "legs 3"]) -> SequenceBuilder:
    """Move the body to a level pose with the loaded feet stationary.

    Parameters
    ----------
    builder, target : SequenceBuilder, BodyTarget
        The robot in its initial state; pose of the body at the end.
    stance : array, shape (legs, 3)
        Preferred footholds in B [m].

    Returns
    -------
    SequenceBuilder
        The robot with its body level.

    Raises
    ------
    TarsusError
        If the pose cannot be reached.
    """
    if builder.belly:
        return builder
    on_knee = builder.points[:, 2, 2] < GROUND_TOLERANCE
    follows = _can_follow(builder, target)
    blocking, free = on_knee | (builder.contacts & ~follows), ~(builder.contacts | on_knee)
    near_ground = np.zeros_like(free)
    if target.belly and not blocking.any():
        near_ground = free & follows & (builder.feet[:, 2] < _NEAR_GROUND)
        folded = np.where((free & ~near_ground)[:, None], folded_pose(builder.robot), builder.angles)
        builder = builder.move_legs("retract free legs", folded, landed=False)
    else:
        builder = _place_feet(builder, target, stance, blocking)
    name = "lie down" if target.belly else "level body"
    builder = builder.move_body(name, target, builder.contacts | near_ground)
    return builder.lie_down() if target.belly else builder


def _can_follow(builder: SequenceBuilder, target: BodyTarget) -> Bool[np.ndarray, "legs"]:
    """Return the legs that can keep their feet in place while the body moves to the target."""
    stage = builder.stage("", end=target.body, pivot=target.pivot, cartesian=np.ones_like(builder.contacts))
    excess_grows = np.diff(limit_excess(stage), axis=0) > _ANGLE_TOLERANCE
    return np.array(~(np.isnan(stage.table).any((0, 2)) | excess_grows.any((0, 2))))


def _place_feet(
    builder: SequenceBuilder, target: BodyTarget, stance: Float[np.ndarray, "legs 3"], blocks: Bool[np.ndarray, "legs"]
) -> SequenceBuilder:
    """Place the legs in the air on footholds that they can keep while the body moves, then those that block its motion.

    `blocks` are the legs on the ground that cannot stay where they are.
    """
    choices = _footholds(builder, target, stance)
    folded = folded_pose(builder.robot)
    for leg in np.flatnonzero(~(builder.contacts | blocks)).tolist():
        # A leg without a foothold is retracted; if that is not possible either, it stays in the air as it is.
        builder = _move(builder, leg, choices[leg]) or _move(builder, leg, folded[[leg]], landed=False) or builder
    # A robot that initially rests with a small stability margin is not required to have a greater one.
    remaining, margin = np.flatnonzero(blocks).tolist(), min(builder.margin, builder.initial_margin)
    while found := next(((leg, to) for leg in remaining if (to := _move(builder, leg, choices[leg], margin))), None):
        placed, builder = found
        remaining.remove(placed)
    for leg in remaining:
        # A leg that cannot be lifted by itself comes off the ground with the body, supported by the other legs.
        builder = builder.unload(leg)
    return builder


def _move(
    builder: SequenceBuilder, leg: int, choices: Float[np.ndarray, "n 3"], margin: float = 0.0, *, landed: bool = True
) -> SequenceBuilder | None:
    """Move a leg through the air to the first joint angles of shape (n, 3) that can be reached [rad]; None if none can.

    `landed` tells whether its foot is placed on the ground.
    """
    name = f"{'place' if landed else 'retract'} {builder.robot.leg_codes[leg]}"
    for angles in choices:
        target = builder.angles.copy()
        target[leg] = angles
        with suppress(TarsusError):
            return builder.unload(leg).move_legs(name, target, landed=landed, margin=margin)
    return None


def _footholds(
    builder: SequenceBuilder, target: BodyTarget, stance: Float[np.ndarray, "legs 3"]
) -> list[Float[np.ndarray, "..."]]:
    """Return by leg the joint angles of reachable footholds, shape (n, 3) [rad], nearest to the preferred one first."""
    robot, g = builder.robot, builder.robot.geometry
    distance = (g.coxa + g.femur + g.tibia) * _DISTANCES[:, None, None]
    yaw = robot.mount_yaw + _COXA_ANGLES[:, None]
    x, y = (robot.mount_position[:, axis] + distance * fn(yaw) for axis, fn in ((0, np.cos), (1, np.sin)))
    height = target.body.position[2]
    candidates = np.stack([x, y, np.full_like(x, -height)], axis=-1).reshape(-1, robot.legs, 3)
    candidates = np.concatenate([(stance * [1, 1, 0] - [0, 0, height])[None], candidates])
    path = builder.stage("", end=target.body, pivot=target.pivot).body_at(np.linspace(0, 1, _POSES))
    solution = inverse_kinematics(robot, (target.body @ candidates)[:, None], path)
    reachable = (np.asarray(solution.reach) == 0).all(1)
    offset = np.where(reachable, np.linalg.norm(candidates - candidates[0], axis=-1), np.inf)
    order = np.argsort(offset, axis=0)
    chosen = []
    for leg in range(robot.legs):
        good = order[: int(reachable[:, leg].sum()), leg]
        chosen.append(np.asarray(solution.angles)[good[:: max(len(good) // _CHOICES, 1)][:_CHOICES], 0, leg])
    return chosen
