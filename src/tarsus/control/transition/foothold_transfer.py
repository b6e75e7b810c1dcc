"""The workspace and the rest foothold of each foot while the robot transfers from one stance to another."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.transition.stance_transition import StanceTransition
from tarsus.control.walk.state import POSITION_TOLERANCE
from tarsus.gait.foot_polygons import NORMALS_CONJUGATE, polygon_margin
from tarsus.gait.stance.velocity_limits import VelocityLimits

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Float

__all__ = ["FootholdTransfer"]


class FootholdTransfer:
    """Workspace polygons and rest footholds, leg by leg: each leg transfers to new ones with its next step.

    Parameters
    ----------
    transition : StanceTransition
        The stance at the start.

    Attributes
    ----------
    limits : VelocityLimits
        Limits of the twist.
    bounds : array, shape (legs, 16)
        Sides of the polygons in which standing feet have to stay [m].
    rest : complex array, shape (legs,)
        Where each foot rests, or will be put down, in the heading frame [m].
    new_rest : complex array, shape (legs,)
        The rest footholds once all feet are transferred [m].
    placement_bounds : array, shape (legs, 16)
        Greatest distance from its rest foothold at which each foot may be put down next, along each side's normal [m].
    placement_radii : list of float
        The least of these distances of each foot [m].
    transferred : array of bool, shape (legs,)
        Which feet stand at their new rest footholds.
    """

    def __init__(self, transition: StanceTransition) -> None:
        self.new_rest = self._level_rest = transition.rest
        self._shift, self._sides_shift = np.zeros_like(self.new_rest), np.zeros_like(transition.final_limits.bounds)
        self.transferred = np.ones(len(self.new_rest), dtype=bool)
        self._lands_at_old = ~self.transferred
        self.complete(transition.final_limits)

    def complete(self, limits: VelocityLimits) -> None:
        """Switch to the limits of the stance that has been reached."""
        self.limits, self.bounds, self._next_bounds = limits, limits.bounds, limits.bounds
        self._update_placement()

    def _update_placement(self) -> None:
        landing = np.where(self._lands_at_old[:, None], self.bounds, self._next_bounds)
        self.placement_bounds: Float[np.ndarray, "legs 16"] = polygon_margin(landing, self._level_rest).clip(0.0)
        self.placement_radii: list[float] = self.placement_bounds.min(axis=1).tolist()
        self.rest: Complex[np.ndarray, "legs"] = self._level_rest + self._shift

    def shift(self, shift: Complex[np.ndarray, "legs"]) -> None:
        """Shift rest footholds and polygons as the ground requires; stances are planned without this shift [m]."""
        if shift is not self._shift:
            self._shift, self.rest = shift, self._level_rest + shift
            self._sides_shift = (NORMALS_CONJUGATE * shift[:, None]).real

    def shifted(self, bounds: Float[np.ndarray, "legs 16"]) -> Float[np.ndarray, "legs 16"]:
        """Return sides of polygons, shifted with the rest footholds [m]."""
        return np.asarray(bounds + self._sides_shift)

    def bounds_with(self, transition: StanceTransition) -> Float[np.ndarray, "legs 16"]:
        """Return the polygons' sides with which the feet would start to transfer if the transition began now [m]."""
        moved = self._moved(transition)
        return np.where(moved[:, None], self.bounds, np.minimum(self.bounds, transition.stepping_limits.bounds))

    def _moved(self, transition: StanceTransition) -> Bool[np.ndarray, "legs"]:
        return np.asarray(np.abs(transition.rest - self.new_rest) > POSITION_TOLERANCE)

    def begin(self, transition: StanceTransition, down: Bool[np.ndarray, "legs"]) -> None:
        """Begin to transfer the feet to new rest footholds; `down` tells which feet are on the ground."""
        self.limits = self.limits.intersection(transition.stepping_limits)
        moved = self._moved(transition)
        self.bounds = self.bounds_with(transition)
        self.transferred = ~moved
        # A foot in the air still lands at the foothold that it swings to; only its next step transfers it.
        self._lands_at_old = moved & ~down
        self._level_rest = np.where(self._lands_at_old, self._level_rest, transition.rest)
        self._next_bounds, self.new_rest = transition.stepping_limits.bounds, transition.rest
        self._update_placement()

    def feet_landed(self, before: Bool[np.ndarray, "legs"], down: Bool[np.ndarray, "legs"]) -> None:
        """Take note of the feet that have landed: those that are on the ground, and were not before."""
        if down is before or (self.bounds is self._next_bounds and self.transferred.all()):
            return
        landed = down & ~before
        self._level_rest = np.where(landed, self.new_rest, self._level_rest)
        counts, self._lands_at_old = landed & ~self._lands_at_old, self._lands_at_old & ~landed
        self.transferred = self.transferred | counts
        self.bounds = np.where(counts[:, None], self._next_bounds, self.bounds)
        self._update_placement()

    def restrict(self, limits: VelocityLimits) -> None:
        """Restrict the feet to further limits as well."""
        self.limits = self.limits.intersection(limits)
        self.bounds = self._next_bounds = np.minimum(self.bounds, limits.bounds)
        self._update_placement()
