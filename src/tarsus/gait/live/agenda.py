"""What the walker is asked for besides its twist, and what of it is being worked out."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from tarsus.errors import InputError, UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.live.change import Change
from tarsus.gait.live.manner import Manner
from tarsus.gait.live.parts import Parts
from tarsus.gait.live.stand import Terrain
from tarsus.gait.live.wish import Wish

__all__ = ["Agenda"]

Floats = np.ndarray[Any, Any]
WorkOut: TypeAlias = Callable[[Manner, bool], Parts[Change | str]]


class Agenda:
    """Holds the manner that is asked for, and gets there by changes, each worked out in parts.

    Parameters
    ----------
    doing : Change
        What the walker does to begin with.

    Attributes
    ----------
    wanted : Manner
        What is asked for.
    doing : Change
        What was gone over to last.
    ready : Change or None
        What is worked out, and waits for the walk to allow it.
    refusals : dict of Manner to str
        What doesn't work at all, and why.
    """

    def __init__(self, doing: Change) -> None:
        self.doing = doing
        self.wanted = doing.manner
        self.ready: Change | None = None
        self.refusals: dict[Manner, str] = {}
        self._asked = doing.manner
        self._job: Parts[Change | str] | None = None
        # What there is nothing left to do for.
        self._done: Manner | None = None

    def ask(self, wish: Wish, gone: tuple[int, ...], correction: tuple[float, ...], terrain: Terrain) -> None:
        """Note what is asked for.

        Parameters
        ----------
        wish : Wish
            The wish; what is None in it stays.
        gone : tuple of int
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
        gait = m.gait if wish.gait is None else wish.gait
        if isinstance(gait, str):
            gait = m.gait if gait == m.gait.name else Gait.named(gait, legs=legs)
        if not isinstance(gait, Gait):
            raise InputError(f"the wish's gait is {gait!r}; it must be a name or a Gait")
        gait.require_legs(legs)
        asked = Manner(
            gait=gait,
            body=m.body if wish.body is None else tuple(wish.body),
            clearance=m.clearance if wish.clearance is None else wish.clearance,
            lift=m.lift if wish.lift is None else wish.lift,
            stance_width=m.stance_width if wish.stance_width is None else wish.stance_width,
            cycle_time=_cycle_time(m.cycle_time, wish.cycle_time),
            sway=m.sway if wish.sway is None else tuple(wish.sway),
            correction=correction,
            gone=gone,
            terrain=terrain,
        )
        if asked.lift < 0:
            raise InputError(f"the wish's lift is {asked.lift} m; it must not be negative")
        if asked.cycle_time is not None and asked.cycle_time <= 0:
            raise InputError(f"the wish's cycle_time is {asked.cycle_time} s; it must be greater than 0")
        if asked != self.wanted:
            self.wanted, self.refusals = asked, {}

    def think(self, work_out: WorkOut, *, free: bool) -> None:
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
            asked, stay = self._next_manner()
            if asked not in (self.doing.manner, *self.refusals):
                self._asked, self._job = asked, work_out(asked, stay)
            else:
                self._done = self.wanted

    def adopt(self, change: Change) -> None:
        """Note that a change has been gone over to.

        Parameters
        ----------
        change : Change
            The change.
        """
        manner = change.manner if change.whole else self.doing.manner
        self.doing, self.ready = dataclasses.replace(change, manner=manner), None
        # What didn't work may work now.
        self.refusals, self._done = {}, None

    def _note(self, found: Change | str) -> None:
        self._job = None
        if isinstance(found, str):
            # What is no longer asked for by now is refused nothing.
            if self._asked == self._next_manner()[0]:
                self.refusals[self._asked] = found
        else:
            self.ready = found

    def _next_manner(self) -> tuple[Manner, bool]:
        """Return what to change first, how the robot steps or how it stands; and whether its posture stays."""
        doing, wanted = self.doing.manner, self.wanted
        stepping = dataclasses.replace(doing, gait=wanted.gait, cycle_time=wanted.cycle_time, gone=wanted.gone)
        standing = dataclasses.replace(wanted, gait=doing.gait, cycle_time=doing.cycle_time, gone=doing.gone)
        order = [(stepping, True), (standing, False)]
        if set(doing.gone) - set(wanted.gone):
            # Legs that are out come back in the order of steps that they left.
            # Only once they are down may others leave it.
            staying = tuple(leg for leg in doing.gone if leg in wanted.gone)
            order = [(dataclasses.replace(doing, gone=staying), True)]
        elif doing.gone:
            # Where the feet of these legs are may be out of reach from another posture.
            order = order[:1]
        elif wanted.gone:
            # Before a leg leaves the gait, the body leans over the others.
            order.reverse()
        for manner, stay in order:
            if manner not in (doing, *self.refusals):
                return manner, stay
        return doing, True


def _cycle_time(before: float | None, wished: float | str | None) -> float | None:
    """Return the duration of a cycle that is asked for; None for the one that gets the robot farthest."""
    if wished is None:
        return before
    return None if isinstance(wished, str) else wished
