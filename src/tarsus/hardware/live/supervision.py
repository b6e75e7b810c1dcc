"""What stands between a source of commands and a real robot: rising first, walking slower with warm servos."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Protocol

from tarsus.control.command import Command
from tarsus.control.control_output import ControlOutput
from tarsus.control.loop.run import CommandSource
from tarsus.control.robot_state import RobotState

__all__ = ["Rising", "Supervised"]

# Changes of the factor smaller than this are not worth a note.
_NOTED = 0.1


class _Derated(Protocol):
    """Something that allows a share of the speed: a `ServoPlant`."""

    @property
    def speed_factor(self) -> float: ...


class Supervised:
    """A source of commands whose speeds are reduced as the servos get warm.

    Parameters
    ----------
    source : CommandSource
        What gives the commands.
    plant : ServoPlant
        Knows the temperatures.
    """

    def __init__(self, source: CommandSource, plant: _Derated) -> None:
        self._source, self._plant = source, plant
        self._noted = 1.0

    def command(self, time: float, output: ControlOutput, note: Callable[[str, str], None]) -> Command:
        """Return the command for the next tick."""
        command, factor = self._source.command(time, output, note), self._plant.speed_factor
        if abs(factor - self._noted) >= _NOTED:
            self._noted = factor
            note("limit", f"servos are warm: {factor * 100:.0f} % of the commanded speed")
        if factor >= 1.0 or not any(command.twist):
            return command
        return dataclasses.replace(command, twist=tuple(part * factor for part in command.twist))

    def over(self, time: float, output: ControlOutput) -> bool:
        """Return whether the run is over."""
        return self._source.over(time, output)


class Rising:
    """A source of commands that begins once the robot has stood up.

    Parameters
    ----------
    source : CommandSource
        What gives the commands; its time begins when the robot stands.
    """

    def __init__(self, source: CommandSource) -> None:
        self._source = source
        self._stood: float | None = None

    def command(self, time: float, output: ControlOutput, note: Callable[[str, str], None]) -> Command:
        """Return the command for the next tick."""
        if self._stood is None:
            if output.state is not RobotState.STANDING or not output.at_rest:
                return Command(state=RobotState.STANDING)
            self._stood = time
        return self._source.command(time - self._stood, output, note)

    def over(self, time: float, output: ControlOutput) -> bool:
        """Return whether the run is over."""
        return self._stood is not None and self._source.over(time - self._stood, output)
