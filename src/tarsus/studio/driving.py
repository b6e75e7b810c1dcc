"""Live walking: the walker that a visitor drives, with the guard behind it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.errors import TarsusError
from tarsus.gait.gait import Gait
from tarsus.gait.live.guard import Guard, GuardBounds
from tarsus.gait.live.walker import Walker
from tarsus.gait.live.wish import Wish
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot
from tarsus.studio.messages import client as ask
from tarsus.studio.messages.moving import DriveFrame
from tarsus.studio.statics import margin_of
from tarsus.studio.wire import degrees, flags, millimetres, or_null, plain

__all__ = ["Driver"]


class Driver:
    """A live walker, and what it is wished to do.

    Parameters
    ----------
    robot : Robot
        A single robot.
    id : int
        Of the message that began it: its frames bear it.

    Raises
    ------
    TarsusError
        If the robot can't walk.
    """

    def __init__(self, robot: Robot, *, id: int) -> None:
        self.id = id
        self._robot = robot
        self._walker = Walker(robot)
        walker = self._walker
        bounds = GuardBounds.of(robot, speed=walker.joint_speed, acceleration=walker.joint_acceleration)
        self._guard = Guard(robot, bounds=bounds, start=walker.angles)
        self._wish = self._granted = Wish()

    def wish(self, message: ask.Wish) -> None:
        """Take a wish; it holds until the next.

        Parameters
        ----------
        message : Wish
            What the walker shall do.

        Raises
        ------
        TarsusError
            If there is no such gait.
        """
        self._wish = Wish(
            twist=(*(speed / 1000 for speed in message.velocity_mm_s), math.radians(message.turn_deg_s)),
            body=None if message.body is None else _body(message.body),
            gait=None if message.gait is None else Gait.named(message.gait, legs=self._robot.legs),
            clearance=_metres(message.clearance_mm),
            lift=_metres(message.lift_mm),
            cycle_time=message.cycle_time_s,
        )

    def step(self, dt: float) -> DriveFrame:
        """Go on by a time step.

        Parameters
        ----------
        dt : float
            The time step [s].

        Raises
        ------
        TarsusError
            If the walker refuses the wish; it goes on with the one before.
        """
        walker = self._walker
        try:
            angles = walker.step(self._wish, dt)
        except TarsusError:
            self._wish = self._granted
            raise
        self._granted = self._wish
        body = walker.body
        guarded = self._guard.check(angles, dt, walker.contacts, body)
        return self._frame(np.asarray(guarded.angles), body)

    def _frame(self, angles: np.ndarray[Any, Any], body: Pose) -> DriveFrame:
        walker = self._walker
        points = forward_kinematics(self._robot, angles)
        com = np.asarray(body @ np.asarray(centre_of_mass(self._robot, angles, points=points)))
        margin = margin_of(np.asarray(body @ points[:, 3]), walker.contacts, com)
        vx, vy, wz = walker.twist
        return DriveFrame(
            type="frame",
            id=self.id,
            time_s=round(walker.time, 4),
            mode=walker.mode,
            gait=walker.gait.name,
            position_mm=millimetres(body.position),
            rpy_deg=degrees(body.rpy),
            angles_deg=degrees(angles),
            contacts=flags(walker.contacts),
            margin_mm=or_null(margin * 1000, decimals=2),
            com_mm=millimetres(com[:2]),
            twist=plain([vx * 1000, vy * 1000, math.degrees(wz)]),
            limited=list(walker.limited),
            interventions=sum(self._guard.counts.values()),
        )


def _metres(mm: float | None) -> float | None:
    return None if mm is None else mm / 1000


def _body(values: tuple[float, ...]) -> tuple[float, ...]:
    return (*(value / 1000 for value in values[:3]), *(math.radians(value) for value in values[3:]))
