"""Motion of the body from its initial pose to a level one, standing or lying.

Feet that bear load stay where they are while the body moves. A leg that cannot follow, or rests on its knee, is lifted
first if the other legs can support the body without it. Legs in the air are placed on footholds that they can keep, so
that they support the body too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.sequence.stage import GRID
from tarsus.control.startup.body_targets import stage_to
from tarsus.control.startup.builder import GROUND_TOLERANCE, BodyTarget, SequenceBuilder
from tarsus.control.startup.checks import limit_excess
from tarsus.control.startup.foothold_search import place_feet
from tarsus.kinematics.folded_pose import folded_pose

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["level_body"]


# Tolerance of an angle beyond its limit [rad].
_ANGLE_TOLERANCE = 1e-7
# Feet below this height over the ground are kept at their place, as joint backlash can explain their height [m].
_NEAR_GROUND = 0.005


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
    follows = builder.contacts & ~on_knee & _can_follow(builder, target)
    blocking = (builder.contacts | on_knee) & ~follows
    free = ~builder.contacts & ~on_knee
    near_ground = np.zeros_like(free)
    if target.belly and not blocking.any():
        near_ground = free & _can_follow(builder, target) & (builder.feet[:, 2] < _NEAR_GROUND)
        free = free & ~near_ground
        folded = np.where(free[:, None], folded_pose(builder.robot), builder.angles)
        builder = builder.move_legs("retract free legs", folded, landed=False)
    else:
        builder = place_feet(builder, target, stance, free=free, blocking=blocking)
    name = "lie down" if target.belly else "level body"
    builder = builder.move_body(name, target, builder.contacts | near_ground)
    return builder.lie_down() if target.belly else builder


def _can_follow(builder: SequenceBuilder, target: BodyTarget) -> Bool[np.ndarray, "legs"]:
    """Return the legs that can keep their feet in place while the body moves to the target."""
    angles = stage_to(builder, target, np.ones(builder.robot.legs, dtype=bool)).angles_at(GRID)
    excess_grows = np.diff(limit_excess(builder.robot, np.nan_to_num(angles)), axis=0) > _ANGLE_TOLERANCE
    return np.array(~(np.isnan(angles).any((0, 2)) | excess_grows.any((0, 2))))
