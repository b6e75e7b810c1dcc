"""Live walking: the walker that a visitor drives, with the guard behind it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.command import Command
from tarsus.control.safety import Guard, GuardBounds
from tarsus.control.walk_controller import WalkController
from tarsus.errors import TarsusError
from tarsus.gait.gait import Gait
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
        self._controller = WalkController(robot)
        controller = self._controller
        bounds = GuardBounds.of(robot, speed=controller.joint_speed, acceleration=controller.joint_acceleration)
        self._guard = Guard(robot, bounds=bounds, start=controller.angles)
        self._command = self._granted = Command()

    def command(self, message: ask.Command) -> None:
        """Take a command; it holds until the next.

        Parameters
        ----------
        message : Command
            What the walker shall do.

        Raises
        ------
        TarsusError
            If there is no such gait.
        """
        self._command = Command(
            twist=(*(speed / 1000 for speed in message.velocity_mm_s), math.radians(message.turn_deg_s)),
            body=None if message.body is None else _body(message.body),
            gait=None if message.gait is None else Gait.named(message.gait, legs=self._robot.legs),
            body_height=_metres(message.body_height_mm),
            swing_height=_metres(message.swing_height_mm),
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
            If the walker refuses the command; it goes on with the one before.
        """
        controller = self._controller
        try:
            angles = controller.step(self._command, dt)
        except TarsusError:
            self._command = self._granted
            raise
        self._granted = self._command
        body = controller.body
        guarded = self._guard.check(angles, dt, controller.contacts, body)
        return self._frame(np.asarray(guarded.angles), body)

    def _frame(self, angles: np.ndarray[Any, Any], body: Pose) -> DriveFrame:
        controller = self._controller
        points = forward_kinematics(self._robot, angles)
        com = np.asarray(body @ np.asarray(centre_of_mass(self._robot, angles, points=points)))
        margin = margin_of(np.asarray(body @ points[:, 3]), controller.contacts, com)
        vx, vy, wz = controller.twist
        return DriveFrame(
            type="frame",
            id=self.id,
            time_s=round(controller.time, 4),
            mode=controller.walk_state.value,
            gait=controller.gait.name,
            position_mm=millimetres(body.position),
            rpy_deg=degrees(body.rpy),
            angles_deg=degrees(angles),
            contacts=flags(controller.contacts),
            margin_mm=or_null(margin * 1000, decimals=2),
            com_mm=millimetres(com[:2]),
            twist=plain([vx * 1000, vy * 1000, math.degrees(wz)]),
            limited=[limitation.text() for limitation in controller.limitations],
            interventions=sum(self._guard.counts.values()),
        )


def _metres(mm: float | None) -> float | None:
    return None if mm is None else mm / 1000


def _body(values: tuple[float, ...]) -> tuple[float, ...]:
    return (*(value / 1000 for value in values[:3]), *(math.radians(value) for value in values[3:]))
