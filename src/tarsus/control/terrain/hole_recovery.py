"""Ground that leads nowhere: holes, from which feet are drawn back when something else is asked for; steep slopes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np

from tarsus.control.sensing.ground_plane import GroundPlane
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.stepper import LATEST_LIFT_OFF
from tarsus.gait.gait import Gait

__all__ = ["HoleRecovery", "Request", "repeated_swing"]

Floats = np.ndarray[Any, Any]

# What the robot must have moved for another try to make sense [m].
_ELSEWHERE = 1e-5
# Twists are the same that differ by less, over their size; and by how much they may anyway [m/s, rad/s].
_ALIKE, _NOTHING = 0.2, 1e-3


Request: TypeAlias = tuple[Sequence[float], Any]
"""A twist [m/s, m/s, rad/s], and all else that is asked for."""


class HoleRecovery:
    """What is to be done about feet over a hole: they hang there until something else is asked for.

    Attributes
    ----------
    active : bool
        Whether they are to be drawn back as soon as all others are down.
    """

    def __init__(self) -> None:
        self.active = False
        self._led_here: Request | None = None
        self._tried: tuple[Request, complex] | None = None
        self._legs: set[int] = set()

    def consider(self, asked: Request, place: complex) -> bool:
        """Return whether feet that have just been found to hang over a hole are to be drawn back.

        Parameters
        ----------
        asked : (twist, manner)
            What is asked for: what it was when they got there is not tried again, anything else once, and more often
            as long as the robot gets on by it.
        place : complex
            Where the robot is [m].
        """
        if self._led_here is None:
            self._led_here = asked
        if self.active or _alike(asked, self._led_here):
            return False
        if self._tried is not None and _alike(asked, self._tried[0]) and abs(place - self._tried[1]) < _ELSEWHERE:
            return False
        self.active, self._tried = True, (asked, place)
        return True

    def begun(self, legs: Sequence[int]) -> None:
        """Note that feet swing once more.

        Parameters
        ----------
        legs : sequence of int
            Their legs.
        """
        self.active, self._legs = False, set(legs)

    def landed(self, landed: Floats) -> None:
        """Note which feet have been put down in this tick; once it is those over the hole, that is over.

        Parameters
        ----------
        landed : array of bool, shape (legs,)
            The feet.
        """
        self._legs -= set(np.flatnonzero(landed).tolist())
        if not self._legs:
            self.active, self._led_here, self._tried = False, None, None


def _alike(asked: Request, other: Request) -> bool:
    """Return whether the same is asked for, but for a hand that trembles."""
    bound = max(_ALIKE * math.hypot(*other[0]), _NOTHING)
    return asked[1] == other[1] and math.dist(asked[0], other[0]) < bound


def repeated_swing(now: GaitState, legs: Sequence[int], gait: Gait, ground: GroundPlane) -> GaitState:
    """Return the moment in which feet that have come to the end of their swing begin it once more, where they are.

    The clock goes back to when they were lifted: all others wait for their turn once more.

    Parameters
    ----------
    now : Moment
        The moment; every other foot is down.
    legs : sequence of int
        The legs whose feet are at the end of their swing, at rest.
    gait : Gait
        Order of the steps.
    ground : GroundPlane
        Where the ground is expected.
    """
    again = np.zeros(len(now.down), dtype=bool)
    again[list(legs)] = True
    since = now.clock - (np.asarray(gait.offsets) + gait.duty_factor + now.step_number)
    back = float(since[again].min())
    return now._replace(
        clock=now.clock - back,
        swing_phase=np.where(again, 0.0, now.swing_phase),
        lift_delay=np.where(
            again, np.clip(since - back, 0.0, LATEST_LIFT_OFF * (1 - gait.duty_factor)), now.lift_delay
        ),
        start_height=np.where(again, now.ground_height, now.start_height),
        ground_height=np.where(again, ground.height(now.foot.real, now.foot.imag), now.ground_height),
        contact_phase=np.where(again, np.inf, now.contact_phase),
    )
