"""The command that holds: what earlier commands asked for, until a later one asks for something else."""

from __future__ import annotations

import dataclasses
from typing import Any

from tarsus.control.command import Command
from tarsus.control.states.robot_state import requested_state
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.robot.robot import Robot

__all__ = ["PersistentCommand", "stopped"]

_HELD = ("body", "gait", "body_height", "swing_height", "stance_width", "cycle_time", "sway", "state")
"""What holds until it is changed; twist and foot velocities hold for the ticks in which they are given."""


class PersistentCommand:
    """Merges commands: what is None in a command stays as it was.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._full = Command()
        # The last command that was merged, and the result: commands mostly stay the same object for many ticks.
        self._last: tuple[Command, Command] | None = None

    @property
    def full(self) -> Command:
        """What is commanded now."""
        return self._full

    def merged(self, command: Command) -> Command:
        """Return a command with everything that holds; nothing is changed.

        Parameters
        ----------
        command : Command
            The command.

        Raises
        ------
        InputError
            If the gait or a leg does not fit the robot, or the state can't be asked for.
        UnknownNameError
            If there is no such gait.
        """
        if self._last is not None and self._last[0] is command:
            return self._last[1]
        changes: dict[str, Any] = {name: getattr(command, name) for name in _HELD}
        changes = {name: value for name, value in changes.items() if value is not None}
        if isinstance(changes.get("gait"), str):
            changes["gait"] = Gait.named(changes["gait"], legs=self._robot.legs)
        if isinstance(changes.get("gait"), Gait):
            changes["gait"].require_legs(self._robot.legs)
        if "state" in changes:
            changes["state"] = requested_state(changes["state"])
        targets = {**(self._full.foot_targets or {}), **(command.foot_targets or {})}
        velocities = command.foot_velocities
        for leg in (*targets, *(velocities or {})):
            if leg not in range(self._robot.legs):
                raise InputError(
                    f"foot_targets: the robot has no leg {leg!r}; its legs are 0 to {self._robot.legs - 1}"
                )
        return dataclasses.replace(
            self._full, twist=command.twist, foot_targets=targets or None, foot_velocities=velocities, **changes
        )

    def keep(self, command: Command, full: Command) -> None:
        """Hold to a merged command from now on.

        Parameters
        ----------
        command : Command
            What was merged.
        full : Command
            The result of `merged`.
        """
        self._full, self._last = full, (command, full)

    def forget_released(self) -> None:
        """Forget the feet that are to be put back into the gait: after standing up, every foot is in it."""
        targets = {leg: point for leg, point in (self._full.foot_targets or {}).items() if point is not None}
        self._full, self._last = dataclasses.replace(self._full, foot_targets=targets or None), None


def stopped(command: Command, legs: int) -> Command:
    """Return the command to stand with every foot in the gait: what a robot does before it sits down."""
    targets = dict.fromkeys(range(legs)) if command.foot_targets or command.foot_velocities else None
    return dataclasses.replace(command, twist=(0.0, 0.0, 0.0), foot_targets=targets, foot_velocities=None)
