"""Where feet stand while other legs bear no load: turned about their coxa axes towards the places of these legs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.gait import Gait
from tarsus.gait.stance.support_stance import support_stance
from tarsus.incremental import Incremental
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.stance import default_stance
from tarsus.robot.remaining import remaining_robot
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Complex

__all__ = ["one_at_a_time", "supporting_turns"]

# Name of the gait in which one foot is in the air at a time; with fewer legs than these, it needs a body shift.
_WAVE, _FEWEST = "wave", 5


def one_at_a_time(legs: int, unloaded: tuple[int, ...]) -> Gait | None:
    """Return the gait in which one foot is in the air at a time; None where the other feet can't support the robot.

    Parameters
    ----------
    legs, unloaded : int, tuple of int
        Number of legs; those that bear no load.
    """
    return Gait.named(_WAVE, legs=legs) if legs - len(unloaded) >= _FEWEST else None


def supporting_turns(robot: Robot, unloaded: tuple[int, ...]) -> Incremental[Complex[np.ndarray, "legs"]]:
    """Find by how much feet turn about their coxa axes to support the robot, any one of them lifted, without some legs.

    Parameters
    ----------
    robot, unloaded : Robot, tuple of int
        A single robot; the legs that bear no load.

    Returns
    -------
    complex array, shape (legs,)
        Factors of the way from coxa axis to foothold; 1 for the legs that bear no load, and where fewer than five bear
        it.
    """
    turns, legs = np.ones(robot.legs, dtype=complex), [leg for leg in range(robot.legs) if leg not in unloaded]
    gait = one_at_a_time(len(legs), ())
    if unloaded and gait is not None:
        rest = remaining_robot(robot, legs)
        coxae = yield from support_stance(rest, gait)
        by_default = inverse_kinematics(rest, np.asarray(default_stance(rest))).angles
        turns[legs] = np.exp(1j * (coxae - np.asarray(by_default)[:, 0]))
    return turns
