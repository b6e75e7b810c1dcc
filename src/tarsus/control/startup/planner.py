"""Plans for standing up from any joint angles, sitting down and folding."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array
from tarsus.control.sequence.sequence import MotionSequence
from tarsus.control.startup.builder import BodyTarget, SequenceBuilder
from tarsus.control.startup.initial_state import lying_state, measured_state, resting_state, uneven_state
from tarsus.control.startup.level_body import body_targets, level_body
from tarsus.control.startup.raise_body import lower_body, raise_body
from tarsus.errors import InputError, TarsusError, UnreachableError
from tarsus.kinematics.folded_pose import folded_pose
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.polygon import as_mask
from tarsus.kinematics.stance import default_body_height, default_stance, foothold_distances, footholds_straight_out
from tarsus.kinematics.underside import belly_depth
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["fold", "sit_down", "stand_up"]

# Default of the least stability margin during changes of footholds [m].
_MARGIN = 0.010
# Least number of feet that bear load for a robot to count as standing on uneven ground.
_LEAST_FEET = 3


def stand_up(
    robot: Robot,
    angles: Float[Array, "legs 3"],
    *,
    body_height: float | None = None,
    swing_height: float | None = None,
    margin: float = _MARGIN,
    joint_speed: Float[Array, "..."] | None = None,
    joint_acceleration: Float[Array, "..."] | None = None,
) -> MotionSequence:
    """Plan how the robot stands up from any joint angles to its walking stance.

    `resting_pose` determines how the robot rests with these angles. A standing robot keeps its feet in place, levels
    its body, and moves its feet to their footholds in groups. Otherwise the robot lies down on its belly, folds its
    legs, places its feet on the ground beside the body and raises the body vertically. Where one set of footholds does
    not reach over the whole height, the legs change footholds in between, in groups. Loaded feet are never dragged.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Measured joint angles, possibly slightly beyond their limits [rad].
    body_height, swing_height : float, optional
        Body height of the final stance, and swing height of the feet [m]; by default those of the robot. The final
        stance is ``default_stance(robot, body_height, swing_height=swing_height)``.
    margin : float
        Least stability margin during changes of footholds; for feet loaded in the initial state, at most the initial
        stability margin [m].
    joint_speed, joint_acceleration : float or array, shape (3,) or (legs, 3), optional
        Greatest joint speed [rad/s] and acceleration [rad/s^2]; by default half the servo's no-load
        speed, reached within 0.05 s.

    Returns
    -------
    MotionSequence
        Ends with the body over the origin of G and yaw 0.

    Raises
    ------
    InputError
        If the robot is a batch, or a number is not finite or out of range.
    UnreachableError
        If the legs cannot perform the motion: which leg, at what height, by how much, and what would work.
    TarsusError
        If the robot has fallen over, or would fall over.
    """
    state = measured_state(robot, angles, joint_speed, joint_acceleration, swing_height=swing_height, margin=margin)
    height = default_body_height(robot) if body_height is None else float(body_height)
    lowest = belly_depth(state.robot)
    if height < lowest:
        raise UnreachableError(
            f"body_height is {height * 1000:.1f} mm; it must be at least {lowest * 1000:.1f} mm, the height with the "
            "belly on the ground"
        )
    folded, start = folded_pose(robot), resting_state(state)
    feet = default_stance(robot, height, swing_height=state.swing_height)
    stance = inverse_kinematics(robot, feet).require().angles

    def plan(target: BodyTarget) -> SequenceBuilder:
        level = level_body(start, target, feet)
        return raise_body(level.move_legs("fold", folded, landed=False) if level.belly else level, feet, stance)

    return _first_feasible(robot, body_targets(start, height), plan)


def sit_down(
    robot: Robot,
    angles: Float[Array, "legs 3"] | None = None,
    *,
    swing_height: float | None = None,
    margin: float = _MARGIN,
    joint_speed: Float[Array, "..."] | None = None,
    joint_acceleration: Float[Array, "3"] | Float[Array, "legs 3"] | None = None,
    loaded: Bool[np.ndarray, "legs"] | None = None,
) -> MotionSequence:
    """Plan how the robot lowers its body to the ground over stationary feet.

    Where one set of footholds does not reach over the whole height, the legs change footholds in between, in groups.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3), optional
        Measured joint angles [rad]; by default those of the robot's walking stance.
    swing_height : float, optional
        Swing height of feet that change their foothold [m]; by default that of the robot.
    margin : float
        Least stability margin during changes of footholds [m].
    joint_speed, joint_acceleration : float or array, shape (3,) or (legs, 3), optional
        Greatest joint speed [rad/s] and acceleration [rad/s^2]; by default half the servo's no-load
        speed, reached within 0.05 s.
    loaded : array of bool, shape (legs,), optional
        Feet that are known to bear load, on ground of any height; by default those on which it rests on flat ground.

    Returns
    -------
    MotionSequence
        Ends with the body over the origin of G and yaw 0.

    Raises
    ------
    InputError
        If the robot is a batch, or a number is not finite or out of range.
    UnreachableError
        If the legs cannot perform the motion: which leg, at what height, by how much, and what would work.
    TarsusError
        If the robot has fallen over, or would fall over.
    """
    if angles is None:
        angles = inverse_kinematics(robot, default_stance(robot, swing_height=swing_height)).require().angles
    state = measured_state(robot, angles, joint_speed, joint_acceleration, swing_height=swing_height, margin=margin)
    bears = np.zeros(robot.legs, dtype=bool) if loaded is None else as_mask(np, loaded, name="loaded")
    if bears.shape != (robot.legs,):
        raise InputError(f"loaded has shape {bears.shape}; expected ({robot.legs},), one value for each leg")
    if bears.sum() >= _LEAST_FEET:
        with suppress(TarsusError):
            return _lying(robot, uneven_state(state, bears))
    return _lying(robot, resting_state(state))


def fold(
    robot: Robot,
    angles: Float[Array, "legs 3"],
    *,
    joint_speed: Float[Array, "..."] | None = None,
    joint_acceleration: Float[Array, "3"] | Float[Array, "legs 3"] | None = None,
) -> MotionSequence:
    """Plan how a robot that lies on its belly moves its legs to the folded pose.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Measured joint angles with which the robot rests on its belly [rad].
    joint_speed, joint_acceleration : float or array, shape (3,) or (legs, 3), optional
        Greatest joint speed [rad/s] and acceleration [rad/s^2]; by default half the servo's no-load
        speed, reached within 0.05 s.

    Raises
    ------
    InputError
        If the robot is a batch, or a number is not finite or out of range.
    UnreachableError
        If a leg has no path to the folded pose.
    TarsusError
        If the robot does not lie on its belly.
    """
    lying = lying_state(measured_state(robot, angles, joint_speed, joint_acceleration), purpose="folding its legs")
    return lying.move_legs("fold", folded_pose(robot), landed=False).sequence(robot)


def _first_feasible(
    robot: Robot, targets: Iterable[BodyTarget], plan: Callable[[BodyTarget], SequenceBuilder]
) -> MotionSequence:
    """Return the first feasible plan; if there is none, raise the error of the most promising one."""
    errors: list[TarsusError] = []
    for target in targets:
        try:
            return plan(target).sequence(robot)
        except TarsusError as error:
            errors.append(error)
    others = f" ({len(errors) - 1} alternatives fail too)" if len(errors) > 1 else ""
    raise type(errors[0])(f"{robot.name}: {errors[0]}{others}") from errors[0]


def _lying(robot: Robot, start: SequenceBuilder) -> MotionSequence:
    """Return the sequence by which a robot lies down on its belly."""
    distances = foothold_distances(robot, start.body.inverse() @ start.feet)
    feet = footholds_straight_out(robot, distances, -start.height)

    def plan(target: BodyTarget) -> SequenceBuilder:
        level = level_body(start, target, feet)
        return level if level.belly else lower_body(level)

    lying_first = sorted(body_targets(start, start.height), key=lambda target: not target.belly)
    return _first_feasible(robot, lying_first, plan)
