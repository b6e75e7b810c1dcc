"""Live driving: the robot controller that a visitor commands, and its frames."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from tarsus.control.command import Command
from tarsus.control.control_output import ControlOutput
from tarsus.control.plant import IdealPlant, Plant
from tarsus.control.robot_controller import RobotController
from tarsus.control.states.robot_state import next_state, requested_state
from tarsus.errors import TarsusError
from tarsus.gait.gait import Gait
from tarsus.kinematics.convex_hull import origin_margin
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import MassWeights
from tarsus.robot.robot import Robot
from tarsus.simulation.plant_state import PlantState
from tarsus.studio.encoding import degrees, flags, millimetres, or_null, plain
from tarsus.studio.messages import client as ask
from tarsus.studio.messages.motion import DriveFrame
from tarsus.studio.physics.live import LivePhysics, contacts_of

__all__ = ["Driver"]

# How many of the guard's interventions a frame lists.
_LISTED = 5


class Driver:
    """A robot controller with an ideal or a simulated plant, and the command that holds.

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
        self._masses = MassWeights.of(robot)
        self._controller = RobotController(robot)
        self._physics = physics
        self._plant: Plant = IdealPlant(robot) if physics is None else physics.plant
        self._plant.start(self._controller.output)
        self._command = self._accepted = Command()
        self._interventions: deque[str] = deque(maxlen=_LISTED)
        self._intervention_count = 0

    @property
    def is_planning(self) -> bool:
        """Whether the next step may plan a change of state, which takes longer than a frame."""
        state, requested = self._controller.output.state, self._command.state
        return requested is not None and next_state(state, requested_state(requested)) is not None

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
        self._command = Command(
            twist=(*(speed / 1000 for speed in message.velocity_mm_s), math.radians(message.turn_deg_s)),
            body=None if message.body is None else _body(message.body),
            gait=None if message.gait is None else Gait.named(message.gait, legs=self._robot.legs),
            body_height=_metres(message.body_height_mm),
            swing_height=_metres(message.swing_height_mm),
            cycle_time=message.cycle_time_s,
            state=message.state,
        )

    def step(self, dt: float) -> DriveFrame:
        """Advance by one tick.

        Parameters
        ----------
        dt : float
            Time since the last tick [s].

        Raises
        ------
        TarsusError
            If the controller refuses the command; the last accepted one holds again.
        """
        controller = self._controller
        readings = self._plant.step(controller.output, dt)
        try:
            output = controller.step(self._command, dt, readings)
        except TarsusError:
            self._command = self._accepted
            raise
        self._accepted = self._command
        self._intervention_count += len(output.interventions)
        self._interventions.extendleft(intervention.text() for intervention in output.interventions)
        return self._frame(output)

    def _frame(self, output: ControlOutput) -> DriveFrame:
        state, physics = (None, None) if self._physics is None else self._physics.frame(output)
        margin, com = (None, None) if output.belly else self._stability(output, state)
        vx, vy, wz = output.twist
        rpy = degrees(output.body.rpy)
        return DriveFrame(
            type="frame",
            id=self.id,
            time_s=round(output.time, 4),
            state=output.state.value,
            activity=output.activity,
            guard=output.guard,
            gait=output.gait.name,
            position_mm=millimetres(output.body.position),
            rpy_deg=rpy,
            heading_deg=rpy[2],
            angles_deg=degrees(output.angles),
            contacts=flags(output.contacts),
            belly=output.belly,
            margin_mm=margin,
            com_mm=com,
            twist=plain([vx * 1000, vy * 1000, math.degrees(wz)]),
            limitations=[limitation.text() for limitation in output.limitations],
            intervention_count=self._intervention_count,
            interventions=list(self._interventions),
            physics=physics,
        )

    def _stability(self, output: ControlOutput, state: PlantState | None) -> tuple[float | None, list[float]]:
        """Return the static stability margin [mm] and the centre of mass projected onto the ground [mm]."""
        angles, body, contacts = (
            (output.angles, output.body, output.contacts)
            if state is None
            else (state.joint_angles, state.body, contacts_of(state))
        )
        points = forward_kinematics(self._robot, angles)
        com = self._masses.centre_of_mass(points)
        placed = np.asarray(body @ np.concatenate([points[contacts, 3], com[None]]))
        margin = origin_margin((placed[:-1, :2] - placed[-1, :2]).tolist())[0]
        return or_null(margin * 1000, decimals=2), millimetres(placed[-1, :2])


def _metres(mm: float | None) -> float | None:
    return None if mm is None else mm / 1000


def _body(values: tuple[float, ...]) -> tuple[float, ...]:
    return (*(value / 1000 for value in values[:3]), *(math.radians(value) for value in values[3:]))
