"""Notices joints that do not follow their commands.

A joint that is stuck does not move; but healthy servos stand still too while their commands move: in the play of their
gears, in friction, and where the load on a leg changes as fast as its command. How far commands move meanwhile is the
dead zone of the machine. It is measured all the time, for coxas, femurs and tibias apart, and a joint is taken for
stuck where its command has moved well beyond it.
"""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING

import numpy as np

from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.plant.fault import FaultKind, ServoFault
from tarsus.hardware.plant.settings import PlantSettings

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["MotionMonitor"]

_SAME = 1e-6
# What counts as a motion: an angle [rad], steps of the position sensor, a share of the command's.
_ANGLE, _STEPS, _SHARE = math.radians(0.25), 1.5, 0.2
# How many readings in a row must show that a joint stands still.
_READINGS = 2
# A command is beyond the dead zone by this factor; how long what is seen of it counts while joints move [s].
_FACTOR, _MEMORY = 1.5, 8.0
# Where a joint is looked at less often, it counts as still for this long after a look that found it so [s].
_LOOK = 0.02
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
        How far the command of a joint that stood still when it was last looked at has moved, as a share of `bound`.
    """

    def __init__(self, calibration: Calibration, settings: PlantSettings) -> None:
        self._calibration, self._settings = calibration, settings
        self._shape = (calibration.robot.legs, 3)
        self._noise = np.maximum(_ANGLE, _STEPS / np.abs(calibration.slopes))
        self.forget()

    def forget(self) -> None:
        """Begin anew, after a pause."""
        self._sent: deque[tuple[float, Float[np.ndarray, "legs 3"]]] = deque(maxlen=200)
        self._dead_zone = np.full(3, self._settings.dead_zone)
        # Where each joint was when it moved last: measured, commanded, when, and how often it was looked at since.
        self._at, self._commanded = np.full(self._shape, np.nan), np.full(self._shape, np.nan)
        self._since, self._looks = np.full(self._shape, np.nan), np.zeros(self._shape, dtype=int)
        # When each joint was looked at last, and how far its command had moved by then.
        self._looked, self._passed = np.full(self._shape, np.nan), np.zeros(self._shape)
        self._behind_since = np.full(self._shape, np.nan)
        self.suspicion = np.zeros(self._shape)

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
        """
        settings = self._settings
        passed = now - self._sent[-1][0] if self._sent else 0.0
        moving = bool(self._sent) and float(np.abs(sent - self._sent[-1][1]).max()) > _SLOW * passed
        self._sent.append((now, sent))
        expected = self._expected(now - settings.delay)
        if expected is None:
            return None
        if moving:
            self._dead_zone *= math.exp(-passed / _MEMORY)
        commanded = np.where(np.isnan(self._commanded), 0.0, np.abs(expected - self._commanded))
        behind = np.abs(expected - measured)
        self._looks += read
        moved = np.abs(measured - self._at) > np.maximum(self._noise, _SHARE * commanded)
        long = (self._looks >= _READINGS) & (now - self._since >= settings.stuck_window - _SAME)
        # A command that comes back to where a load has bent the leg moves nothing either.
        still = read & ~moved & long & (commanded > self.bound) & (behind > self.bound / 2)
        stuck = still | self._far(behind, read, now)
        self.suspicion = np.where((self._looks > 0) & ~moved, commanded / self.bound, 0.0)
        self._learn(commanded, read & moved & (self._looks > _READINGS), now)
        self._looked = np.where(read, now, self._looked)
        self._passed = np.where(read, np.where(moved, 0.0, commanded), self._passed)
        self._keep(read & (moved | np.isnan(self._at)), measured, expected, now)
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

    def _learn(self, commanded: Float[np.ndarray, "legs 3"], which: Bool[np.ndarray, "legs 3"], now: float) -> None:
        """Take note of how far commands went before joints that stood still moved on."""
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
        expected: Float[np.ndarray, "legs 3"],
        now: float,
    ) -> None:
        """Take note of where joints are that have moved."""
        self._at, self._commanded = np.where(which, measured, self._at), np.where(which, expected, self._commanded)
        self._since, self._looks = np.where(which, now, self._since), np.where(which, 0, self._looks)

    def _far(
        self, behind: Float[np.ndarray, "legs 3"], read: Bool[np.ndarray, "legs 3"], now: float
    ) -> Bool[np.ndarray, "legs 3"]:
        """Return which joints have been far behind for long, moving or not."""
        far = np.where(read, behind > self._settings.lag, ~np.isnan(self._behind_since))
        self._behind_since = np.where(far, np.where(np.isnan(self._behind_since), now, self._behind_since), np.nan)
        return np.asarray(read & far & (now - self._behind_since >= self._settings.stuck_window - _SAME))

    def _expected(self, time: float) -> Float[np.ndarray, "legs 3"] | None:
        """Return what was sent at a time; None where that is too long ago."""
        for at, sent in reversed(self._sent):
            if at <= time + _SAME:
                return np.asarray(sent)
        return None
