"""From joint angles as they are found to a level body: standing on its feet, or lying on its belly.

How the robot rests with those angles, `resting_pose` tells. Feet that bear load stay where they are while the body
moves; a leg that can't follow, or that bears on its knee, is lifted first, when the others hold the body without it.
Legs in the air are put down where they can stay, so that they hold it too.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.arrays import Array
from tarsus.control.sequence.joint_rates import JointRates
from tarsus.control.sequence.stage import GRID
from tarsus.control.startup.body_targets import FLAT, BodyTarget, path_to
from tarsus.control.startup.builder import SequenceBuilder
from tarsus.control.startup.checks import excess
from tarsus.control.startup.folded_pose import belly_depth, folded_pose, rest_points
from tarsus.control.startup.foothold_search import place_feet
from tarsus.errors import InputError, TarsusError
from tarsus.kinematics.leg import checked_angles, forward_kinematics
from tarsus.kinematics.rest import resting_pose
from tarsus.robot.robot import Robot

__all__ = ["initial_state", "level_body"]

Floats = np.ndarray[Any, np.dtype[np.float64]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]

# A body that is tilted further has not been put down on its feet or its belly.
_MOST_TILT = math.radians(60)
# What rounding may make of a level body, and of an angle beyond its limit [rad].
_LEVEL = 1e-7
# Feet that are lower than this over the ground are meant to be on it [m].
_NEAR = 0.005


def initial_state(robot: Robot, angles: Array, pace: JointRates) -> SequenceBuilder:
    """Return a draft of the robot as it rests with the joint angles that were found.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles, also somewhat beyond their limits [rad].
    pace : JointRates
        What the joints may do.

    Raises
    ------
    InputError
        If the angles have another shape, or are not finite.
    TarsusError
        If the robot has fallen over.
    """
    _, found = checked_angles(robot, angles)
    if robot.batch_shape or found.ndim != 2:
        raise InputError("getting up and lying down are planned for a single robot in a single pose")
    found = found.copy()
    found.setflags(write=False)
    rest = resting_pose(robot, found)
    body, down = rest.body, np.asarray(rest.leg_points_down)
    tilt = math.acos(min(max(float(body.rotation[2, 2]), -1.0), 1.0))
    if not rest.stable or tilt > _MOST_TILT:
        raise TarsusError(
            f"with these joint angles {robot.name} {rest.describe()}, its body tilted by {math.degrees(tilt):.0f} deg; "
            f"at most {math.degrees(_MOST_TILT):.0f} deg can be made level: put it on its belly"
        )
    points = body @ forward_kinematics(robot, found)
    corners = (body @ rest_points(robot)) if robot.body_size is not None else np.zeros((0, 3))
    props = np.concatenate([points[:, :3][down[:, :3]], corners[corners[:, 2] < FLAT]])
    draft = SequenceBuilder(
        robot=robot,
        pace=pace,
        angles=found,
        body=body,
        contacts=down[:, 3].copy(),
        belly=False,
        props=props,
        margin=float(rest.margin),
    )
    if tilt < _LEVEL and abs(draft.height - belly_depth(robot)) < FLAT:
        draft.lie()
    return draft


def level_body(draft: SequenceBuilder, goal: BodyTarget, stance: Floats, *, least: float) -> None:
    """Bring the body to a level pose, feet that bear load still.

    Parameters
    ----------
    draft : Draft
        The robot as found; takes the stages.
    goal : Goal
        Where the body goes.
    stance : array, shape (legs, 3)
        Footholds in B that are wanted in the end: others are chosen near to them [m].
    least : float
        The least stability margin while feet are lifted that bear load, or the margin as found where that is less [m].

    Raises
    ------
    TarsusError
        If it can't be done; the message says why.
    """
    if draft.belly:
        return
    knees = _on_knees(draft)
    follows = draft.contacts & ~knees & _can_follow(draft, goal)
    lift_first = (draft.contacts | knees) & ~follows
    free = ~draft.contacts & ~knees
    near = np.zeros_like(free)
    if goal.lying and not lift_first.any():
        # Feet that hang a little above the ground, by the play of joints, stay there like those on it.
        near = free & _can_follow(draft, goal) & (draft.feet[:, 2] < _NEAR)
        free = free & ~near
        folded = np.where(free[:, None], folded_pose(draft.robot), draft.angles)
        draft.fly("draw in the free legs", free, folded, landed=False)
    else:
        place_feet(draft, goal, stance, free=free, lift_first=lift_first, least=min(least, draft.margin))
    held = _belly_points(draft) if goal.lying else np.zeros((0, 3))
    name = "lie down" if goal.lying else "level the body"
    draft.move_body(name, goal.body, pivot=goal.pivot, props=held, still=near)
    if goal.lying:
        draft.lie()


def _on_knees(draft: SequenceBuilder) -> Flags:
    """Return the legs whose knee is on the ground."""
    points = draft.body @ forward_kinematics(draft.robot, draft.angles)
    knees: Flags = points[:, 2, 2] < FLAT
    return knees


def _belly_points(draft: SequenceBuilder) -> Floats:
    """Return the points of the body that touch the ground, in G."""
    points = draft.body @ rest_points(draft.robot)
    touching: Floats = points[points[:, 2] < FLAT]
    return touching


def _can_follow(draft: SequenceBuilder, goal: BodyTarget) -> Flags:
    """Return the legs that can keep their feet where they are on the body's way."""
    angles = path_to(draft, goal, np.ones(draft.robot.legs, dtype=bool)).angles_at(GRID)
    beyond = np.diff(excess(draft.robot, np.nan_to_num(angles)), axis=0) > _LEVEL
    return np.array(~(np.isnan(angles).any((0, 2)) | beyond.any((0, 2))))
