"""How much is left to the legs of a stand wherever a foot is, on the ground and on its way over it.

What a foot's place is in its leg's frame is linear in the place, so that all that belongs to the stand is worked out
once; and what the triangle of the leg tells by its sides needs no sine.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.workspace.stance_geometry import RAISED_FRACTION, StanceGeometry, joint_margin
from tarsus.kinematics.triangle import Triangle, solve_triangle, to_leg_frame
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

__all__ = ["RESERVED_MARGIN", "LegMargin"]

Floats = np.ndarray[Any, Any]

RESERVED_MARGIN = 0.0015
"""What feet keep from where their leg fails, and knees from the ground [m]."""

# How much of the way each side is a foot may be at half the lift and at the whole, shares of the way on the ground.
_LIFTS = ((0.0, 1.0), (0.5, 0.9), (1.0, 0.4))
# A joint may turn this much faster for the same speed of the foot than it does at the rest foothold.
_FASTER = 4.0
# How many places of feet are looked at at once.
_BLOCK = 2600


class LegMargin:
    """How much is left to each leg of a stand.

    Parameters
    ----------
    robot : Robot
        A single robot.
    stand : Stand
        The body and the rest footholds.
    knees : bool
        Whether the ground is in the way of femur axes and knees.
    """

    def __init__(self, robot: Robot, stand: StanceGeometry, *, knees: bool = True) -> None:
        self._g = g = robot.geometry
        self._sideways = bool(g.side.any())
        p, rest = stand.position, stand.rest
        swing_heights = [(part * stand.swing_height, narrower) for part, narrower in _LIFTS]
        # Where ground may be lower than it is expected, all of the polygon must do for feet there too; where it may be
        # higher, feet are lifted from there.
        uneven = [(stand.swing_height + RAISED_FRACTION * stand.depth, swing_heights[-1][1]), (-stand.depth, 1.0)]
        heights = [*swing_heights[:-1], *uneven] if stand.depth else swing_heights
        height, self._narrower = (np.array(column)[:, None, None] for column in zip(*heights, strict=True))
        at_rest = stand.to_body(rest.real - p[0], rest.imag - p[1], height[:, 0] - p[2])
        self._at_rest = [part[:, None] for part in to_leg_frame(g, *at_rest)]
        # What a step over the ground along x or y of the heading frame is in the legs' frames, and what up is.
        slope, r = stand.slope, stand.rotation
        rows = (r[0] + slope.real * r[2], r[1] + slope.imag * r[2]) if slope else (r[0], r[1])
        self._along_x, self._along_y = (_in_legs(g, *row.tolist()) for row in rows)
        up, above = _over_ground(stand)
        self._up = _in_legs(g, *up.tolist())
        self._rising, self._tilted = bool(rows[0][2] or rows[1][2]), bool(up[:2].any())
        self._axis_height = up[0] * g.mount_x + up[1] * g.mount_y + up[2] * (g.mount_z + g.up) + above
        self._lowest_femur = _lowest_femur(g, up, above) if knees else -math.inf
        self._nowhere = np.zeros(len(heights), dtype=bool)
        self._turning_at_rest = self._turning(self._solve(np.zeros((1, len(rest))), np.zeros((1, len(rest)))))[0, 0]

    def __call__(self, out: Floats) -> Floats:
        """Return the least slack at all heights over places, negative where the leg fails.

        Parameters
        ----------
        out : complex array, shape (..., legs) or (..., 1)
            The places, seen from the rest footholds [m].

        Returns
        -------
        array, shape (..., legs)
            How far the nearest bound is: [rad], of lengths over the reach, of the knee's height [m].
        """
        flat = out.reshape(-1, out.shape[-1])
        # Larger arrays than these cost more than their share of time.
        blocks = math.ceil(len(flat) * self._g.coxa.size * len(self._nowhere) / _BLOCK)
        parts = np.array_split(flat, blocks)
        # At each height, knees count for all places or for none: what is worked out at once makes no difference. They
        # are lowest far out, at the end.
        low, found = self._nowhere, []
        for part in reversed(parts):
            slack, low = self._at(part, low)
            found.append((part, slack, low))
        all_slack = [slack if (at == low).all() else self._at(part, low)[0] for part, slack, at in reversed(found)]
        return np.concatenate(all_slack).reshape(*out.shape[:-1], -1)

    def _at(self, out: Floats, low: Floats) -> tuple[Floats, Floats]:
        """Return the least slack ``(n, legs)``, and at which heights knees count, be it elsewhere or here."""
        solution = self._solve(out.real, out.imag)
        slack = joint_margin(self._g, solution)
        low = low | (solution.femur.min(axis=(1, 2)) <= self._lowest_femur)
        if low.any():
            slack[low] = np.minimum(slack[low], self._above_ground(solution, low) - RESERVED_MARGIN)
        slack = np.minimum(slack, _FASTER - self._turning(solution) / self._turning_at_rest)
        return np.asarray(slack.min(axis=0)), low

    def _solve(self, x: Floats, y: Floats) -> Triangle:
        """Return the joint angles ``(heights, n, legs)`` at places seen from the rest footholds ``(n, legs)``."""
        rest, (xx, xy, xz), (yx, yy, yz) = self._at_rest, self._along_x, self._along_y
        narrower = self._narrower
        in_x, in_y = rest[0] + narrower * (xx * x + yx * y), rest[1] + narrower * (xy * x + yy * y)
        in_z = rest[2] + narrower * (xz * x + yz * y) if self._rising else rest[2]
        return solve_triangle(np, self._g, in_x, in_y, in_z, knee=1, sideways=self._sideways)

    def _turning(self, s: Triangle) -> Floats:
        """Return how fast the joints turn at most, over the foot's speed [rad/m]."""
        # The leg's Jacobian in its plane has the determinant femur tibia sin(tibia angle), twice the triangle's area
        # and so half the root of `far near`; the squares of its elements add up to those of the distances from foot
        # to femur axis and to knee. Where the triangle doesn't close, the leg fails anyway.
        g = self._g
        across = np.sqrt(np.maximum(s.far * s.near, 4e-18)) / 2
        in_plane = np.sqrt(g.farthest2 + g.tibia * g.tibia - s.far) / across
        return np.asarray(np.maximum(in_plane, 1 / np.sqrt(np.maximum(s.beside, 1e-18))))

    def _above_ground(self, s: Triangle, heights: Floats) -> Floats:
        """Return how high each leg's femur axis or knee is, whichever is lower, at some of the heights [m]."""
        g, (up_x, up_y, up_z) = self._g, self._up
        femur = s.femur[heights]
        if not self._tilted:
            return np.asarray(self._axis_height + np.minimum(g.femur * np.sin(femur) * up_z, 0.0))
        cos, sin = np.cos(s.coxa[heights]), np.sin(s.coxa[heights])
        outward = up_x * cos + up_y * sin
        axis = self._axis_height + g.coxa * outward + g.side * (up_y * cos - up_x * sin)
        knee = g.femur * (np.cos(femur) * outward + np.sin(femur) * up_z)
        return np.asarray(axis + np.minimum(knee, 0.0))


def _in_legs(g: LegGeometry, x: float, y: float, z: float) -> tuple[Floats, Floats, float]:
    """Return a vector of B in each leg's frame."""
    return g.cos_yaw * x + g.sin_yaw * y, g.cos_yaw * y - g.sin_yaw * x, z


def _over_ground(stand: StanceGeometry) -> tuple[Floats, float]:
    """Return the ground's normal in B, and how far B's origin is from the ground [m]."""
    up, above = stand.rotation[2], float(stand.position[2])
    if not stand.slope:
        return up, above
    normal = up - stand.slope.real * stand.rotation[0] - stand.slope.imag * stand.rotation[1]
    size = float(np.linalg.norm(normal))
    return normal / size, above / size


def _lowest_femur(g: LegGeometry, up: Floats, above: float) -> float:
    """Return down to which femur angle surely no femur axis or knee of a stand is below the ground [rad].

    The bound of `surely_above`, the other way round.
    """
    x, y, z = up.tolist()
    left = above - math.hypot(x, y) * g.knee_span
    if z < 0 or left.min() <= 0:
        return math.inf
    drop = float(((left - g.axis_depth) / g.femur).min())
    return -math.inf if drop > 1 else -math.asin(drop) if drop > 0 else math.inf
