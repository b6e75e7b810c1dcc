"""What the walker is asked for besides its twist, and what of it is being worked out."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from tarsus.control.command import Command
from tarsus.control.incremental import Incremental
from tarsus.control.transition.parameters import WalkParameters
from tarsus.control.transition.planner import StanceTransition
from tarsus.control.workspace.stance_geometry import TerrainEstimate
from tarsus.errors import InputError, UnreachableError
from tarsus.gait.gait import Gait

__all__ = ["TransitionScheduler"]

Floats = np.ndarray[Any, Any]
PlanTransition: TypeAlias = Callable[[WalkParameters, bool], Incremental[StanceTransition | str]]


class TransitionScheduler:
    """Holds the manner that is asked for, and gets there by changes, each worked out in parts.

    Parameters
    ----------
    doing : Change
        What the walker does to begin with.

    Attributes
    ----------
    wanted : WalkParameters
        What is asked for.
    doing : Change
        What was gone over to last.
    ready : Change or None
        What is worked out, and waits for the walk to allow it.
    rejections : dict of WalkParameters to str
        What doesn't work at all, and why.
    """

    def __init__(self, doing: StanceTransition) -> None:
        self.doing = doing
        self.wanted = doing.parameters
        self.ready: StanceTransition | None = None
        self.rejections: dict[WalkParameters, str] = {}
        self._asked = doing.parameters
        self._job: Incremental[StanceTransition | str] | None = None
        # What there is nothing left to do for.
        self._done: WalkParameters | None = None

    def ask(
        self, command: Command, excluded: tuple[int, ...], correction: tuple[float, ...], terrain: TerrainEstimate
    ) -> None:
        """Note what is asked for.

        Parameters
        ----------
        command : Command
            The wish; what is None in it stays.
        excluded : tuple of int
            Legs that are to be hands.
        correction : tuple of float
            What the ground asks of the body.
        terrain : Terrain
            How the ground lies.

        Raises
        ------
        InputError
            If a value is out of its range, or the gait for another number of legs.
        UnknownNameError
            If there is no such gait.
        """
        m = self.wanted
        legs = m.gait.legs
        gait = m.gait if command.gait is None else command.gait
        if isinstance(gait, str):
            gait = m.gait if gait == m.gait.name else Gait.named(gait, legs=legs)
        if not isinstance(gait, Gait):
            raise InputError(f"the command's gait is {gait!r}; it must be a name or a Gait")
        gait.require_legs(legs)
        asked = WalkParameters(
            gait=gait,
            body=m.body if command.body is None else tuple(command.body),
            body_height=m.body_height if command.body_height is None else command.body_height,
            swing_height=m.swing_height if command.swing_height is None else command.swing_height,
            stance_width=m.stance_width if command.stance_width is None else command.stance_width,
            cycle_time=_cycle_time(m.cycle_time, command.cycle_time),
            sway=m.sway if command.sway is None else tuple(command.sway),
            correction=correction,
            excluded=excluded,
            terrain=terrain,
        )
        if asked.swing_height < 0:
            raise InputError(f"the command's swing_height is {asked.swing_height} m; it must not be negative")
        if asked.cycle_time is not None and asked.cycle_time <= 0:
            raise InputError(f"the command's cycle_time is {asked.cycle_time} s; it must be greater than 0")
        if asked != self.wanted:
            self.wanted, self.rejections = asked, {}

    def think(self, work_out: PlanTransition, *, free: bool) -> None:
        """Do one part of working out the next change.

        Parameters
        ----------
        work_out : callable
            Gives the parts for a manner; its second argument is whether the posture stays.
        free : bool
            Whether the walker has done with the last change, so that a further one may begin.
        """
        if self._job is not None:
            try:
                next(self._job)
            except StopIteration as done:
                self._note(done.value)
            except UnreachableError as error:
                self._note(str(error))
            else:
                return
        if free and self.ready is None and self.wanted is not self._done:
            asked, stay = self._next_parameters()
            if asked not in (self.doing.parameters, *self.rejections):
                self._asked, self._job = asked, work_out(asked, stay)
            else:
                self._done = self.wanted

    def adopt(self, change: StanceTransition) -> None:
        """Note that a change has been gone over to.

        Parameters
        ----------
        change : Change
            The change.
        """
        parameters = change.parameters if change.whole else self.doing.parameters
        self.doing, self.ready = dataclasses.replace(change, parameters=parameters), None
        # What didn't work may work now.
        self.rejections, self._done = {}, None

    def _note(self, found: StanceTransition | str) -> None:
        self._job = None
        if isinstance(found, str):
            # What is no longer asked for by now is refused nothing.
            if self._asked == self._next_parameters()[0]:
                self.rejections[self._asked] = found
        else:
            self.ready = found

    def _next_parameters(self) -> tuple[WalkParameters, bool]:
        """Return what to change first, how the robot steps or how it stands; and whether its posture stays."""
        doing, wanted = self.doing.parameters, self.wanted
        stepping = dataclasses.replace(doing, gait=wanted.gait, cycle_time=wanted.cycle_time, excluded=wanted.excluded)
        standing = dataclasses.replace(wanted, gait=doing.gait, cycle_time=doing.cycle_time, excluded=doing.excluded)
        order = [(stepping, True), (standing, False)]
        if set(doing.excluded) - set(wanted.excluded):
            # Legs that are out come back in the order of steps that they left.
            # Only once they are down may others leave it.
            staying = tuple(leg for leg in doing.excluded if leg in wanted.excluded)
            order = [(dataclasses.replace(doing, excluded=staying), True)]
        elif doing.excluded:
            # Where the feet of these legs are may be out of reach from another posture.
            order = order[:1]
        elif wanted.excluded:
            # Before a leg leaves the gait, the body leans over the others.
            order.reverse()
        for parameters, stay in order:
            if parameters not in (doing, *self.rejections):
                return parameters, stay
        return doing, True


def _cycle_time(before: float | None, wished: float | str | None) -> float | None:
    """Return the duration of a cycle that is asked for; None for the one that gets the robot farthest."""
    if wished is None:
        return before
    return None if isinstance(wished, str) else wished
