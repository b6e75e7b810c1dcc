"""Level poses that the body of a robot could be brought to from where it is found, and the way there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.control.sequence.stage import Stage
from tarsus.control.startup.builder import SequenceBuilder
from tarsus.control.startup.folded_pose import belly_depth, rest_points
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose

__all__ = ["FLAT", "BodyTarget", "body_targets", "path_to"]

Floats = np.ndarray[Any, np.dtype[np.float64]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]

FLAT = 1e-7
"""What rounding may make of the height of a point on the ground [m]."""

# How many heights between lying and standing are tried.
_HEIGHTS = 6
# How much higher than it is found or wanted the body may go to make room for its legs [m].
_HIGHER = 0.04


@dataclass(frozen=True, eq=False)
class BodyTarget:
    """A level pose to bring the body to.

    Attributes
    ----------
    body : Pose
        The pose in G.
    pivot : array, shape (3,)
        The point of B that goes straight there [m].
    lying : bool
        Whether the belly then lies flat on the ground.
    """

    body: Pose
    pivot: Floats
    lying: bool


def body_targets(draft: SequenceBuilder, height: float) -> tuple[BodyTarget, ...]:
    """Return the level poses that are worth a try, the likeliest first.

    Parameters
    ----------
    draft : Draft
        The robot as found.
    height : float
        Where its body's origin is wanted in the end [m].
    """
    robot, body = draft.robot, draft.body
    up = body.rotation[2]
    # The least turn that brings the body's z upright: about the horizontal axis across the tilt.
    upright = _least_turn(body.rotation[:, 2]) @ body.rotation
    on_body = rest_points(robot)
    touching = (on_body @ up + draft.height) < FLAT
    lying = belly_depth(robot)
    com = np.asarray(centre_of_mass(robot, draft.angles))
    heights = np.linspace(max(height, draft.height) + _HIGHER, lying + _HIGHER / 2, _HEIGHTS)
    nearest_first = sorted(heights.tolist(), key=lambda h: abs(h - draft.height))
    standing = [BodyTarget(_over(body, upright, com, h), com, lying=False) for h in (height, *nearest_first)]
    pivot = on_body[touching].mean(0) if touching.any() else com
    down = BodyTarget(_over(body, upright, pivot, lying), pivot, lying=True)
    return (down, *standing) if touching.any() else (*standing, down)


def _over(body: Pose, rotation: Floats, pivot: Floats, height: float) -> Pose:
    """Return the pose with that rotation and height in which the pivot is over where it is now."""
    across = body.position + body.rotation @ pivot - rotation @ pivot
    return Pose(rotation, np.array([across[0], across[1], height]))


def _least_turn(up: Floats) -> Floats:
    """Return the rotation by the least angle that carries the unit vector `up` into z."""
    x, y, z = up
    turn: Floats = np.array(
        [[z + y * y / (1 + z), -x * y / (1 + z), -x], [-x * y / (1 + z), z + x * x / (1 + z), -y], up]
    )
    return turn


def path_to(draft: SequenceBuilder, goal: BodyTarget, by_foot: Flags) -> Stage:
    """Return the body's way to the goal, with feet still."""
    feet = draft.feet
    return Stage(
        name="",
        robot=draft.robot,
        duration=1.0,
        start=draft.body,
        end=goal.body,
        pivot=goal.pivot,
        angles=draft.angles,
        angles_end=draft.angles,
        feet=feet,
        feet_end=feet,
        swing_height=0.0,
        by_foot=by_foot,
        contacts=by_foot,
        contacts_end=by_foot,
        props=np.zeros((0, 3)),
        belly=False,
    )
