"""Lost time: how much the ground has cost, and how much faster than commanded the walk makes up for it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from tarsus.control.limiter.protocol import TwistGrant, TwistRequest

__all__ = ["LostTime"]

# Most lost time that is remembered, and the lost time from which the walk is as fast as it may be [s].
_MEMORY, _WHOLE = 3.0, 1.0
# The speed changes in this many steps only, as the limits are computed anew for each.
_STEPS = 4
# Cosine of the angle between two twists at and below which the new one leads elsewhere; lever arm at which turning
# counts as walking [m].
_ELSEWHERE, _OUT = 0.9, 0.2


class LostTime:
    """Asks for more than the commanded twist after the ground has delayed the walk, until the mean is as commanded.

    Parameters
    ----------
    most : float
        Greatest ratio of the speed to the commanded one, at least 1.
    rate : callable
        Returns the rate at which the ground lets the walk advance along a commanded twist: 1 at most, negative while
        the body backs off, None while the robot is carried.
    """

    def __init__(self, most: float, rate: Callable[[Sequence[float]], float | None]) -> None:
        self._most, self._rate, self._lost = most, rate, 0.0
        self._twist: tuple[float, ...] = (0.0, 0.0, 0.0)

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant, with a greater fraction as long as there is lost time to make up for."""
        twist, first = request.twist, self._twist
        square = _dot(twist, twist)
        # The command is compared with the one under which time was first lost, as small changes add up.
        if not self._lost or _dot(twist, first) <= _ELSEWHERE * math.sqrt(square * _dot(first, first)):
            self._twist, self._lost = twist, 0.0
        rate = self._rate(twist) if request.state.felt and square else None
        if rate is None:
            self._lost = 0.0
        elif self._lost or rate < 1.0:
            gained = max(_dot(request.state.twist.value.tolist(), twist) / square - 1, 0.0) * rate
            self._lost = min(max(self._lost + request.dt * (1 - rate - gained), 0.0), _MEMORY)
        share = round(_STEPS * min(self._lost / _WHOLE, 1.0)) / _STEPS
        return grant._replace(fraction=1 + share * (self._most - 1)) if share else grant


def _dot(twist: Sequence[float], other: Sequence[float]) -> float:
    """Return the inner product of two twists [m^2/s^2]."""
    return twist[0] * other[0] + twist[1] * other[1] + _OUT * _OUT * twist[2] * other[2]
