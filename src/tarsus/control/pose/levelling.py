"""Levelling: keeps the body level or parallel to the slope, with its centre of mass over the support polygon.

The vertical of the ground frame G deviates from gravity's where the ground is steeper than estimated, or where legs
are compliant. With R the commanded attitude of B in G and u the measured upward direction in B, ``R u`` is the upward
direction of gravity in G. Its low-pass filtered value is the only state estimated here; the corrections follow from it
in closed form (docs/ground.md).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from tarsus.arrays import Array
from tarsus.control.filters import RateLimitedFilter
from tarsus.control.pose.attitude import (
    CommandedAttitude,
    rotate_roll_pitch,
    rotate_z,
    slope_along,
    tilt_onto,
    upward_direction,
)
from tarsus.control.readings import Vector
from tarsus.control.sensing.ground_plane import GroundPlane
from tarsus.errors import InputError, UnknownNameError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["LEVELLING_MODES", "Correction", "Levelling", "LevellingMode", "com_shift_ratio"]

_STEP = 1e-3  # [m]


def com_shift_ratio(robot: Robot, feet: Float[Array, "legs 3"]) -> float:
    """Return the shift of the centre of mass over the shift of the body, with the feet fixed.

    The links move less than the body, the less the nearer they are to their feet. Computed by central differences
    over a millimetre, as the mean of forward and sideways.

    Parameters
    ----------
    robot : Robot
        One robot; without masses in its file the links count as massless and the ratio is 1.
    feet : array, shape (legs, 3)
        Feet in B before the shift [m].

    Returns
    -------
    float
        Between the body's fraction of the total mass and 1, for stances that are not close to joint limits.

    Raises
    ------
    InputError
        If the shape is wrong, or a value is not finite.
    """
    steps = _STEP * np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
    shifted = Pose(position=steps)
    angles = inverse_kinematics(robot, np.asarray(feet, dtype=float) - steps[:, None, :]).angles
    centres = shifted @ centre_of_mass(robot, angles)
    return float((centres[0, 0] - centres[1, 0] + centres[2, 1] - centres[3, 1]) / (4 * _STEP))


LevellingMode: TypeAlias = Literal["level", "follow"]
LEVELLING_MODES: tuple[LevellingMode, ...] = ("level", "follow")

# Below this a decaying estimate is set to 0: a hundred-thousandth of a degree.
_NEGLIGIBLE = 1e-7


class Correction(NamedTuple):
    """Correction that is added to the commanded body pose.

    Attributes
    ----------
    x, y : float
        Shift of B along the axes of G rotated by the commanded yaw [m].
    roll, pitch : float
        Changes of the commanded roll and pitch [rad].
    """

    x: float = 0.0
    y: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0


class Levelling:
    """Correction of the body pose on ground that is not level, tick by tick.

    ``"level"`` keeps the commanded attitude relative to gravity, ``"follow"`` relative to the plane through the stance
    feet; None returns to no correction. In both modes the centre of mass, projected along gravity, stays over the point
    where it is on level ground. Without an attitude reading the estimate of gravity decays to G's z axis.

    For any input, corrections stay within their bounds and rates, with a continuous rate.

    Parameters
    ----------
    mode : "level", "follow" or None
        What the attitude refers to; the attribute `mode` may be set at any time.
    com : (x, y, z)
        Centre of mass in B [m].
    com_shift_ratio : float
        Shift of the centre of mass over the shift of the body, from `com_shift_ratio`.
    gain : float
        Bandwidth of the estimate [1/s]. With a total delay T of sensor and servos, stable while ``gain T < 1``; a third
        of that settles without overshoot.
    max_tilt : float
        Greatest magnitude of the correction of roll and pitch together [rad].
    max_shift : float
        Greatest shift [m].
    tilt_rate, shift_rate : float
        Greatest rates of both [rad/s, m/s].
    frequency : float
        Bandwidth with which the corrections follow their targets [rad/s].

    Attributes
    ----------
    correction : Correction
        The last correction.
    lean : (x, y)
        Estimated upward direction of gravity in G: its components along x and y.

    Raises
    ------
    UnknownNameError
        If the mode is unknown.
    InputError
        If a bound is not positive, or `com` not three finite numbers.
    """

    def __init__(
        self,
        mode: LevellingMode | None = None,
        *,
        com: Sequence[float] = (0.0, 0.0, 0.0),
        com_shift_ratio: float = 1.0,
        gain: float = 1.0,
        max_tilt: float = math.radians(20.0),
        max_shift: float = 0.04,
        tilt_rate: float = 0.3,
        shift_rate: float = 0.05,
        frequency: float = 8.0,
    ) -> None:
        for name, bound in (
            ("com_shift_ratio", com_shift_ratio),
            ("gain", gain),
            ("max_tilt", max_tilt),
            ("max_shift", max_shift),
            ("tilt_rate", tilt_rate),
            ("shift_rate", shift_rate),
            ("frequency", frequency),
        ):
            if not 0 < bound < math.inf:
                raise InputError(f"{name} is {bound}; it must be a positive number")
        if len(com) != 3 or not all(math.isfinite(part) for part in com):
            raise InputError(f"com is {com}; it must be three finite numbers")
        self.mode = mode
        self._com = (float(com[0]), float(com[1]), float(com[2]))
        self._com_shift_ratio, self._gain = com_shift_ratio, gain
        self._tilt = RateLimitedFilter(max_tilt, rate=tilt_rate, frequency=frequency)
        self._shift = RateLimitedFilter(max_shift, rate=shift_rate, frequency=frequency)
        self.correction = Correction()
        self.lean = (0.0, 0.0)

    @property
    def mode(self) -> LevellingMode | None:
        """What the attitude refers to: "level", "follow" or None."""
        return self._mode

    @mode.setter
    def mode(self, mode: LevellingMode | None) -> None:
        if mode not in (None, *LEVELLING_MODES):
            raise UnknownNameError.of("levelling mode", str(mode), LEVELLING_MODES)
        self._mode = mode

    def step(
        self, dt: float, plane: GroundPlane | None, attitude: tuple[float, float] | None, commanded: CommandedAttitude
    ) -> Correction:
        """Return the correction after a tick.

        Parameters
        ----------
        dt : float
            Length of the tick [s]; the correction stays unless it is finite and positive.
        plane : GroundPlane or None
            The plane through the stance feet in G; None for level ground.
        attitude : (roll, pitch) or None
            Valid reading of the attitude of B in the world [rad].
        commanded : CommandedAttitude
            Commanded attitude and height; the correction stays unless it is finite.
        """
        if not (0.0 < dt < math.inf and math.isfinite(sum(commanded))):
            return self.correction
        cos, sin = math.cos(commanded.yaw), math.sin(commanded.yaw)
        self._estimate(dt, attitude, commanded, cos, sin)
        up = upward_direction(*rotate_z(*self.lean, cos, -sin))
        tilt = shift = (0.0, 0.0)
        if self._mode is not None:
            slope = slope_along(plane, cos, sin)
            length = math.sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1])
            normal = (-slope[0] / length, -slope[1] / length, 1.0 / length)
            tilt = tilt_onto(up if self._mode == "level" else normal, commanded)
            shift = self._shift_over(up, slope, commanded)
        roll, pitch = self._tilt.step(tilt, dt)
        x, y = self._shift.step(shift, dt)
        self.correction = Correction(x, y, roll, pitch)
        return self.correction

    def _estimate(
        self, dt: float, attitude: tuple[float, float] | None, commanded: CommandedAttitude, cos: float, sin: float
    ) -> None:
        """Move the estimate of gravity's direction in G towards the measured one, or back to G's z axis."""
        x = y = 0.0
        known = attitude is not None and math.isfinite(attitude[0] + attitude[1])
        if known and attitude is not None:
            roll, pitch = attitude
            tilt = math.cos(pitch)
            up = (-math.sin(pitch), tilt * math.sin(roll), tilt * math.cos(roll))
            # With the correction actually applied, bounds and rates cause no wind-up.
            up = rotate_roll_pitch(up, commanded.roll + self.correction.roll, commanded.pitch + self.correction.pitch)
            x, y = rotate_z(up[0], up[1], cos, sin)
        fraction = -math.expm1(-self._gain * dt)
        x, y = self.lean[0] + fraction * (x - self.lean[0]), self.lean[1] + fraction * (y - self.lean[1])
        self.lean = (x, y) if known or abs(x) + abs(y) > _NEGLIGIBLE else (0.0, 0.0)

    def _shift_over(self, up: Vector, slope: tuple[float, float], commanded: CommandedAttitude) -> tuple[float, float]:
        """Return the shift that keeps the centre of mass, projected along gravity, over its point on level ground.

        That point is the projection of the centre of mass of the commanded pose along G's z.
        """
        nominal = rotate_roll_pitch(self._com, commanded.roll, commanded.pitch)
        tilted = rotate_roll_pitch(
            self._com, commanded.roll + self.correction.roll, commanded.pitch + self.correction.pitch
        )
        height = commanded.height + tilted[2] - slope[0] * nominal[0] - slope[1] * nominal[1]
        return (
            (height * up[0] / up[2] + nominal[0] - tilted[0]) / self._com_shift_ratio,
            (height * up[1] / up[2] + nominal[1] - tilted[1]) / self._com_shift_ratio,
        )
