"""Where each foot may be at this moment, while the robot goes over from one stand to another."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.control.transition.planner import StanceTransition
from tarsus.control.workspace.polygon import NORMALS_CONJUGATE
from tarsus.control.workspace.velocity_limits import VelocityLimits

__all__ = ["FootholdTransfer"]

Floats = np.ndarray[Any, Any]

_SAME = 1e-9


class FootholdTransfer:
    """The feet's polygons and rest footholds, leg by leg: each leg goes over to new ones with its own next step.

    Parameters
    ----------
    change : Change
        How the robot stands to begin with.

    Attributes
    ----------
    bounds : array, shape (legs, 16)
        Sides of the polygons in which the feet on the ground have to stay [m].
    rest : complex array, shape (legs,)
        Where each foot rests, or is to be put down, in the heading frame [m].
    way : VelocityLimits
        What limits the twist.
    stepped : array of bool, shape (legs,)
        Which feet are where they are to rest now.
    room : array, shape (legs, 16)
        How far from its rest foothold each foot may be put down next, along each side's normal [m].
    """

    def __init__(self, change: StanceTransition) -> None:
        self.way: VelocityLimits = change.there
        self.bounds: Floats = change.there.bounds
        self.rest: Floats = change.rest
        self.stepped = np.ones(len(self.rest), dtype=bool)
        self._landing = self.bounds
        self._new_rest = self.rest
        self._old_step = ~self.stepped
        self._make_room()

    def _make_room(self) -> None:
        landing = np.where(self._old_step[:, None], self.bounds, self._landing)
        self.room: Floats = np.maximum(landing - (NORMALS_CONJUGATE * self.rest[:, None]).real, 0.0)

    @property
    def new_rest(self) -> Floats:
        """Where the feet rest once all have stepped ``(legs,)``, complex [m]."""
        return self._new_rest

    def begun(self, change: StanceTransition) -> Floats:
        """Return the sides ``(legs, 16)`` with which feet would begin to step to new rest footholds [m].

        Parameters
        ----------
        change : Change
            What would be gone over to.
        """
        moved = self._moved(change)
        return np.where(moved[:, None], self.bounds, np.minimum(self.bounds, change.stepping.bounds))

    def _moved(self, change: StanceTransition) -> Floats:
        return np.asarray(np.abs(change.rest - self._new_rest) > _SAME)

    def begin(self, change: StanceTransition, down: Floats) -> None:
        """Send the feet to new rest footholds.

        Parameters
        ----------
        change : Change
            What is gone over to.
        down : array of bool, shape (legs,)
            Which feet are on the ground.
        """
        self.way = self.way.intersection(change.stepping)
        moved = self._moved(change)
        self.bounds = self.begun(change)
        self.stepped = ~moved
        # A foot in the air lands where it is bound for; its next step is the one that counts.
        self._old_step = moved & ~down
        self.rest = np.where(self._old_step, self.rest, change.rest)
        self._landing, self._new_rest = change.stepping.bounds, change.rest
        self._make_room()

    def land(self, landed: Floats) -> None:
        """Note which feet have been put down in this tick.

        Parameters
        ----------
        landed : array of bool, shape (legs,)
            The feet.
        """
        self.rest = np.where(landed, self._new_rest, self.rest)
        counts, self._old_step = landed & ~self._old_step, self._old_step & ~landed
        self.stepped = self.stepped | counts
        self.bounds = np.where(counts[:, None], self._landing, self.bounds)
        self._make_room()

    def tighten(self, limits: VelocityLimits) -> None:
        """Keep within further limits too.

        Parameters
        ----------
        limits : VelocityLimits
            The limits.
        """
        self.way = self.way.intersection(limits)
        self.bounds = self._landing = np.minimum(self.bounds, limits.bounds)
        self._make_room()

    def arrive(self, limits: VelocityLimits) -> None:
        """Go over to the limits of the stand that has been reached.

        Parameters
        ----------
        limits : VelocityLimits
            The limits.
        """
        self.way, self.bounds, self._landing = limits, limits.bounds, limits.bounds
        self._make_room()
