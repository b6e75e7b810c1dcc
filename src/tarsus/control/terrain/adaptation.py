"""What is under the feet: what the walker feels of the ground, and what it has its feet do about that."""

from __future__ import annotations

import cmath
from typing import Any

import numpy as np

from tarsus.control.pose.admittance import Admittance
from tarsus.control.pose.attitude import CommandedAttitude
from tarsus.control.pose.levelling import LevellingMode
from tarsus.control.pose.pose_controller import ELEVATION_BANDWIDTH, elevation_bandwidth
from tarsus.control.readings import SensorReadings
from tarsus.control.terrain.ground_estimator import GroundEstimate, GroundEstimator
from tarsus.control.terrain.ground_search import (
    SEARCH_DEPTH,
    GroundSearch,
    lowest_planned_height,
    lowest_reachable_height,
)
from tarsus.control.terrain.hole_recovery import HoleRecovery, Request, repeated_swing
from tarsus.control.walk.state import ZERO_ELEVATION, GaitState
from tarsus.control.walk.time_scaling import STOP_DURATION
from tarsus.control.workspace.stance_geometry import LEVEL_TERRAIN, RAISED_FRACTION, SWING_HEIGHT, TerrainEstimate
from tarsus.gait.gait import Gait
from tarsus.robot.robot import Robot

__all__ = ["TerrainAdaptation"]

Floats = np.ndarray[Any, Any]

# What share of the swing is over before ground may be met, and how much higher that is than it was expected [m].
_DESCENDING, _EARLY = 0.5, 1e-3
# How long a foot is taken to touch or not to touch as it was last felt to [s].
_LASTS = 0.5


class TerrainAdaptation:
    """What a walker knows of the ground under its feet, and the feet that look for it.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles, feet : array, shape (legs, 3)
        Joint angles [rad] and feet in G [m] when it stands.
    acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s^2].
    levelling : "level", "follow" or None
        Whether the body stays level on ground that is not, or follows its slope.
    admittance : Admittance, optional
        How the feet give way to the forces on them; left out, they don't.

    Attributes
    ----------
    has_feedback : bool
        Whether readings have been given, or levelling or admittance need an estimate without them.
    estimate : GroundEstimate or None
        The last estimate; None without feedback.
    hold_time : float
        How long feet may have to wait for others that look for ground [s].
    searches : GroundSearch
        The feet that do.
    """

    def __init__(
        self,
        robot: Robot,
        angles: Floats,
        feet: Floats,
        *,
        acceleration: Floats,
        levelling: LevellingMode | None,
        admittance: Admittance | None,
    ) -> None:
        self.estimate: GroundEstimate | None = None
        self.hold_time = 0.0
        self.searches = GroundSearch(acceleration)
        self.has_feedback = levelling is not None or admittance is not None
        self._robot, self._gives_way = robot, admittance is not None
        self._estimator = GroundEstimator(robot, angles, feet, levelling=levelling, admittance=admittance)
        self._recovery = HoleRecovery()
        self._touching: list[bool | None] = [None] * robot.legs
        self._since = [0.0] * robot.legs
        self._elevation = ZERO_ELEVATION

    @property
    def terrain(self) -> TerrainEstimate:
        """How the ground lies, as far as it is felt."""
        if self.estimate is None:
            return LEVEL_TERRAIN
        return TerrainEstimate(self.estimate.slope, SEARCH_DEPTH if self.hold_time or self._gives_way else 0.0)

    @property
    def stops_walk(self) -> bool:
        """Whether the robot is to stand still, as feet look for ground."""
        return bool(self.searches) and not self.recovering

    @property
    def recovering(self) -> bool:
        """Whether a foot over a hole is to be drawn back once all others are down."""
        return self._recovery.active

    def sense(
        self,
        readings: SensorReadings | None,
        dt: float,
        now: GaitState,
        *,
        feet: Floats,
        contacts: Floats,
        angles: Floats,
        commanded: CommandedAttitude,
    ) -> None:
        """Take in what is measured.

        Parameters
        ----------
        readings : SensorReadings, optional
            The readings.
        dt : float
            Time since the last tick [s].
        now : Moment
            The moment.
        feet, angles : array, shape (legs, 3)
            The feet in G [m], the joints [rad].
        contacts : array of bool, shape (legs,)
            Which feet the walker has put down.
        commanded : Commanded
            How the body is asked to stand.
        """
        self.has_feedback = True
        lean = now.posture.value[3:5] - (commanded.roll, commanded.pitch)
        self._estimator.set_applied_correction(float(lean[0]), float(lean[1]))
        self.estimate = self._estimator.step(
            readings,
            dt,
            feet=feet,
            offsets=now.admittance_offset.value,
            contacts=contacts,
            yaw=now.yaw,
            commanded=commanded,
            angles=angles,
        )
        # A lag is late by 2 over its bandwidth: where the robot will be by then.
        forward, left, _ = now.twist.value.tolist()
        ahead = now.origin + cmath.exp(1j * now.yaw) * complex(forward, left) * (2 / ELEVATION_BANDWIDTH)
        self._elevation = np.array([self._estimator.plane.height(ahead.real, ahead.imag)])
        self._remember(self.estimate.contacts, dt)
        if self.estimate.contacts is not None:
            # A foot that finds no ground is noticed a tick later, and the walk takes a while to stop.
            self.hold_time = max(self.hold_time, STOP_DURATION + dt)

    def _remember(self, contacts: tuple[bool | None, ...] | None, dt: float) -> None:
        """Note which feet touch; where that is not known, they do as they did, for a while."""
        for leg, contact in enumerate(contacts or (None,) * len(self._since)):
            self._since[leg] = 0.0 if contact is not None else self._since[leg] + dt
            if contact is not None or self._since[leg] > _LASTS:
                self._touching[leg] = contact

    def early_contacts(self, now: GaitState) -> Floats:
        """Return which feet have come to ground that they were not expected to meet yet ``(legs,)``.

        Parameters
        ----------
        now : Moment
            The moment.
        """
        if self.estimate is None or self.estimate.contacts is None:
            return np.zeros_like(now.down)
        touch = np.array([contact is True for contact in self.estimate.contacts])
        falls = ~now.down & (now.swing_phase > _DESCENDING) & (now.swing_phase < 1.0) & np.isinf(now.contact_phase)
        if not (touch & falls).any():
            return np.zeros_like(falls)
        high = now.height(float(now.posture.value[SWING_HEIGHT])) > now.ground_height + _EARLY
        return np.asarray(touch & falls & high)

    def _touches(self, leg: int) -> bool:
        """Return whether a foot at the end of its swing is on the ground, as far as is known."""
        return self._touching[leg] is not False

    def may_land(self, now: GaitState, soon: Floats) -> tuple[Floats, bool]:
        """Return which feet may be put down at the end of their swing, and whether none may be lifted meanwhile.

        Parameters
        ----------
        now : Moment
            The moment.
        soon : array of bool, shape (legs,)
            Whose swing ends with this tick.
        """
        lands = np.ones_like(now.down)
        for leg in np.flatnonzero(~now.down).tolist():
            lands[leg] = self.searches.stands(leg, touches=self._touches(leg))
        # Where a foot that is about to land finds no ground, none may lift in its stead.
        return lands, bool(self.searches) or bool((~now.down & ~lands & soon).any())

    def step_inputs(self, now: GaitState, terrain: TerrainEstimate) -> dict[str, Any]:
        """Return what a `Course` knows of the ground.

        Parameters
        ----------
        now : Moment
            The moment.
        terrain : Terrain
            How the ground was thought to lie when the polygons were worked out.
        """
        assert self.estimate is not None  # or there is nothing to know
        lowest = lowest_planned_height(now, terrain)
        return {
            # Feet in the air have nothing to give way to.
            "admittance_offset": np.maximum(self.estimate.offsets, np.minimum(lowest - now.ground_height, 0.0))
            * now.down,
            "ground_plane": self._estimator.plane,
            "lowest_ground": lowest,
            "highest_ground": lowest + (1 + RAISED_FRACTION) * SEARCH_DEPTH * float(now.posture.value[SWING_HEIGHT]),
            "elevation": self._elevation,
            "elevation_bandwidth": elevation_bandwidth(float(self._elevation[0] - now.elevation.value[0])),
        }

    def search(self, now: GaitState, dt: float, *, terrain: TerrainEstimate, stance_time: float) -> GaitState:
        """Let feet that have come down where there is no ground look for it, in the world's time.

        Parameters
        ----------
        now : Moment
            The moment.
        dt : float
            The time [s].
        terrain : Terrain
            How the ground was thought to lie when the polygons were worked out.
        stance_time : float
            How long feet are to stand [s].
        """

        def lowest(leg: int) -> float:
            reached = lowest_reachable_height(self._robot, now, leg, stance_time + self.hold_time)
            return min(float(lowest_planned_height(now, terrain)[leg]), reached) if terrain.depth else reached

        return self.searches.step(now, dt, touches=self._touches, lowest=lowest) if self.estimate else now

    def feet_landed(self, landed: Floats) -> None:
        """Note which feet have been put down in this tick.

        Parameters
        ----------
        landed : array of bool, shape (legs,)
            The feet.
        """
        self.searches.land(landed)
        if not self.searches:
            self._recovery.landed(landed)

    def recover(self, now: GaitState, asked: Request, gait: Gait) -> GaitState | None:
        """Let feet that hang over a hole swing once more as soon as something else is asked for.

        Parameters
        ----------
        now : Moment
            The moment.
        asked : (twist, manner)
            What is asked for.
        gait : Gait
            Order of the steps.

        Returns
        -------
        Moment or None
            The moment after that; None where nothing comes of it.
        """
        legs, begins = self.searches.failed_legs, self._recovery.consider(asked, now.origin)
        if self._recovery.active and np.delete(now.down, legs).all():
            self.searches.give_up()
            self._recovery.begun(legs)
            return repeated_swing(now, legs, gait, self._estimator.plane)
        return now if begins else None
