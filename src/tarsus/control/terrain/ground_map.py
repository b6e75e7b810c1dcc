"""Ground map: ground heights from a sensor, tied to the standing feet."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from statistics import median
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tarsus.control.readings import RollPitch, ValidReadings
from tarsus.control.terrain.reach import Reach
from tarsus.control.walk.state import GaitState
from tarsus.gait.foot_plane import FootPlane, fitted_plane
from tarsus.gait.ground_heights import GroundHeights, is_steep, lowest_near, on_way

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["GroundMap"]

# Where feet stand, and how high [m].
_Feet: TypeAlias = Sequence[tuple[complex, float]]

# How fast the slope of the plane follows the feet [1/s].
_SLOPE_RATE = 2.0
# Horizontal error of the known heights that is allowed for [m].
_OFF = 0.03
# Distance from a hole up to which a foothold counts as in it [m]: one farther away is preferred where there is any.
_EDGE = 0.012
# Downward slope above which low ground is behind an edge; down less steep ground, the robot walks until legs reach it.
_CLIFF = 1.2
# Clearance of the body over the ground [m].
_CLEAR = 0.015
# Points under the body, over half its length and width; they reach a little beyond its front and rear.
_UNDER = (np.linspace(-1.2, 1.2, 9)[:, None] + 1j * np.linspace(-1.0, 1.0, 5)).ravel()
# Places of a foot's next footholds ahead of its rest foothold, in strokes.
_NEXT = np.array([0.5, 1.0])


class GroundMap:
    """Keeps known heights in place on the ground; their level is tied to the standing feet again with each update.

    So nothing is dead-reckoned for longer than from one reading to the next. Places and heights that are asked for are
    in the heading frame; where nothing is known, the ground is the plane of the standing feet.

    Parameters
    ----------
    scale : float
        Factor by which lengths are reduced on short legs, 0 to 1.

    Attributes
    ----------
    plane : FootPlane
        The plane through the standing feet.
    given : bool
        Whether any heights are known.
    deepest : float
        How far below the plane of the feet ground may be that they step on [m].
    """

    def __init__(self, *, scale: float = 1.0) -> None:
        self._scale = scale
        self.plane, self.given, self.deepest = FootPlane(), False, math.inf
        self._seen: GroundHeights | None = None
        # Middle of the grid and its x axis, in G.
        self._middle, self._axis = 0j, 1 + 0j
        # The heading frame: its origin and x axis in G, its inclination, and its height among those of the grid [m].
        self._origin, self._turn, self._inclination, self._height = 0j, 1 + 0j, 0j, 0.0
        self._feet: tuple[Shaped[np.ndarray, "n"], Shaped[np.ndarray, "n"]] = np.zeros(0, dtype=complex), np.zeros(0)

    def see(self, readings: ValidReadings, state: GaitState) -> None:
        """Replace the known heights by those of readings.

        Parameters
        ----------
        readings, state : ValidReadings, GaitState
            The readings, whose heights are ignored where they are None or those taken before; the gait state.
        """
        if readings.ground is None or readings.ground is self._seen:
            return
        self.given, self._seen, age = True, readings.ground, readings.ground_age
        (vx, vy, wz), (x, y, yaw) = state.twist.value.tolist(), state.moved_posture[[0, 1, 5]].tolist()
        self._middle = state.origin + cmath.exp(1j * state.yaw) * (complex(x, y) - complex(vx, vy) * age)
        self._axis = cmath.exp(1j * (state.yaw + yaw - wz * age))
        self._tie()

    def step(
        self, feet: _Feet, tilt: RollPitch | None, state: GaitState, dt: float, *, drift: complex, turning: float = 0.0
    ) -> None:
        """Fit the plane to the standing feet, and tie the known heights to them.

        Parameters
        ----------
        feet : sequence of (complex, float)
            Places and heights of the feet that bear load, in the heading frame [m].
        tilt : (roll, pitch) or None
            By how much the heading frame is tilted [rad].
        state, dt : GaitState, float
            The gait state; time since the last update [s].
        drift, turning : complex, float
            Velocity with which the feet move backwards to make up for lost way, in the heading frame [m/s]; how fast
            the body turns over them to make up for lost heading [rad/s].
        """
        (roll, pitch), places, heights = tilt or (0.0, 0.0), [foot for foot, _ in feet], [height for _, height in feet]
        self.plane = fitted_plane(places, heights, self.plane, min(_SLOPE_RATE * dt, 1.0))
        self._origin, self._turn, self._inclination = state.origin, cmath.exp(1j * state.yaw), complex(-pitch, roll)
        if self.given:
            back = cmath.exp(-1j * turning * dt)
            self._middle = self._origin + (self._middle - self._origin) * back - self._turn * drift * dt
            self._axis *= back
            self._feet = (on := np.array(places, dtype=complex)), self._rise(on) + heights
            self._tie()

    def _rise(self, places: Shaped[np.ndarray, "..."]) -> Shaped[np.ndarray, "..."]:
        """Return the height of the tilted heading frame over a level plane through its origin, at places [m]."""
        return np.asarray((places * self._inclination.conjugate()).real)

    def _known(self, places: Shaped[np.ndarray, "..."]) -> Shaped[np.ndarray, "..."]:
        """Return the heights of the grid at places [m]."""
        assert self._seen is not None  # nothing is asked before
        return self._seen.at((self._origin + self._turn * places - self._middle) / self._axis)

    def _tie(self) -> None:
        """Find the height of the heading frame on the grid by the median: a foot at an edge may be far off."""
        off = self._known(self._feet[0]) - self._feet[1]
        known = off[~np.isnan(off)].tolist()
        self._height = median(known) if known else self._height

    def expected(self, places: Shaped[np.ndarray, "..."]) -> Shaped[np.ndarray, "..."]:
        """Return the heights at which the ground is expected at places; in a hole, those of the plane [m]."""
        found, level = self.lies(places), np.asarray(self.plane.at(places))
        return np.where(found > self.floor(places), found, level)

    def floor(self, places: Shaped[np.ndarray, "..."]) -> Shaped[np.ndarray, "..."]:
        """Return the heights below which known ground is a hole at places [m]; a rising plane does not raise them."""
        return np.asarray(np.minimum(self.plane.at(places), self.plane.height) - self.deepest)

    def lies(self, places: Shaped[np.ndarray, "..."]) -> Shaped[np.ndarray, "..."]:
        """Return the known heights at places, those of holes too, and those of the plane where nothing is known [m]."""
        known = self._known(places) - self._height - self._rise(places)
        return np.where(np.isnan(known), np.asarray(self.plane.at(places)), known)

    def at(self, place: complex) -> float:
        """Return the height at which the ground is expected at a place [m]."""
        return float(self.expected(np.array(place))) if self.given else self.plane.at(place)

    def lowest_near(self, place: complex) -> float:
        """Return the least height at which the ground is expected around a place [m].

        Known ground above the plane of the feet does not count: a foot that feels none there shows that it is wrong.
        """
        found = lowest_near(self.expected, np.array(place), within=self._scale * _OFF) if self.given else math.inf
        return min(float(found), float(self.plane.at(place)))

    def is_hole(self, place: complex) -> bool:
        """Return whether the known ground at a place, or close to it, is too low to stand on."""
        if not self.given:
            return False
        lowest = lowest_near(self.lies, np.array(place), within=self._scale * _EDGE)
        if lowest >= self.floor(np.array(place)):
            return False
        way = on_way(self.lies, 0j, place)
        found = np.append(way, lowest)
        return bool((found[:-2] - found[2:]).max() > _CLIFF * abs(place) * 2 / (len(way) - 1))

    def on_way(self, start: complex, foothold: complex) -> tuple[float, bool]:
        """Return the greatest height of the known ground on a foot's way, and whether it rises soon on that way.

        Where nothing is known, the height is minus infinity [m].

        Parameters
        ----------
        start, foothold : complex
            Where the foot is, and where it will be put down, in the heading frame [m].
        """
        if not self.given:
            return -math.inf, False
        return float(on_way(self.expected, start, foothold).max()), is_steep(self.expected, start, foothold)

    def rises_ahead(self, reach: Reach) -> tuple[list[float], list[float]]:
        """Return least and greatest ground height at each leg's next footholds, over the plane's at the origin [m].

        Parameters
        ----------
        reach : Reach
            Rest footholds, and strokes about them.
        """
        ahead = self.expected(reach.rest + _NEXT[:, None] * reach.strokes) - self.plane.height
        return ahead.min(axis=0).tolist(), ahead.max(axis=0).tolist()

    def body_rise(self, half: Sequence[float], height: float) -> float:
        """Return how much higher than commanded the body has to be to clear the known ground under it [m].

        Parameters
        ----------
        half, height : sequence of float, float
            Half the body's length, width and height [m]; commanded height of the body [m].
        """
        if not self.given:
            return -math.inf
        highest = float(self.expected(_UNDER.real * half[0] + 1j * _UNDER.imag * half[1]).max())
        return highest - self.plane.height + half[2] + self._scale * _CLEAR - height
