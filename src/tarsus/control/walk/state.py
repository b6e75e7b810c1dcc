"""The gait state of a walking robot, and the inputs of the stepper: all that determines the further walk.

Points of the ground plane are complex numbers, x + iy; a rotation by an angle is a product with ``exp(i angle)``.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.pose.pose_controller import NO_SHIFT
from tarsus.control.walk.felt_feet import FeltFoot, FeltInputs
from tarsus.gait.body_shift import shift_at
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stance_geometry import rotation_rows, with_sway
from tarsus.gait.swing_trajectory import swinging_height
from tarsus.kinematics.pose import Pose

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Float

__all__ = ["POSITION_TOLERANCE", "ROUNDING", "GaitState", "StepInputs", "integrate_twist"]

ROUNDING = 1e-9
"""Differences of fractions, of the clock [cycles], of places and heights [m] below this are rounding."""

POSITION_TOLERANCE = 1e-6
"""A foot this close to its rest foothold is at it [m]."""

_Places = TypeVar("_Places", complex, np.ndarray)


class GaitState(NamedTuple):
    """The state of walking, as far as the stepper determines it.

    Attributes
    ----------
    step_number : array, shape (legs,)
        Number of each leg's present step, or of the last one during a swing; its touchdown is at
        ``offset + step_number`` on the clock.
    down : array of bool, shape (legs,)
        Whether the foot is on the ground.
    swing_phase : array, shape (legs,)
        Fraction of the swing that is over.
    foot, foothold : complex array, shape (legs,)
        Where the feet are, and where they stand or will be put down, in G [m].
    swing_velocity, swing_acceleration : complex array, shape (legs,)
        First and second derivative of a swinging foot's position with respect to its swing phase [m].
    ground_height, start_height : array, shape (legs,)
        Height of the ground at each foothold, and of the foot at its lift-off, in G [m].
    twist : CriticallyDamped
        Twist of the heading frame, shape (3,): forward, left [m/s], turning [rad/s].
    posture : CriticallyDamped
        Body pose in the heading frame, shape (13,): see `tarsus.gait.stance.stance_geometry`.
    lift_delay : array, shape (legs,)
        Delay of each foot's lift-off, by which its swing is shorter [cycles].
    rhythm : CriticallyDamped
        Rates of `cycles` and `beats`, shape (2,) [1/s].
    admittance_offset : CriticallyDamped
        Upward offset of each foot on the ground, shape (legs,) [m].
    clock : float
        Time in cycles.
    origin : complex
        Origin of the heading frame in G [m].
    yaw : float
        Direction of the heading frame [rad].
    elevation, climb : float
        Height of the heading frame over G's origin [m], and its rate of change [m/s].
    cycles, beats : float
        Cycles and beats of the gait so far: the phases of the body's sway.
    shift : CriticallyDamped
        Coefficients of the body shift, real and imaginary parts, shape (14,) [m]; `NO_SHIFT` before the first one.
    felt : sequence of FeltFoot
        The feet of a walk that feels the ground: `ground_height` is then the height of every foot, in the air too.
        Empty for a walk that has not had any readings.
    """

    step_number: Float[np.ndarray, "legs"]
    down: Bool[np.ndarray, "legs"]
    swing_phase: Float[np.ndarray, "legs"]
    foot: Complex[np.ndarray, "legs"]
    foothold: Complex[np.ndarray, "legs"]
    swing_velocity: Complex[np.ndarray, "legs"]
    swing_acceleration: Complex[np.ndarray, "legs"]
    ground_height: Float[np.ndarray, "legs"]
    start_height: Float[np.ndarray, "legs"]
    twist: CriticallyDamped
    posture: CriticallyDamped
    lift_delay: Float[np.ndarray, "legs"]
    rhythm: CriticallyDamped
    admittance_offset: CriticallyDamped
    clock: float = 0.0
    origin: complex = 0j
    yaw: float = 0.0
    elevation: float = 0.0
    climb: float = 0.0
    cycles: float = 0.0
    beats: float = 0.0
    shift: CriticallyDamped = NO_SHIFT
    felt: Sequence[FeltFoot] = ()

    @classmethod
    def standing(cls, rest: Complex[np.ndarray, "legs"], posture: Float[np.ndarray, "n"]) -> GaitState:
        """Return the state of a robot that stands with its feet at rest, its heading frame at G.

        Parameters
        ----------
        rest : complex array, shape (legs,)
            The rest footholds [m].
        posture : array, shape (13,)
            The posture: see `tarsus.gait.stance.stance_geometry`.
        """
        none, zero = np.zeros(len(rest)), np.zeros(len(rest), dtype=complex)
        return cls(
            step_number=none,
            down=np.ones(len(rest), dtype=bool),
            swing_phase=none,
            foot=rest,
            foothold=rest,
            swing_velocity=zero,
            swing_acceleration=zero,
            ground_height=none,
            start_height=none,
            twist=CriticallyDamped.still(np.zeros(3)),
            posture=CriticallyDamped.still(posture),
            lift_delay=none,
            rhythm=CriticallyDamped.still(np.zeros(2)),
            admittance_offset=CriticallyDamped.still(none),
        )

    @property
    def moved_posture(self) -> Float[np.ndarray, "7"]:
        """The posture with the displacements by sway and body shift."""
        posture = with_sway(self.posture.value, self.cycles, self.beats)
        if self.shift is NO_SHIFT:
            return posture
        shift = complex(shift_at(self.shift.value.view(complex), self.clock))
        return np.asarray(posture + np.array([shift.real, shift.imag, 0.0, 0.0, 0.0, 0.0, 0.0]))

    @property
    def body(self) -> Pose:
        """Pose of B in G."""
        x, y, z, roll, pitch, yaw, _ = self.moved_posture.tolist()
        origin = self.origin + cmath.exp(1j * self.yaw) * complex(x, y)
        rotation = np.array(rotation_rows(roll, pitch, self.yaw + yaw))
        return Pose.unchecked(rotation, np.array([origin.real, origin.imag, self.elevation + z]))

    def in_heading(self, places: _Places) -> _Places:
        """Return places of G in the heading frame, x + iy [m]."""
        return (places - self.origin) * cmath.exp(-1j * self.yaw)

    def heights(self, swing_height: float) -> list[float]:
        """Return the heights of the feet in G, for a swing height over the footholds [m]."""
        heights: list[float] = self.ground_height.tolist()
        if self.felt:
            return heights
        feet = zip(heights, self.down.tolist(), self.swing_phase.tolist(), self.start_height.tolist(), strict=True)
        return [
            ground if down else swinging_height(phase, start=start, ground=ground, swing_height=swing_height)
            for ground, down, phase, start in feet
        ]


class StepInputs(NamedTuple):
    """Inputs of the stepper, constant for a tick.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    frequency : float
        Cycles per second; 0 for a standing robot [1/s].
    twist, posture : array, shape (3,) and (13,)
        Targets of the twist and of the posture.
    bandwidth, posture_bandwidth : float
        Bandwidths of their filters [rad/s].
    rest : complex array, shape (legs,)
        Rest footholds in the heading frame [m].
    placement_bounds : array, shape (legs, 16)
        Greatest distance from its rest foothold at which each foot may be put down, along each of `NORMALS` [m].
    placement_radii : list of float
        The least of these distances of each foot [m].
    admittance_offset : array, shape (legs,)
        Target of each foot's admittance offset [m].
    hold_feet : bool
        Whether no foot lifts off.
    excluded : tuple of int
        Legs whose feet may not lift off.
    unstepped : tuple of int
        Legs whose feet step even if they are at their rest footholds.
    felt : FeltInputs or None
        What is felt of the ground; None for a walk without readings.
    shift : array, shape (14,)
        Target of the body shift's coefficients [m].
    """

    gait: Gait
    frequency: float
    twist: Float[np.ndarray, "3"]
    posture: Float[np.ndarray, "_"]
    bandwidth: float
    posture_bandwidth: float
    rest: Complex[np.ndarray, "legs"]
    placement_bounds: Float[np.ndarray, "legs 16"]
    placement_radii: list[float]
    admittance_offset: Float[np.ndarray, "legs"]
    hold_feet: bool = False
    excluded: tuple[int, ...] = ()
    unstepped: tuple[int, ...] = ()
    felt: FeltInputs | None = None
    shift: Float[np.ndarray, "14"] = NO_SHIFT.value


def integrate_twist(origin: complex, yaw: float, travel: Sequence[float]) -> tuple[complex, float]:
    """Return origin [m] and yaw [rad] of a frame after a travel (x, y, angle): the exponential map of a twist."""
    x, y, angle = travel
    half = angle / 2
    # Ratio of the path's chord to its arc length.
    chord = math.sin(half) / half if abs(half) > 1e-6 else 1 - half * half / 6
    return origin + cmath.exp(1j * (yaw + half)) * complex(x, y) * chord, yaw + angle
