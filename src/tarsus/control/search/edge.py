"""Edge: the direction in which the ground ends, inferred from feet that find none."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from tarsus.control.limiter.protocol import leads_towards
from tarsus.control.terrain.ground_map import GroundMap

__all__ = ["FORGETS", "Edge", "direction"]

FORGETS = 6.0
"""Time without a foot over a hole after which the edge that the robot has left is forgotten [s]."""

# Speed above which the robot has met the edge in the direction in which the foot moved [m/s].
_MOVES = 0.005
# Offset of a foot from its rest foothold above which it tells the direction of the edge [m].
_OFF = 0.01
# Time after which ground that was seen to be a hole and is not any more counts as solid [s].
_SOLID = 1.0


class Edge:
    """Keeps the direction of the edge that the robot has met, and that of the edge that it has left.

    All directions are in the heading frame, and are turned as that turns, so that they stay fixed to the ground.

    Parameters
    ----------
    scale : float
        Factor by which speeds are reduced on short legs, 0 to 1.

    Attributes
    ----------
    way, left : complex
        Direction of the edge that feet have met, and of the edge that the robot leaves; 0 without one.
    since : float
        Time without a foot over a hole [s]; starts again when the robot leaves an edge.
    hole : complex or None
        Place of a hole that was seen, not felt, in the heading frame [m]; None without one.
    twist : sequence of float
        The last twist before a foot searched for the ground, with which the robot met the edge [m/s, m/s, rad/s].
    """

    def __init__(self, scale: float) -> None:
        self._scale = scale
        self.way, self.left, self.since, self._yaw = 0j, 0j, 0.0, 0.0
        self.hole: complex | None = None
        self._solid = 0.0
        self.twist: Sequence[float] = (0.0, 0.0, 0.0)

    @property
    def _moves(self) -> bool:
        return math.hypot(*self.twist[:2]) > self._scale * _MOVES

    @property
    def turns(self) -> bool:
        """Whether the robot was turning on the spot when it met the edge."""
        return bool(self.twist[2]) and not self._moves

    def along(self, place: complex) -> float:
        """Return how far a place in the heading frame is along the direction of the edge that feet have met [m]."""
        return (place * self.way.conjugate()).real

    def turn_to(self, yaw: float) -> complex:
        """Take the yaw of the heading frame [rad]; return the factor that keeps directions fixed to the ground."""
        turn, self._yaw = cmath.exp(1j * (self._yaw - yaw)), yaw
        self.way, self.left, self.hole = self.way * turn, self.left * turn, self.hole and self.hole * turn
        return turn

    def look_again(self, ground: GroundMap, dt: float) -> None:
        """Forget an edge at a hole that was seen, once it has been solid ground for a time; `dt` in [s]."""
        self._solid = (self._solid + dt) * (self.hole is not None and not ground.is_hole(self.hole))
        if self._solid > _SOLID:
            self.leave(self.way)

    def leave(self, obstacle: complex) -> None:
        """Remember the edge as the one that the robot leaves, unless its direction is that of an obstacle."""
        self.left = 0j if self.way == obstacle else self.way
        self.way, self.since, self.hole = 0j, 0.0, None

    def seen_from(self, foot: complex, rest: complex) -> complex:
        """Return the direction of the edge at a foot.

        For a robot that walked, it is the direction in which the foot moved over the ground; for one that stood, that
        of the known edge on the foot's side, or else that of the foot from its rest foothold. An edge that the robot
        has just left comes first, unless it walks in another direction than away from that.

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
            # A foot behind the body, as seen along the way, is at an edge that the robot leaves.
            return -way if leads_towards(rest, -way) else way
        # A foot that has stepped back is off its rest foothold to the side away from the edge.
        if leads_towards(rest, self.way):
            return self.way
        # Feet of a robot that turns move along the edge as well as over it, so only their place tells its direction.
        return rest / abs(rest) if self.turns else direction(foot - rest, rest)


def direction(off: complex, rest: complex) -> complex:
    """Return the direction of a foot from its rest foothold; where it is at that, of the rest foothold from the body.

    Parameters
    ----------
    off, rest : complex
        Offset of the foot from its rest foothold; the rest foothold; both in the heading frame [m].
    """
    return off / abs(off) if abs(off) > _OFF else rest / abs(rest)
