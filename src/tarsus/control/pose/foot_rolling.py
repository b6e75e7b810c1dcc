"""Rolling of the spherical feet of a live walk, as their legs turn over them in stance."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, sqrt
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.readings import Vector
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT, Rows, rotation_rows
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Float

__all__ = ["FootRolling"]

# Rotation of the body, and position of its origin [m].
_Body: TypeAlias = tuple[Rows, Sequence[float]]

# Bandwidth with which changes of rest footholds and of legs out of the gait are followed: within a swing [rad/s].
_BANDWIDTH = 12.0
# Keeps quotients finite for a straight leg, and for a foot on its femur axis [m^2].
_TINY = 1e-12


class FootRolling:
    """Displaces the feet by the distance that their balls have rolled.

    A ball of radius `r` rolls by ``-r`` times the change of its tibia's inclination, along the direction in which the
    leg points. With the inclination at the rest foothold as the origin, the displacement of the foot depends on posture
    and foothold alone: the same function at lift-off and at touchdown, continuous from stance to swing, towards the
    rest foothold, and zero there. It neglects that the leg turns while the ball rolls, which is of second order: less
    than 0.3 % of a stroke. Where posture or rest footholds change, the origin follows, so that a foot at rest is at
    its rest foothold again. The origin of a standing foot follows other rest footholds only from its next lift-off on,
    as its ball would slide otherwise.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Attributes
    ----------
    started : bool
        Whether feet roll: never for a robot whose feet are points, for others from the first tick on.

    Notes
    -----
    `tarsus.gait.rolling_feet` integrates the rolling over a plan, which is known in advance.
    """

    def __init__(self, robot: Robot) -> None:
        self._radius = np.asarray(robot.foot_radius, dtype=float)
        self._rolls = bool(self._radius.any())
        self.started = False
        self._rest = np.zeros(0)
        self._out: list[int] = []
        g = robot.geometry
        rows = (g.mount_x, g.mount_y, g.mount_z + g.up, g.coxa, g.side, g.side2)
        columns = [column.tolist() for column in (*rows, g.farthest2, g.nearest2, g.difference2)]
        self._legs: list[tuple[float, ...]] = list(zip(*columns, strict=True))
        # Rest footholds, x and y, and the radius of each ball, 0 for legs out of the gait [m].
        self._goal = np.zeros(3 * robot.legs)
        # The same, but for standing feet with the rest footholds of when they came down.
        self._aim = self._goal
        self._filter = CriticallyDamped.still(self._goal)
        # Result of `balls`, and the posture and rest footholds for which it holds.
        self._balls: list[tuple[float, float]] = []
        self._solved = np.zeros(0), self._filter

    def step(
        self, rest: Complex[np.ndarray, "legs"], out_of_gait: list[int], dt: float, *, down: Bool[np.ndarray, "legs"]
    ) -> None:
        """Advance by a tick.

        Parameters
        ----------
        rest : complex array, shape (legs,)
            Rest footholds in the heading frame [m].
        out_of_gait, dt : list of int, float
            Legs taken out of the gait, whose feet are where they are commanded to be; length of the tick [s].
        down : array of bool, shape (legs,)
            Feet that are not in a swing.
        """
        if not self._rolls:
            return
        if rest is not self._rest or out_of_gait != self._out:
            radius = self._radius.copy()
            radius[out_of_gait] = 0.0
            goal = np.concatenate([rest.real, rest.imag, radius])
            self._goal = self._goal if np.array_equal(goal, self._goal) else goal
            self._rest, self._out = rest, out_of_gait
        if not self.started:
            self.started, self._aim, self._filter = True, self._goal, CriticallyDamped.still(self._goal)
        if self._aim is not self._goal:
            aim = np.where(np.concatenate([down, down, np.zeros_like(down)]), self._aim, self._goal)
            self._aim = self._goal if np.array_equal(aim, self._goal) else aim
        self._filter = self._filter.settling_step(self._aim, dt, bandwidth=_BANDWIDTH)

    def balls(self, posture: Float[np.ndarray, "_"]) -> list[tuple[float, float]]:
        """Return each ball's radius, 0 for a leg out of the gait, and the radius times its tibia's inclination at rest.

        The result is kept for as long as the stance stays the same.

        Parameters
        ----------
        posture : array, shape (7,) or more
            The posture.

        Returns
        -------
        list of (radius, at_rest)
            For each foot [m]; the inclination is that of the tibia over the ground, with the foot at its rest foothold.
        """
        if self._solved[0] is posture and self._solved[1] is self._filter:
            return self._balls
        x, y, radius = self._filter.value.reshape(3, -1).tolist()
        *position, roll, pitch, yaw = posture[:SWING_HEIGHT].tolist()
        level = [0.0] * len(x)
        rest = list(zip(x, y, level, strict=True))
        legs = self._legs_over_ground(rest, level, (rotation_rows(roll, pitch, yaw), position))
        self._balls = [(ball, ball * leg[2]) for ball, leg in zip(radius, legs, strict=True)]
        self._solved = posture, self._filter
        return self._balls

    def rolled(
        self, feet: Sequence[Vector], standing: Sequence[float], body: _Body, *, posture: Float[np.ndarray, "_"]
    ) -> list[Vector]:
        """Return the feet, displaced by the rolling of their balls.

        Parameters
        ----------
        feet : sequence of (x, y, z)
            Where the feet would be as points, in a frame whose z axis is vertical [m].
        standing : sequence of float
            The height in that frame at which each foot stands [m]: how far a foot has rolled does not depend on how
            high it is lifted, so that rolling is continuous at lift-off and touchdown.
        body : (three rows, (x, y, z))
            Rotation of the body, and position of its origin, in that frame [m].
        posture : array, shape (7,) or more
            The posture without sway and body shift, for which a foot at rest is at its rest foothold.
        """
        legs = zip(feet, self.balls(posture), self._legs_over_ground(feet, standing, body), strict=True)
        found = []
        for (fx, fy, fz), (radius, at_rest), (x, y, inclination, bend, out) in legs:
            # A Newton step: the tibia turns further as the foot moves.
            gain = bend / (bend + 2.0 * radius * (out if out > 0.0 else 0.0) + _TINY)
            distance = gain * (at_rest - radius * inclination)
            found.append((fx + distance * x, fy + distance * y, fz))
        return found

    def _legs_over_ground(
        self, feet: Sequence[Vector], heights: Sequence[float], body: _Body
    ) -> list[tuple[float, float, float, float, float]]:
        """Return each leg's direction over the ground, its tibia's inclination, and its knee's bend and distance."""
        ((r00, r01, r02), (r10, r11, r12), (r20, r21, r22)), (px, py, pz) = body
        found = []
        for (fx, fy, _), height, leg in zip(feet, heights, self._legs, strict=True):
            mx, my, mz, coxa, side, side2, farthest2, nearest2, difference2 = leg
            dx, dy, dz = fx - px, fy - py, height - pz
            bx, by = dx * r00 + dy * r10 + dz * r20 - mx, dx * r01 + dy * r11 + dz * r21 - my
            z = dx * r02 + dy * r12 + dz * r22 - mz
            across2 = bx * bx + by * by + _TINY
            along = sqrt(across2 - side2) if across2 > side2 else 0.0
            # The direction of the leg in B.
            x, y = (bx * along + by * side) / across2, (by * along - bx * side) / across2
            r = along - coxa
            distance2 = r * r + z * z + _TINY
            area2, base = (farthest2 - distance2) * (distance2 - nearest2), distance2 + difference2
            bend, half = sqrt(area2) if area2 > 0.0 else 0.0, 0.5 / distance2
            # The knee, from the femur axis: the triangle of `tarsus.kinematics.triangle`.
            out, up = (r * base - z * bend) * half, (z * base + r * bend) * half
            inclination = atan2(z - up, r - out) + r20 * x + r21 * y
            found.append((r00 * x + r01 * y, r10 * x + r11 * y, inclination, bend, out))
        return found
