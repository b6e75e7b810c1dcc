"""Terrain adaptation: the ground estimate and the feet's reactions to early, late and missing ground."""

from __future__ import annotations

import cmath
from typing import TYPE_CHECKING, Any

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

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["TerrainAdaptation"]


# Ground contact counts as early in this part of the swing, and at least this far above the expected ground [m].
_EARLIEST_PHASE, _LEAST_HEIGHT = 0.5, 1e-3
# A missing contact reading is replaced by the last one for this long [s].
_CONTACT_TIMEOUT = 0.5


class TerrainAdaptation:
    """Estimate of the ground under a walking robot, and the reactions of its feet.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles, feet : array, shape (legs, 3)
        Joint angles [rad] and feet in G [m] in the initial stance.
    acceleration : array, shape (legs, 3)
        Acceleration limits of the joints [rad/s^2].
    levelling : "level", "follow" or None
        Whether the body stays level on a slope, follows it, or neither.
    admittance : Admittance, optional
        Compliance of the feet; left out, they are stiff.

    Attributes
    ----------
    has_feedback : bool
        Whether readings have been given, or levelling or admittance need an estimate without them.
    estimate : GroundEstimate or None
        The last estimate; None without feedback.
    hold_time : float
        How long a stance may be extended while other feet search for ground [s].
    searches : GroundSearch
        The feet that search for ground.
    """

    def __init__(
        self,
        robot: Robot,
        angles: Float[np.ndarray, "legs 3"],
        feet: Float[np.ndarray, "legs 3"],
        *,
        acceleration: Float[np.ndarray, "legs 3"],
        levelling: LevellingMode | None,
        admittance: Admittance | None,
    ) -> None:
        self.estimate: GroundEstimate | None = None
        self.hold_time = 0.0
        self.searches = GroundSearch(acceleration)
        self.has_feedback = levelling is not None or admittance is not None
        self._robot, self._compliant = robot, admittance is not None
        self._estimator = GroundEstimator(robot, angles, feet, levelling=levelling, admittance=admittance)
        self._recovery = HoleRecovery()
        self._contacts: list[bool | None] = [None] * robot.legs
        self._contact_ages = [0.0] * robot.legs
        self._elevation = ZERO_ELEVATION

    @property
    def terrain(self) -> TerrainEstimate:
        """Slope of the ground, and the depth below it that stances must allow for."""
        if self.estimate is None:
            return LEVEL_TERRAIN
        return TerrainEstimate(self.estimate.slope, SEARCH_DEPTH if self.hold_time or self._compliant else 0.0)

    @property
    def stops_walk(self) -> bool:
        """Whether the robot stands still while feet search for ground."""
        return bool(self.searches) and not self.recovering

    @property
    def recovering(self) -> bool:
        """Whether feet over a hole swing again once all others are down."""
        return self._recovery.active

    def sense(
        self,
        readings: SensorReadings | None,
        dt: float,
        state: GaitState,
        *,
        feet: Float[np.ndarray, "legs 3"],
        contacts: Bool[np.ndarray, "legs"],
        angles: Float[np.ndarray, "legs 3"],
        commanded: CommandedAttitude,
    ) -> None:
        """Update the estimate from the readings of one tick.

        Parameters
        ----------
        readings : SensorReadings, optional
            The readings.
        dt : float
            Time since the last tick [s].
        state : GaitState
            The state of the walk.
        feet, angles : array, shape (legs, 3)
            Feet in G [m], joint angles [rad].
        contacts : array of bool, shape (legs,)
            Which feet are in stance.
        commanded : CommandedAttitude
            Commanded attitude and height of the body.
        """
        self.has_feedback = True
        applied = state.posture.value[3:5] - (commanded.roll, commanded.pitch)
        self._estimator.set_applied_correction(float(applied[0]), float(applied[1]))
        self.estimate = self._estimator.step(
            readings,
            dt,
            feet=feet,
            offsets=state.admittance_offset.value,
            contacts=contacts,
            yaw=state.yaw,
            commanded=commanded,
            angles=angles,
        )
        # A critically damped filter lags by 2 / bandwidth: the ground's height is taken where the robot will be then.
        forward, left, _ = state.twist.value.tolist()
        ahead = state.origin + cmath.exp(1j * state.yaw) * complex(forward, left) * (2 / ELEVATION_BANDWIDTH)
        self._elevation = np.array([self._estimator.plane.height(ahead.real, ahead.imag)])
        self._update_contacts(self.estimate.contacts, dt)
        if self.estimate.contacts is not None:
            # Missing ground is detected one tick later, and the walk takes a while to stop.
            self.hold_time = max(self.hold_time, STOP_DURATION + dt)

    def _update_contacts(self, contacts: tuple[bool | None, ...] | None, dt: float) -> None:
        """Store the contacts; one that is missing keeps its last value until the timeout."""
        for leg, contact in enumerate(contacts or (None,) * len(self._contact_ages)):
            self._contact_ages[leg] = 0.0 if contact is not None else self._contact_ages[leg] + dt
            if contact is not None or self._contact_ages[leg] > _CONTACT_TIMEOUT:
                self._contacts[leg] = contact

    def early_contacts(self, state: GaitState) -> Bool[np.ndarray, "legs"]:
        """Return which swinging feet touch ground above its expected height.

        Parameters
        ----------
        state : GaitState
            The state of the walk.

        Returns
        -------
        array of bool, shape (legs,)
            Feet with early contact that was not detected before.
        """
        if self.estimate is None or self.estimate.contacts is None:
            return np.zeros_like(state.down)
        touching = np.array([contact is True for contact in self.estimate.contacts])
        descending = ~state.down & (state.swing_phase > _EARLIEST_PHASE) & (state.swing_phase < 1.0)
        descending = descending & np.isinf(state.contact_phase)
        if not (touching & descending).any():
            return np.zeros_like(descending)
        above = state.height(float(state.posture.value[SWING_HEIGHT])) > state.ground_height + _LEAST_HEIGHT
        return np.asarray(touching & descending & above)

    def _touches(self, leg: int) -> bool:
        """Return whether a foot at the end of its swing is on the ground; True where nothing is known."""
        return self._contacts[leg] is not False

    def may_land(self, state: GaitState, ending: Bool[np.ndarray, "legs"]) -> tuple[Bool[np.ndarray, "legs"], bool]:
        """Return which feet may end their swing, and whether all others are held on the ground.

        Parameters
        ----------
        state : GaitState
            The state of the walk.
        ending : array of bool, shape (legs,)
            Feet whose swing ends in this tick.

        Returns
        -------
        may_land : array of bool, shape (legs,)
            Feet that may be put down.
        hold : bool
            Whether no foot may lift.
        """
        may_land = np.ones_like(state.down)
        for leg in np.flatnonzero(~state.down).tolist():
            may_land[leg] = self.searches.stands(leg, touches=self._touches(leg))
        # While a foot that should land has no ground, no other may lift.
        return may_land, bool(self.searches) or bool((~state.down & ~may_land & ending).any())

    def step_inputs(self, state: GaitState, terrain: TerrainEstimate) -> dict[str, Any]:
        """Return the fields of `StepInputs` that depend on the ground.

        Parameters
        ----------
        state : GaitState
            The state of the walk.
        terrain : TerrainEstimate
            The terrain for which the stance was planned.
        """
        assert self.estimate is not None  # called with feedback only
        lowest = lowest_planned_height(state, terrain)
        offsets = np.maximum(self.estimate.offsets, np.minimum(lowest - state.ground_height, 0.0))
        return {
            "admittance_offset": offsets * state.down,
            "ground_plane": self._estimator.plane,
            "lowest_ground": lowest,
            "highest_ground": lowest + (1 + RAISED_FRACTION) * SEARCH_DEPTH * float(state.posture.value[SWING_HEIGHT]),
            "elevation": self._elevation,
            "elevation_bandwidth": elevation_bandwidth(float(self._elevation[0] - state.elevation.value[0])),
        }

    def search(self, state: GaitState, dt: float, *, terrain: TerrainEstimate, stance_time: float) -> GaitState:
        """Lower feet that are at the end of their swing without ground contact; not subject to time scaling.

        Parameters
        ----------
        state : GaitState
            The state of the walk.
        dt : float
            Length of the tick [s].
        terrain : TerrainEstimate
            The terrain for which the stance was planned.
        stance_time : float
            Duration of a stance [s].
        """

        def lowest(leg: int) -> float:
            reachable = lowest_reachable_height(self._robot, state, leg, stance_time + self.hold_time)
            return min(float(lowest_planned_height(state, terrain)[leg]), reachable) if terrain.depth else reachable

        return self.searches.step(state, dt, touches=self._touches, lowest=lowest) if self.estimate else state

    def feet_landed(self, landed: Bool[np.ndarray, "legs"]) -> None:
        """Remove feet that have been put down from the search.

        Parameters
        ----------
        landed : array of bool, shape (legs,)
            Feet put down in this tick.
        """
        self.searches.land(landed)
        if not self.searches:
            self._recovery.landed(landed)

    def recover(self, state: GaitState, request: Request, gait: Gait) -> GaitState | None:
        """Repeat the swing of feet over a hole, once the command has changed.

        Parameters
        ----------
        state : GaitState
            The state of the walk.
        request : (twist, parameters)
            What is commanded.
        gait : Gait
            Order of the steps.

        Returns
        -------
        GaitState or None
            The state with the swing restarted, or the same one while the feet wait for all others to be down; None
            if nothing changes.
        """
        legs, begins = self.searches.failed_legs, self._recovery.consider(request, state.origin)
        if self._recovery.active and np.delete(state.down, legs).all():
            self.searches.give_up()
            self._recovery.begun(legs)
            return repeated_swing(state, legs, gait, self._estimator.plane)
        return state if begins else None
