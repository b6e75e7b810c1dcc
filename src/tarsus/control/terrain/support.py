"""Support: whether the feet that bear load hold the robot, and how fast the walk may go on."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import NamedTuple

from tarsus.control.readings import RollPitch
from tarsus.control.walk.state import GaitState

__all__ = ["HALTING", "Footing", "Support", "Tipping", "along_gravity", "holds", "off_commanded", "sunk_at"]

# Rates at which the pace falls and rises [1/s].
_FALL, _RISE = 10.0, 6.0
# Fraction of a swing time over which the pace falls to 0 while feet that are due have to wait.
_PATIENCE = 0.3
# Time without support after which the pace falls, and over which it falls to 0; a third of it before feet that wait
# slow the walk [s].
_GRACE = 0.15
# Time of waiting after which feet in the air are put down: they may hang, as the walk no longer lowers them [s].
_PUTS_DOWN = 1.0
# Margin of a centre of mass inside the support polygon: it sees neighbouring feet less than pi apart, by this [rad].
_LEAST_ANGLE = 0.02
# Where contacts are estimated: least sinking of the body at a foot at which it tips [m], from the mean tilt over a time
# [s]; least depth of that foot below the expected ground [m]; time of tipping after which there is an edge [s]; time of
# the mean tilt while the robot tips: a body that stays tilted settles in it [s].
_SINKS, _FOLLOWED, _LOW, _LASTS, _SETTLES = 0.015, 0.6, 0.008, 0.2, 2.0
# A loaded foot slides over an edge once it has sunk against the others by more than the sum of a length [m], so many
# times the usual change between two looks, initially the third value [m], and a share of how much deeper ground may be;
# sinking speed up to which feet only roll, or slip on slopes [m/s]; rate at which the usual change is learnt [1/s].
_SLIDES, _TIMES, _AT_FIRST, _DEEPER, _ROLLS, _LEARNT = 0.003, 4.0, 0.01, 0.5, 0.02, 3.0
# Speed at which the body shifts over feet that do not hold it yet [m/s]; how far it shifts at most [m].
_SHIFTS, _FARTHEST = 0.05, 0.08
HALTING = 0.5
"""Below this pace the robot waits for support."""


class Footing(NamedTuple):
    """Feet and body of a walk in a tick, in the heading frame.

    Attributes
    ----------
    places : list of complex
        Where the feet are, x + iy [m].
    down : list of bool
        Which feet should stand.
    centre : complex
        Where the centre of mass is above the feet, along gravity [m].
    height : float
        Commanded height of the body [m].
    """

    places: list[complex]
    down: list[bool]
    centre: complex
    height: float


def holds(feet: Sequence[complex], centre: complex) -> bool:
    """Return whether a point is inside the support polygon of feet, by a small margin; x + iy [m]."""
    angles = sorted(cmath.phase(foot - centre) for foot in feet)
    if len(angles) < 3:
        return False
    gaps = [after - before for before, after in zip(angles, [*angles[1:], angles[0] + math.tau], strict=True)]
    return max(gaps) < math.pi - _LEAST_ANGLE


def along_gravity(centre: complex, posture: Sequence[float], tilt: RollPitch) -> complex:
    """Return where a point of the body is above its feet along gravity, x + iy in the heading frame [m].

    Parameters
    ----------
    centre, posture : complex, (x, y, z, roll, pitch, yaw, swing height)
        The point in the body's frame; posture of the body, z over the feet [m], [rad].
    tilt : (roll, pitch)
        By how much the body is tilted more than commanded [rad].
    """
    (x, y, height, _, _, yaw, _), (roll, pitch) = posture, tilt
    return centre * cmath.exp(1j * yaw) + complex(x + height * math.tan(pitch), y - height * math.tan(roll))


def off_commanded(attitude: RollPitch, state: GaitState) -> RollPitch:
    """Return by how much a body is tilted more than commanded, about the axes of the heading frame [rad].

    Parameters
    ----------
    attitude, state : (roll, pitch), GaitState
        Measured roll and pitch, about the body's axes [rad]; the gait state.
    """
    roll, pitch, yaw = state.moved_posture[3:6].tolist()
    off = complex(attitude[0] - roll, attitude[1] - pitch) * cmath.exp(1j * yaw)
    return off.real, off.imag


def sunk_at(place: complex, tilt: RollPitch, before: RollPitch = (0.0, 0.0)) -> float:
    """Return how far a body has sunk at a place by a change of its tilt [m].

    Parameters
    ----------
    place : complex
        The place, x + iy in the heading frame [m].
    tilt, before : (roll, pitch)
        The tilt, and the one before [rad].
    """
    return place.real * (tilt[1] - before[1]) - place.imag * (tilt[0] - before[0])


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
            left = [footing.places[other] for other in over if other != leg]
            return None if holds(left, footing.centre) else leg
        self._usual += min(_LEARNT * dt, 1.0) * (change - self._usual)
        return None


class Support:
    """Decides whether feet may lift off, and at which pace the walk goes on.

    Attributes
    ----------
    pace : float
        Rate of steps and twist, 0 to 1.
    waits, held : bool
        Whether feet that are due stay on the ground; whether the feet that bear load hold the robot.
    shift : complex
        Velocity of the body over its feet, in the heading frame [m/s].
    """

    def __init__(self) -> None:
        self.pace, self.waits = 1.0, False
        self._waited = self._unsupported = 0.0
        self._bearing, self.held = list[int](), False
        self.shift, self._shifted = 0j, 0.0

    @property
    def halts(self) -> bool:
        """Whether the robot waits until its feet hold it."""
        return self.pace < HALTING

    def puts_down(self, *, refuses: bool) -> bool:
        """Return whether a robot that waits has to put down feet in the air: at once where the motion is refused."""
        return self.halts and (refuses or max(self._waited, self._unsupported) > _PUTS_DOWN)

    def holds(self, legs: list[int], footing: Footing, *, anew: bool) -> bool:
        """Return whether feet hold the robot; computed again only for other feet, or when asked to.

        Parameters
        ----------
        legs, footing, anew : list of int, Footing, bool
            Legs whose feet bear load; all feet; whether to compute it again for the same feet.
        """
        if anew or legs != self._bearing:
            self._bearing, self.held = legs, holds([footing.places[leg] for leg in legs], footing.centre)
        return self.held

    def shift_over(self, legs: list[int], footing: Footing, dt: float, *, scale: float) -> None:
        """Shift the body over feet that do not hold it yet: with all feet at rest, it would otherwise wait for ever.

        Parameters
        ----------
        legs, footing, dt : list of int, Footing, float
            Legs whose feet stay while others lift off, none for no shift; all feet; time since the last call [s].
        scale : float
            Factor by which lengths and speeds are reduced on short legs, 0 to 1.
        """
        self.shift, self._shifted = 0j, self._shifted * bool(legs)
        if legs and self.halts and self._shifted < scale * _FARTHEST:
            way = sum(footing.places[leg] for leg in legs) / len(legs) - footing.centre
            self.shift = scale * _SHIFTS * way / max(abs(way), 1e-9)
            self._shifted += abs(self.shift) * dt

    def step(self, *, stays: bool, lifts: bool, dt: float, swing_time: float, most: float = 1.0) -> None:
        """Decide for a tick.

        Parameters
        ----------
        stays : bool
            Whether the feet that bear load and are not due to lift off hold the robot.
        lifts, dt : bool, float
            Whether any foot is due to lift off; length of the tick [s].
        swing_time, most : float
            Duration of a swing [s]; the greatest pace.
        """
        self.waits = lifts and not stays
        self._waited = self._waited + dt if self.waits else 0.0
        self._unsupported = 0.0 if stays or lifts else self._unsupported + dt
        late = max((self._waited - _GRACE / 3) / (_PATIENCE * swing_time), (self._unsupported - _GRACE) / _GRACE)
        wanted = min(1 - min(max(late, 0.0), 1.0), most)
        self.pace += min(max(wanted - self.pace, -_FALL * dt), _RISE * dt)
