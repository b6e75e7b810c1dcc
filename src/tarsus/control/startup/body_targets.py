"""Level body poses that a robot can be moved to from its initial pose."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.startup.builder import GROUND_TOLERANCE, BodyTarget, SequenceBuilder
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rotation import levelling_rotation
from tarsus.kinematics.underside import belly_depth, underside_points

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["body_targets"]

# Number of body heights to try between lying and standing.
_HEIGHTS = 6
# How far the body may rise above its initial and its final height to make room for its legs [m].
_EXTRA_HEIGHT = 0.04


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
    """Return the pose with a rotation and a height that keeps the horizontal position of the pivot."""
    position = body.position + body.rotation @ pivot - rotation @ pivot
    return Pose(rotation, np.array([position[0], position[1], height]))
