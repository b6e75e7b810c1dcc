"""The joint angles of a moment of the walk, in plain numbers: what every tick needs."""

from __future__ import annotations

import cmath
from typing import Any

import numpy as np

from tarsus.gait.live.lag import Lag
from tarsus.gait.live.moment import Moment
from tarsus.gait.live.posture import LIFT, Rows, rotation_rows, swayed
from tarsus.gait.live.quick import QuickLegs
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.robot.robot import Robot

__all__ = ["Solver"]

Floats = np.ndarray[Any, Any]


class Solver:
    """Solves the legs of one robot for moments of its walk.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._quick = QuickLegs(robot)
        # Of a posture that stays, the body's rotation and place and the lift stay too.
        self._posture: Lag | None = None
        self._body: tuple[Rows, list[float], float] = (((),), [], 0.0)

    def angles(self, now: Moment) -> Floats:
        """Return the joint angles ``(legs, 3)`` of a moment [rad].

        Parameters
        ----------
        now : Moment
            The moment.
        """
        rotation, position, lift = self._body_at(now)
        turn, origin = cmath.exp(-1j * now.yaw), now.origin
        elevation = float(now.elevation.value[0])
        feet = []
        for foot, height, given in zip(now.foot.tolist(), now.heights(lift), now.give_way.value.tolist(), strict=True):
            seen = (foot - origin) * turn
            feet.append((seen.real, seen.imag, height + given - elevation))
        found = self._quick.angles(feet, rotation, position)
        if found is None:
            in_body = (np.array(feet) - position) @ np.array(rotation)
            angles = np.array(inverse_kinematics(self._robot, in_body).angles)
        else:
            angles = np.array(found)
        angles.setflags(write=False)
        return angles

    def _body_at(self, now: Moment) -> tuple[Rows, list[float], float]:
        if now.posture is not self._posture:
            row = now.posture.value
            x, y, z, roll, pitch, yaw, lift = swayed(row, now.cycles, now.beats).tolist()
            self._body = rotation_rows(roll, pitch, yaw), [x, y, z], lift
            self._posture = None if row[LIFT + 1 :].any() else now.posture
        return self._body
