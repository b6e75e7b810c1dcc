"""What the robot has been told and holds to, until it is told something else."""

from __future__ import annotations

from collections import deque
from typing import Any

from tarsus.drive.command import Command
from tarsus.drive.commands import (
    Clearance,
    CycleTime,
    Fold,
    Force,
    GaitChange,
    Ground,
    HandSpeed,
    Lift,
    MoveBody,
    MoveHand,
    PowerOff,
    Sit,
    StanceWidth,
    StandUp,
    Stop,
    Sway,
    Tilt,
    Walk,
)
from tarsus.drive.feeling import Feeling
from tarsus.gait.live.wish import BODY_AXES, Wish
from tarsus.robot.robot import Robot

__all__ = ["Orders", "leg_number"]

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


class Orders:
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
        self._hands: dict[int, MoveHand | HandSpeed | None] = {}
        self.twist = _STILL
        self.acts: deque[Command] = deque()
        self.feeling = Feeling(robot)

    def take(self, command: Command) -> None:
        """Take a command."""
        if isinstance(command, StandUp | Sit | Fold | PowerOff):
            self.acts.append(command)
        elif isinstance(command, Walk | Stop):
            self.twist = (command.vx, command.vy, command.turn) if isinstance(command, Walk) else _STILL
        elif isinstance(command, MoveBody | Sway):
            axes = tuple(float(getattr(command, axis)) for axis in BODY_AXES)
            self._asked["body" if isinstance(command, MoveBody) else "sway"] = axes
        elif isinstance(command, GaitChange | Clearance | Lift | StanceWidth | CycleTime):
            self._asked[command.word] = getattr(command, command.word)
        else:
            self._take_for_leg(command)

    def _take_for_leg(self, command: Command) -> None:
        leg = leg_number(self._robot, getattr(command, "leg", ""))
        if isinstance(command, Ground | Tilt | Force):
            self.feeling.take(command, leg)
        elif leg is not None:
            self._hands[leg] = command if isinstance(command, MoveHand | HandSpeed) else None

    def wish(self) -> Wish:
        """Return what the walker is asked for: to stand with all its feet down where an act is to come."""
        if self.acts:
            return Wish(twist=_STILL, hands=dict.fromkeys(self._hands) or None, **self._asked)
        told = self._hands.items()
        speeds = {leg: (hand.vx, hand.vy, hand.vz) for leg, hand in told if isinstance(hand, HandSpeed)}
        points = {
            leg: (hand.x, hand.y, hand.z) if hand else None for leg, hand in told if not isinstance(hand, HandSpeed)
        }
        return Wish(twist=self.twist, hands=points or None, hand_speeds=speeds or None, **self._asked)

    def forget_hands_back(self) -> None:
        """Forget the legs that are back in the gait: a robot that has got up has them all there."""
        self._hands = {leg: hand for leg, hand in self._hands.items() if hand is not None}
