"""Feet that find no ground where it was expected: they look for it further down."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.walk.state import GaitState, chord_factor
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT, TerrainEstimate, joint_margin, stance_geometry_of
from tarsus.robot.robot import Robot

__all__ = ["SEARCH_DEPTH", "FootSearch", "GroundSearch", "lowest_planned_height", "lowest_reachable_height"]

Floats = np.ndarray[Any, Any]

SEARCH_DEPTH = 0.6
"""How far below the ground feet look for it, in lifts."""

# How many heights are tried.
_HEIGHTS = 13


def lowest_planned_height(now: GaitState, terrain: TerrainEstimate) -> Floats:
    """Return how low each foot may be put down ``(legs,)`` [m]: so far below the ground as it was taken to lie.

    Parameters
    ----------
    now : Moment
        The moment.
    terrain : Terrain
        How the ground was thought to lie.
    """
    deep = SEARCH_DEPTH * float(now.posture.value[SWING_HEIGHT])
    seen = (now.foothold - now.origin) * cmath.exp(-1j * now.yaw)
    return np.asarray(now.elevation.value + (terrain.slope.conjugate() * seen).real - deep)


def lowest_reachable_height(robot: Robot, now: GaitState, leg: int, stance_time: float) -> float:
    """Return how low a leg can put its foot down and stand there for a stance, if the robot walks on as it does [m].

    Parameters
    ----------
    robot : Robot
        A single robot.
    now : Moment
        The moment; the foot is where it is to be put down.
    leg : int
        The leg.
    stance_time : float
        How long it is to stand there [s].

    Returns
    -------
    float
        Not lower than `SEARCH_DEPTH` below the ground that was expected.
    """
    forward, left, turning = (now.twist.value * stance_time).tolist()
    here = (now.foot - now.origin) * cmath.exp(-1j * now.yaw)
    there = (here - complex(forward, left) * chord_factor(turning)) * cmath.exp(-1j * turning)
    deep = SEARCH_DEPTH * float(now.posture.value[SWING_HEIGHT])
    heights = float(now.ground_height[leg]) - np.linspace(0.0, deep, _HEIGHTS)
    places = np.stack([here, there])[:, None]
    above = (heights - float(now.elevation.value[0]))[:, None]
    solution = stance_geometry_of(now.posture.value, now.foot).solve(robot, places.real, places.imag, above)
    fails = (joint_margin(robot.geometry, solution)[..., leg].min(axis=0) < 0).tolist()
    return float(heights[max(fails.index(True) - 1, 0) if True in fails else -1])


# How fast a foot goes down [m/s], how fast it stops once it has found ground [rad/s], and when it is at rest [m/s];
# and what the joints' acceleration must be for that [rad/s^2].
_SPEED, _STOPPING, _RESTING, _BRISK = 0.05, 40.0, 1e-3, 60.0


class FootSearch(NamedTuple):
    """A foot on its way down.

    Attributes
    ----------
    height : CriticallyDamped
        Where it is ``(1,)`` [m].
    lowest : float
        How low it goes at most [m].
    bandwidth, stopping : float
        How fast it goes there, and how fast it stops [rad/s].
    found : float or None
        Where it comes to rest, once there is ground [m].
    """

    height: CriticallyDamped
    lowest: float
    bandwidth: float
    stopping: float
    found: float | None = None

    @classmethod
    def begin(cls, height: float, lowest: float, pace: float) -> FootSearch:
        """Return the search of a foot that is at rest.

        Parameters
        ----------
        height : float
            Where it is [m].
        lowest : float
            How low it goes at most; no lower, if it is as low already [m].
        pace : float
            How fast it goes and stops, of what it does at its fastest.
        """
        lowest, stopping = min(lowest, height), pace * _STOPPING
        bandwidth = min(math.e * pace * _SPEED / max(height - lowest, 1e-6), stopping)
        return cls(CriticallyDamped.still(np.array([height])), lowest, bandwidth, stopping)

    def step(self, dt: float, *, ground: bool) -> FootSearch:
        """Return the search after a time.

        Parameters
        ----------
        dt : float
            The time [s].
        ground : bool
            Whether the foot touches ground.
        """
        found = self.found
        if ground and found is None:
            found = float(self.height.value[0] + 2 * self.height.rate[0] / self.stopping)
        target, bandwidth = (self.lowest, self.bandwidth) if found is None else (found, self.stopping)
        height = self.height.step(np.array([target]), dt, bandwidth=bandwidth)
        return self._replace(height=height, found=found)

    @property
    def at_rest(self) -> bool:
        """Whether the foot has found ground, and stands."""
        return self.found is not None and abs(float(self.height.rate[0])) < _RESTING

    @property
    def failed(self) -> bool:
        """Whether the foot is as low as it goes, without ground."""
        return self.found is None and float(self.height.value[0]) - self.lowest < 1e-3


class GroundSearch:
    """All feet that look for ground, by their legs.

    Parameters
    ----------
    acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s^2]: where it is low, feet go more slowly.
    """

    def __init__(self, acceleration: Floats) -> None:
        self._feet: dict[int, FootSearch] = {}
        # The foot's acceleration goes with the square of its pace.
        self._pace = min(1.0, math.sqrt(float(acceleration.min()) / _BRISK))

    def __bool__(self) -> bool:
        return bool(self._feet)

    @property
    def failed_legs(self) -> list[int]:
        """The legs under which there is no ground."""
        return [leg for leg, search in self._feet.items() if search.failed]

    @property
    def all_failed(self) -> bool:
        """Whether there is no ground under any foot that looks for it."""
        return bool(self._feet) and all(search.failed for search in self._feet.values())

    def give_up(self) -> None:
        """Look for ground no more."""
        self._feet = {}

    def stands(self, leg: int, *, touches: bool) -> bool:
        """Return whether a foot at the end of its swing may stand where it is: on ground, if it had to look for it.

        Parameters
        ----------
        leg : int
            The leg.
        touches : bool
            Whether it touches ground.
        """
        return self._feet[leg].at_rest if leg in self._feet else touches

    def step(
        self, now: GaitState, dt: float, *, touches: Callable[[int], bool], lowest: Callable[[int], float]
    ) -> GaitState:
        """Let feet that have come down where there is no ground look for it, in the world's time.

        Parameters
        ----------
        now : Moment
            The moment.
        dt : float
            The time [s].
        touches : callable
            Whether the foot of a leg touches ground.
        lowest : callable
            How low the foot of a leg may go [m].
        """
        over = ~now.down & (now.swing_phase >= 1.0)
        ground = now.ground_height.copy()
        for leg in np.flatnonzero(over).tolist():
            if leg not in self._feet:
                if touches(leg):
                    continue
                self._feet[leg] = FootSearch.begin(float(ground[leg]), lowest(leg), self._pace)
            self._feet[leg] = self._feet[leg].step(dt, ground=touches(leg))
            ground[leg] = float(self._feet[leg].height.value[0])
        return now._replace(ground_height=ground, contact_phase=np.where(over, np.inf, now.contact_phase))

    def land(self, landed: Floats) -> None:
        """Note which feet have been put down.

        Parameters
        ----------
        landed : array of bool, shape (legs,)
            The feet.
        """
        self._feet = {leg: search for leg, search in self._feet.items() if not landed[leg]}
