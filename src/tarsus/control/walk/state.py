"""The walking robot at one moment, and what it is doing: all that the future of the walk depends on.

Points of the ground plane are complex numbers here, x + iy; a turn by an angle is a product with ``exp(i angle)``.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.sensing.ground_plane import FLAT, GroundPlane
from tarsus.control.walk.swing_trajectory import stopping_height, swinging_height
from tarsus.gait.gait import Gait

__all__ = [
    "EARLY_STOP_FRACTION",
    "PHASE_TOLERANCE",
    "POSITION_TOLERANCE",
    "ZERO_ELEVATION",
    "GaitState",
    "StepInputs",
    "chord_factor",
    "integrate_twist",
]

Floats = np.ndarray[Any, Any]

PHASE_TOLERANCE = 1e-9
"""What counts as the same moment [cycles]."""

POSITION_TOLERANCE = 1e-6
"""A foot this near to its rest foothold is there [m]."""

ZERO_ELEVATION = np.zeros(1)
"""Where the heading frame is as long as nothing is felt of the ground [m]."""

EARLY_STOP_FRACTION = 0.0625
"""Within which share of the swing a foot that has met the ground comes to rest on it at the earliest."""


class GaitState(NamedTuple):
    """Everything that the future of the walk depends on; each array ``(legs,)`` unless said otherwise.

    Attributes
    ----------
    clock : float
        Time in cycles.
    number : array
        The step that each leg is in, or swings out of: touchdown at ``offset + number``.
    down : array of bool
        Whether the foot is on the ground.
    share : array
        Share of the swing that is over.
    foot, target : complex array
        Where the feet are, and where they are or will be put down, in G [m].
    pace, bend : complex array
        First and second derivative of a swinging foot's way by its share [m].
    ground, start_height : array
        Height of the ground that each foot is on or bound for, and where its swing began [m].
    lift_part : array
        How much of the lift its swing takes.
    met : array
        Share of the swing at which the foot met ground that was not expected yet; infinite where it did not.
    give : array
        Within which share of the swing it comes to rest on that.
    met_height, met_speed : array
        Where that was [m], and how the height changed with the swing's share [m].
    origin : complex
        The heading frame's origin in G [m].
    yaw : float
        Where it faces [rad].
    elevation : CriticallyDamped
        How high it is over G's origin ``(1,)`` [m].
    twist : CriticallyDamped
        Its speed ``(3,)``: forward, left [m/s], turning [rad/s].
    posture : CriticallyDamped
        The body over the heading frame: see `tarsus.control.workspace.stance_geometry`.
    rhythm : CriticallyDamped
        How fast `cycles` and `beats` grow ``(2,)`` [1/s].
    give_way : CriticallyDamped
        How far each foot on the ground has given way upwards ``(legs,)`` [m].
    late : array
        How much later than it was to each foot was lifted [cycles]; its swing is shorter by that.
    cycles, beats : float
        How many cycles and how many beats of the gait have been walked: what the body sways by.
    """

    clock: float
    step_number: Floats
    down: Floats
    swing_phase: Floats
    foot: Floats
    foothold: Floats
    swing_velocity: Floats
    swing_acceleration: Floats
    ground_height: Floats
    start_height: Floats
    height_factor: Floats
    contact_phase: Floats
    stop_phase: Floats
    contact_height: Floats
    contact_speed: Floats
    origin: complex
    yaw: float
    twist: CriticallyDamped
    posture: CriticallyDamped
    lift_delay: Floats
    rhythm: CriticallyDamped
    elevation: CriticallyDamped
    admittance_offset: CriticallyDamped
    cycles: float = 0.0
    beats: float = 0.0

    @classmethod
    def standing(cls, rest: Floats, posture: Floats) -> GaitState:
        """Return a robot that stands with its feet at rest, its heading frame at G's.

        Parameters
        ----------
        rest : complex array, shape (legs,)
            The rest footholds [m].
        posture : array, shape (13,)
            The body: see `tarsus.control.workspace.stance_geometry`.
        """
        none, zero = np.zeros(len(rest)), np.zeros(len(rest), dtype=complex)
        return cls(
            clock=0.0,
            step_number=none,
            down=np.ones(len(rest), dtype=bool),
            swing_phase=none,
            foot=rest,
            foothold=rest,
            swing_velocity=zero,
            swing_acceleration=zero,
            ground_height=none,
            start_height=none,
            height_factor=np.ones(len(rest)),
            contact_phase=np.full(len(rest), np.inf),
            stop_phase=np.full(len(rest), EARLY_STOP_FRACTION),
            contact_height=none,
            contact_speed=none,
            origin=0j,
            yaw=0.0,
            twist=CriticallyDamped.still(np.zeros(3)),
            posture=CriticallyDamped.still(posture),
            lift_delay=none,
            rhythm=CriticallyDamped.still(np.zeros(2)),
            elevation=CriticallyDamped.still(ZERO_ELEVATION),
            admittance_offset=CriticallyDamped.still(none),
        )

    def swings(self, duty_factor: float) -> Floats:
        """Return how long each foot swings ``(legs,)``, those on the ground for as long as is planned [cycles].

        Parameters
        ----------
        duty_factor : float
            Duty factor.
        """
        return np.asarray(1 - duty_factor - np.where(self.down, 0.0, self.lift_delay))

    def height(self, swing_height: float) -> Floats:
        """Return the feet's heights in G [m].

        Parameters
        ----------
        swing_height : float
            How high a swinging foot rises [m].
        """
        return np.array(self.heights(swing_height))

    def heights(self, swing_height: float) -> list[float]:
        """Return the same in plain numbers.

        Parameters
        ----------
        swing_height : float
            How high a swinging foot rises [m].
        """
        heights: list[float] = self.ground_height.tolist()
        for leg, down in enumerate(self.down.tolist()):
            if not down:
                heights[leg] = self._height(leg, swing_height)
        return heights

    def _height(self, leg: int, swing_height: float) -> float:
        """Return the height of a foot in the air."""
        fraction, ground, contact = (
            float(self.swing_phase[leg]),
            float(self.ground_height[leg]),
            float(self.contact_phase[leg]),
        )
        if contact == math.inf:
            rise = swing_height * float(self.height_factor[leg])
            return swinging_height(fraction, start=float(self.start_height[leg]), ground=ground, swing_height=rise)
        return stopping_height(
            fraction,
            contact=contact,
            duration=float(self.stop_phase[leg]),
            height=float(self.contact_height[leg]),
            speed=float(self.contact_speed[leg]),
            ground=ground,
        )


class StepInputs(NamedTuple):
    """What the robot is doing: constant for a tick.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    frequency : float
        Cycles a second [1/s].
    twist, posture : array
        What twist and posture follow.
    bandwidth, posture_bandwidth : float
        How fast they follow [rad/s].
    steps, lands : array of bool, shape (legs,)
        Which legs may lift, and which put their feet down at the end of their swing.
    rest : complex array, shape (legs,)
        Rest footholds in the heading frame [m].
    room : array, shape (legs, 16)
        How far from these the feet may be put down, along each of `NORMALS` [m].
    give_way : array, shape (legs,)
        How far each foot is to give way [m].
    holds : bool
        Whether all feet that are down wait, and lift later than they were to.
    beats : int
        How often in a cycle feet are lifted.
    sways : bool
        Whether the body sways with them, and the sway's rhythm has to go on.
    ground : GroundPlane
        Where the ground is expected.
    lowest, highest : array, shape (legs,)
        How low each foot may be put down at the lowest, and from how high it may be lifted by all of the lift [m].
    elevation : array, shape (1,)
        How high the heading frame is to be [m].
    elevation_bandwidth : float
        How fast it follows that [rad/s].
    """

    gait: Gait
    frequency: float
    twist: Floats
    posture: Floats
    bandwidth: float
    posture_bandwidth: float
    may_lift: Floats
    may_land: Floats
    rest: Floats
    placement_bounds: Floats
    admittance_offset: Floats
    hold_feet: bool = False
    beats: int = 2
    swaying: bool = True
    ground_plane: GroundPlane = FLAT
    lowest_ground: Floats | float = -math.inf
    highest_ground: Floats | float = math.inf
    elevation: Floats = ZERO_ELEVATION
    elevation_bandwidth: float = 4.0


def chord_factor(angle: Any) -> Any:
    """Return ``(exp(i angle) - 1) / (i angle)``: how a way bends that turns by an angle.

    Parameters
    ----------
    angle : float or array
        The angle [rad].
    """
    if isinstance(angle, float):
        half = angle / 2
        return cmath.exp(1j * half) * (math.sin(half) / half if abs(half) > 1e-6 else 1 - half * half / 6)
    half = angle / 2
    return np.exp(1j * half) * np.sinc(half / np.pi)


def integrate_twist(origin: complex, yaw: float, travel: Sequence[float]) -> tuple[complex, float]:
    """Return where the heading frame is after a travel (x, y, angle), the exponential of its displacement."""
    x, y, angle = travel
    return origin + cmath.exp(1j * yaw) * complex(x, y) * chord_factor(angle), yaw + angle
