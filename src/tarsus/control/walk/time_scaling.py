"""Time scaling: the walk advances more slowly wherever the joints could not follow it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from tarsus.robot.joint_limits import JointLimits

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["TimeScaling"]

_T = TypeVar("_T")

# How fast the rate may rise, and how fast it may fall ahead of high accelerations or with a lag [1/s].
_RISE, _FALL = 3.0, 5.0

# Number of rates that are tried in a tick, and the fraction of the joints' speed and acceleration that is used.
_TRIES, _USED = 5, 0.98
# A joint this close to its target has caught up [rad].
_CAUGHT_UP = 1e-9
# Signs of upward and downward motion.
_SIGNS = np.array([1.0, -1.0])[:, None, None]
# Distance that a joint keeps from its limits while it catches up [rad].
_SPARE = 1e-3
# Lags of a joint at which the walk begins to slow down and at which it stands still [rad]; the same where feet have to
# keep to their paths: joints that lag by different angles put a foot lower.
_LAG, _EXACT_LAG = (0.2, 0.7), (0.02, 0.15)
# Used fraction of the joints' acceleration from which to look ahead; the fraction to aim at then; how far to look [s].
_HIGH, _AIM, _AHEAD = 0.5, 0.75, 0.02


class TimeScaling:
    """Advances the walk by as much of each tick as the joints' speed and acceleration allow.

    The trajectories stay the same; only the rate at which they are followed changes. So a standing foot stays where it
    is, and the order of the steps is kept.

    Parameters
    ----------
    angles : array, shape (legs, 3)
        Joint angles at the start, at rest [rad].
    joint_limits : JointLimits
        Greatest speed and acceleration of each joint.
    limits : array, shape (legs, 3, 2)
        Lower and upper limit of each joint [rad].

    Attributes
    ----------
    angles : array, shape (legs, 3)
        The joint angles [rad].
    rate : float
        Rate of the walk's time, 0 to 1.
    """

    def __init__(
        self, angles: Float[np.ndarray, "legs 3"], joint_limits: JointLimits, limits: Float[np.ndarray, "legs 3 2"]
    ) -> None:
        self.angles, self.rate = angles, 1.0
        speed, self._acceleration = joint_limits
        self._top_speed, self._hardest = _USED * speed, _USED * self._acceleration
        self._softest, self._slowest = float(self._hardest.min()) / 2, float(self._top_speed.min())
        self._ends: Float[np.ndarray, "2 legs 3"] = np.moveaxis(limits, -1, 0)[::-1].copy()
        self._speeds, self._target = np.zeros_like(angles), angles
        # `_room` is a lower bound of the joints' distances from their limits [rad]; `_clear` is the time for which no
        # further look ahead is needed [s].
        self._last_dt = self._used = self._room = self._clear = 0.0

    def joints_held(self) -> None:
        """Take note that the joints have been held where they are: the walk goes on from rest."""
        self._speeds, self.rate, self._last_dt, self._clear = np.zeros_like(self.angles), 0.0, 0.0, 0.0

    def advance(self, integrate: Callable[[float], _T], solve: Callable[[_T], np.ndarray], dt: float) -> _T:
        """Return the state of the walk after a tick.

        Parameters
        ----------
        integrate : callable
            Returns the state after a time of the walk [s].
        solve, dt : callable, float
            Returns the joint angles of a state: array, shape (legs, 3) [rad]; length of the tick [s].
        """
        self._clear -= dt
        looks = self._used > _HIGH and self._clear <= 0.0
        fastest = self._relaxed_rate(integrate, solve) if looks else 1.0
        rate = min(1.0, self.rate + _RISE * dt, max(fastest, self.rate - _FALL * dt))
        between = (dt + self._last_dt) / 2
        tries = _TRIES
        while True:
            after = integrate(dt * rate)
            angles = solve(after)
            speeds, _, self._used, works = self._demand(angles, dt, between)
            # Slowing down may itself be too sudden.
            other = rate if works or not tries else self._other_rate(speeds, rate, between)
            if other == rate:
                break
            rate, tries = other, tries - 1
        self.angles, self._target, self._speeds, self.rate, self._last_dt = angles, angles, speeds, rate, dt
        return after

    def follow(
        self, integrate: Callable[[float], _T], solve: Callable[[_T], np.ndarray], dt: float, *, exact: bool = False
    ) -> _T:
        """Return the state after a tick of a walk that feels the ground: each of its joints follows on its own.

        Every contact changes the feet's trajectories at once. Where that asks for more than a joint's speed or
        acceleration, the joint lags behind and catches up, and the walk advances more slowly meanwhile.

        Parameters
        ----------
        integrate, solve, dt
            As for `advance`.
        exact : bool
            Whether feet have to keep to their paths: the walk then slows down at smaller lags.
        """
        behind = None if self._target is self.angles else self._target - self.angles
        lag = 0.0 if behind is None else float(np.maximum.reduce(np.abs(behind), axis=None))
        least, most = _EXACT_LAG if exact else _LAG
        fastest = max(1 - max(lag - least, 0.0) / (most - least), 0.0)
        rate = self.rate = min(self.rate + _RISE * dt, max(fastest, self.rate - _FALL * dt), 1.0)
        after = integrate(dt * rate)
        target, between = solve(after), (dt + self._last_dt) / 2
        if behind is None:
            speeds, fastest, _, works = self._demand(target, dt, between)
            # Far from their limits, joints need not be compared with them one by one.
            needed = fastest * (fastest / (2 * self._softest) + dt)
            if works and self._room <= needed:
                self._room = float(self._left().min())
            if works and (self._room > needed or not np.count_nonzero(_SIGNS * speeds > self._stopping_speeds(dt))):
                self.angles = self._target = target
                self._speeds, self._last_dt, self._room = speeds, dt, self._room - fastest * dt
                return after
            behind, self._room = np.zeros_like(target), 0.0
        # The speed of the target, plus one from which a joint can still stop as it catches up.
        far = np.abs(behind)
        catching = np.minimum(far / dt, np.sqrt(self._hardest * far))
        speeds = (target - self._target) / dt + np.copysign(catching, behind)
        up, down = self._stopping_speeds(dt)
        speeds, reach = np.maximum(np.minimum(speeds, up), -down), self._hardest * between
        speeds = np.minimum(np.maximum(speeds, self._speeds - reach), self._speeds + reach)
        speeds = np.minimum(np.maximum(speeds, -self._top_speed), self._top_speed)
        angles = self.angles + speeds * dt
        angles.setflags(write=False)
        # Within rounding, the joints have caught up.
        caught_up = not np.count_nonzero(np.abs(target - angles) >= _CAUGHT_UP)
        self.angles, self._target = target if caught_up else angles, target
        self._speeds, self._last_dt = speeds, dt
        return after

    def _left(self) -> Float[np.ndarray, "2 legs 3"]:
        """Return how far the joints may move upward and downward [rad]."""
        return np.asarray(_SIGNS * (self._ends - self.angles) - _SPARE)

    def _stopping_speeds(self, dt: float) -> Float[np.ndarray, "2 legs 3"]:
        """Return the greatest speeds upward and downward from which half the acceleration stops the joints in time."""
        braking = self._hardest * (dt / 2)
        return np.asarray(np.sqrt(braking * braking + self._hardest * np.maximum(self._left(), 0.0)) - braking)

    def _demand(
        self, angles: Float[np.ndarray, "legs 3"], dt: float, between: float
    ) -> tuple[Float[np.ndarray, "legs 3"], float, float, bool]:
        """Return the joints' speeds, the greatest, the used fraction of acceleration, and whether bounds are kept."""
        speeds = (angles - self.angles) / dt
        used = max((np.abs(speeds - self._speeds) / self._acceleration).ravel().tolist()) / between
        fastest = max(map(abs, speeds.ravel().tolist()))
        slow = fastest <= self._slowest or not np.count_nonzero(np.abs(speeds) > self._top_speed)
        return speeds, fastest, used, slow and used <= _USED

    def _relaxed_rate(self, integrate: Callable[[float], _T], solve: Callable[[_T], np.ndarray]) -> float:
        """Return the rate at which the joints stay well within their acceleration for the next moments."""
        first, second = solve(integrate(_AHEAD)), solve(integrate(2 * _AHEAD))
        acceleration = np.abs(second - 2 * first + self.angles) / (_AHEAD * _AHEAD)
        used = float((acceleration / self._acceleration).max())
        # The time that has been examined is twice as long.
        self._clear = 0.0 if used > _AIM else _AHEAD
        return math.sqrt(_AIM / max(used, _AIM))

    def _other_rate(self, speeds: Float[np.ndarray, "n 3"], rate: float, dt: float) -> float:
        """Return a rate at which the joints keep within speed and acceleration, or come closest to that."""
        if rate == 0:  # the stop is too sudden
            return self.rate / 2
        size, was, reach = np.maximum(np.abs(speeds), 1e-12), self._speeds * np.sign(speeds), self._hardest * dt
        highest = max(float((np.minimum(self._top_speed, was + reach) / size).min()), 0.0)
        lowest = max(float(((was - reach) / size).max()), 0.0)
        share = 0.999 * highest if highest < 1 else 1.001 * lowest
        if highest < lowest:
            share = 0.999 * (highest + lowest) / 2
        return min(rate * share, max(rate, self.rate))
