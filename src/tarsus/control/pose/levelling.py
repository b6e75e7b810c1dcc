"""Holding the body level or along the slope, its centre of mass over the support.

The walker's ground frame G has a vertical of its own. On ground that is steeper than the walker knows, or on feet that
give way, it leans against gravity's. An attitude sensor tells how: with R the attitude that B was commanded to have in
G, and u the upward direction in B that was measured, ``R u`` is gravity's upward direction in G. Slowly averaged, it is
the one thing estimated here; the corrections follow from it in closed form (docs/ground.md).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from tarsus.arrays import Array
from tarsus.control.filters import RateLimitedFilter
from tarsus.control.pose.attitude import CommandedAttitude, direction, rotated, slope_along, tilt_onto, turned
from tarsus.control.readings import Vector
from tarsus.control.sensing.ground_plane import GroundPlane
from tarsus.errors import InputError, UnknownNameError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

__all__ = ["LEVELLING_MODES", "Correction", "Levelling", "LevellingMode", "com_shift_ratio"]

_STEP = 1e-3  # [m]


def com_shift_ratio(robot: Robot, feet: Array) -> float:
    """Return the share of the body's shift over the ground that the centre of mass makes.

    The body's mass goes all the way, the links' less the nearer they are to their feet. By central differences over
    a millimetre; the mean of forward and sideways.

    Parameters
    ----------
    robot : Robot
        One robot; where its file gives no masses, the links count as massless and the share is 1.
    feet : array, shape (legs, 3)
        Where the feet stand, in B before the shift [m].

    Returns
    -------
    float
        Between the body's share of the whole mass and 1, in any stance that is not close to a leg's limits.

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

# Below this an estimate that fades away has gone: a lean of less than a hundred-thousandth of a degree.
_NOTHING = 1e-7


class Correction(NamedTuple):
    """What to add to the command.

    Attributes
    ----------
    x, y : float
        Shift of B along the axes of G turned by the commanded yaw [m].
    roll, pitch : float
        To be added to the commanded ones [rad].
    """

    x: float = 0.0
    y: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0


class Levelling:
    """The body's correction on ground that is not level, tick by tick.

    ``"level"`` keeps the attitude that is wished for against gravity, ``"follow"`` against the plane through the
    stance feet; None goes back to no correction. In both, the centre of mass stays, seen along gravity, over the place
    where it is on level ground. Without an attitude the corrections that need one fade to zero, and gravity is taken
    to act along G's z.

    Whatever comes in, corrections stay within their bounds, change no faster than their rates, and change smoothly.

    Parameters
    ----------
    mode : "level", "follow" or None
        What to do; may be changed at any time by setting the attribute of that name.
    com : (x, y, z)
        Centre of mass in B [m].
    com_shift_ratio : float
        How far the centre of mass goes with the body when it is shifted over feet that stay, as a share: less than
        1, as the legs' masses lag behind.
    gain : float
        How fast the estimate follows the sensor [1/s]. Where sensor and servos together are late by T, stable while
        ``gain T < 1``; a third of that settles without swinging.
    max_tilt : float
        Greatest correction of roll and pitch, together [rad].
    max_shift : float
        Greatest shift [m].
    tilt_rate, shift_rate : float
        Greatest speeds of both [rad/s, m/s].
    frequency : float
        How fast the corrections follow their goals [rad/s].

    Attributes
    ----------
    correction : Correction
        The last.
    lean : (x, y)
        Gravity's upward direction in G as estimated: its parts along G's x and y.

    Raises
    ------
    UnknownNameError
        If there is no such mode.
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
        """What to do: "level", "follow" or None."""
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
            Length of the tick [s]; nothing moves unless it is finite and positive.
        plane : GroundPlane or None
            The plane through the stance feet in G; None for level ground.
        attitude : (roll, pitch) or None
            How B leans in the world, as measured and admitted [rad].
        commanded : Commanded
            Where the command has the body; nothing moves unless it is finite.
        """
        if not (0.0 < dt < math.inf and math.isfinite(sum(commanded))):
            return self.correction
        cos, sin = math.cos(commanded.yaw), math.sin(commanded.yaw)
        self._estimate(dt, attitude, commanded, cos, sin)
        up = direction(*turned(*self.lean, cos, -sin))
        tilt = shift = (0.0, 0.0)
        if self._mode is not None:
            slope = slope_along(plane, cos, sin)
            steep = math.sqrt(1.0 + slope[0] * slope[0] + slope[1] * slope[1])
            normal = (-slope[0] / steep, -slope[1] / steep, 1.0 / steep)
            tilt = tilt_onto(up if self._mode == "level" else normal, commanded)
            shift = self._shift_over(up, slope, commanded)
        roll, pitch = self._tilt.step(tilt, dt)
        x, y = self._shift.step(shift, dt)
        self.correction = Correction(x, y, roll, pitch)
        return self.correction

    def _estimate(
        self, dt: float, attitude: tuple[float, float] | None, commanded: CommandedAttitude, cos: float, sin: float
    ) -> None:
        """Move the estimate of gravity's direction in G towards what is measured, or back to G's own vertical."""
        x = y = 0.0
        known = attitude is not None and math.isfinite(attitude[0] + attitude[1])
        if known and attitude is not None:
            roll, pitch = attitude
            tilt = math.cos(pitch)
            up = (-math.sin(pitch), tilt * math.sin(roll), tilt * math.cos(roll))
            # The correction that is under way is in the sum: no wind-up, whatever bounds or slows it.
            up = rotated(up, commanded.roll + self.correction.roll, commanded.pitch + self.correction.pitch)
            x, y = turned(up[0], up[1], cos, sin)
        share = -math.expm1(-self._gain * dt)
        x, y = self.lean[0] + share * (x - self.lean[0]), self.lean[1] + share * (y - self.lean[1])
        self.lean = (x, y) if known or abs(x) + abs(y) > _NOTHING else (0.0, 0.0)

    def _shift_over(self, up: Vector, slope: tuple[float, float], commanded: CommandedAttitude) -> tuple[float, float]:
        """Return the shift that brings the centre of mass, seen along gravity, over its place on level ground.

        That place is on the ground under the centre of mass as it was wished for, seen along G's z.
        """
        wished = rotated(self._com, commanded.roll, commanded.pitch)
        tilted = rotated(self._com, commanded.roll + self.correction.roll, commanded.pitch + self.correction.pitch)
        height = commanded.height + tilted[2] - slope[0] * wished[0] - slope[1] * wished[1]
        return (
            (height * up[0] / up[2] + wished[0] - tilted[0]) / self._com_shift_ratio,
            (height * up[1] / up[2] + wished[1] - tilted[1]) / self._com_shift_ratio,
        )
