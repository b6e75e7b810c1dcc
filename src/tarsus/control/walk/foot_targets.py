"""Foot targets: legs taken out of the gait whose feet follow commanded points or velocities."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.command import Command
from tarsus.control.filters import CriticallyDamped
from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.walk.state import GaitState
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT, joint_margin, stance_geometry_of, sway_extremes
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["FootTargets"]

# Greatest speed [m/s] and greatest bandwidth [rad/s] with which a foot follows its target.
_GREATEST_SPEED, _BANDWIDTH = 0.12, 5.0
# Fractions of a path that are tested for reach.
_TRIED = np.arange(17) / 16
_FASTEST = f"feet out of the gait move at {1e3 * _GREATEST_SPEED:.0f} mm/s at most"
_BELOW_GROUND = "the point is below the ground; the foot stays on it"


class _Motion(NamedTuple):
    """State of a foot that is taken out of the gait.

    Attributes
    ----------
    position : CriticallyDamped
        Its position in the heading frame ``(3,)`` [m].
    target : array, shape (3,)
        Its target in the heading frame [m].
    """

    position: CriticallyDamped
    target: Float[np.ndarray, "3"]

    @classmethod
    def beginning(cls, state: GaitState, leg: int) -> _Motion:
        """Return the motion of a foot that leaves the gait, from its position and velocity in stance.

        Parameters
        ----------
        state : GaitState
            The state of the walk.
        leg : int
            Index of the leg; its foot is in stance.
        """
        in_heading = state.in_heading(complex(state.foot[leg]))
        vx, vy, wz = state.twist.value.tolist()
        # A stance foot is at rest in G.
        relative = -(complex(vx, vy) + 1j * wz * in_heading)
        here = np.array([in_heading.real, in_heading.imag, float(state.ground_height[leg]) - state.elevation])
        return cls(CriticallyDamped(here, np.array([relative.real, relative.imag, -state.climb])), here)

    def step(self, dt: float) -> _Motion:
        """Return the motion after a time [s]."""
        distance = float(np.abs(self.target - self.position.value).max())
        # A critically damped filter with bandwidth 2 v / distance, renewed every tick, reaches speed v and keeps it.
        bandwidth = min(_BANDWIDTH, 2 * _GREATEST_SPEED / max(distance, 1e-9))
        return self._replace(position=self.position.step(self.target, dt, bandwidth=bandwidth))

    def stopped(self) -> _Motion:
        """Return the motion with a target at which it can stop."""
        return self._replace(target=self.position.value + 2 * self.position.rate / _BANDWIDTH)


class FootTargets:
    """Motion of the feet that are taken out of the gait.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Attributes
    ----------
    limitations : list of Limitation
        Foot targets that are out of reach or below the ground, and foot velocities that are too high.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._motions: dict[int, _Motion] = {}
        self._excluded: tuple[int, ...] = ()
        self._points: dict[int, Sequence[float]] = {}
        self.limitations: list[Limitation] = []

    @property
    def legs(self) -> list[int]:
        """Legs that bear no load: those taken out of the gait, and those that return to it with their next step."""
        return list(self._motions)

    @property
    def returning(self) -> bool:
        """Whether a leg is returning to the gait."""
        return len(self._motions) > len(self._excluded)

    def set_legs(self, excluded: tuple[int, ...], state: GaitState) -> None:
        """Set the legs that are taken out of the gait; a leg that returns stays in the air until its next step."""
        stopped = {leg: motion.stopped() for leg, motion in self._motions.items() if leg not in excluded}
        self._motions = stopped | {leg: self._motions.get(leg) or _Motion.beginning(state, leg) for leg in excluded}
        self._excluded, self.limitations = excluded, []

    def set_targets(self, command: Command, state: GaitState, sway: tuple[float, ...], dt: float) -> None:
        """Set the targets of the feet, as far towards the commanded points as their legs reach.

        Parameters
        ----------
        command : Command
            A point in it holds until the next one; a velocity for this tick.
        state, sway : GaitState, tuple of float
            The state of the walk; amplitudes of the body's sway, throughout which the feet have to reach their targets.
        dt : float
            Length of the tick [s].
        """
        self.limitations = []
        if not (self._points or command.foot_targets or command.foot_velocities):
            return
        velocities = command.foot_velocities or {}
        points = {**self._points, **(command.foot_targets or {})}
        self._points = {leg: point for leg, point in points.items() if point is not None and leg not in velocities}
        postures = sway_extremes(state.posture.value[: SWING_HEIGHT + 1], sway)
        for leg in self._excluded:
            motion = self._motions[leg]
            start = motion.position.value
            if leg in velocities:
                velocity = np.array(velocities[leg])
                share = min(_GREATEST_SPEED / max(float(np.abs(velocity).max()), 1e-9), 1.0)
                if share < 1:
                    self._note(leg, _FASTEST, asked=1.0, granted=share)
                end = motion.target + share * velocity * dt
            elif leg in self._points:
                end = np.array(self._points[leg])
                if end[2] < 0:
                    self._note(leg, _BELOW_GROUND)
            else:
                continue
            end[2] = max(end[2], 0.0)
            fraction = self._reachable(leg, end, postures)
            if fraction < 1:
                self._note(leg, "out of reach", asked=1.0, granted=fraction)
            self._motions[leg] = motion._replace(target=start + fraction * (end - start))

    def _note(self, leg: int, cause: str, *, asked: float = math.nan, granted: float = math.nan) -> None:
        """Note why a foot does not follow what is commanded."""
        why = Cause(cause, self._robot.leg_names[leg])
        self.limitations.append(why.limitation(LimitationKind.FOOT_TARGET, asked=asked, granted=granted))

    def _reachable(self, leg: int, end: Float[np.ndarray, "3"], postures: list[Float[np.ndarray, "7"]]) -> float:
        """Return the fraction of a straight path to a point that a foot can follow in all given postures."""
        geometry, start, rest = self._robot.geometry, self._motions[leg].position.value, np.zeros(self._robot.legs)
        points = (start + _TRIED[:, None] * (end - start)).T[..., None] + rest
        stances = [stance_geometry_of(posture, rest.astype(complex)) for posture in postures]
        margins = np.array([joint_margin(geometry, stance.solve(geometry, *points))[:, leg] for stance in stances])
        # A foot that starts lower or farther out than its leg should reach may come back.
        works = (margins >= np.minimum(margins[:, :1], 0.0)).all(axis=0)
        reached = np.logical_and.accumulate(works) & (margins >= 0.0).all(axis=0)
        return float(_TRIED[reached].max(initial=0.0))

    def apply(self, state: GaitState, time: float, *, swing_time: float) -> GaitState:
        """Return the state after a time of motion of the feet out of the gait, except of those that swing again.

        Parameters
        ----------
        state, time, swing_time : GaitState, float, float
            The state of the walk after that time; the time [s]; duration of a swing [s].
        """
        if not self._motions:
            return state
        foot, ground, pace = state.foot.copy(), state.ground_height.copy(), state.swing_velocity.copy()
        turn = cmath.exp(1j * state.yaw)
        vx, vy, wz = state.twist.value.tolist()
        for leg, motion in self._motions.items():
            if not state.down[leg]:
                continue
            position = motion.step(time).position
            x, y, z = position.value.tolist()
            dx, dy, _ = position.rate.tolist()
            in_heading = complex(x, y)
            foot[leg], ground[leg] = state.origin + turn * in_heading, z + state.elevation
            pace[leg] = turn * (complex(dx, dy) + complex(vx, vy) + 1j * wz * in_heading) * swing_time
        target = np.where(state.down, foot, state.foothold)
        return state._replace(foot=foot, foothold=target, ground_height=ground, swing_velocity=pace)

    def step(self, time: float, down: Bool[np.ndarray, "legs"]) -> None:
        """Advance the motions by a time; a leg that steps again is removed.

        Parameters
        ----------
        time : float
            The time [s].
        down : array of bool, shape (legs,)
            Feet that are not in a swing.
        """
        if self._motions:
            self._motions = {leg: motion.step(time) for leg, motion in self._motions.items() if down[leg]}

    def without_bounds(self, bounds: Float[np.ndarray, "legs 16"]) -> Float[np.ndarray, "legs 16"]:
        """Return the sides of the feet's polygons, infinite for the feet that bear no load [m]."""
        free = bounds.copy()
        free[self.legs] = np.inf
        return free
