"""Slope stance: to keep the body level, legs turn to point across the slope, and downhill feet are drawn in."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.foot_plane import FootPlane
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["SlopeStance"]

# Slopes between which the stance changes, in proportion [rad].
_LEAST, _MOST = math.radians(6.0), math.radians(14.0)
# How far legs turn about their coxa axes on a slope along the body [rad]; on one across the body, feet would come too
# close together. How far feet are drawn in, over the length of femur and tibia.
_TURNED, _DRAWN_IN = math.radians(30.0), 0.13
# How far feet are drawn in on rough ground at most, over their distance from the coxa axes.
_NEAREST = 0.4
# Slopes between which feet come down ever more slowly [m/m], and the time over which slopes are averaged for that [s]:
# feet push on after contact, throw the body up, and slide as it comes down. On rough ground, slopes do not last.
_SLOW_FROM, _SLOW, _LASTS = 0.18, 0.27, 1.0
# Cycle time on a slope on which the stance changes, over that on level ground: feet slide downhill with each step, and
# longer cycles mean fewer steps.
_LONGER = 1.125
# Downhill component of a leg's direction from which on its foot is drawn in fully; below, it is in proportion.
_DOWNHILL = 2 / 3
# Changes of the stance below which none is made: while the robot walks, and while it would step for them alone [m].
_SMALLEST, _STANDING = 0.005, 0.03
# Clearance between body and slope that is kept in reserve, as legs sag [m].
_ROOM = 0.04


class SlopeStance:
    """Moves the rest footholds with the slope: feet far uphill and downhill come closer to the height below mid-body.

    Parameters
    ----------
    robot, scale : Robot, float
        A single robot; factor by which lengths are reduced on short legs, 0 to 1.

    Attributes
    ----------
    half : tuple of float
        Half the body's length, width and height [m].
    shift : complex array, shape (legs,)
        Displacement of each rest foothold, in the heading frame [m].
    uphill : complex
        The slope in the heading frame [m/m]; 0 where the stance is that of level ground.
    lasting : float
        How much feet slow down before contact on a slope that lasts, 0 to 1.
    """

    def __init__(self, robot: Robot, *, scale: float = 1.0) -> None:
        g, size = robot.geometry, robot.body_size
        self.shift: Complex[np.ndarray, "legs"] = np.zeros(robot.legs, dtype=complex)
        self.uphill, self.lasting, self._mean, self._scale = 0j, 0.0, 0j, scale
        self._mounts: Complex[np.ndarray, "legs"] = np.asarray(g.mount_x + 1j * g.mount_y)
        self._drawn_in: Float[np.ndarray, "legs"] = np.asarray(_DRAWN_IN * (g.femur + g.tibia))
        self.half = (0.0, 0.0, 0.0) if size is None else tuple((np.asarray(size) / 2).tolist())

    @property
    def cycle_time(self) -> float:
        """Cycle time over that on level ground."""
        return _LONGER if self.uphill else 1.0

    def step(
        self, level: FootPlane, rest: Complex[np.ndarray, "legs"], drawn_in: float, dt: float, *, walks: bool
    ) -> None:
        """Follow the slope, and the roughness.

        Parameters
        ----------
        level : FootPlane
            The plane of the feet as a level body sees it.
        rest : complex array, shape (legs,)
            Rest footholds on level ground, in the heading frame [m].
        drawn_in, dt : float
            How far all feet are drawn in for rough ground [m]; time since the last call [s].
        walks : bool
            Whether the body is to move: a standing robot makes only greater changes, as its feet slide when they step.
        """
        uphill = complex(level.slope_x, level.slope_y)
        self._mean += min(dt / _LASTS, 1.0) * (uphill - self._mean)
        self.lasting = min(max((abs(self._mean) - _SLOW_FROM) / (_SLOW - _SLOW_FROM), 0.0), 1.0)
        share = min(max((math.atan(abs(uphill)) - _LEAST) / (_MOST - _LEAST), 0.0), 1.0)
        self.uphill = uphill if share else 0j
        if not share and not drawn_in and not self.shift.any():
            return
        out = rest - self._mounts
        angle = np.angle(out * uphill.conjugate())
        downhill = np.clip(-np.cos(angle) / _DOWNHILL, 0.0, 1.0)
        nearer = np.minimum(drawn_in, _NEAREST * np.abs(out)) * (1 - share) + share * self._drawn_in * downhill
        turned = share * _TURNED * math.cos(cmath.phase(uphill)) ** 2
        wanted = out * ((1 - nearer / np.abs(out)) * np.exp(1j * turned * np.sin(2 * angle)) - 1)
        least = self._scale * (_SMALLEST if walks else _STANDING) if share or drawn_in else 0.0
        if float(np.abs(wanted - self.shift).max()) > least:
            self.shift = wanted

    def not_downhill(self, velocity: complex) -> complex:
        """Return a correction of the velocity without its downhill part, as feet slip downhill unnoticed [m/s]."""
        along = (velocity * self.uphill.conjugate()).real
        return velocity - along * self.uphill / abs(self.uphill) ** 2 if along < 0 else velocity

    def underside(self, plane: FootPlane, height: float) -> tuple[float, float]:
        """Return the greatest rise of a slope under the edges of the body, and the greatest that it may have there [m].

        Parameters
        ----------
        plane, height : FootPlane, float
            The plane of the feet, in the heading frame; commanded height of the body [m].
        """
        rise = abs(plane.slope_x) * self.half[0] + abs(plane.slope_y) * self.half[1]
        return float(rise), float(max(height - self.half[2] - self._scale * _ROOM, 0.0))
