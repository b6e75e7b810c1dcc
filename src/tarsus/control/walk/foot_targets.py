"""All legs of a walk that are moved by hand: which there are, where they are told to go, and what stops them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tarsus.control.command import Command
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.walk.foot_target_motion import FootTargetMotion, apply_foot_targets, begin_foot_target
from tarsus.control.walk.state import GaitState
from tarsus.errors import InputError

__all__ = ["FootTargets", "excluded_legs"]

Floats = np.ndarray[Any, Any]


def excluded_legs(command: Command, before: tuple[int, ...], legs: int) -> tuple[int, ...]:
    """Return which legs are to be out of the gait.

    Parameters
    ----------
    command : Command
        The wish.
    before : tuple of int
        The legs that were to be out so far.
    legs : int
        How many legs the robot has.

    Raises
    ------
    InputError
        If the command names a leg that there is not.
    """
    if not (command.foot_targets or command.foot_velocities):
        return before
    out = set(before)
    for leg, point in [*(command.foot_targets or {}).items(), *(command.foot_velocities or {}).items()]:
        if leg not in range(legs):
            raise InputError(f"foot_target {leg!r}: the robot has the legs 0 to {legs - 1}")
        (out.discard if point is None else out.add)(leg)
    return tuple(sorted(out))


class FootTargets:
    """The hands of a walker.

    Parameters
    ----------
    names : sequence of str
        What the legs are called.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self._names = names
        self._foot_targets: dict[int, FootTargetMotion] = {}
        self._out: tuple[int, ...] = ()
        self._points: dict[int, Sequence[float]] = {}
        self._parts: dict[int, float] = {}

    def __bool__(self) -> bool:
        return bool(self._foot_targets)

    @property
    def legs(self) -> list[int]:
        """The legs that don't bear: those that are out, and those on their way back, still in the air."""
        return list(self._foot_targets)

    @property
    def returning(self) -> bool:
        """Whether a leg is on its way back."""
        return len(self._foot_targets) > len(self._out)

    @property
    def limitations(self) -> list[Limitation]:
        """Foot targets that are out of reach."""
        return [
            Limitation(
                kind=LimitationKind.FOOT_TARGET, cause="out of reach", leg=self._names[leg], asked=1.0, granted=part
            )
            for leg, part in self._parts.items()
            if part < 1
        ]

    def set_legs(self, out: tuple[int, ...], now: GaitState) -> None:
        """Make the legs that are out from now on hands; one that comes back stays in the air until its next step.

        Parameters
        ----------
        out : tuple of int
            The legs.
        now : Moment
            Where their feet are.
        """
        stopped = {leg: foot_target.stopped() for leg, foot_target in self._foot_targets.items() if leg not in out}
        self._foot_targets = stopped | {leg: self._foot_targets.get(leg) or begin_foot_target(now, leg) for leg in out}
        self._out, self._parts = out, {}

    def set_targets(self, command: Command, dt: float, reachable: Callable[[int, Floats, Floats], float]) -> None:
        """Set where the hands go: as far towards what is asked for as their legs reach.

        Parameters
        ----------
        command : Command
            A point in it holds until there is another; a speed, as long as it is given.
        dt : float
            For how long [s].
        reachable : callable
            How much of the way a leg's foot can go from one point to another.
        """
        if not (self._points or command.foot_targets or command.foot_velocities):
            return
        speeds = command.foot_velocities or {}
        asked = {**self._points, **(command.foot_targets or {})}
        self._points = {leg: point for leg, point in asked.items() if point is not None and leg not in speeds}
        for leg in self._out:
            foot_target = self._foot_targets[leg]
            here = foot_target.position.value
            if leg in speeds:
                wished = foot_target.target + np.array(speeds[leg]) * dt
            elif leg in self._points:
                wished = np.array(self._points[leg])
            else:
                continue
            wished[2] = max(wished[2], 0.0)
            part = self._parts[leg] = reachable(leg, here, wished)
            self._foot_targets[leg] = foot_target._replace(target=here + part * (wished - here))

    def apply(self, now: GaitState, time: float, *, swing_time: float) -> GaitState:
        """Return a moment with the hands where they are after a time.

        Parameters
        ----------
        now : Moment
            The moment, after that time.
        time : float
            The time [s].
        swing_time : float
            How long a swing takes [s].
        """
        if not self._foot_targets:
            return now
        return apply_foot_targets(
            now, {leg: foot_target.step(time) for leg, foot_target in self._foot_targets.items()}, swing_time
        )

    def step(self, time: float, down: Floats) -> None:
        """Go on by a time; a leg that has been lifted to step is a hand no more.

        Parameters
        ----------
        time : float
            The time [s].
        down : array of bool, shape (legs,)
            Which feet are not in a swing.
        """
        if self._foot_targets:
            self._foot_targets = {
                leg: foot_target.step(time) for leg, foot_target in self._foot_targets.items() if down[leg]
            }

    def without_bounds(self, bounds: Floats) -> Floats:
        """Return the feet's polygons without those of the hands, whose legs bound them by themselves.

        Parameters
        ----------
        bounds : array, shape (legs, 16)
            Sides of the polygons [m].
        """
        if not self._foot_targets:
            return bounds
        free = bounds.copy()
        free[self.legs] = np.inf
        return free
