"""The recording of a run: motion, commands, limitations, interventions, and which commands were not met."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.arrays import read_only
from tarsus.control.limitation import Limitation
from tarsus.control.walk_state import WalkState
from tarsus.gait.motion import Motion
from tarsus.gait.storage import write_table
from tarsus.representation import represented
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["Event", "Recording", "Unmet"]


@represented()
class Event(NamedTuple):
    """An event of a run.

    Attributes
    ----------
    time : float
        When it happened or began [s].
    until : float
        When it ended [s]; the same as `time` where it has no duration.
    kind : str
        ``"command"``, ``"stage"`` (of rising, sitting down or folding), ``"state"``, ``"gait"``, ``"limit"`` (a command
        is not met in full), ``"refused"``, ``"power"`` or ``"guard"`` (an intervention).
    text : str
        What happened.
    """

    time: float
    until: float
    kind: str
    text: str


@represented()
class Unmet(NamedTuple):
    """A command that was not met in full by the time it was replaced, or the run ended.

    Attributes
    ----------
    time : float
        When the limitation began [s].
    until : float
        When the command was replaced, or the run ended [s].
    limitation : Limitation
        Why it was not met.
    """

    time: float
    until: float
    limitation: Limitation

    def text(self) -> str:
        """Return the unmet command as a line of text."""
        return f"{self.time:.2f} to {self.until:.2f} s: {self.limitation.text()}"


@represented("robot", "name", "rate", "motion", "interventions", "unmet", "events")
@dataclass(frozen=True, eq=False, kw_only=True)
class Recording:
    """A run of a controller and a plant: arrays have a row for the start and one for each tick.

    Attributes
    ----------
    robot : Robot
        The robot.
    name : str
        Name of the run.
    rate : float
        Nominal ticks per second [1/s].
    compliant : bool
        Whether feet comply with forces.
    motion : Motion
        The whole motion; its stability margins are meaningless while the robot lies on its belly. Gait, cycle time,
        stroke and speed are those of the fastest walking, `body_height` and `swing_height` those at the start.
    twist_commanded, twist : array, shape (n, 3)
        Commanded twist, and the twist walked: forward, left [m/s], turning [rad/s].
    cycle_times : array, shape (n,)
        Duration of a cycle [s].
    belly : array of bool, shape (n,)
        Whether the body rests on the ground.
    measured_angles : array, shape (n, legs, 3)
        Joint angles measured by the plant; NaN where none were measured [rad].
    states : tuple of str
        State of the robot.
    activities : tuple of str
        The state in detail: walk state, or stage of rising, sitting down or folding.
    gaits : tuple of str
        Name of the gait.
    guard : tuple of str
        State of the guard: ``"passing"``, ``"holding"``, ...; empty without a guard.
    interventions : mapping of str to int
        How often each kind of intervention of the guard began.
    unmet : tuple of Unmet
        Commands that were not met in full.
    events : tuple of Event
        What happened, in order of time.
    """

    robot: Robot
    name: str
    rate: float
    compliant: bool
    motion: Motion
    twist_commanded: Float[np.ndarray, "n 3"]
    twist: Float[np.ndarray, "n 3"]
    cycle_times: Float[np.ndarray, "n"]
    belly: Bool[np.ndarray, "n"]
    measured_angles: Float[np.ndarray, "n legs 3"]
    states: tuple[str, ...]
    activities: tuple[str, ...]
    gaits: tuple[str, ...]
    guard: tuple[str, ...]
    interventions: Mapping[str, int]
    unmet: tuple[Unmet, ...]
    events: tuple[Event, ...]

    def __post_init__(self) -> None:
        for array in (self.twist_commanded, self.twist, self.cycle_times, self.belly, self.measured_angles):
            read_only(array)

    @cached_property
    def upright(self) -> Bool[np.ndarray, "n"]:
        """Whether the robot stands or walks, and is not lying, rising, sitting down or folding ``(n,)``."""
        return read_only(np.array([activity in _WALK_STATES for activity in self.activities]))

    @cached_property
    def standing(self) -> tuple[Motion, ...]:
        """The intervals in which the body is off the ground, each as a motion of its own that starts at 0 s.

        Stability margins and loads are meaningful only for these.
        """
        edges = np.flatnonzero(np.diff(np.concatenate([[True], self.belly, [True]]).astype(int)))
        return tuple(self._part(int(first), int(end)) for first, end in edges.reshape(-1, 2) if end - first > 1)

    @property
    def longest_standing(self) -> Motion | None:
        """The longest motion of `standing`; None where it has too few samples to compute loads."""
        longest = max(self.standing, key=lambda part: part.duration, default=None)
        return longest if longest is not None and len(longest.time) > 2 else None

    def _part(self, first: int, end: int) -> Motion:
        whole, rows = self.motion, slice(first, end)
        if end - first == len(whole.time):
            return whole
        parts = {name: getattr(whole, name)[rows] for name in ("body", "feet", "contacts", "angles", "reach")}
        return replace(whole, time=whole.time[rows] - whole.time[first], **parts)

    @property
    def command_problems(self) -> tuple[str, ...]:
        """Refused and unmet commands, and kinds of interventions of the guard, a line for each."""
        refused = [f"at {event.time:.2f} s {event.text}" for event in self.events if event.kind == "refused"]
        unmet = [f"not met in full, {each.text()}" for each in self.unmet]
        stopped = [f"guard: {number} x {kind}" for kind, number in self.interventions.items()]
        return (*refused, *unmet, *stopped)

    @property
    def problems(self) -> tuple[str, ...]:
        """What went wrong, a line for each: `command_problems`, and infeasible motion."""
        bodily = (problem for part in self.standing for problem in part.problems)
        return tuple(dict.fromkeys((*self.command_problems, *bodily)))

    @property
    def ok(self) -> bool:
        """Whether the motion is possible, every command was met in full, and the guard did not intervene."""
        return not self.problems

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the run as a table with a row for each tick, in mm/s and deg/s; `motion` has a table of the angles.

        Parameters
        ----------
        path : path
            Where to write it.

        Raises
        ------
        InputError
            If the file can't be written.
        """
        scale = np.array([1e3, 1e3, 180 / np.pi])
        twists = [self.motion.time[:, None], self.twist_commanded * scale, self.twist * scale]
        rows = np.hstack([*twists, self.cycle_times[:, None], self.motion.margin[:, None] * 1e3]).tolist()
        guard = self.guard or ("",) * len(rows)
        ticks = zip(rows, self.gaits, self.states, self.activities, guard, strict=True)
        texts = ([*(f"{round(value, 6) + 0.0:.6f}" for value in row), *words] for row, *words in ticks)
        write_table(path, _COLUMNS, texts)


_WALK_STATES = frozenset(map(str, WalkState))
_COLUMNS = (
    "time_s",
    *(f"{what}_{axis}" for what in ("commanded", "walked") for axis in ("vx_mm_s", "vy_mm_s", "turn_deg_s")),
    *("cycle_time_s", "margin_mm", "gait", "state", "activity", "guard"),
)
