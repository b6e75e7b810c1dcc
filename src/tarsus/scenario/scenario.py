"""A scenario: a robot, how it is found, and what it is told at which moment."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tarsus.control.pose.admittance import Admittance
from tarsus.errors import InputError, UnknownNameError
from tarsus.representation import represented
from tarsus.scenario.quantities import require_quantity
from tarsus.scenario.settings import ADMITTANCE, LEVELLINGS, NUMBERS, STARTS
from tarsus.scenario.timed_command import GAIT_NAMES, TimedCommand
from tarsus.scenario.wording import command_text, time_text

__all__ = ["LONGEST_TICK", "Scenario"]

LONGEST_TICK = 0.05
"""The longest tick [s]; of a longer one, the walk controller would execute only this much."""

_MOST_TICKS = 1_000_000


@represented()
@dataclass(frozen=True)
class Scenario:
    """Commands to a robot over time, and the state and settings with which it starts.

    Attributes
    ----------
    commands : tuple of Command
        In the order of their times; those of the same time in the order given.
    name : str
        Name of the scenario.
    robot : str
        A robot's name, or the path of its file; empty where any robot will do.
    rate : float
        Ticks per second [1/s].
    jitter : float
        Greatest random change of the length of a tick [s].
    seed : int
        Seed of the random jitter.
    start : {"standing", "sitting", "folded"}
        State of the robot at the start.
    duration : float, optional
        How long it takes [s]. Left out: until 2 s after the last command, and until what that began is over.
    gait : str
        The gait it starts with; the robot's own where empty.
    body_height, swing_height : float, optional
        Of the stance it starts in or gets up to [m]; the robot's own where left out.
    levelling : {"", "level", "between", "follow", "none"}
        Attitude of the body on sloping ground that it feels: level (also where left out), halfway between level and the
        slope, along the slope, or not controlled.
    admittance : Admittance, optional
        How feet yield to the forces on them; left out, they do not.

    Raises
    ------
    InputError
        If a number is not finite or out of its range.
    UnknownNameError
        If there is no such start or gait.
    """

    commands: tuple[TimedCommand, ...] = ()
    name: str = ""
    robot: str = ""
    rate: float = 100.0
    jitter: float = 0.0
    seed: int = 0
    start: str = "standing"
    duration: float | None = None
    gait: str = ""
    body_height: float | None = None
    swing_height: float | None = None
    levelling: str = ""
    admittance: Admittance | None = None

    def __post_init__(self) -> None:
        commands: Iterable[object] = self.commands
        for command in commands:
            if not isinstance(command, TimedCommand):
                raise InputError(f"a scenario's commands are Walk, Stop and the like, not {command!r}")
        object.__setattr__(self, "commands", tuple(sorted(self.commands, key=lambda command: command.at)))
        if self.start not in STARTS:
            raise UnknownNameError.of("start", str(self.start), STARTS)
        for kind, known in (("gait", GAIT_NAMES), ("levelling", LEVELLINGS)):
            if getattr(self, kind) not in ("", *known):
                raise UnknownNameError.of(kind, str(getattr(self, kind)), known)
        self._check_numbers()
        self._check_admittance()

    def _check_admittance(self) -> None:
        admittance: object = self.admittance
        if admittance is None:
            return
        if not isinstance(admittance, Admittance):
            raise InputError(f"a scenario's admittance is an Admittance or None, not {admittance!r}")
        for each in ADMITTANCE:
            require_quantity(f"a scenario's admittance: {each.name}", getattr(admittance, each.name), each)

    def _check_numbers(self) -> None:
        for each in NUMBERS:
            value = getattr(self, each.name)
            if value is not None:
                require_quantity(f"a scenario's {each.name}", value, each)
        tick = 1 / self.rate
        if self.jitter >= tick:
            raise InputError(f"jitter is {self.jitter:g} s; it must be less than a tick, {tick:g} s")
        if tick + self.jitter > LONGEST_TICK + 1e-12:
            raise InputError(
                f"with a rate of {self.rate:g} Hz and a jitter of {self.jitter:g} s a tick takes up to "
                f"{tick + self.jitter:g} s; at most {LONGEST_TICK:g} s works"
            )
        last = self.duration if self.duration is not None else max((c.at for c in self.commands), default=0.0)
        if last * self.rate > _MOST_TICKS:
            raise InputError(
                f"{last:g} s at {self.rate:g} Hz are {last * self.rate:.3g} ticks, more than {_MOST_TICKS}"
            )

    @property
    def timeline(self) -> str:
        """The commands as text, a line for each moment; `tarsus.scenario.text` reads it back to the same commands."""
        lines: list[str] = []
        last: float | None = None
        for command in self.commands:
            text = command_text(command)
            if command.at == last:
                lines[-1] += f"; {text}"
            else:
                lines.append(f"at {time_text(command.at)}: {text}")
            last = command.at
        return "\n".join(lines)
