"""Getting up from any joint angles to the walking stance, and sitting down again."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tarsus.arrays import Array
from tarsus.control.sequence.joint_rates import JointRates
from tarsus.control.sequence.sequence import MotionSequence
from tarsus.control.startup.body_targets import BodyTarget, body_targets
from tarsus.control.startup.builder import SequenceBuilder
from tarsus.control.startup.folded_pose import belly_depth, folded_pose
from tarsus.control.startup.foothold_stations import foothold_distances, footholds
from tarsus.control.startup.initial_state import initial_state, level_body
from tarsus.control.startup.raise_body import lower_body, raise_body
from tarsus.errors import InputError, TarsusError, UnreachableError
from tarsus.gait.setup import default_swing_height, require_number
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.stance import default_body_height, default_stance
from tarsus.robot.robot import Robot

__all__ = ["LEAST_MARGIN", "fold", "lying", "sit_down", "stand_up"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

LEAST_MARGIN = 0.010
"""The least stability margin while feet are lifted to other footholds, unless another is asked for [m]."""


def stand_up(
    robot: Robot,
    angles: Array,
    *,
    body_height: float | None = None,
    swing_height: float | None = None,
    margin: float = LEAST_MARGIN,
    joint_speed: Array | None = None,
    joint_acceleration: Array | None = None,
) -> MotionSequence:
    """Plan how the robot gets up from any joint angles to its walking stance.

    How it rests with these angles, `resting_pose` tells. Standing on its feet, it keeps them where they are, makes its
    body level, and lifts them in groups to their footholds. Else it lies down on its belly, folds its legs, puts
    its feet on the ground beside it and pushes the body straight up; where legs can't reach that far from one
    foothold, they change their footholds on the way, in groups. No foot that bears load is ever dragged.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles as measured, also somewhat beyond their limits [rad].
    body_height, swing_height : float, optional
        Of the walking stance that it ends in: ``default_stance(robot, body height, lift=lift)`` [m]; the robot's own
        where left out. `swing_height` is also how high feet are lifted.
    margin : float
        The least stability margin while feet are lifted to other footholds; of feet that are found bearing load, the
        margin as found where that is less [m].
    joint_speed, joint_acceleration : array, optional
        What no joint exceeds [rad/s, rad/s^2]; see `JointRates.of`.

    Returns
    -------
    Sequence
        It ends with the body over G's origin, heading along x.

    Raises
    ------
    InputError
        If the robot is a batch, or a number is not finite or out of its range.
    UnreachableError
        If the legs can't do it: which leg, at what height, by how much, and what would work.
    TarsusError
        If the robot has fallen over, or would.
    """
    swing_height, margin = _heights(robot, swing_height, margin)
    height = default_body_height(robot) if body_height is None else float(body_height)
    if height < belly_depth(robot):
        raise UnreachableError(
            f"at a body height of {height * 1000:.1f} mm the body would be in the ground: it lies on its belly at "
            f"{belly_depth(robot) * 1000:.1f} mm, and can stand higher"
        )
    pace = JointRates.of(robot, joint_speed, joint_acceleration)
    found = initial_state(robot, angles, pace)
    feet = default_stance(robot, height, swing_height=swing_height)
    stance = inverse_kinematics(robot, feet).require().angles

    def rise(draft: SequenceBuilder, goal: BodyTarget) -> None:
        level_body(draft, goal, feet, least=margin)
        if draft.belly:
            _fold(draft)
        raise_body(draft, feet, stance, swing_height=swing_height, least=margin)

    return _first_that_works(found, height, rise)


def sit_down(
    robot: Robot,
    angles: Array | None = None,
    *,
    swing_height: float | None = None,
    margin: float = LEAST_MARGIN,
    joint_speed: Array | None = None,
    joint_acceleration: Array | None = None,
) -> MotionSequence:
    """Plan how the robot lets itself down until its belly rests on the ground, feet still.

    Where legs can't let the body down that far from where they stand, they change their footholds on the way, in
    groups.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3), optional
        Joint angles as measured [rad]; those of the robot's own walking stance where left out.
    swing_height : float, optional
        How high feet are lifted that change their footholds [m]; the robot's own where left out.
    margin : float
        The least stability margin meanwhile [m].
    joint_speed, joint_acceleration : array, optional
        What no joint exceeds [rad/s, rad/s^2]; see `JointRates.of`.

    Returns
    -------
    Sequence
        It ends with the body over G's origin, heading along x.

    Raises
    ------
    InputError
        If the robot is a batch, or a number is not finite or out of its range.
    UnreachableError
        If the legs can't do it: which leg, at what height, by how much, and what would work.
    TarsusError
        If the robot has fallen over, or would.
    """
    swing_height, margin = _heights(robot, swing_height, margin)
    pace = JointRates.of(robot, joint_speed, joint_acceleration)
    if angles is None:
        angles = inverse_kinematics(robot, default_stance(robot, swing_height=swing_height)).require().angles
    found = initial_state(robot, angles, pace)
    feet = footholds(robot, foothold_distances(robot, found.body.inverse() @ found.feet), found.height)

    def sit(draft: SequenceBuilder, goal: BodyTarget) -> None:
        level_body(draft, goal, feet, least=margin)
        if not draft.belly:
            lower_body(draft, swing_height=swing_height, least=margin)

    return _first_that_works(found, found.height, sit, lie_first=True)


def fold(
    robot: Robot,
    angles: Array,
    *,
    joint_speed: Array | None = None,
    joint_acceleration: Array | None = None,
) -> MotionSequence:
    """Plan how a robot that lies on its belly draws its legs in to the folded pose.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles as measured; with them, the robot must rest on its belly [rad].
    joint_speed, joint_acceleration : array, optional
        What no joint exceeds [rad/s, rad/s^2]; see `JointRates.of`.

    Raises
    ------
    InputError
        If the robot is a batch, or a number is not finite or out of its range.
    UnreachableError
        If a leg finds no way there.
    TarsusError
        If the robot does not lie on its belly.
    """
    draft = lying(robot, angles, "fold its legs", joint_speed=joint_speed, joint_acceleration=joint_acceleration)
    _fold(draft)
    return draft.sequence()


def lying(
    robot: Robot,
    angles: Array,
    what: str,
    *,
    joint_speed: Array | None = None,
    joint_acceleration: Array | None = None,
) -> SequenceBuilder:
    """Return a draft of a robot that lies flat on its belly; refuse one that doesn't.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Its joint angles [rad].
    what : str
        What only a robot can do that lies so, for the message.
    joint_speed, joint_acceleration : array, optional
        See `JointRates.of`.

    Raises
    ------
    InputError
        If the robot is a batch, or a number is not finite or out of its range.
    TarsusError
        If it doesn't lie on its belly.
    """
    draft = initial_state(robot, angles, JointRates.of(robot, joint_speed, joint_acceleration))
    if not draft.belly:
        above = (draft.height - belly_depth(robot)) * 1000
        raise TarsusError(
            f"{robot.name} {resting_pose(robot, draft.angles).describe()}; its body's origin is {above:.1f} mm higher "
            f"than with its belly flat on the ground, and only so can it {what}; sit_down brings it there"
        )
    return draft


def _heights(robot: Robot, swing_height: float | None, margin: float) -> tuple[float, float]:
    if robot.batch_shape:
        raise InputError(f"a single robot gets up and sits down, not a batch {robot.batch_shape} of designs")
    swing_height = (
        default_swing_height(robot) if swing_height is None else require_number("swing_height", swing_height, zero=True)
    )
    return swing_height, require_number("margin", margin, zero=True)


def _first_that_works(
    found: SequenceBuilder,
    height: float,
    plan: Callable[[SequenceBuilder, BodyTarget], None],
    *,
    lie_first: bool = False,
) -> MotionSequence:
    """Try the level poses in turn; where none works, say why the likeliest doesn't."""
    rejected: list[TarsusError] = []
    for goal in sorted(body_targets(found, height), key=lambda goal: lie_first and not goal.lying):
        draft = found.copy()
        try:
            plan(draft, goal)
        except TarsusError as error:
            rejected.append(error)
        else:
            return draft.sequence()
    ways = f" (and {len(rejected) - 1} other ways fail too)" if len(rejected) > 1 else ""
    raise type(rejected[0])(f"{found.robot.name} as found: {rejected[0]}{ways}") from rejected[0]


def _fold(draft: SequenceBuilder) -> None:
    """Draw all legs in, the body lying on its belly."""
    folded = folded_pose(draft.robot)
    draft.fly("fold", (draft.angles != folded).any(-1), folded, landed=False)
