"""How low feet may be put down where the ground is lower than it was expected."""

from __future__ import annotations

import cmath
from typing import Any

import numpy as np

from tarsus.gait.live.moment import Moment, turned
from tarsus.gait.live.posture import LIFT, stand_of
from tarsus.gait.live.stand import Terrain, joint_slack
from tarsus.robot.robot import Robot

__all__ = ["DEPTH", "lowest_in_reach", "lowest_planned"]

Floats = np.ndarray[Any, Any]

DEPTH = 0.6
"""How far below the ground feet look for it, in lifts."""

# How many heights are tried.
_HEIGHTS = 13


def lowest_planned(now: Moment, terrain: Terrain) -> Floats:
    """Return how low each foot may be put down ``(legs,)`` [m]: so far below the ground as it was taken to lie.

    Parameters
    ----------
    now : Moment
        The moment.
    terrain : Terrain
        How the ground was thought to lie.
    """
    deep = DEPTH * float(now.posture.value[LIFT])
    seen = (now.target - now.origin) * cmath.exp(-1j * now.yaw)
    return np.asarray(now.elevation.value + (terrain.slope.conjugate() * seen).real - deep)


def lowest_in_reach(robot: Robot, now: Moment, leg: int, stance_time: float) -> float:
    """Return how low a leg can put its foot down and stand there for a stance, if the robot walks on as it does [m].

    Parameters
    ----------
    robot : Robot
        A single robot.
    now : Moment
        The moment; the foot is where it is to be put down.
    leg : int
        The leg.
    stance_time : float
        How long it is to stand there [s].

    Returns
    -------
    float
        Not lower than `DEPTH` below the ground that was expected.
    """
    forward, left, turning = (now.twist.value * stance_time).tolist()
    here = (now.foot - now.origin) * cmath.exp(-1j * now.yaw)
    there = (here - complex(forward, left) * turned(turning)) * cmath.exp(-1j * turning)
    deep = DEPTH * float(now.posture.value[LIFT])
    heights = float(now.ground[leg]) - np.linspace(0.0, deep, _HEIGHTS)
    places = np.stack([here, there])[:, None]
    above = (heights - float(now.elevation.value[0]))[:, None]
    solution = stand_of(now.posture.value, now.foot).solve(robot, places.real, places.imag, above)
    fails = (joint_slack(robot.geometry, solution)[..., leg].min(axis=0) < 0).tolist()
    return float(heights[max(fails.index(True) - 1, 0) if True in fails else -1])
