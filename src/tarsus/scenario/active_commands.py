"""The commands of a scenario as a source of commands for a controller: each holds until another one of its kind."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from tarsus.control.command import BODY_AXES, Command
from tarsus.control.control_output import ControlOutput
from tarsus.control.limitation import LimitationKind
from tarsus.control.loop.run import AFTER, LONGEST
from tarsus.control.plant import Environment
from tarsus.control.robot_state import RobotState
from tarsus.control.startup import power_off_order
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
from tarsus.scenario.scenario import Scenario
from tarsus.scenario.timed_command import TimedCommand
from tarsus.scenario.wording import command_text

__all__ = ["ScenarioCommands", "leg_number"]

_NO_TWIST = (0.0, 0.0, 0.0)
# Times that differ by no more than this count as the same [s].
_SAME_TIME = 1e-9
_STATES: dict[type[TimedCommand], RobotState] = {
    StandUp: RobotState.STANDING,
    Sit: RobotState.LYING,
    Fold: RobotState.FOLDED,
}


def leg_number(robot: Robot, name: str) -> int | None:
    """Return the number of the leg with a name or short name; None where there is none.

    Parameters
    ----------
    robot : Robot
        A single robot.
    name : str
        Full or short name of the leg; upper and lower case are the same.
    """
    for names in (robot.leg_codes, robot.leg_names):
        lower = [each.lower() for each in names]
        if name.lower() in lower:
            return lower.index(name.lower())
    return None


class ScenarioCommands:
    """Gives the command for every tick; a change of state waits in a queue until the previous one has ended.

    Parameters
    ----------
    scenario : Scenario
        The scenario.
    robot : Robot
        A single robot.
    environment : Environment, optional
        Deviations from flat ground that an ideal plant measures; the commands ``ground``, ``tilt`` and ``force`` set
        them.
    """

    def __init__(self, scenario: Scenario, robot: Robot, environment: Environment | None) -> None:
        self._scenario, self._robot, self._environment = scenario, robot, environment
        self._left = deque(scenario.commands)
        self._queue: deque[TimedCommand] = deque()
        self._twist = _NO_TWIST
        self._held: dict[str, Any] = {}
        # Target or velocity of each leg that was taken out of the gait; None for a leg that was put back into it.
        self._feet: dict[int, FootTarget | FootVelocity | None] = {}
        self._state: RobotState | None = None
        # Whether a twist, and for which legs a foot, was commanded while the robot is to lie or fold: such commands are
        # passed on, so that the controller reports why it does not carry them out.
        self._asks, self._asked = False, set[int]()
        self._command = Command()

    # The interface of a source of commands.

    def command(self, time: float, output: ControlOutput, note: Callable[[str, str], None]) -> Command:
        """Return the command for the next tick: all scenario commands that are in force.

        Parameters
        ----------
        time : float
            The time at the end of the last tick [s].
        output : ControlOutput
            The last output of the controller.
        note : callable
            Records an event, given its kind and text.
        """
        changed = False
        while self._left and self._left[0].at <= time + _SAME_TIME:
            command = self._left.popleft()
            note("command", command_text(command))
            self._take(command)
            changed = True
        while self._queue and self._handled(self._queue[0], output, note):
            self._queue.popleft()
            changed = True
        if self._queue and type(self._queue[0]) in _STATES:
            state = _STATES[type(self._queue[0])]
            if state is not self._state:
                changed, self._state, self._asks, self._asked = True, state, False, set()
        if changed:
            self._command = self._merged()
        return self._command

    def over(self, time: float, output: ControlOutput) -> bool:
        """Return whether the run is over.

        Parameters
        ----------
        time : float
            The time at the end of the last tick [s].
        output : ControlOutput
            The last output of the controller.
        """
        if self._scenario.duration is not None:
            return time >= self._scenario.duration - _SAME_TIME
        last = self._scenario.commands[-1].at if self._scenario.commands else 0.0
        if self._left or time < last + AFTER - _SAME_TIME:
            return False
        walks = output.state.upright and any(self._twist)
        return (not self._queue and (walks or output.at_rest)) or time >= last + LONGEST

    # Commands in force.

    def _take(self, command: TimedCommand) -> None:
        if isinstance(command, StandUp | Sit | Fold | PowerOff):
            self._queue.append(command)
        elif isinstance(command, Walk | Stop):
            self._twist = (command.vx, command.vy, command.turn) if isinstance(command, Walk) else _NO_TWIST
            self._asks = not self._stands
        elif isinstance(command, MoveBody | Sway):
            axes = tuple(float(getattr(command, axis)) for axis in BODY_AXES)
            self._held["body" if isinstance(command, MoveBody) else "sway"] = axes
        elif isinstance(command, GaitChange | BodyHeight | SwingHeight | StanceWidth | CycleTime):
            self._held[command.word] = getattr(command, command.word)
        else:
            self._take_for_leg(command)

    def _take_for_leg(self, command: TimedCommand) -> None:
        leg = leg_number(self._robot, getattr(command, "leg", ""))
        if isinstance(command, Tilt) and self._environment is not None:
            self._environment.set_tilt(command.roll, command.pitch)
        elif isinstance(command, Ground) and leg is not None and self._environment is not None:
            self._environment.set_ground(leg, command.height)
        elif isinstance(command, Force) and leg is not None and self._environment is not None:
            self._environment.set_force(leg, command.force)
        elif leg is not None:
            self._feet[leg] = command if isinstance(command, FootTarget | FootVelocity) else None
            if not self._stands:
                self._asked.add(leg)

    @property
    def _stands(self) -> bool:
        return self._state in (None, RobotState.STANDING)

    def _merged(self) -> Command:
        """Return the command in force; twist and feet commanded before the robot was to lie or fold no longer count."""
        stands = self._stands
        feet = {leg: foot if stands or leg in self._asked else None for leg, foot in self._feet.items()}
        velocities = {n: (f.vx, f.vy, f.vz) for n, f in feet.items() if isinstance(f, FootVelocity)}
        targets = {
            n: (f.x, f.y, f.z) if isinstance(f, FootTarget) else None
            for n, f in feet.items()
            if not isinstance(f, FootVelocity)
        }
        return Command(
            twist=self._twist if stands or self._asks else _NO_TWIST,
            foot_targets=targets or None,
            foot_velocities=velocities or None,
            state=self._state,
            **self._held,
        )

    # Changes of state.

    @staticmethod
    def _is_met(command: TimedCommand, output: ControlOutput) -> bool:
        """Return whether the robot is in the state that a command asks for."""
        if isinstance(command, StandUp):
            return output.state.upright
        if isinstance(command, Sit):
            return output.state.on_belly
        return output.state is RobotState.FOLDED

    def _handled(self, command: TimedCommand, output: ControlOutput, note: Callable[[str, str], None]) -> bool:
        """Return whether a change of state is finished: reached, refused, or a power-off that was reported."""
        if isinstance(command, PowerOff):
            return self._powered_off(output, note)
        if self._is_met(command, output):
            return True
        refused = [each for each in output.limitations if each.kind is LimitationKind.STATE]
        if not refused or self._state is not _STATES[type(command)]:
            return False
        note("refused", f"{command.word}: {refused[0].cause}")
        self._state = RobotState.STANDING if output.state.upright else RobotState(output.state)
        return True

    def _powered_off(self, output: ControlOutput, note: Callable[[str, str], None]) -> bool:
        """Report what falls when the joints are released, once the robot rests on its belly; return whether done."""
        if output.state.upright:
            note("refused", "power_off: the robot stands; it must lie on its belly before the joints are released")
            return True
        if not (output.state.on_belly and output.at_rest):
            return False
        falls = power_off_order(self._robot, output.angles).falls
        note("power", "joints released: coxae, femurs, tibiae; " + ("; ".join(falls) or "nothing falls"))
        return True
