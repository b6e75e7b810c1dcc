"""Ground search: a foot at the end of its swing without contact is lowered until it touches the ground."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.walk.state import GaitState, chord_factor
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT, TerrainEstimate, joint_margin, stance_geometry_of
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["SEARCH_DEPTH", "FootSearch", "GroundSearch", "lowest_planned_height", "lowest_reachable_height"]

SEARCH_DEPTH = 0.6
"""Depth below the expected ground that is searched, in swing heights."""

# Number of heights tested.
_HEIGHTS = 13


def lowest_planned_height(state: GaitState, terrain: TerrainEstimate) -> Float[np.ndarray, "legs"]:
    """Return the lowest height at which each foot may be put down: `SEARCH_DEPTH` below the planned ground [m].

    Parameters
    ----------
    state : GaitState
        The state of the walk.
    terrain : TerrainEstimate
        The terrain for which the stance was planned.

    Returns
    -------
    array, shape (legs,)
        Heights in G [m].
    """
    depth = SEARCH_DEPTH * float(state.posture.value[SWING_HEIGHT])
    seen = (state.foothold - state.origin) * cmath.exp(-1j * state.yaw)
    return np.asarray(state.elevation.value + (terrain.slope.conjugate() * seen).real - depth)


def lowest_reachable_height(robot: Robot, state: GaitState, leg: int, stance_time: float) -> float:
    """Return the lowest height at which a leg can hold its foot for a whole stance at the current twist [m].

    Parameters
    ----------
    robot : Robot
        A single robot.
    state : GaitState
        The state of the walk; the foot is over its foothold.
    leg : int
        Index of the leg.
    stance_time : float
        Duration of the stance [s].

    Returns
    -------
    float
        At most `SEARCH_DEPTH` below the expected ground.
    """
    forward, left, turning = (state.twist.value * stance_time).tolist()
    here = (state.foot - state.origin) * cmath.exp(-1j * state.yaw)
    there = (here - complex(forward, left) * chord_factor(turning)) * cmath.exp(-1j * turning)
    depth = SEARCH_DEPTH * float(state.posture.value[SWING_HEIGHT])
    heights = float(state.ground_height[leg]) - np.linspace(0.0, depth, _HEIGHTS)
    places = np.stack([here, there])[:, None]
    above = (heights - float(state.elevation.value[0]))[:, None]
    solution = stance_geometry_of(state.posture.value, state.foot).solve(robot, places.real, places.imag, above)
    failing = (joint_margin(robot.geometry, solution)[..., leg].min(axis=0) < 0).tolist()
    return float(heights[max(failing.index(True) - 1, 0) if True in failing else -1])


# Search speed [m/s], bandwidth of the stop on the ground [rad/s], speed below which a foot is at rest [m/s], and the
# joint acceleration that this speed and stop need [rad/s^2].
_SPEED, _STOP_BANDWIDTH, _REST_SPEED, _FULL_ACCELERATION = 0.05, 40.0, 1e-3, 60.0


class FootSearch(NamedTuple):
    """A foot that is lowered in search of ground.

    Attributes
    ----------
    height : CriticallyDamped
        Its height in G ``(1,)`` [m].
    lowest : float
        Lowest height of the search [m].
    bandwidth, stop_bandwidth : float
        Bandwidths of the motion down and of the stop on the ground [rad/s].
    ground : float or None
        Height at which the foot comes to rest, once it has touched the ground [m].
    """

    height: CriticallyDamped
    lowest: float
    bandwidth: float
    stop_bandwidth: float
    ground: float | None = None

    @classmethod
    def begin(cls, height: float, lowest: float, speed_factor: float) -> FootSearch:
        """Return the search of a foot that is at rest.

        Parameters
        ----------
        height : float
            Height of the foot in G [m].
        lowest : float
            Lowest height of the search; the foot's own if that is lower [m].
        speed_factor : float
            Fraction of the full speed and bandwidth of the stop.
        """
        lowest, stop_bandwidth = min(lowest, height), speed_factor * _STOP_BANDWIDTH
        bandwidth = min(math.e * speed_factor * _SPEED / max(height - lowest, 1e-6), stop_bandwidth)
        return cls(CriticallyDamped.still(np.array([height])), lowest, bandwidth, stop_bandwidth)

    def step(self, dt: float, *, touches: bool) -> FootSearch:
        """Return the search one tick later.

        Parameters
        ----------
        dt : float
            Length of the tick [s].
        touches : bool
            Whether the foot touches the ground.
        """
        ground = self.ground
        if touches and ground is None:
            ground = float(self.height.value[0] + 2 * self.height.rate[0] / self.stop_bandwidth)
        target, bandwidth = (self.lowest, self.bandwidth) if ground is None else (ground, self.stop_bandwidth)
        height = self.height.step(np.array([target]), dt, bandwidth=bandwidth)
        return self._replace(height=height, ground=ground)

    @property
    def at_rest(self) -> bool:
        """Whether the foot has found ground and stopped on it."""
        return self.ground is not None and abs(float(self.height.rate[0])) < _REST_SPEED

    @property
    def failed(self) -> bool:
        """Whether the foot is at its lowest height without ground contact."""
        return self.ground is None and float(self.height.value[0]) - self.lowest < 1e-3


class GroundSearch:
    """The feet of a robot that search for ground.

    Parameters
    ----------
    acceleration : array, shape (legs, 3)
        Acceleration limits of the joints [rad/s^2]; low limits slow the search down.
    """

    def __init__(self, acceleration: Float[np.ndarray, "legs 3"]) -> None:
        self._feet: dict[int, FootSearch] = {}
        # The foot's acceleration is proportional to the square of its speed.
        self._speed_factor = min(1.0, math.sqrt(float(acceleration.min()) / _FULL_ACCELERATION))

    def __bool__(self) -> bool:
        return bool(self._feet)

    @property
    def failed_legs(self) -> list[int]:
        """Indices of the legs that found no ground."""
        return [leg for leg, search in self._feet.items() if search.failed]

    @property
    def all_failed(self) -> bool:
        """Whether every searching foot has failed to find ground."""
        return bool(self._feet) and all(search.failed for search in self._feet.values())

    def give_up(self) -> None:
        """End all searches."""
        self._feet = {}

    def stands(self, leg: int, *, touches: bool) -> bool:
        """Return whether a foot at the end of its swing may be put down: at rest on ground if it had to search.

        Parameters
        ----------
        leg : int
            Index of the leg.
        touches : bool
            Whether its foot touches the ground.
        """
        return self._feet[leg].at_rest if leg in self._feet else touches

    def step(
        self, state: GaitState, dt: float, *, touches: Callable[[int], bool], lowest: Callable[[int], float]
    ) -> GaitState:
        """Lower the feet that are at the end of their swing without contact, by one tick.

        Parameters
        ----------
        state : GaitState
            The state of the walk.
        dt : float
            Length of the tick [s].
        touches : callable
            Whether the foot of a leg touches the ground.
        lowest : callable
            Lowest height of the search of a leg's foot [m].
        """
        swing_ended = ~state.down & (state.swing_phase >= 1.0)
        ground = state.ground_height.copy()
        for leg in np.flatnonzero(swing_ended).tolist():
            if leg not in self._feet:
                if touches(leg):
                    continue
                self._feet[leg] = FootSearch.begin(float(ground[leg]), lowest(leg), self._speed_factor)
            self._feet[leg] = self._feet[leg].step(dt, touches=touches(leg))
            ground[leg] = float(self._feet[leg].height.value[0])
        return state._replace(ground_height=ground, contact_phase=np.where(swing_ended, np.inf, state.contact_phase))

    def land(self, landed: Bool[np.ndarray, "legs"]) -> None:
        """End the searches of feet that have been put down.

        Parameters
        ----------
        landed : array of bool, shape (legs,)
            Feet put down in this tick.
        """
        self._feet = {leg: search for leg, search in self._feet.items() if not landed[leg]}
