"""Tipping: a foot at which the robot sinks, though it seems to bear load."""

from __future__ import annotations

from collections.abc import Sequence

from tarsus.control.contact.footing import Footing, sunk_at
from tarsus.control.readings import RollPitch

__all__ = ["Sinking", "Tipping"]

# Where contacts are estimated: least sinking of the body at a foot at which it tips [m], from the mean tilt over a time
# [s]; least depth of that foot below the expected ground [m]; time of tipping after which there is an edge [s]; time of
# the mean tilt while the robot tips: a body that stays tilted settles in it [s].
_SINKS, _FOLLOWED, _LOW, _LASTS, _SETTLES = 0.015, 0.6, 0.008, 0.2, 2.0
# A loaded foot slides over an edge once it has sunk against the others by more than the sum of a length [m], so many
# times the usual change between two looks, initially the third value [m], and a share of how much deeper ground may be;
# sinking speed up to which feet only roll, or slip on slopes [m/s]; rate at which the usual change is learnt [1/s].
_SLIDES, _TIMES, _AT_FIRST, _DEEPER, _ROLLS, _LEARNT = 0.003, 4.0, 0.01, 0.5, 0.02, 3.0


class Tipping:
    """Finds the foot at which a robot tips, where contacts are estimated.

    A leg whose shin rests on an edge bears load like one whose foot stands. But the body sinks there, faster than
    slopes tilt it, and farther than at a foot that stands.

    Parameters
    ----------
    scale : float
        Factor by which lengths are reduced on short legs, 0 to 1.

    Attributes
    ----------
    leg : int or None
        The leg at whose foot the robot tips; None where it does not.
    """

    def __init__(self, scale: float) -> None:
        self.leg: int | None = None
        self._scale, self._since = scale, 0.0
        self._before: RollPitch | None = None

    @property
    def at_edge(self) -> bool:
        """Whether the robot has tipped at the leg's foot for long enough to have met an edge."""
        return self.leg is not None and self._since > _LASTS

    def step(self, footing: Footing, depths: Sequence[float], tilt: RollPitch | None, dt: float) -> None:
        """Take in the tilt.

        Parameters
        ----------
        footing, depths : Footing, sequence of float
            The feet that should stand; how far below the expected ground they are [m].
        tilt, dt : (roll, pitch) or None, float
            By how much the body is tilted more than commanded, None where it is not measured [rad]; time since the last
            call [s].
        """
        self._since = (self._since + dt) * (self.leg is not None)
        if tilt is None:
            self.leg = self._before = None
            return
        follows = _FOLLOWED if self.leg is None else _SETTLES
        share, (roll, pitch) = min(dt / follows, 1.0), self._before or tilt
        self._before = roll, pitch = roll + share * (tilt[0] - roll), pitch + share * (tilt[1] - pitch)
        sunk = [sunk_at(place, tilt, self._before) for place in footing.places]
        low = [leg for leg, on in enumerate(footing.down) if on and depths[leg] > self._scale * _LOW]
        least = self._scale * (_SINKS if self.leg is None else _SINKS / 2)
        leg = max(low, key=sunk.__getitem__, default=None) if self.leg is None else self.leg
        self.leg = leg if leg is not None and sunk[leg] > least else None


class Sinking:
    """Finds a foot that bears load and sinks against the others: it slides over an edge with its switch still closed.

    Parameters
    ----------
    scale : float
        Factor by which lengths are reduced on short legs, 0 to 1.
    """

    def __init__(self, scale: float) -> None:
        self._scale, self._usual = scale, _AT_FIRST
        # Height of each foot over the mean of the others, and the greatest one since the same feet have borne load [m].
        self._over, self._highest = dict[int, float](), dict[int, float]()

    def step(self, heights: dict[int, float], footing: Footing, dt: float, *, deeper: float) -> int | None:
        """Return the leg of a foot that sinks while the others alone do not hold the robot; None without one.

        Parameters
        ----------
        heights : dict of int to float
            Heights of the feet that bear load, by leg, along gravity [m].
        footing, dt, deeper : Footing, float, float
            The feet; time since the last call [s]; how much deeper ground may be than expected [m].
        """
        others, total, before = max(len(heights) - 1, 1), sum(heights.values()), self._over
        self._over = over = {leg: height - (total - height) / others for leg, height in heights.items()}
        if over.keys() != before.keys() or len(over) < 3:
            self._highest = over
            return None
        change = sum(abs(over[leg] - before[leg]) for leg in over) / len(over)
        self._highest = {leg: max(high - _ROLLS * dt, over[leg]) for leg, high in self._highest.items()}
        leg = max(over, key=lambda leg: self._highest[leg] - over[leg])
        most = self._scale * _SLIDES + _TIMES * self._usual + _DEEPER * deeper
        if self._highest[leg] - over[leg] > most:
            return None if footing.held_by([other for other in over if other != leg]) else leg
        self._usual += min(_LEARNT * dt, 1.0) * (change - self._usual)
        return None
