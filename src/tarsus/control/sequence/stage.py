"""A stage of a motion sequence: one smooth motion of all joints from rest to rest.

After the fraction u of its duration, a stage has covered the fraction ``10 u^3 - 15 u^4 + 6 u^5`` of its path: the
minimum-jerk motion between two rests (T. Flash and N. Hogan, Journal of Neuroscience 5, 1985). Each leg follows either
a straight path in joint space, or a Cartesian path of its foot in the ground frame: stationary, or to another foothold
with a swing height profile of ``64 u^3 (1 - u)^3``. The body moves from one pose to another by a rotation about a fixed
axis through a pivot, which moves in a straight line.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.gait.branch import branches
from tarsus.gait.swing import horizontal_profile, vertical_profile
from tarsus.kinematics.ground import points_in_body
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rotation import axis_and_angle, rotation_about
from tarsus.kinematics.triangle import solve_triangle, to_leg_frame
from tarsus.representation import represented
from tarsus.robot.joint_limits import JointLimits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["GRID", "Stage"]

GRID = np.linspace(0.0, 1.0, 257)
"""Fractions of a stage's duration at which it is evaluated."""

_FULL_TURN = 2 * np.pi
# Least knee bend of a leg on a Cartesian path: distance from the singularities, straight and folded [rad].
_MIN_BEND = 0.01
# Fractions of the joint limits that are used; the rest is a reserve for the times between the points of `GRID`.
_SPEED_FRACTION = 0.99
_ACCELERATION_FRACTION = 0.96


@represented()
@dataclass(frozen=True, eq=False, kw_only=True)
class Stage:
    """A motion of the whole robot from rest to rest.

    Attributes
    ----------
    name : str
        Name of the stage.
    robot : Robot
        A single robot.
    duration : float
        Duration [s].
    start, end : Pose
        Pose of B in G at the start and at the end.
    pivot : array, shape (3,)
        Point in B that moves in a straight line while the body rotates about it [m].
    angles, angles_end : array, shape (legs, 3)
        Joint angles at the start and at the end [rad]. A leg on a Cartesian path keeps the solution of inverse
        kinematics that it starts with.
    feet, feet_end : array, shape (legs, 3)
        Footholds in G at the start and at the end, for legs on a Cartesian path [m].
    swing_height : float
        Swing height of feet that change their foothold [m].
    cartesian : array of bool, shape (legs,)
        Legs whose feet follow a Cartesian path; the others follow a straight path in joint space.
    contacts, contacts_end : array of bool, shape (legs,)
        Feet on the ground throughout the stage, and at its end.
    supports : array, shape (n, 3)
        Points in G other than feet that bear load throughout the stage: points of the body, or knees [m].
    belly : bool
        Whether the body lies on the ground throughout the stage.
    """

    name: str
    robot: Robot
    duration: float
    start: Pose
    end: Pose
    pivot: Float[np.ndarray, "3"]
    angles: Float[np.ndarray, "legs 3"]
    angles_end: Float[np.ndarray, "legs 3"]
    feet: Float[np.ndarray, "legs 3"]
    feet_end: Float[np.ndarray, "legs 3"]
    swing_height: float
    cartesian: Bool[np.ndarray, "legs"]
    contacts: Bool[np.ndarray, "legs"]
    contacts_end: Bool[np.ndarray, "legs"]
    supports: Float[np.ndarray, "n 3"]
    belly: bool

    def transformed(self, pose: Pose) -> Self:
        """Return the stage moved in G by a yaw and a horizontal translation."""
        points = {name: pose @ getattr(self, name) for name in ("feet", "feet_end", "supports")}
        return replace(self, start=pose @ self.start, end=pose @ self.end, **points)

    def body_at(self, fractions: Float[np.ndarray, "n"]) -> Pose:
        """Return the poses of B in G at fractions of the duration: a batch of shape (n,)."""
        progress = horizontal_profile(fractions)[:, None]
        axis, angle = axis_and_angle(self.end.rotation @ self.start.rotation.T)
        if not angle:
            return Pose(self.start.rotation, self.start.position + progress * (self.end.position - self.start.position))
        rotation = rotation_about(axis, angle * progress[:, 0]) @ self.start.rotation
        first, last = (pose.position + pose.rotation @ self.pivot for pose in (self.start, self.end))
        return Pose(rotation, first + progress * (last - first) - rotation @ self.pivot)

    def feet_at(self, fractions: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n legs 3"]:
        """Return the Cartesian paths of the feet in G at fractions of the duration: array, shape (n, legs, 3) [m].

        They are meaningless for legs that follow a path in joint space.
        """
        progress = horizontal_profile(fractions)[:, None, None]
        feet: np.ndarray = self.feet + progress * (self.feet_end - self.feet)
        moves = (self.feet != self.feet_end).any(-1)
        feet[..., 2] += self.swing_height * vertical_profile(fractions)[:, None] * moves
        return feet

    def angles_at(self, fractions: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n legs 3"]:
        """Return the joint angles at fractions of the duration; NaN where a foot is out of reach [rad]."""
        progress = horizontal_profile(fractions)[:, None, None]
        angles: np.ndarray = self.angles + progress * (self.angles_end - self.angles)
        if self.cartesian.any():
            angles[:, self.cartesian] = self._solve(fractions)[:, self.cartesian]
        return angles

    @cached_property
    def _branches(self) -> Bool[np.ndarray, "legs 2"]:
        """The branch of the inverse kinematics in which each leg starts: see `branches`."""
        return branches(self.robot, self.angles)

    def _solve(self, fractions: Float[np.ndarray, "n"]) -> Float[np.ndarray, "n legs 3"]:
        """Return the joint angles for all feet, each leg in its initial branch; NaN where one is out of reach [rad]."""
        g = self.robot.geometry
        points = points_in_body(self.body_at(fractions), self.feet_at(fractions))
        x, y, z = to_leg_frame(g, points[..., 0], points[..., 1], points[..., 2])
        min_bend = _MIN_BEND**2 * g.femur * g.tibia
        solved = np.full(points.shape, np.nan)
        for behind, up in set(map(tuple, self._branches[self.cartesian].tolist())):
            with np.errstate(invalid="ignore"):
                found = solve_triangle(np, g, x, y, z, knee=-1 if up else 1, facing=-1 if behind else 1)
            bent = (found.far >= min_bend) & (found.near >= min_bend) & (found.beside >= 0)
            ok = bent & (self._branches == (behind, up)).all(axis=-1)
            solved = np.where(ok[..., None], np.stack(found[:3], axis=-1), solved)
        # Of equivalent angles, a full turn apart, the one nearest to the start.
        return np.asarray(solved - _FULL_TURN * np.round((solved - self.angles) / _FULL_TURN))

    @cached_property
    def table(self) -> Float[np.ndarray, "257 legs 3"]:
        """Joint angles at the fractions of `GRID`: array, shape (257, legs, 3) [rad]."""
        return self.angles_at(GRID)

    @cached_property
    def derivatives(self) -> tuple[Float[np.ndarray, "257 legs 3"], Float[np.ndarray, "257 legs 3"]]:
        """First and second derivative of `table` with respect to the fraction, each of its shape [rad]."""
        angles, step = self.table, GRID[1]
        second = np.zeros_like(angles)
        second[1:-1] = (angles[2:] - 2 * angles[1:-1] + angles[:-2]) / step**2
        return np.gradient(angles, step, axis=0, edge_order=2), second

    def shortest_duration(self, limits: JointLimits) -> float:
        """Return the shortest duration within the limits of the joints [s]."""
        speed, acceleration = (np.abs(values).max(0) for values in self.derivatives)
        by_speed = float((speed / limits.speed).max()) / _SPEED_FRACTION
        return max(by_speed, float(np.sqrt((acceleration / limits.acceleration).max() / _ACCELERATION_FRACTION)))
