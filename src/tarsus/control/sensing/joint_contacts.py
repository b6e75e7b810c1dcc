"""Contacts of the feet by the measured joint angles: feet that the ground holds up do not follow their commands."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.readings import Vector
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["JointContacts"]

# Swing phases between which a foot is in the air, and learnt from.
_CLEAR, _DOWNWARD = 0.12, 0.45
# How far a descending foot that touches is held up over the least of its swing, and how far below that a standing foot
# may be that touches; by how much that least is below the mean of free swings at most [m].
_CONTACT, _HANGING, _DIP = 0.005, 0.001, 0.006
# How far off a rising foot is that is stopped by an obstacle [m].
_OBSTACLE = 0.012
# From a command to the servo's effect: at first, and at most [s]; how fast it and the mean of free swings are learnt,
# a tick; and the square of a foot's speed below which that tells little of it [m^2/s^2].
_LAG, _LONGEST_LAG, _RATE, _MEAN_RATE, _SLOW = 0.01, 0.1, 0.02, 0.05, 0.05
# How far standing feet have to be held up once, on the average, for contacts to be known from then on [m].
_LEAST_SAG = 0.0005
# Steps of integration a tick, and ticks whose expected heights are kept.
_STEPS, _KEPT = 4, 25


class JointContacts:
    """Estimates contacts by the heights of the feet over where free legs would be.

    Femur and tibia are expected to follow as servos of the robot's file do without load: position control within
    torque and speed, and a lag that is learnt. What is left over, measured less expected height, is compared with that
    of the same foot in free swing, which takes care of offsets of horns and of the leg's weight. While standing feet
    have not been held up by their load, as with ideal or emulated servos, nothing is known.

    Parameters
    ----------
    robot : Robot
        A single robot whose servos are known.

    Attributes
    ----------
    lag : float
        From a command to its effect, as learnt [s].

    Raises
    ------
    MissingDataError
        If a servo is unknown.
    """

    def __init__(self, robot: Robot) -> None:
        springs, legs = JointSprings.of(robot), robot.legs
        stiffness, inertia = springs.stiffness[:, 1:], springs.rotor_inertia[:, 1:]
        self._rates = stiffness / inertia, springs.damping[:, 1:] / inertia
        self._most = springs.stall_torque[:, 1:] / stiffness
        self._tick, self._factors = 0.0, self._rates
        self._lengths = np.asarray(robot.geometry.femur), np.asarray(robot.geometry.tibia)
        self._state: tuple[Float[np.ndarray, "legs 2"], Float[np.ndarray, "legs 2"]] | None = None
        self._expected: deque[Float[np.ndarray, "legs"]] = deque(maxlen=_KEPT)
        self.lag, self._sag = _LAG, 0.0
        self._mean, self._least = np.zeros(legs), np.full(legs, np.inf)

    def contacts(
        self,
        measured: Sequence[Vector | None],
        commanded: Float[np.ndarray, "legs 3"],
        dt: float,
        *,
        age: float,
        down: Bool[np.ndarray, "legs"],
        phase: Float[np.ndarray, "legs"],
    ) -> list[bool | None] | None:
        """Return which feet touch the ground; None for what is not known.

        Parameters
        ----------
        measured : sequence of ((coxa, femur, tibia) or None)
            Joint angles [rad].
        commanded : array, shape (legs, 3)
            Joint angles that were commanded in the last tick [rad].
        dt : float
            Time since the last tick [s].
        age : float
            Time since the measurement [s].
        down : array of bool, shape (legs,)
            Which feet should stand.
        phase : array, shape (legs,)
            Swing phase of the others.
        """
        self._follow(commanded[:, 1:], dt)
        back, share = divmod((self.lag + age) / dt, 1.0)
        recent = int(back) + 1
        if recent >= len(self._expected) or None in measured:
            return None
        newer, older = self._expected[-recent], self._expected[-recent - 1]
        held_up = self._heights(np.array(measured)[:, 1:]) - newer - share * (older - newer)
        free, off = ~down & (phase > _CLEAR) & (phase < _DOWNWARD), held_up - self._mean
        stopped = free & (np.abs(off) > _OBSTACLE)
        self._learn(off, (newer - older) / dt, free & ~stopped)
        falling = ~down & (phase >= _DOWNWARD)
        lowest = np.maximum(np.minimum(self._least, held_up), self._mean - _DIP)
        self._least = np.where(free, np.inf, np.where(falling, lowest, self._least))
        if down.any() and self._sag < _LEAST_SAG:
            self._sag += _MEAN_RATE * (float(held_up[down].mean()) - self._sag)
            return None
        over = held_up - self._least
        touching = np.where(down, over > -_HANGING, stopped | falling & (over > _CONTACT))
        known = free | np.isfinite(self._least)
        return [bool(on) if sure else None for on, sure in zip(touching, known, strict=True)]

    def _heights(self, angles: Float[np.ndarray, "legs 2"]) -> Float[np.ndarray, "legs"]:
        """Return the heights of the feet over the femur axes [m]."""
        femur, tibia = self._lengths
        found: np.ndarray = femur * np.sin(angles[:, 0]) + tibia * np.sin(angles[:, 0] + angles[:, 1])
        return found

    def _follow(self, commanded: Float[np.ndarray, "legs 2"], dt: float) -> None:
        """Take note of the heights after a tick in which free legs follow their commands."""
        step, most = dt / _STEPS, self._most
        if dt != self._tick:
            spring, damper = self._rates
            kept = 1 / (1 + step * damper + step**2 * spring)
            self._tick, self._factors = dt, (kept, step * spring * kept)
        kept, gain = self._factors
        angles, speeds = self._state or (commanded, np.zeros_like(commanded))
        for _ in range(_STEPS):
            speeds = kept * speeds + gain * np.minimum(np.maximum(commanded - angles, -most), most)
            angles = angles + step * speeds
        self._state = angles, speeds
        self._expected.append(self._heights(angles))

    def _learn(
        self, off: Float[np.ndarray, "legs"], speeds: Float[np.ndarray, "legs"], free: Bool[np.ndarray, "legs"]
    ) -> None:
        """Learn the lag, and the mean height of each foot in free swing, from what the heights are off by."""
        if free.any():
            change = float(off[free] @ speeds[free]) / (float(speeds[free] @ speeds[free]) + _SLOW)
            self.lag = min(max(self.lag - _RATE * change, 0.0), _LONGEST_LAG)
            self._mean = np.where(free, self._mean + _MEAN_RATE * off, self._mean)
