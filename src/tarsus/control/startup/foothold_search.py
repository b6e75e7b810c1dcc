"""Footholds that legs can keep while the body moves to a target, and the placing of feet on them."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.startup.body_targets import stage_to
from tarsus.control.startup.builder import BodyTarget, SequenceBuilder
from tarsus.errors import TarsusError
from tarsus.kinematics.folded_pose import folded_pose
from tarsus.kinematics.inverse import inverse_kinematics

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["place_feet"]


# Number of body poses on the path to the target at which a foothold must be within reach.
_POSES = 9
# Candidate footholds: distances as fractions of the leg length, and coxa angles [rad].
_DISTANCES = np.linspace(0.3, 0.95, 14)
_COXA_ANGLES = np.deg2rad(np.linspace(-45, 45, 13))
# Number of reachable footholds to try for each leg, spread over near and far ones.
_CHOICES = 6


def place_feet(
    builder: SequenceBuilder,
    target: BodyTarget,
    stance: Float[np.ndarray, "legs 3"],
    *,
    free: Bool[np.ndarray, "legs"],
    blocking: Bool[np.ndarray, "legs"],
) -> SequenceBuilder:
    """Place the free legs on footholds that they can keep while the body moves, then the legs that block the motion.

    Parameters
    ----------
    builder, target : SequenceBuilder, BodyTarget
        The robot in its initial state; pose that the body moves to afterwards.
    stance : array, shape (legs, 3)
        Preferred footholds in B [m].
    free, blocking : array of bool, shape (legs,)
        Legs in the air, and legs on the ground that cannot stay where they are.

    Returns
    -------
    SequenceBuilder
        The robot with its feet where they can stay.
    """
    choices = _footholds(builder, target, stance)
    folded = folded_pose(builder.robot)
    for leg in np.flatnonzero(free).tolist():
        # A leg without a foothold is retracted, or else stays in the air as it is.
        after = _place(builder, leg, choices[leg])
        if after is None:
            with suppress(TarsusError):
                after = _move_leg(builder, leg, folded[leg], "retract", landed=False)
        builder = after or builder
    # A robot that lies or stands unsteadily at first can't have more margin than that.
    remaining, margin = np.flatnonzero(blocking).tolist(), min(builder.margin, builder.initial_margin)
    while found := next(((leg, to) for leg in remaining if (to := _place(builder, leg, choices[leg], margin))), None):
        placed, builder = found
        remaining.remove(placed)
    for leg in remaining:
        # A leg that cannot be lifted by itself comes off the ground with the body, supported by the other legs.
        builder = builder.unload(leg)
    return builder


def _place(
    builder: SequenceBuilder, leg: int, choices: Float[np.ndarray, "n 3"], margin: float = 0.0
) -> SequenceBuilder | None:
    """Place a foot with the first reachable joint angles of shape (n, 3) [rad]; return None if none are."""
    for angles in choices:
        with suppress(TarsusError):
            return _move_leg(builder, leg, angles, "place", landed=True, margin=margin)
    return None


def _move_leg(
    builder: SequenceBuilder, leg: int, angles: Float[np.ndarray, "3"], verb: str, *, landed: bool, margin: float = 0.0
) -> SequenceBuilder:
    """Move one leg through the air to joint angles."""
    target, name = builder.angles.copy(), f"{verb} {builder.robot.leg_codes[leg]}"
    target[leg] = angles
    return builder.unload(leg).move_legs(name, target, landed=landed, margin=margin)


def _footholds(
    builder: SequenceBuilder, target: BodyTarget, stance: Float[np.ndarray, "legs 3"]
) -> list[Float[np.ndarray, "..."]]:
    """Return for each leg the joint angles of reachable footholds, shape (n, 3) [rad], near the preferred one first."""
    robot, g = builder.robot, builder.robot.geometry
    distance = (g.coxa + g.femur + g.tibia) * _DISTANCES[:, None, None]
    yaw = robot.mount_yaw + _COXA_ANGLES[:, None]
    x, y = (robot.mount_position[:, axis] + distance * fn(yaw) for axis, fn in ((0, np.cos), (1, np.sin)))
    height = target.body.position[2]
    candidates = np.stack([x, y, np.full_like(x, -height)], axis=-1).reshape(-1, robot.legs, 3)
    candidates = np.concatenate([(stance * [1, 1, 0] - [0, 0, height])[None], candidates])
    path = stage_to(builder, target, np.zeros(robot.legs, dtype=bool)).body_at(np.linspace(0, 1, _POSES))
    feet = np.broadcast_to((target.body @ candidates)[:, None], (len(candidates), _POSES, robot.legs, 3))
    solution = inverse_kinematics(robot, feet, path)
    reachable = (np.asarray(solution.reach) == 0).all(1)
    offset = np.where(reachable, np.linalg.norm(candidates - candidates[0], axis=-1), np.inf)
    order = np.argsort(offset, axis=0)
    chosen = []
    for leg in range(robot.legs):
        good = order[: int(reachable[:, leg].sum()), leg]
        chosen.append(np.asarray(solution.angles)[good[:: max(len(good) // _CHOICES, 1)][:_CHOICES], 0, leg])
    return chosen
