"""How much is left to the legs of a stand wherever a foot is, on the ground and on its way over it.

What a foot's place is in its leg's frame is linear in the place, so that all that belongs to the stand is worked out
once; and what the triangle of the leg tells by its sides needs no sine.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.gait.live.stand import Stand, joint_slack
from tarsus.kinematics.triangle import Triangle, solve_triangle, to_leg_frame
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

__all__ = ["KEEP", "StandSlack"]

Floats = np.ndarray[Any, Any]

KEEP = 0.0015
"""What feet keep from where their leg fails, and knees from the ground [m]."""

# How much of the way each side is a foot may be at half the lift and at the whole, shares of the way on the ground.
_HEIGHTS = np.array([0.0, 0.5, 1.0])[:, None]
_NARROWER = np.array([1.0, 0.9, 0.4])[:, None, None]
# A joint may turn this much faster for the same speed of the foot than it does at the rest foothold.
_FASTER = 4.0
_NOWHERE = np.zeros(len(_HEIGHTS), dtype=bool)
# How many places of feet are looked at at once.
_BLOCK = 2600


class StandSlack:
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

    def __init__(self, robot: Robot, stand: Stand, *, knees: bool = True) -> None:
        self._g = g = robot.geometry
        self._sideways = bool(g.side.any())
        p, rest = stand.position, stand.rest
        at_rest = stand.turned_into_body(rest.real - p[0], rest.imag - p[1], _HEIGHTS * stand.lift - p[2])
        self._at_rest = [part[:, None] for part in to_leg_frame(g, *at_rest)]
        # What a step along x, y or z of the heading frame is in the legs' frames.
        self._along_x, self._along_y, self._up = (_in_legs(g, *stand.rotation[i].tolist()) for i in range(3))
        self._tilted = bool(stand.rotation[:2, 2].any())
        self._axis_height = _axis_height(g, stand)
        self._lowest_femur = _lowest_femur(g, stand) if knees else -math.inf
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
        blocks = math.ceil(len(flat) * self._g.coxa.size * len(_HEIGHTS) / _BLOCK)
        parts = np.array_split(flat, blocks)
        # At each height, knees count for all places or for none: what is worked out at once makes no difference. They
        # are lowest far out, at the end.
        low, found = _NOWHERE, []
        for part in reversed(parts):
            slack, low = self._at(part, low)
            found.append((part, slack, low))
        all_slack = [slack if (at == low).all() else self._at(part, low)[0] for part, slack, at in reversed(found)]
        return np.concatenate(all_slack).reshape(*out.shape[:-1], -1)

    def _at(self, out: Floats, low: Floats) -> tuple[Floats, Floats]:
        """Return the least slack ``(n, legs)``, and at which heights knees count, be it elsewhere or here."""
        solution = self._solve(out.real, out.imag)
        slack = joint_slack(self._g, solution)
        low = low | (solution.femur.min(axis=(1, 2)) <= self._lowest_femur)
        if low.any():
            slack[low] = np.minimum(slack[low], self._above_ground(solution, low) - KEEP)
        slack = np.minimum(slack, _FASTER - self._turning(solution) / self._turning_at_rest)
        return np.asarray(slack.min(axis=0)), low

    def _solve(self, x: Floats, y: Floats) -> Triangle:
        """Return the joint angles ``(heights, n, legs)`` at places seen from the rest footholds ``(n, legs)``."""
        rest, (xx, xy, xz), (yx, yy, yz) = self._at_rest, self._along_x, self._along_y
        in_x, in_y = rest[0] + _NARROWER * (xx * x + yx * y), rest[1] + _NARROWER * (xy * x + yy * y)
        in_z = rest[2] + _NARROWER * (xz * x + yz * y) if self._tilted else rest[2]
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


def _axis_height(g: LegGeometry, stand: Stand) -> Floats:
    """Return how high each coxa axis is where the femur axis meets its height [m]."""
    x, y, z = stand.rotation[2]
    return np.asarray(x * g.mount_x + y * g.mount_y + z * (g.mount_z + g.up) + stand.position[2])


def _lowest_femur(g: LegGeometry, stand: Stand) -> float:
    """Return down to which femur angle surely no femur axis or knee of a stand is below the ground [rad].

    The bound of `surely_above`, the other way round.
    """
    x, y, z = stand.rotation[2].tolist()
    left = stand.position[2] - math.hypot(x, y) * g.knee_span
    if z < 0 or left.min() <= 0:
        return math.inf
    drop = float(((left - g.axis_depth) / g.femur).min())
    return -math.inf if drop > 1 else -math.asin(drop) if drop > 0 else math.inf
