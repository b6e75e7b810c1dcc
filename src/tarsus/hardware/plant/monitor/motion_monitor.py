"""Notices joints that do not follow their commands.

A joint that is stuck does not move; but healthy servos stand still too while their commands move: in the play of their
gears, in friction, and where the load on a leg changes as fast as its command. How far commands move meanwhile is the
dead zone of the machine. It is measured all the time, separately for coxas, femurs and tibias, and a joint is taken for
stuck where its command has moved well beyond it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.plant.fault import FaultKind, ServoFault
from tarsus.hardware.plant.monitor.command_history import CommandHistory
from tarsus.hardware.plant.settings import PlantSettings

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["MotionMonitor"]

_SAME = 1e-6
# A joint has moved if it is beyond all of these: an angle [rad], steps of its sensor, a share of its command's motion.
_ANGLE, _STEPS, _SHARE = math.radians(0.25), 1.5, 0.2
# How many readings in a row must show that a joint stands still.
_READINGS = 2
# Factor on the dead zone in the bound of a stuck joint; time constant with which it fades while commands move [s].
_FACTOR, _MEMORY = 1.5, 8.0
# Where a joint is looked at less often, it counts as still for this long after a look that found it so [s].
_LOOK = 0.02
# Looks farther apart than this are rare: how far a joint came between them tells when it stopped. Those farther apart
# than the second are not used to measure the delay [s].
_SELDOM, _LONG = 0.025, 0.5
# Slower commands show nothing of the dead zone [rad/s].
_SLOW = math.radians(5)


class MotionMonitor:
    """Compares what is sent with what is measured.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.
    settings : PlantSettings
        The bounds.

    Attributes
    ----------
    suspicion : array, shape (legs, 3)
        How far each command had moved while its joint stood still, when last looked at, as a share of `bound`.
    doubtful : array of bool, shape (legs, 3)
        Which joints are stuck if another reading finds them in the same place.
    """

    def __init__(self, calibration: Calibration, settings: PlantSettings) -> None:
        self._calibration, self._settings = calibration, settings
        self._shape = (calibration.robot.legs, 3)
        self._noise = np.maximum(_ANGLE, _STEPS / np.abs(calibration.slopes))
        self.forget()

    def forget(self) -> None:
        """Begin anew, after a pause."""
        self._history = CommandHistory(self._settings.delay)
        self._dead_zone = np.full(3, self._settings.dead_zone)
        # Where each joint was when it moved last: measured, commanded, when, and how often it was looked at since.
        self._at, self._commanded = np.full(self._shape, np.nan), np.full(self._shape, np.nan)
        self._since, self._looks = np.full(self._shape, np.nan), np.zeros(self._shape, dtype=int)
        # When each joint was looked at last, how far its command had moved by then; where it and its command were.
        self._looked, self._passed = np.full(self._shape, np.nan), np.zeros(self._shape)
        self._seen, self._asked = np.full(self._shape, np.nan), np.full(self._shape, np.nan)
        self._behind_since = np.full(self._shape, np.nan)
        self.suspicion, self.doubtful = np.zeros(self._shape), np.zeros(self._shape, dtype=bool)

    @property
    def bound(self) -> Float[np.ndarray, "3"]:
        """How far commands of coxas, femurs and tibias may move while the joint stands still [rad]."""
        return np.asarray(self._settings.stuck_angle + _FACTOR * self._dead_zone)

    def followed(
        self,
        sent: Float[np.ndarray, "legs 3"],
        measured: Float[np.ndarray, "legs 3"],
        *,
        read: Bool[np.ndarray, "legs 3"],
        now: float,
        times: Float[np.ndarray, "legs 3"] | None = None,
        sent_at: float | None = None,
    ) -> ServoFault | None:
        """Compare what was sent with what was measured, and return a fault.

        Parameters
        ----------
        sent, measured : array, shape (legs, 3)
            Joint angles [rad].
        read : array of bool, shape (legs, 3)
            Which of them were measured since the last call; the others are not looked at.
        now : float
            The time [s].
        times : array, shape (legs, 3), optional
            When each of them was measured last; now where left out [s].
        sent_at : float, optional
            When the commands had been transmitted; now where left out [s].
        """
        settings = self._settings
        passed, moving = self._history.add(now if sent_at is None else sent_at, sent)
        when = np.full(self._shape, now) if times is None else np.where(read, times, now)
        expected = self._history.expected(when)
        self.doubtful = np.zeros(self._shape, dtype=bool)
        if expected is None:
            return None
        if moving > _SLOW * passed:
            self._dead_zone *= math.exp(-passed / _MEMORY)
        commanded = np.where(np.isnan(self._commanded), 0.0, np.abs(expected - self._commanded))
        behind = np.abs(expected - measured)
        self._looks += read
        moved = np.abs(measured - self._at) > np.maximum(self._noise, _SHARE * commanded)
        long = now - self._since >= settings.stuck_window - _SAME
        # A command that comes back to where a load has pushed the joint does not move it: that joint is not behind.
        rare = when - self._looked > _SELDOM
        standing = (
            read & ~moved & long & (commanded > self.bound) & (behind > np.where(rare, self.bound, self.bound / 2))
        )
        # Between rare looks a command moves far: a joint that has just begun to follow it is not stuck.
        standing &= ~(rare & (np.abs(measured - self._seen) > self._noise))
        still, self.doubtful = standing & (self._looks >= _READINGS), standing & (self._looks < _READINGS)
        stuck = still | self._far(behind, read, now)
        short, share = self._short(measured, expected, now)
        progress = np.where(moved, np.abs(short), np.where(self._looks > 0, commanded, 0.0))
        self.suspicion = np.where(read, progress / self.bound, self.suspicion)
        self._learn(commanded, read & moved & (self._looks > _READINGS), now)
        self._measure_delay(measured, when, read)
        stopped = now - share * (now - self._looked)
        self._keep(read & (moved | np.isnan(self._at)), measured, expected - short, np.where(share > 0, stopped, now))
        self._looked = np.where(read, when, self._looked)
        self._passed = np.where(read, np.where(moved, 0.0, commanded), self._passed)
        self._seen, self._asked = np.where(read, measured, self._seen), np.where(read, expected, self._asked)
        if not stuck.any():
            return None
        leg, j = np.unravel_index(int(np.argmax(np.where(stuck, np.maximum(behind, commanded), -1.0))), self._shape)
        place = int(leg), int(j)
        where = math.degrees(measured[place])
        text = f"it is {math.degrees(behind[place]):.1f} deg behind its command, at {where:.1f} deg"
        if still[place]:
            lasted, bound = now - float(self._since[place]), self.bound[j]
            text += (
                f", and has stood still for {lasted * 1e3:.0f} ms, while its command moved by "
                f"{math.degrees(commanded[place]):.1f} deg, more than the {math.degrees(bound):.1f} deg of gear play "
                "and load"
            )
        else:
            text += f", more than {math.degrees(settings.lag):.0f} deg for {settings.stuck_window * 1e3:.0f} ms"
        return ServoFault.of_joint(FaultKind.STUCK, self._calibration, place, text=text, time=now)

    def _measure_delay(
        self, measured: Float[np.ndarray, "legs 3"], when: Float[np.ndarray, "legs 3"], read: Bool[np.ndarray, "legs 3"]
    ) -> None:
        """Measure the delay of servos from motions between rare looks."""
        apart = when - self._looked
        which = read & (apart > _SELDOM) & (apart < _LONG) & (np.abs(measured - self._seen) > self._noise)
        if which.any():
            self._history.moved(self._seen, measured, times=np.stack([self._looked, when]), which=which)

    def _short(
        self, measured: Float[np.ndarray, "legs 3"], expected: Float[np.ndarray, "legs 3"], now: float
    ) -> tuple[Float[np.ndarray, "legs 3"], Float[np.ndarray, "legs 3"]]:
        """Return how far joints fell short of their commands between rare looks, and that as a share; else 0."""
        way = expected - self._asked
        come = np.clip((measured - self._seen) * np.sign(way), 0.0, np.abs(way))
        seldom = (now - self._looked > _SELDOM) & (np.abs(way) > self._noise)
        share = np.where(seldom, 1.0 - come / np.maximum(np.abs(way), _SAME), 0.0)
        return np.where(seldom, share * way, 0.0), share

    def _learn(self, commanded: Float[np.ndarray, "legs 3"], which: Bool[np.ndarray, "legs 3"], now: float) -> None:
        """Widen the dead zone to how far commands moved before joints that stood still moved on."""
        until = np.minimum(self._looked + _LOOK, now)
        share = (until - self._looked) / np.maximum(now - self._looked, _SAME)
        long = until - self._since >= self._settings.stuck_window - _SAME
        reached = self._passed + share * (commanded - self._passed)
        seen = np.minimum(np.where(which & long, reached, 0.0).max(axis=0), self._settings.widest_dead_zone)
        self._dead_zone = np.maximum(self._dead_zone, seen)

    def _keep(
        self,
        which: Bool[np.ndarray, "legs 3"],
        measured: Float[np.ndarray, "legs 3"],
        commanded: Float[np.ndarray, "legs 3"],
        since: Float[np.ndarray, "legs 3"],
    ) -> None:
        """Take note of where joints are that have moved, by which command, and since when."""
        self._at, self._commanded = np.where(which, measured, self._at), np.where(which, commanded, self._commanded)
        self._since, self._looks = np.where(which, since, self._since), np.where(which, 0, self._looks)

    def _far(
        self, behind: Float[np.ndarray, "legs 3"], read: Bool[np.ndarray, "legs 3"], now: float
    ) -> Bool[np.ndarray, "legs 3"]:
        """Return which joints have been far behind for long, moving or not."""
        far = np.where(read, behind > self._settings.lag, ~np.isnan(self._behind_since))
        self._behind_since = np.where(far, np.where(np.isnan(self._behind_since), now, self._behind_since), np.nan)
        return np.asarray(read & far & (now - self._behind_since >= self._settings.stuck_window - _SAME))
