"""Frames of a robot that is driven, and the command of a visitor in SI units."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.command import Command
from tarsus.control.control_output import ControlOutput
from tarsus.gait.gait import Gait
from tarsus.kinematics.convex_hull import origin_margin
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import MassWeights
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot
from tarsus.studio.encoding import degrees, flags, millimetres, or_null, plain
from tarsus.studio.messages import client as ask
from tarsus.studio.messages.machine import FrameMachine
from tarsus.studio.messages.motion import DriveFrame
from tarsus.studio.messages.physics import FramePhysics

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["DriveFrames", "command_of"]

# Number of the latest interventions of the guard that a frame lists.
_LISTED = 5


class DriveFrames:
    """Makes the frames of a robot that is driven.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._masses = MassWeights.of(robot)
        # Replaced as a whole, never changed: a run calls `note` in one thread, its studio calls `frame` in another.
        self._interventions: tuple[str, ...] = ()
        self._count = 0

    def note(self, output: ControlOutput) -> None:
        """Count the guard's interventions in a tick, and keep the latest.

        Parameters
        ----------
        output : ControlOutput
            The output of the controller.
        """
        self._count += len(output.interventions)
        latest = tuple(intervention.text() for intervention in reversed(output.interventions))
        self._interventions = (*latest, *self._interventions)[:_LISTED]

    def frame(
        self,
        output: ControlOutput,
        *,
        id: int,
        physics: FramePhysics | None = None,
        machine: FrameMachine | None = None,
        stands: tuple[Float[np.ndarray, "legs 3"], Pose, Bool[np.ndarray, "legs"]] | None = None,
    ) -> DriveFrame:
        """Return a frame.

        Parameters
        ----------
        output : ControlOutput
            The last output of the controller.
        id : int
            Id of the message that started driving.
        physics : FramePhysics, optional
            The robot in physics.
        machine : FrameMachine, optional
            What the servos measure.
        stands : (array, Pose, array), optional
            Actual joint angles, body pose and contacts, for the stability; those commanded where left out.
        """
        margin, com = (None, None) if output.belly else self._stability(output, stands)
        vx, vy, wz = output.twist
        rpy = degrees(output.body.rpy)
        return DriveFrame(
            type="frame",
            id=id,
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
            intervention_count=self._count,
            interventions=list(self._interventions),
            physics=physics,
            machine=machine,
        )

    def _stability(
        self,
        output: ControlOutput,
        stands: tuple[Float[np.ndarray, "legs 3"], Pose, Bool[np.ndarray, "legs"]] | None,
    ) -> tuple[float | None, list[float]]:
        """Return the static stability margin [mm] and the centre of mass projected onto the ground [mm]."""
        angles, body, contacts = (output.angles, output.body, output.contacts) if stands is None else stands
        points = forward_kinematics(self._robot, angles)
        com = self._masses.centre_of_mass(points)
        placed = np.asarray(body @ np.concatenate([points[contacts, 3], com[None]]))
        margin = origin_margin((placed[:-1, :2] - placed[-1, :2]).tolist())[0]
        return or_null(margin * 1000, decimals=2), millimetres(placed[-1, :2])


def command_of(message: ask.Command, *, legs: int) -> Command:
    """Return a visitor's command in SI units.

    Parameters
    ----------
    message : Command
        The command as received.
    legs : int
        Number of legs of the robot.

    Raises
    ------
    TarsusError
        If there is no such gait, or a value is out of its range.
    """
    return Command(
        twist=(*(speed / 1000 for speed in message.velocity_mm_s), math.radians(message.turn_deg_s)),
        body=None if message.body is None else _body(message.body),
        gait=None if message.gait is None else Gait.named(message.gait, legs=legs),
        body_height=_metres(message.body_height_mm),
        swing_height=_metres(message.swing_height_mm),
        cycle_time=message.cycle_time_s,
        state=message.state,
    )


def _metres(mm: float | None) -> float | None:
    return None if mm is None else mm / 1000


def _body(values: tuple[float, ...]) -> tuple[float, ...]:
    return (*(value / 1000 for value in values[:3]), *(math.radians(value) for value in values[3:]))
