"""Obstacles: feet that are stopped on their way try again, swung out, then beside it, and are put down before it."""

from __future__ import annotations

import math

from tarsus.control.limiter.protocol import leads_towards

__all__ = ["Obstacles"]

# How often a foot is stopped until it goes beside its way, on how many sides, how far, and how far back before [m].
_STOPS, _SIDES, _BESIDE, _BEFORE = 3, 2, 0.06, 0.04
# A way below which it has no direction [m].
_NO_WAY = 1e-9


class Obstacles:
    """Decides where feet try next that are stopped on their way.

    Parameters
    ----------
    scale : float
        By how much lengths are smaller than given, on short legs, 0 to 1.

    Attributes
    ----------
    found : complex
        The direction of the obstacle that no foot got past; 0 without one.
    stops : dict of int to (int, complex, complex)
        By leg, how often its foot was stopped, where first, and where it was to go, in the heading frame [m].
    goals : dict of int to complex
        By leg, where its foot goes on to from beside its way, in the heading frame [m].
    """

    def __init__(self, scale: float) -> None:
        self.found, self._scale = 0j, scale
        self.stops = dict[int, tuple[int, complex, complex]]()
        self.goals = dict[int, complex]()

    def tries(self, leg: int) -> bool:
        """Return whether a foot is to get past an obstacle, and is not put down before it."""
        return leg in self.stops and self.stops[leg][0] <= _STOPS + _SIDES

    def leaves(self, way: complex) -> bool:
        """Return whether a way of a foot, in the heading frame, leads away from the obstacle that was found."""
        return (way * self.found.conjugate()).real < 0.0

    def stopped(self, leg: int, foot: complex, goal: complex, bow: complex) -> tuple[complex, complex]:
        """Decide where a foot tries next that is stopped here on its way to a goal.

        Parameters
        ----------
        leg : int
            The leg.
        foot, goal : complex
            Where the foot is, and where it was to go, in the heading frame [m].
        bow : complex
            How far the foot may swing out: there the leg reaches higher [m].

        Returns
        -------
        start, place : complex
            Where it is drawn back to; where it goes from there, the same place if it was stopped too often [m].
        """
        stops, start, goal = self.stops.get(leg, (1, foot, goal))
        self.stops[leg], way = (stops + 1, start, goal), goal - start
        way /= max(abs(way), _NO_WAY)
        start -= self._scale * _BEFORE * way
        self.goals.pop(leg, None)
        if stops >= _STOPS + _SIDES:
            self.found = way
            return start, start
        if stops < _STOPS and not bow:
            return start, goal
        side = bow
        if stops >= _STOPS:
            # Towards the body first: there the leg is steeper.
            inwards = -(start * way.conjugate()).imag * (-1) ** (stops - _STOPS)
            side = 1j * way * math.copysign(self._scale * _BESIDE, inwards)
        self.goals[leg] = goal + side
        return start, start + side

    def led_away(self, velocity: complex) -> list[int]:
        """Return the legs with feet that try to get past an obstacle, where a twist leads back on their way."""
        back = {leg: start - goal for leg, (_, start, goal) in self.stops.items() if self.tries(leg)}
        return [leg for leg, way in back.items() if leads_towards(velocity, way)]

    def forget(self, leg: int) -> None:
        """Forget that a foot was stopped."""
        self.stops.pop(leg, None)
        self.goals.pop(leg, None)
