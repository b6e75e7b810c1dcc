"""Posture feedback: two slow loops move all standing feet at once, for the height of the body and for its tilt."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple, TypeAlias

from tarsus.control.readings import RollPitch
from tarsus.errors import InputError
from tarsus.gait.foot_plane import FootPlane

__all__ = ["BodyMove", "Levelling", "PostureFeedback", "PostureRates"]

Levelling: TypeAlias = Literal["level", "between", "follow"]
"""The attitude to keep: level, halfway between level and the slope, or along the slope."""

# Share of the slope that the body follows.
_SHARES = {"level": 0.0, "between": 0.5, "follow": 1.0}
# Height: gain [1/s] and greatest rate [m/s]. Tilt: gain [1/s], greatest rate [rad/s], gain without measured attitude.
_HEIGHT_GAIN, _MOST_CLIMB = 2.5, 0.1
_TILT_GAIN, _MOST_TURN, _UNMEASURED_GAIN = 6.0, 0.3, 0.5
# Gain and greatest rate of the tilt fall to this share where the walk waits, as the body would follow feet into holes,
# and on slopes, as feet that are moved under load slip; slopes between which they fall [m/m].
_SLOW, _SLOPES = 1 / 3, (0.14, 0.24)
# Greatest speed at which a foot may approach the end of its reach, over its distance from there [1/s].
_BARRIER = 8.0
# Climb [m/s] and turn [rad/s] below which a standing body comes to rest; those above which it moves again.
_RESTS, _MOVES = (0.01, 0.06), (0.05, 0.18)
# How fast the height to keep rises and falls [m/s]; how far it may be below the commanded height, over that height.
_RAISING, _LOWERING, _MOST_LOWER = 0.08, 0.2, 0.25

# Least and greatest heights of all feet [m]; the same for one set of footholds after the other.
_Ranges: TypeAlias = tuple[Sequence[float], Sequence[float]]
_Rises: TypeAlias = Sequence[_Ranges]


class BodyMove(NamedTuple):
    """What the body does over its standing feet.

    Attributes
    ----------
    velocity : complex
        Velocity of the body [m/s].
    feet : sequence of (complex, float)
        The standing feet, at least one: place x + iy in the heading frame, and how much lower each could be [m].
    stands : bool
        Whether the body is to stand still: feet that are moved under their load slide down a slope.
    pace : float
        Rate of the walk, 0 to 1: where it waits for feet that look for the ground, the body turns more slowly.
    """

    velocity: complex
    feet: Sequence[tuple[complex, float]]
    stands: bool = False
    pace: float = 1.0


class PostureRates(NamedTuple):
    """How the body is to move over its standing feet; by default it does not.

    Attributes
    ----------
    climb : float
        Upward speed [m/s].
    turn : tuple of float
        Angular velocity of the feet about the body, along x and y of the heading frame [rad/s].
    """

    climb: float = 0.0
    turn: tuple[float, float] = (0.0, 0.0)


class PostureFeedback:
    """Keeps the body at its height over the feet, and level, along the slope or between.

    Parameters
    ----------
    levelling, scale : "level", "between", "follow" or None, float
        The attitude to keep, None to make no use of the measured one; factor by which speeds are reduced on short legs,
        0 to 1.

    Attributes
    ----------
    raised : float
        How much higher over the ground than commanded the body is to be [m].
    given_way : float
        Share of the slope that the body has to follow, as a level body lacks clearance or its legs reach, 0 to 1.
    kept : float
        Share of a measured tilt that is corrected, 0 to 1.

    Raises
    ------
    InputError
        If `levelling` is anything else.
    """

    def __init__(self, levelling: Levelling | None, *, scale: float = 1.0) -> None:
        if levelling is not None and levelling not in _SHARES:
            raise InputError(f"levelling is {levelling!r}; it must be None or one of {', '.join(_SHARES)}")
        self._scale = scale
        self._share = None if levelling is None else _SHARES[levelling]
        self.raised = self.given_way = 0.0
        self.kept = 0.0 if self._share is None else 1 - self._share
        self._rests = False

    def fit_to_reach(
        self, rises: _Rises, raises: tuple[float, float], dt: float, *, reach: _Ranges, height: float, share: float
    ) -> None:
        """Change the height to keep towards the one at which all legs reach the plane of the feet.

        Parameters
        ----------
        rises : sequence of (sequence of float, sequence of float)
            Least and greatest height of each foot over the plane's height at the origin [m]; those at the next
            footholds, where these are known, before those of now: no foot is taken off the ground for them.
        raises : tuple of float
            Least and wanted rise of the body above its commanded height [m].
        dt, reach : float, tuple of sequence of float
            Length of the tick [s]; least and greatest height of each foot [m].
        height, share : float
            Commanded height of the body [m]; share of the slope that a level body has reach and clearance for, 0 to 1.
        """
        wanted = raises[1]
        for least, most in (_heights(feet, reach, raises[0]) for feet in rises):
            wanted = max(min(wanted, most), least) if most >= least else (most + least) / 2
        wanted = max(wanted, -_MOST_LOWER * height)
        self.given_way = 1 - share
        most = self._scale * dt
        self.raised += min(max(wanted - self.raised, -_LOWERING * most), _RAISING * most)

    def rates(self, plane: FootPlane, tilt: RollPitch | None, move: BodyMove) -> PostureRates:
        """Return how the body is to climb and to turn.

        Parameters
        ----------
        plane : FootPlane
            The plane of the standing feet, in the heading frame.
        tilt : (roll, pitch) or None
            By how much the body is tilted more than commanded [rad]; None where it is not measured.
        move : BodyMove
            What the body does.
        """
        (velocity, feet, stands, pace), fastest = move, self._scale * _MOST_CLIMB
        climb = min(max(_HEIGHT_GAIN * (plane.height + self.raised), -fastest), fastest)
        climb += plane.slope_x * velocity.real + plane.slope_y * velocity.imag
        # Level ground looks sloped from a tilted body: the lesser slope counts.
        slope = min(math.hypot(seen.slope_x, seen.slope_y) for seen in (plane, plane.levelled(tilt)))
        even = (_SLOPES[1] - slope) / (_SLOPES[1] - _SLOPES[0])
        quick = _SLOW + (1 - _SLOW) * min(pace, max(even, 0.0))
        along = (-math.atan(plane.slope_y), math.atan(plane.slope_x))
        if tilt is None or self._share is None:
            turn = [_UNMEASURED_GAIN * angle for angle in along]
        else:
            share = max(self._share, self.given_way)
            turn = [quick * _TILT_GAIN * ((1 - share) * a + share * b) for a, b in zip(tilt, along, strict=True)]
        fastest_turn = quick * _MOST_TURN
        roll, pitch = (min(max(rate, -fastest_turn), fastest_turn) for rate in turn)
        # The nearer a foot is to the end of its reach, the more slowly it may approach that.
        sinks = [(pitch * place.real - roll * place.imag, _BARRIER * margin) for place, margin in feet]
        share = 1.0
        for sink, fastest_sink in sinks:
            if sink > 0.0 and fastest_sink < share * sink:
                share = max(fastest_sink, 0.0) / sink
        roll, pitch = share * roll, share * pitch
        climb = max(min(climb, *(fastest_sink - share * sink for sink, fastest_sink in sinks)), -2 * fastest)
        most = _MOVES if self._rests else _RESTS
        self._rests = stands and abs(climb) < most[0] and math.hypot(roll, pitch) < quick * most[1]
        return PostureRates() if self._rests else PostureRates(climb, (roll, pitch))


def _heights(rises: _Ranges, reach: _Ranges, least: float) -> tuple[float, float]:
    """Return the least and greatest rise of the body, not below `least`, that keeps all feet within reach [m]."""
    most = min(rise - low for low, rise in zip(reach[0], rises[0], strict=True))
    return max(least, *(rise - high for high, rise in zip(reach[1], rises[1], strict=True))), most
