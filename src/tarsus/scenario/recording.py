"""What came of a scenario: the motion, what was wished for, what was limited and why, what the guard did."""

from __future__ import annotations

import csv
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.robot.robot import Robot
from tarsus.scenario.scenario import Scenario

__all__ = ["Event", "Recording"]

Floats = np.ndarray[Any, Any]


class Event(NamedTuple):
    """Something that happened.

    Attributes
    ----------
    time : float
        When, or from when on [s].
    until : float
        Until when [s]; the same where it is a moment.
    kind : str
        ``"command"``, ``"stage"`` of getting up or lying down, ``"gait"``, ``"limit"``: the command is not met in full,
        ``"refused"``, ``"power"``, ``"guard"``: an intervention.
    text : str
        What.
    """

    time: float
    until: float
    kind: str
    text: str


@dataclass(frozen=True, eq=False, kw_only=True)
class Recording:
    """A scenario as it was run. Arrays have a row for each tick, the first for how the robot was found.

    Attributes
    ----------
    scenario : Scenario
        What the robot was told.
    robot : Robot
        Which robot.
    motion : Motion
        What it did, all of it: also while it lay on its belly, when margins mean nothing. The gait, the cycle time,
        the stroke and the speed are those of its fastest walking; `body_height` and `swing_height` those it
        started with.
    wished, done : array, shape (n, 3)
        Twist that was asked for, and that was walked: forward, left [m/s], turning [rad/s].
    cycle_times : array, shape (n,)
        Duration of a cycle of steps; what it was last where it does not walk [s].
    belly : array of bool, shape (n,)
        Whether its body rests on the ground.
    upright : array of bool, shape (n,)
        Whether it stands or walks, and is not lying, getting up or going down.
    doing : tuple of str
        The walker's mode, such as ``"walking"``; ``"lying"``; or the stage of getting up or lying down.
    gaits : tuple of str
        Name of the gait.
    guard : tuple of str
        What the guard did: ``"passing"``, ``"holding"``, ...; empty where there was none.
    interventions : mapping of str to int
        How often each kind of intervention of the guard began.
    events : tuple of Event
        In the order of their times.
    """

    scenario: Scenario
    robot: Robot
    motion: Motion
    wished: Floats
    done: Floats
    cycle_times: Floats
    belly: Floats
    upright: Floats
    doing: tuple[str, ...]
    gaits: tuple[str, ...]
    guard: tuple[str, ...]
    interventions: Mapping[str, int]
    events: tuple[Event, ...]

    @cached_property
    def standing(self) -> tuple[Motion, ...]:
        """The stretches in which the body is off the ground, each as a motion of its own that starts at 0 s.

        Margins and loads mean something for these.
        """
        edges = np.flatnonzero(np.diff(np.concatenate([[True], self.belly, [True]]).astype(int)))
        return tuple(self._part(int(first), int(end)) for first, end in edges.reshape(-1, 2) if end - first > 1)

    def _part(self, first: int, end: int) -> Motion:
        whole, rows = self.motion, slice(first, end)
        if end - first == len(whole.time):
            return whole
        return Motion(
            robot=whole.robot,
            gait=whole.gait,
            time=whole.time[rows] - whole.time[first],
            body=whole.body[rows],
            feet=whole.feet[rows],
            contacts=whole.contacts[rows],
            angles=whole.angles[rows],
            reach=whole.reach[rows],
            cycle_time=whole.cycle_time,
            stroke=whole.stroke,
            speed=whole.speed,
            body_height=whole.body_height,
            swing_height=whole.swing_height,
            foot_distance=whole.foot_distance,
            assumed=whole.assumed,
        )

    @property
    def problems(self) -> tuple[str, ...]:
        """What went wrong, a line for each: refused commands, interventions, what is not possible of the motion."""
        rejected = [f"at {event.time:.2f} s {event.text}" for event in self.events if event.kind == "refused"]
        stopped = [f"the guard stepped in {number} x: {kind}" for kind, number in self.interventions.items()]
        bodily = [problem for part in self.standing for problem in part.problems]
        return tuple(dict.fromkeys([*rejected, *stopped, *bodily]))

    @property
    def ok(self) -> bool:
        """Whether all of it is possible, nothing was refused, and the guard had nothing to do."""
        return not self.problems

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the log as a table: a row for each tick, in mm/s and deg/s. The angles are in `motion`'s table.

        Parameters
        ----------
        path : path
            Where to write it.

        Raises
        ------
        InputError
            If it can't be written.
        """
        scale = np.array([1e3, 1e3, 180 / np.pi])
        twists = [self.motion.time[:, None], self.wished * scale, self.done * scale]
        rows = np.hstack([*twists, self.cycle_times[:, None], self.motion.margin[:, None] * 1e3]).tolist()
        guard = self.guard or ("",) * len(rows)
        try:
            with open(path, "w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file)
                writer.writerow(_COLUMNS)
                for row, *words in zip(rows, self.gaits, self.doing, guard, strict=True):
                    writer.writerow([*(f"{round(value, 6) + 0.0:.6f}" for value in row), *words])
        except OSError as error:
            raise InputError(f"{path} can't be written: {error.strerror}") from None


_COLUMNS = (
    "time_s",
    *(f"{what}_{axis}" for what in ("wished", "done") for axis in ("vx_mm_s", "vy_mm_s", "turn_deg_s")),
    *("cycle_time_s", "margin_mm", "gait", "doing", "guard"),
)
