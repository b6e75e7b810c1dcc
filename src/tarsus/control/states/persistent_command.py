"""The command that holds: what earlier commands asked for, until a later one asks for something else."""

from __future__ import annotations

import dataclasses

from tarsus.control.command import Command
from tarsus.control.states.robot_state import requested_state
from tarsus.gait.gait import Gait
from tarsus.robot.robot import Robot, require_leg_number

__all__ = ["PersistentCommand", "stopped"]


class PersistentCommand:
    """Merges commands: what is None in a command stays as it was, but for foot velocities.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Attributes
    ----------
    full : Command
        What is commanded now.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self.full = Command()
        # The last command that was merged, and the result: commands mostly stay the same object for many ticks.
        self._last: tuple[Command, Command] | None = None

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
        changes, legs = command.parameters, self._robot.legs
        if isinstance(changes.get("gait"), str):
            changes["gait"] = Gait.named(changes["gait"], legs=legs)
        if "gait" in changes:
            changes["gait"].require_legs(legs)
        if command.state is not None:
            changes["state"] = requested_state(command.state)
        targets = {**(self.full.foot_targets or {}), **(command.foot_targets or {})}
        velocities = command.foot_velocities
        targets = {leg: point for leg, point in targets.items() if leg not in (velocities or {})}
        for leg in (*targets, *(velocities or {})):
            require_leg_number("foot_targets", leg, legs)
        return dataclasses.replace(
            self.full, twist=command.twist, foot_targets=targets or None, foot_velocities=velocities, **changes
        )

    def keep(self, command: Command, full: Command) -> None:
        """Hold to a command from now on, and to what `merged` has made of it."""
        self.full, self._last = full, (command, full)

    def forget_released(self) -> None:
        """Forget the feet that are to be put back into the gait: after standing up, every foot is in it."""
        targets = {leg: point for leg, point in (self.full.foot_targets or {}).items() if point is not None}
        self.full, self._last = dataclasses.replace(self.full, foot_targets=targets or None), None


def stopped(command: Command, legs: int) -> Command:
    """Return the command to stand with every foot in the gait: what a robot does before it sits down."""
    targets = dict.fromkeys(range(legs)) if command.foot_targets or command.foot_velocities else None
    return dataclasses.replace(command, twist=(0.0, 0.0, 0.0), foot_targets=targets, foot_velocities=None)
