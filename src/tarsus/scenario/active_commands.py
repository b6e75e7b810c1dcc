"""What the robot has been told and holds to, until it is told something else."""

from __future__ import annotations

from collections import deque
from typing import Any

from tarsus.control.command import BODY_AXES, Command
from tarsus.robot.robot import Robot
from tarsus.scenario.commands import (
    BodyHeight,
    CycleTime,
    Fold,
    FootTarget,
    FootVelocity,
    Force,
    GaitChange,
    Ground,
    MoveBody,
    PowerOff,
    Sit,
    StanceWidth,
    StandUp,
    Stop,
    Sway,
    SwingHeight,
    Tilt,
    Walk,
)
from tarsus.scenario.environment import Environment
from tarsus.scenario.timed_command import TimedCommand

__all__ = ["ActiveCommands", "leg_number"]

_STILL = (0.0, 0.0, 0.0)


def leg_number(robot: Robot, name: str) -> int | None:
    """Return the number of the leg of that name or short name; None where there is none.

    Parameters
    ----------
    robot : Robot
        A single robot.
    name : str
        In capitals or not.
    """
    for names in (robot.leg_codes, robot.leg_names):
        lower = [each.lower() for each in names]
        if name.lower() in lower:
            return lower.index(name.lower())
    return None


class ActiveCommands:
    """The orders that hold: each until another one of its kind; and the acts that are to come.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._asked: dict[str, Any] = {}
        # Legs that are moved by hand, each to a point or at a speed; None for one that comes back.
        self._foot_targets: dict[int, FootTarget | FootVelocity | None] = {}
        self.twist = _STILL
        self.acts: deque[TimedCommand] = deque()
        self.feeling = Environment(robot)

    def take(self, command: TimedCommand) -> None:
        """Take a command."""
        if isinstance(command, StandUp | Sit | Fold | PowerOff):
            self.acts.append(command)
        elif isinstance(command, Walk | Stop):
            self.twist = (command.vx, command.vy, command.turn) if isinstance(command, Walk) else _STILL
        elif isinstance(command, MoveBody | Sway):
            axes = tuple(float(getattr(command, axis)) for axis in BODY_AXES)
            self._asked["body" if isinstance(command, MoveBody) else "sway"] = axes
        elif isinstance(command, GaitChange | BodyHeight | SwingHeight | StanceWidth | CycleTime):
            self._asked[command.word] = getattr(command, command.word)
        else:
            self._take_for_leg(command)

    def _take_for_leg(self, command: TimedCommand) -> None:
        leg = leg_number(self._robot, getattr(command, "leg", ""))
        if isinstance(command, Ground | Tilt | Force):
            self.feeling.take(command, leg)
        elif leg is not None:
            self._foot_targets[leg] = command if isinstance(command, FootTarget | FootVelocity) else None

    def command(self) -> Command:
        """Return what the walker is asked for: to stand with all its feet down where an act is to come."""
        if self.acts:
            return Command(twist=_STILL, foot_targets=dict.fromkeys(self._foot_targets) or None, **self._asked)
        told = self._foot_targets.items()
        speeds = {
            leg: (foot_target.vx, foot_target.vy, foot_target.vz)
            for leg, foot_target in told
            if isinstance(foot_target, FootVelocity)
        }
        points = {
            leg: (foot_target.x, foot_target.y, foot_target.z) if foot_target else None
            for leg, foot_target in told
            if not isinstance(foot_target, FootVelocity)
        }
        return Command(twist=self.twist, foot_targets=points or None, foot_velocities=speeds or None, **self._asked)

    def forget_hands_back(self) -> None:
        """Forget the legs that are back in the gait: a robot that has got up has them all there."""
        self._foot_targets = {
            leg: foot_target for leg, foot_target in self._foot_targets.items() if foot_target is not None
        }
