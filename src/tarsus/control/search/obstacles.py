"""Obstacles: a foot that is stopped tries again, swung out, then beside its way, and is at last put down before it."""

from __future__ import annotations

import math

from tarsus.control.limiter.protocol import leads_towards

__all__ = ["Obstacles"]

# From which stop on, after the first collision, a foot tries beside its way; on how many sides, and how far beside [m];
# how far behind the place of its first stop it starts again [m].
_STOPS, _SIDES, _BESIDE, _BEFORE = 3, 2, 0.06, 0.04


class Obstacles:
    """Decides where a foot that is stopped on its way tries next.

    Parameters
    ----------
    scale : float
        Factor by which lengths are reduced on short legs, 0 to 1.

    Attributes
    ----------
    found : complex
        Direction of the obstacle that a foot has failed to get past; 0 without one.
    stops : dict of int to (int, complex, complex)
        By leg, the number of its stops, the first collision included; where the foot was at the first stop after that;
        its goal; places in the heading frame [m].
    goals : dict of int to complex
        By leg, where its foot goes once it is beside its way, in the heading frame [m].
    """

    def __init__(self, scale: float) -> None:
        self.found, self._scale = 0j, scale
        self.stops = dict[int, tuple[int, complex, complex]]()
        self.goals = dict[int, complex]()

    def tries(self, leg: int) -> bool:
        """Return whether a foot still tries to get past an obstacle, rather than being put down before it."""
        return leg in self.stops and self.stops[leg][0] <= _STOPS + _SIDES

    def leaves(self, way: complex) -> bool:
        """Return whether a foot's way, in the heading frame, leads away from the obstacle that was found."""
        return (way * self.found.conjugate()).real < 0.0

    def stopped(self, leg: int, foot: complex, goal: complex, bow: complex) -> tuple[complex, complex]:
        """Decide where a foot that is stopped on its way to a goal tries next.

        Parameters
        ----------
        leg : int
            The leg.
        foot, goal : complex
            Where the foot is, and where it was to go, in the heading frame [m].
        bow : complex
            How far the foot may swing out, to where the leg reaches higher, in the heading frame [m].

        Returns
        -------
        start, place : complex
            Where the foot is drawn back to; where it goes from there: the same place after too many stops [m].
        """
        stops, start, goal = self.stops.get(leg, (1, foot, goal))
        self.stops[leg], way = (stops + 1, start, goal), goal - start
        way /= max(abs(way), 1e-9)
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
        """Return the legs whose feet try to get past an obstacle while the velocity leads back along their way."""
        back = {leg: start - goal for leg, (_, start, goal) in self.stops.items() if self.tries(leg)}
        return [leg for leg, way in back.items() if leads_towards(velocity, way)]
