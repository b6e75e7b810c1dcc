"""Live driving: a robot controller that a visitor commands, and the frames that show what it does."""

from __future__ import annotations

from typing import Protocol

from tarsus.control.command import Command
from tarsus.control.plant import IdealPlant, Plant
from tarsus.control.robot_controller import RobotController
from tarsus.control.robot_state import CHANGES, requested_state
from tarsus.errors import TarsusError
from tarsus.robot.robot import Robot
from tarsus.studio.drive_frames import DriveFrames, command_of
from tarsus.studio.messages import client as ask
from tarsus.studio.messages.motion import DriveFrame
from tarsus.studio.physics.live import LivePhysics, contacts_of

__all__ = ["Driven", "Driver"]


class Driven(Protocol):
    """A robot that a visitor drives: executed ideally, simulated in physics, or a machine in a run."""

    @property
    def id(self) -> int:
        """Id of the message that started driving; all frames carry it."""

    @property
    def is_planning(self) -> bool:
        """Whether the next step may take longer than a frame."""

    def command(self, message: ask.Command) -> None:
        """Set the command; it holds until the next one.

        Parameters
        ----------
        message : Command
            The command as received.
        """

    def step(self, dt: float) -> DriveFrame | None:
        """Return the next frame; None where there is nothing new.

        Parameters
        ----------
        dt : float
            Time since the last frame [s].
        """

    def close(self) -> None:
        """End driving."""


class Driver:
    """A robot controller with an ideal or a simulated plant, and the command in force.

    Parameters
    ----------
    robot : Robot
        A single robot; it stands at first.
    physics : LivePhysics, optional
        The robot in physics, on which the commands are executed.
    id : int
        Id of the message that started driving; all frames carry it.

    Raises
    ------
    TarsusError
        If the robot can't stand, or can't be simulated.
    """

    def __init__(self, robot: Robot, *, physics: LivePhysics | None = None, id: int) -> None:
        self.id = id
        self._robot = robot
        self._frames = DriveFrames(robot)
        self._controller = RobotController(robot)
        self._physics = physics
        self._plant: Plant = IdealPlant(robot) if physics is None else physics.plant
        self._plant.start(self._controller.output)
        self._command = self._accepted = Command()

    @property
    def is_planning(self) -> bool:
        """Whether the next step may plan a change of state, which takes longer than a frame."""
        state, requested = self._controller.output.state, self._command.state
        return requested is not None and (state, requested_state(requested)) in CHANGES

    def command(self, message: ask.Command) -> None:
        """Set the command; it holds until the next one.

        Parameters
        ----------
        message : Command
            The command as received.

        Raises
        ------
        TarsusError
            If there is no such gait.
        """
        self._command = command_of(message, legs=self._robot.legs)

    def step(self, dt: float) -> DriveFrame:
        """Advance by one tick.

        Parameters
        ----------
        dt : float
            Time since the last tick [s].

        Raises
        ------
        TarsusError
            If the controller refuses the command; the last accepted one is in force again.
        """
        controller = self._controller
        readings = self._plant.step(controller.output, dt)
        try:
            output = controller.step(self._command, dt, readings)
        except TarsusError:
            self._command = self._accepted
            raise
        self._accepted = self._command
        self._frames.note(output)
        if self._physics is None:
            return self._frames.frame(output, id=self.id)
        state, physics = self._physics.frame(output)
        stands = (state.joint_angles, state.body, contacts_of(state))
        return self._frames.frame(output, id=self.id, physics=physics, stands=stands)

    def close(self) -> None:
        """End driving; there is nothing to release."""
