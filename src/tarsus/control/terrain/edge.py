"""Edge: the direction in which the ground ends, as the feet that find none tell it."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from tarsus.control.limiter.protocol import leads_towards

__all__ = ["FORGETS", "Edge", "direction"]

FORGETS = 6.0
"""Time without holes after which it is forgotten which edge the robot has left [s]."""

# A robot that walks faster has met the edge on the way of its foot [m/s].
_MOVES = 0.005
# A foot this far from its rest foothold is on that side of it [m].
_OFF = 0.01


class Edge:
    """Keeps the directions of the edge that the robot has met, and of the one that it has left.

    All are in the heading frame, and turn back as that turns.

    Parameters
    ----------
    scale : float
        By how much speeds are smaller than given, on short legs, 0 to 1.

    Attributes
    ----------
    way, left : complex
        Directions of the edge that feet have met, and of the one that the robot leaves; 0 without one.
    since : float
        Time without feet over holes [s].
    twist : sequence of float
        The twist before any foot searched, by which it has met the edge [m/s, m/s, rad/s].
    """

    def __init__(self, scale: float) -> None:
        self._scale = scale
        self.way, self.left, self.since, self._yaw = 0j, 0j, 0.0, 0.0
        self.twist: Sequence[float] = (0.0, 0.0, 0.0)

    @property
    def _moves(self) -> bool:
        return math.hypot(*self.twist[:2]) > self._scale * _MOVES

    @property
    def turns(self) -> bool:
        """Whether the robot has turned on the spot as it met the edge."""
        return bool(self.twist[2]) and not self._moves

    def along(self, place: complex) -> float:
        """Return how far a place in the heading frame is towards the edge that feet have met [m]."""
        return (place * self.way.conjugate()).real

    def turn_to(self, yaw: float) -> complex:
        """Take the direction of the heading frame [rad]; return what directions in it are to be multiplied by."""
        turn, self._yaw = cmath.exp(1j * (self._yaw - yaw)), yaw
        self.way, self.left = self.way * turn, self.left * turn
        return turn

    def leave(self, obstacle: complex) -> None:
        """Remember the edge as the one that the robot leaves, unless it is the direction of an obstacle."""
        self.left = 0j if self.way == obstacle else self.way
        self.way, self.since = 0j, 0.0

    def seen_from(self, foot: complex, rest: complex) -> complex:
        """Return the direction of the edge at a foot.

        It is that of the foot's way over the ground, or that from its rest foothold if it stood.

        Parameters
        ----------
        foot, rest : complex
            The foot and its rest foothold, in the heading frame [m].
        """
        moves, velocity = self._moves, complex(*self.twist[:2]) + 1j * self.twist[2] * rest
        if self.left and self.since < FORGETS and (not moves or leads_towards(-velocity, self.left)):
            return self.left
        if moves:
            way = velocity / abs(velocity)
            # The edge at a foot behind the body on its way is one that the robot leaves.
            return -way if leads_towards(rest, -way) else way
        # A foot that has stepped back from an edge is on the other side of its rest foothold.
        if leads_towards(rest, self.way):
            return self.way
        # The feet of a robot that turns move along the edge as well as over it.
        return rest / abs(rest) if self.turns else direction(foot - rest, rest)


def direction(off: complex, rest: complex) -> complex:
    """Return the direction of a foot from its rest foothold, or of that from the body where it is there.

    Parameters
    ----------
    off, rest : complex
        The foot from its rest foothold; the rest foothold, in the heading frame [m].
    """
    return off / abs(off) if abs(off) > _OFF else rest / abs(rest)
