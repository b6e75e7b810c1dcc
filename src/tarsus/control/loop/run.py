"""The control loop that runs a source of commands, a controller and a plant."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Protocol, TypeAlias, runtime_checkable

import numpy as np

from tarsus.control.command import Command
from tarsus.control.control_output import ControlOutput
from tarsus.control.loop.recorder import Recorder
from tarsus.control.loop.recording import Recording
from tarsus.control.plant import Plant
from tarsus.control.robot_controller import RobotController
from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.robot.same_robot import require_same_robot

__all__ = ["CommandSource", "TimedCommands", "run"]

Asked: TypeAlias = Command | tuple[float, float, float]
"""A command, or a twist alone."""

# Times that differ by no more than this are the same [s].
_SAME_TIME = 1e-9
# How long a run without a duration continues after its last command: at least, and at most, if not at rest before [s].
AFTER, LONGEST = 2.0, 120.0


@runtime_checkable
class CommandSource(Protocol):
    """A source of the commands of a run: a scenario, a gamepad, a list."""

    def command(self, time: float, output: ControlOutput, note: Callable[[str, str], None]) -> Command:
        """Return the command that holds for the next tick.

        Parameters
        ----------
        time, output : float, ControlOutput
            Time at the end of the last tick [s]; the controller's last output.
        note : callable
            Takes the kind and the text of an event to be recorded.
        """

    def over(self, time: float, output: ControlOutput) -> bool:
        """Return whether the run is over."""


class TimedCommands:
    """Commands that each hold from their time until that of the next.

    Parameters
    ----------
    commands : iterable of (float, Command or (vx, vy, wz))
        Times [s] and commands.
    duration : float, optional
        How long the run takes [s]; left out, it ends 2 s after the last command or, if that has no twist, once the
        robot is at rest after that; 120 s after the last command at the latest.
    """

    def __init__(self, commands: Iterable[tuple[float, Asked]], *, duration: float | None = None) -> None:
        timed = [(require_number("time", time, zero=True), each) for time, each in commands]
        self._left = [
            (time, each if isinstance(each, Command) else Command(twist=each))
            for time, each in sorted(timed, key=lambda pair: pair[0])
        ]
        self._last = self._left[-1][0] if self._left else 0.0
        self._duration = None if duration is None else require_number("duration", duration, zero=False)
        self._now = Command()

    def command(self, time: float, output: ControlOutput, note: Callable[[str, str], None]) -> Command:  # noqa: ARG002
        """Return the command for the next tick."""
        while self._left and self._left[0][0] <= time + _SAME_TIME:
            _, self._now = self._left.pop(0)
        return self._now

    def over(self, time: float, output: ControlOutput) -> bool:
        """Return whether the run is over."""
        if self._duration is not None:
            return time >= self._duration - _SAME_TIME
        late = time >= self._last + AFTER - _SAME_TIME
        return late and not self._left and (output.at_rest or any(self._now.twist) or time >= self._last + LONGEST)


def run(
    controller: RobotController,
    plant: Plant,
    commands: CommandSource | Iterable[tuple[float, Asked]],
    *,
    duration: float | None = None,
    rate: float = 100.0,
    jitter: float = 0.0,
    seed: int = 0,
    name: str = "",
) -> Recording:
    """Run a controller and a plant through commands, and record every tick.

    In each tick the plant executes the angles of the last tick and measures, and the controller takes these readings
    and gives the next angles. Whatever ends the run, the plant is stopped.

    Parameters
    ----------
    controller, plant : RobotController, Plant
        The controller; the plant that executes its joint angles: an ideal, simulated or real robot of the same kind.
    commands : CommandSource or iterable of (float, Command or (vx, vy, wz))
        Times [s] and what is commanded from then on; or a source that gives a command for every tick.
    duration : float, optional
        How long the run takes [s], for a list of commands; a `CommandSource` ends the run itself. Left out, see
        `TimedCommands`.
    rate, jitter : float, float
        Ticks per second [1/s]; greatest random change of the length of a tick [s].
    seed, name : int, str
        Seed of the random changes; name of the run.

    Raises
    ------
    InputError
        If the plant has another robot, or a number is not finite or out of its range.
    """
    require_same_robot(plant.robot, controller.robot, "controller")
    rate = require_number("rate", rate, zero=False)
    jitter = require_number("jitter", jitter, zero=True)
    if jitter >= 1 / rate:
        raise InputError(f"jitter is {jitter:g} s; it must be at least 0 and less than a tick, {1 / rate:g} s")
    source = commands if isinstance(commands, CommandSource) else TimedCommands(commands, duration=duration)
    recorder, random = Recorder(controller), np.random.default_rng(seed)
    output = controller.output
    plant.start(output)
    try:
        time, number = 0.0, 0
        while not source.over(time, output):
            number += 1
            after = number / rate + (float(random.uniform(-0.5, 0.5)) * jitter if jitter else 0.0)
            command = source.command(time, output, recorder.note)
            recorder.command(command)
            readings = plant.step(output, after - time)
            output = controller.step(command, after - time, readings)
            time = after
            recorder.tick(time, output, readings)
    finally:
        plant.stop()
    return recorder.recording(name=name, rate=rate)
