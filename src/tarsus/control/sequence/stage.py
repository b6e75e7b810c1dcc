"""One stage of getting up or lying down: all joints from rest to rest, in one smooth motion.

Over a stage, the share ``w = 10 u^3 - 15 u^4 + 6 u^5`` of the way is gone after the share u of the time: the motion of
least jerk between two rests (T. Flash and N. Hogan, Journal of Neuroscience 5, 1985). What goes that way is either the
joints of a leg, or its foot in the ground frame: still, or to another foothold with a lift of ``64 u^3 (1 - u)^3``. The
body goes the same way from one pose to another, turning about one axis through a point of it that moves straight.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tarsus.gait.swing import ground_share, height_share
from tarsus.kinematics.ground import points_in_body
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.triangle import solve_triangle, to_leg_frame
from tarsus.robot.robot import Robot

__all__ = ["GRID", "Stage", "Table"]

Floats = np.ndarray[Any, np.dtype[np.float64]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]

GRID = np.linspace(0.0, 1.0, 257)
"""The shares of a stage's time at which it is looked at."""

_TURN = 2 * np.pi
# A leg that is led by its foot keeps this far from straight and from folded on itself, where its joints would have to
# turn ever faster for the least motion of the foot [rad].
_LEAST_BEND = 0.01
# Turns by less than this are none [rad]: their axis is rounding.
_NO_TURN = 1e-12


class Table(NamedTuple):
    """Joint angles at the shares of `GRID`, and their derivatives by the share of the time ``(257, legs, 3)``."""

    angles: Floats
    first: Floats
    second: Floats


@dataclass(frozen=True, eq=False, kw_only=True)
class Stage:
    """A motion of the whole robot from rest to rest.

    Attributes
    ----------
    name : str
        What happens.
    robot : Robot
        A single robot.
    duration : float
        How long it takes [s].
    start, end : Pose
        The body's pose in G, before and after.
    pivot : array, shape (3,)
        The point of B that moves straight while the body turns about it [m].
    angles, angles_end : array, shape (legs, 3)
        Joint angles before and after [rad]; a leg that is led by its foot keeps to the solution it starts with.
    feet, feet_end : array, shape (legs, 3)
        Footholds in G before and after, of the legs that are led by their feet [m].
    swing_height : float
        How high a foot that changes its foothold is lifted on the way [m].
    by_foot : array of bool, shape (legs,)
        The legs that are led by their feet; of the others, the joints go straight from start to end.
    contacts, contacts_end : array of bool, shape (legs,)
        The feet that stay on the ground during it, and those on the ground after it.
    props : array, shape (n, 3)
        Points in G, besides the feet, that bear load all the while [m]: of the body, or knees.
    belly : bool
        Whether the body lies flat on the ground during it.
    """

    name: str
    robot: Robot
    duration: float
    start: Pose
    end: Pose
    pivot: Floats
    angles: Floats
    angles_end: Floats
    feet: Floats
    feet_end: Floats
    swing_height: float
    by_foot: Flags
    contacts: Flags
    contacts_end: Flags
    props: Floats
    belly: bool

    @cached_property
    def _turn(self) -> tuple[Floats, float]:
        """Axis in G and angle of the body's turn."""
        turn = self.end.rotation @ self.start.rotation.T
        axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / 2
        sine = float(np.linalg.norm(axis))
        if sine < _NO_TURN:
            return np.zeros(3), 0.0
        return axis / sine, float(np.arctan2(sine, (np.trace(turn) - 1) / 2))

    def body_at(self, share: Floats) -> Pose:
        """Return the body's poses in G after shares of the time, shape ``(n,)``."""
        gone = ground_share(share)[:, None]
        axis, angle = self._turn
        if not angle:
            return Pose(self.start.rotation, self.start.position + gone * (self.end.position - self.start.position))
        cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        sine, versine = np.sin(angle * gone)[..., None], 1 - np.cos(angle * gone)[..., None]
        # Rodrigues' formula.
        rotation = (np.eye(3) + sine * cross + versine * (cross @ cross)) @ self.start.rotation
        first, last = (pose.position + pose.rotation @ self.pivot for pose in (self.start, self.end))
        return Pose(rotation, first + gone * (last - first) - rotation @ self.pivot)

    def feet_at(self, share: Floats) -> Floats:
        """Return where the feet are led to in G, ``(n, legs, 3)``; without meaning for legs that aren't led so."""
        along = ground_share(share)[:, None, None]
        feet: Floats = self.feet + along * (self.feet_end - self.feet)
        moves = (self.feet != self.feet_end).any(-1)
        feet[..., 2] += self.swing_height * height_share(share)[:, None] * moves
        return feet

    def angles_at(self, share: Floats) -> Floats:
        """Return the joint angles after shares of the time, ``(n, legs, 3)``; NaN where a foot is out of reach."""
        angles: Floats = self.angles + ground_share(share)[:, None, None] * (self.angles_end - self.angles)
        if self.by_foot.any():
            led = self._led(share)
            angles[:, self.by_foot] = led[:, self.by_foot]
        return angles

    @cached_property
    def _branches(self) -> tuple[Flags, Flags]:
        """Whether each leg's knee is bent down, and whether its foot is behind its coxa axis."""
        g, femur, tibia = self.robot.geometry, self.angles[:, 1], self.angles[:, 2]
        bend = np.sin(tibia)
        return bend > 0, g.coxa + g.femur * np.cos(femur) + g.tibia * np.cos(femur + tibia) < 0

    def _led(self, share: Floats) -> Floats:
        """Solve all legs for their feet, each by the solution that it starts with."""
        g = self.robot.geometry
        body = self.body_at(share)
        points = points_in_body(body, self.feet_at(share))
        x, y, z = to_leg_frame(g, points[..., 0], points[..., 1], points[..., 2])
        down, behind = self._branches
        solved = np.full(points.shape, np.nan)
        for bent in {bool(d) for d in down[self.by_foot]}:
            for away in {bool(b) for b in behind[self.by_foot]}:
                legs = (down == bent) & (behind == away)
                with np.errstate(invalid="ignore"):
                    found = solve_triangle(np, g, x, y, z, knee=-1 if bent else 1, facing=-1 if away else 1)
                bent_enough = _LEAST_BEND**2 * g.femur * g.tibia
                ok = (found.far >= bent_enough) & (found.near >= bent_enough) & (found.beside >= 0) & legs
                for joint in range(3):
                    solved[..., joint] = np.where(ok, found[joint], solved[..., joint])
        # Of all angles a whole turn apart, that which is nearest to where the stage starts.
        return solved - _TURN * np.round((solved - self.angles) / _TURN)

    @cached_property
    def table(self) -> Table:
        """Joint angles over the stage and how they change."""
        angles = self.angles_at(GRID)
        step = GRID[1]
        first = np.gradient(angles, step, axis=0, edge_order=2)
        second = np.zeros_like(angles)
        second[1:-1] = (angles[2:] - 2 * angles[1:-1] + angles[:-2]) / step**2
        return Table(angles, first, second)
