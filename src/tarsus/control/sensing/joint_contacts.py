"""Contacts of the feet by the measured joint angles: legs that the ground pushes do not follow their commands."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.readings import Vector
from tarsus.kinematics.mass import STANDARD_GRAVITY, total_mass
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["JointContacts"]

# Swing phases between which a foot is in the air, and learnt from; from the last one on it lands.
_CLEAR, _DOWNWARD, _LANDING = 0.12, 0.45, 0.55
# Torques on the femur over the load of all legs: of a foot that lands on the ground, of one that stands, and of a
# rising one that an obstacle stops. A foot that bears little stands: taken for one that hangs, it holds up the walk.
_CONTACT, _STANDS, _OBSTACLE = 0.12, -0.02, 0.3
# Share of the torque that drives a joint by which the expected one may be wrong.
_UNSURE = 0.1
# From a command to the servo's effect: at first, and at most [s]; how fast it, the mean of free swings and the load
# are learnt, a tick; and the square of joint speeds below which that tells little of it [rad^2/s^2].
_LAG, _LONGEST_LAG, _RATE, _MEAN_RATE, _SLOW = 0.005, 0.1, 0.02, 0.05, 2.0
# Torques left over in free swing, over the load, below which servos are familiar and above which they are not; how
# much faster these are learnt.
_FAMILIAR, _STRANGE, _FASTER = 0.12, 0.2, 3.0
# Load of all legs above which contacts are known, over weight times length of femur and tibia.
_LEAST_LOAD = 0.1
# Steps of integration a tick, and ticks whose expected angles are kept.
_STEPS, _KEPT = 4, 25


class JointContacts:
    """Estimates contacts by the torques of the ground on the femur joints: by what these are off.

    Each femur is expected to follow as servos of the robot's file do without load: position control within torque and
    speed, dead band, inertia of rotor and links, and a lag that is learnt. What is left over, measured less expected
    angle, times the stiffness is the torque of the ground. It is compared with that of the same leg in free swing,
    which takes care of offsets of horns and of the leg's weight, and with the load of the standing legs. The tibia
    tells less: its torque changes sign with the direction of the force. While the legs have not been seen to bear the
    robot, as with ideal or emulated servos, or free swings not to follow what is expected, nothing is known.

    Parameters
    ----------
    robot : Robot
        A single robot whose masses and servos are known.

    Attributes
    ----------
    lag : float
        From a command to its effect, as learnt [s].

    Raises
    ------
    MissingDataError
        If a servo or the masses are unknown.
    """

    def __init__(self, robot: Robot) -> None:
        springs = JointSprings.of(robot)
        lengths, mass = np.asarray(robot.geometry.femur), np.asarray(robot.link_mass)[:, 1:].T
        com = np.asarray(robot.link_com)[:, 1:].T
        # The shank hangs down or outwards.
        links = mass[0] * com[0] ** 2 + mass[1] * (lengths**2 + com[1] ** 2)
        inertia = springs.rotor_inertia[:, 1] + links
        self._stiffness, self._band = springs.stiffness[:, 1], springs.dead_band[:, 1]
        self._rates = self._stiffness / inertia, springs.damping[:, 1] / inertia
        self._most = springs.stall_torque[:, 1] / self._stiffness
        self._tick, self._factors = 0.0, self._rates
        self._state: tuple[Float[np.ndarray, "legs"], ...] | None = None
        self._expected: deque[tuple[Float[np.ndarray, "legs"], Float[np.ndarray, "legs"]]] = deque(maxlen=_KEPT)
        longest = float((lengths + np.asarray(robot.geometry.tibia)).max())
        self._least = _LEAST_LOAD * float(total_mass(robot)) * STANDARD_GRAVITY * longest
        self.lag, self._load, self._left = _LAG, 0.0, 0.0
        self._familiar = True
        self._mean = np.zeros(robot.legs)

    def contacts(
        self,
        measured: Sequence[Vector | None],
        commanded: Float[np.ndarray, "legs 3"],
        dt: float,
        *,
        age: float,
        down: Bool[np.ndarray, "legs"],
        phase: Float[np.ndarray, "legs"],
    ) -> list[bool] | None:
        """Return which feet touch the ground; None where nothing is known.

        Parameters
        ----------
        measured : sequence of ((coxa, femur, tibia) or None)
            Joint angles [rad].
        commanded : array, shape (legs, 3)
            Joint angles that were commanded in the last tick [rad].
        dt, age : float
            Time since the last tick [s]; time since the measurement [s].
        down : array of bool, shape (legs,)
            Which feet should stand.
        phase : array, shape (legs,)
            Swing phase of the others.
        """
        self._follow(commanded[:, 1], dt)
        back, share = divmod((self.lag + age) / dt, 1.0)
        recent = int(back) + 1
        if recent >= len(self._expected) or None in measured:
            return None
        (newer, driven), (older, _) = self._expected[-recent], self._expected[-recent - 1]
        error = np.array([leg[1] for leg in measured if leg is not None]) - newer - share * (older - newer)
        off = self._stiffness * error - self._mean
        free = ~down & (phase > _CLEAR) & (phase < _DOWNWARD)
        rising = ~down & (phase < _LANDING)
        if free.any():
            # The further it is off, the less is it a familiar servo that is learnt of. Of another one all is learnt: a
            # lag that is far from the first guess would never be found.
            familiar = self._familiar
            usual = off / (1 + (off / (_CONTACT * max(self._load, self._least))) ** 2) if familiar else off
            speeds, errors = (newer - older)[free] / dt, (usual / self._stiffness)[free]
            change = float(errors @ speeds / (speeds @ speeds + _SLOW))
            rate = _RATE if familiar else _FASTER * _RATE
            self.lag = min(max(self.lag - rate * change, 0.0), _LONGEST_LAG)
            self._left += rate * (float(np.abs(off[free]).mean()) - self._left)
            self._mean = np.where(free, self._mean + _MEAN_RATE * usual, self._mean)
        load = float(off[down].sum())
        if load > self._load / 2:
            self._load += _MEAN_RATE * (load - self._load)
        known = self._load >= self._least
        self._familiar = self._left < (_STRANGE if self._familiar else _FAMILIAR) * max(self._load, self._least)
        if not (known and self._familiar):
            return None
        least = self._load * np.where(rising, _OBSTACLE, np.where(down, _STANDS, _CONTACT))
        found: np.ndarray = np.where(rising, np.abs(off), off) > least + _UNSURE * np.abs(driven)
        touching: list[bool] = found.tolist()
        return touching

    def _follow(self, commanded: Float[np.ndarray, "legs"], dt: float) -> None:
        """Take note of the angles after a tick in which free legs follow their commands."""
        step, most, band = dt / _STEPS, self._most, self._band
        if dt != self._tick:
            spring, damper = self._rates
            kept = 1 / (1 + step * damper + step**2 * spring)
            self._tick, self._factors = dt, (kept, step * spring * kept)
        kept, gain = self._factors
        angles, speeds, target = self._state or (commanded, np.zeros_like(commanded), commanded)
        target = np.minimum(np.maximum(target, commanded - band), commanded + band)
        for _ in range(_STEPS):
            speeds = kept * speeds + gain * np.minimum(np.maximum(target - angles, -most), most)
            angles = angles + step * speeds
        self._state = angles, speeds, target
        self._expected.append((angles, self._stiffness * (target - angles)))
