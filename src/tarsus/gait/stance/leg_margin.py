"""Leg margin: distance of each leg to its bounds for a foot anywhere near its rest foothold, in stance and in swing.

The position of a foot in its leg's frame is linear in its position on the ground, so the coefficients are computed once
for a stance. Margins are taken from the sides of the leg's triangle where possible, without trigonometric functions.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.stance.stance_geometry import StanceGeometry, joint_margin
from tarsus.kinematics.triangle import Triangle, solve_triangle, to_leg_frame
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Float

__all__ = ["RESERVED_MARGIN", "LegMargin"]

RESERVED_MARGIN = 0.0015
"""Distance that feet keep from where their leg fails, and knees from the ground [m]."""

# Heights at which feet are tested, in swing heights, each with the horizontal distance from the rest foothold at that
# height over that on the ground.
_HEIGHTS = ((0.0, 1.0), (0.5, 0.9), (1.0, 0.4))
# Greatest ratio of joint speed to foot speed, relative to that at the rest foothold.
_SPEED_RATIO = 4.0
# Number of foot positions solved at once: larger arrays take disproportionately long.
_BLOCK = 2600


class LegMargin:
    """Margins of the legs in one stance.

    Parameters
    ----------
    robot, stance : Robot, StanceGeometry
        A single robot; the body and the rest footholds.
    knees : bool
        Whether femur axes and knees must stay above the ground.
    """

    def __init__(self, robot: Robot, stance: StanceGeometry, *, knees: bool = True) -> None:
        self._g = g = robot.geometry.with_axes(1)
        self._sideways = bool(g.side.any())
        p, rest = stance.position, stance.rest[:, None]
        swing_heights = [(part * stance.swing_height, narrower) for part, narrower in _HEIGHTS]
        height, self._narrower = (np.array(column)[:, None, None] for column in zip(*swing_heights, strict=True))
        self._at_rest = to_leg_frame(g, *stance.to_body(rest.real - p[0], rest.imag - p[1], height - p[2]))
        # Unit vectors along x and y of the heading frame, in the legs' frames.
        rows = stance.rotation[:2]
        self._along_x, self._along_y = (_in_legs(g, *row.tolist()) for row in rows)
        # The ground's normal in B, and the height of B's origin above the ground.
        up, above = stance.rotation[2], float(stance.position[2])
        self._up = _in_legs(g, *up.tolist())
        self._rising, self._tilted = bool(rows[0][2] or rows[1][2]), bool(up[:2].any())
        self._axis_height = up[0] * g.mount_x + up[1] * g.mount_y + up[2] * (g.mount_z + g.up) + above
        self._lowest_femur = _lowest_femur(g, up, above) if knees else -math.inf
        self._no_knees = np.zeros(len(_HEIGHTS), dtype=bool)
        self._speed_at_rest = self._joint_speed(self._solve(np.zeros_like(g.coxa), np.zeros_like(g.coxa)))[0]

    def __call__(self, out: Complex[np.ndarray, "*#batch #legs"]) -> Float[np.ndarray, "*batch legs"]:
        """Return the least margin over all heights, negative where the leg fails.

        Parameters
        ----------
        out : complex array, shape (..., legs) or (..., 1)
            Positions relative to the rest footholds [m].

        Returns
        -------
        array, shape (..., legs)
            Distance to the nearest bound: angles in [rad], reach as in `joint_margin`, knee height in [m], joint speed
            relative to that at the rest foothold.
        """
        flat = np.ascontiguousarray(out.reshape(-1, out.shape[-1]).T)
        blocks = math.ceil(flat.shape[1] * self._g.coxa.size * len(self._no_knees) / _BLOCK)
        parts = np.array_split(flat, blocks, axis=1)
        # At each height, the knees are tested for all positions or for none, so that the result does not depend on the
        # blocks. Knees are lowest where feet are far out, in the last block, which therefore comes first.
        low, found = self._no_knees, []
        for part in reversed(parts):
            margin, low = self._at(part, low)
            found.append((part, margin, low))
        margins = [margin if (at == low).all() else self._at(part, low)[0] for part, margin, at in reversed(found)]
        return np.concatenate(margins, axis=1).T.reshape(*out.shape[:-1], -1)

    def _at(
        self, out: Complex[np.ndarray, "#legs n"], low: Bool[np.ndarray, "heights"]
    ) -> tuple[Float[np.ndarray, "legs n"], Bool[np.ndarray, "heights"]]:
        """Return the least margin ``(legs, n)``, and the heights at which knees are tested in any block so far."""
        solution = self._solve(out.real, out.imag)
        margin = joint_margin(self._g, solution)
        low = low | (solution.femur.min(axis=(1, 2)) <= self._lowest_femur)
        if low.any():
            margin[low] = np.minimum(margin[low], self._above_ground(solution, low) - RESERVED_MARGIN)
        margin = np.minimum(margin, _SPEED_RATIO - self._joint_speed(solution) / self._speed_at_rest)
        return np.asarray(margin.min(axis=0)), low

    def _solve(self, x: Float[np.ndarray, "#legs n"], y: Float[np.ndarray, "#legs n"]) -> Triangle:
        """Return the joint angles ``(heights, legs, n)`` at positions relative to the rest footholds ``(legs, n)``."""
        rest, (xx, xy, xz), (yx, yy, yz) = self._at_rest, self._along_x, self._along_y
        narrower = self._narrower
        in_x, in_y = rest[0] + narrower * (xx * x + yx * y), rest[1] + narrower * (xy * x + yy * y)
        in_z = rest[2] + narrower * (xz * x + yz * y) if self._rising else rest[2]
        return solve_triangle(np, self._g, in_x, in_y, in_z, knee=1, sideways=self._sideways)

    def _joint_speed(self, s: Triangle) -> Float[np.ndarray, "heights legs n"]:
        """Return the greatest joint speed over the speed of the foot [rad/m]."""
        # In its plane, the leg's Jacobian has the determinant femur tibia sin(tibia angle): twice the area of the
        # triangle, which is half the root of `far near`. The sum of its squared elements is that of the squared
        # distances from the foot to the femur axis and to the knee. Where the triangle does not close, the
        # leg fails anyway.
        g = self._g
        across = np.sqrt(np.maximum(s.far * s.near, 4e-18)) / 2
        in_plane = np.sqrt(g.farthest2 + g.tibia * g.tibia - s.far) / across
        return np.asarray(np.maximum(in_plane, 1 / np.sqrt(np.maximum(s.beside, 1e-18))))

    def _above_ground(self, s: Triangle, heights: Bool[np.ndarray, "heights"]) -> Float[np.ndarray, "k legs n"]:
        """Return the height of each leg's femur axis or knee, whichever is lower, at some of the heights [m]."""
        g, (up_x, up_y, up_z) = self._g, self._up
        femur = s.femur[heights]
        if not self._tilted:
            return np.asarray(self._axis_height + np.minimum(g.femur * np.sin(femur) * up_z, 0.0))
        cos, sin = np.cos(s.coxa[heights]), np.sin(s.coxa[heights])
        outward = up_x * cos + up_y * sin
        axis = self._axis_height + g.coxa * outward + g.side * (up_y * cos - up_x * sin)
        knee = g.femur * (np.cos(femur) * outward + np.sin(femur) * up_z)
        return np.asarray(axis + np.minimum(knee, 0.0))


def _in_legs(
    g: LegGeometry, x: float, y: float, z: float
) -> tuple[Float[np.ndarray, "legs 1"], Float[np.ndarray, "legs 1"], float]:
    """Return the components of a vector of B in each leg's frame."""
    return g.cos_yaw * x + g.sin_yaw * y, g.cos_yaw * y - g.sin_yaw * x, z


def _lowest_femur(g: LegGeometry, up: Float[np.ndarray, "3"], above: float) -> float:
    """Return the femur angle above which no femur axis or knee of a stance can be below the ground [rad].

    The inverse of the bound in `certainly_above_ground`.
    """
    x, y, z = up.tolist()
    clearance = above - math.hypot(x, y) * g.knee_span
    if z < 0 or clearance.min() <= 0:
        return math.inf
    drop = float(((clearance - g.axis_depth) / g.femur).min())
    return -math.inf if drop > 1 else -math.asin(drop) if drop > 0 else math.inf
