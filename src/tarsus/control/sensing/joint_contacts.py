"""Contacts of the feet, from measured joint angles: legs that the ground pushes do not follow their commands."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from tarsus.control.readings import ValidReadings, Vector
from tarsus.control.walk.state import GaitState
from tarsus.kinematics.mass import STANDARD_GRAVITY, known_weight
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.robot.robot import Robot

__all__ = ["JointContacts"]

# Swing phases between which a foot is in the air, and its leg learnt from: up and down, or friction would look like an
# offset; from the second on, a foot lands.
_CLEAR, _LANDING = 0.12, 0.55
# Torque on the femur above which a foot is in contact, over the load of all legs: of a landing foot, of a standing one,
# and of a rising one stopped by an obstacle. A standing foot with little load counts: else it would delay the walk.
_CONTACT, _STANDS, _OBSTACLE = 0.12, -0.02, 0.3
# That torque of a landing foot is at least so many times the residual torque of free swings.
_SPREAD = 2.0
# That torque of a foot new in its stance: the first, until it has borne more than the second for the third in all [s];
# before, it may be over a hole.
_NEW, _BORNE, _LONG = 0.06, 0.15, 0.03
# Uncertainty of the expected torque, as a share of the torque that drives the joint.
_UNSURE = 0.1
# Lag from a command to the servo's effect: first guess; least, of servos stiffer than the file's; greatest [s]. How
# fast it is learnt; how fast the mean of free swings and the load are learnt [1/s]; square of joint speeds below which
# a swing tells little of the lag [rad^2/s^2].
_LAG, _LEAST_LAG, _LONGEST_LAG, _RATE, _MEAN_RATE, _SLOW = 0.005, -0.01, 0.1, 2.0, 5.0, 2.0
# Residual torque in free swing, over the load, below which servos become familiar, and above which they no longer are;
# factor by which unfamiliar servos are learnt faster.
_FAMILIAR, _STRANGE, _FASTER = 0.1, 0.15, 3.0
# Least load of all legs for contacts to be known, over weight times length of femur and tibia; how long the load may be
# less than half the learnt one [s]: after that, something else bears the robot, or what was learnt is wrong.
_LEAST_LOAD, _UNBORNE = 0.1, 0.5
# Step of the integration, and how long expected angles are kept [s]; share of a step that is rounding.
_STEP, _KEPT, _ROUNDING = 0.0025, 0.25, 1e-6


class JointContacts:
    """Estimates contacts from the torques of the ground on the femur joints, seen in the joints' angle errors.

    Each femur is expected to follow its commands as the servo in the robot's file does without load: position control
    within limits of torque and speed, dead band, inertia of rotor and links, and a lag that is learnt. The residual,
    measured less expected angle, times the stiffness, is the torque of the ground and of the leg's weight. It is
    compared with that of the same leg in free swing, which cancels offsets of servo horns, and with the load of the
    standing legs. The tibia tells less: its torque changes sign with the direction of the force.

    Contacts are unknown until free swings have matched the expected ones and the legs have borne the robot, which never
    shows with ideal and emulated servos. Where the legs bear less than half the learnt load for longer than steps take,
    what was learnt is forgotten and learnt anew, and the walk goes on without contacts.

    Parameters
    ----------
    robot : Robot
        A single robot whose masses and servos are known.

    Attributes
    ----------
    lag, unborne : float, bool
        Learnt lag from a command to its effect [s]; whether the legs have just ceased to bear the robot.

    Raises
    ------
    MissingDataError
        If a servo or the masses are unknown.
    """

    def __init__(self, robot: Robot) -> None:
        springs = JointSprings.of(robot)
        lengths, mass = np.asarray(robot.geometry.femur), np.asarray(robot.link_mass)[:, 1:].T
        com = np.asarray(robot.link_com)[:, 1:].T
        # About the femur axis, with the shank at a right angle to the femur.
        links = mass[0] * com[0] ** 2 + mass[1] * (lengths**2 + com[1] ** 2)
        inertia = springs.rotor_inertia[:, 1] + links
        # Moments of the links' weights on the femur joint, for a level femur and for a level shank [N m].
        near, far = STANDARD_GRAVITY * (mass[0] * com[0] + mass[1] * lengths), STANDARD_GRAVITY * mass[1] * com[1]
        self._moments = near.tolist(), far.tolist()
        stiffness = springs.stiffness[:, 1]
        self._stiffness: list[float] = stiffness.tolist()
        spring, damper = stiffness / inertia, springs.damping[:, 1] / inertia
        kept = 1 / (1 + _STEP * damper + _STEP**2 * spring)
        bounds = springs.stall_torque[:, 1] / stiffness, springs.dead_band[:, 1]
        columns = (column.tolist() for column in (kept, _STEP * spring * kept, *bounds, stiffness))
        # Of each femur: its constants; angle, speed and target; expectations after each step. Time since the last [s].
        self._servos, self._state = list(zip(*columns, strict=True)), list[tuple[float, float, float]]()
        self._expected, self._since = deque[list[tuple[float, float]]](), 0.0
        longest = float((lengths + np.asarray(robot.geometry.tibia)).max())
        self._least = _LEAST_LOAD * known_weight(robot) * longest
        self.lag, self._familiar, self._unborne, self.unborne = _LAG, False, 0.0, False
        self._forget()
        # How long each foot has borne load in its present stance [s].
        self._borne = [2 * _LONG] * robot.legs

    def contacts(self, valid: ValidReadings, commanded: list[Vector], state: GaitState, dt: float) -> list[bool] | None:
        """Return which feet touch the ground; None where contacts are unknown.

        Parameters
        ----------
        valid : ValidReadings
            The readings, with joint angles.
        commanded : list of (coxa, femur, tibia)
            Joint angles that were commanded in the last tick [rad].
        state, dt : GaitState, float
            The gait state; time since the last tick [s].
        """
        self._follow([femur for _, femur, _ in commanded], dt)
        legs = [leg for leg in valid.joint_angles or () if leg is not None]
        late = (self.lag + valid.joint_age + self._since) / _STEP
        recent = max(int(late), 0) + 1
        if recent >= len(self._expected) or len(legs) < len(self._stiffness):
            return None
        share = late + 1 - recent
        (newer, driven), (older, _) = (zip(*self._expected[-index], strict=True) for index in (recent, recent + 1))
        behind = zip(legs, newer, older, self._stiffness, *self._moments, self._mean, strict=True)
        off = [
            spring * (femur - new - share * (old - new)) + near * math.cos(femur) + far * math.cos(femur + tibia) - mean
            for (_, femur, tibia), new, old, spring, near, far, mean in behind
        ]
        stands, phases = state.down.tolist(), state.swing_phase.tolist()
        free = [leg for leg, on in enumerate(stands) if not on and _CLEAR < phases[leg] < _LANDING]
        if free:
            self._learn(free, off, [(newer[leg] - older[leg]) / _STEP for leg in free], dt)
        load = sum(torque for torque, on in zip(off, stands, strict=True) if on)
        borne = load > self._load / 2
        self._load += borne * _MEAN_RATE * dt * (load - self._load)
        self._unborne = (self._unborne + dt) * (not borne)
        self.unborne = bool(self._unborne > _UNBORNE and self._familiar and self._load >= self._least)
        if self._unborne > _UNBORNE:
            self._forget()
        self._familiar = self._left < (_STRANGE if self._familiar else _FAMILIAR) * max(self._load, self._least)
        if self._load < self._least or not self._familiar:
            return None
        touching, lands = list[bool](), max(_CONTACT * self._load, _SPREAD * self._left)
        for leg, (torque, drive, on, swung) in enumerate(zip(off, driven, stands, phases, strict=True)):
            rising = not on and swung < _LANDING
            self._borne[leg] = (self._borne[leg] + dt * (torque > _BORNE * self._load)) * on
            stood = self._load * (_STANDS if self._borne[leg] > _LONG else _NEW)
            least = self._load * _OBSTACLE if rising else stood if on else lands
            touching.append((abs(torque) if rising else torque) > least + _UNSURE * abs(drive))
        return touching

    def _forget(self) -> None:
        """Forget the load, the residual torque of free swings and each leg's mean torque [N m]; keep the lag."""
        self._load, self._left, self._mean = 0.0, self._least, [0.0] * len(self._stiffness)
        self._familiar, self._unborne = False, 0.0

    def _learn(self, free: list[int], off: list[float], speeds: list[float], dt: float) -> None:
        """Learn the lag and the mean torques from legs that swing freely, at these speeds of their femurs [rad/s]."""
        # With familiar servos, a large torque is a disturbance and counts for less. With unfamiliar ones it counts in
        # full, or a lag far from the first guess would never be found. Both are limited to that of a caught foot.
        load, rate = max(self._load, self._least), dt * (_RATE if self._familiar else _FASTER * _RATE)
        product = square = 0.0
        off = [min(max(torque, -_OBSTACLE * load), _OBSTACLE * load) for torque in off]
        for leg, speed in zip(free, speeds, strict=True):
            usual = off[leg] / (1 + (off[leg] / (_CONTACT * load)) ** 2) if self._familiar else off[leg]
            product, square = product + usual / self._stiffness[leg] * speed, square + speed * speed
            self._mean[leg] += _MEAN_RATE * dt * usual
        self.lag = min(max(self.lag - rate * product / (square + _SLOW), _LEAST_LAG), _LONGEST_LAG)
        self._left += rate * (sum(abs(off[leg]) for leg in free) / len(free) - self._left)

    def _follow(self, commanded: list[float], dt: float) -> None:
        """Integrate the angles that the femurs of free legs have as they follow their commands for a tick."""
        # Steps of one length, whatever the ticks: expectations of different steps are compared by their number.
        self._since += dt
        steps = int(self._since / _STEP + _ROUNDING)
        self._since -= steps * _STEP
        self._state = self._state or [(command, 0.0, command) for command in commanded]
        for _ in range(steps):
            moved, expected = list[tuple[float, float, float]](), list[tuple[float, float]]()
            for command, state, servo in zip(commanded, self._state, self._servos, strict=True):
                (angle, speed, target), (kept, gain, most, band, stiffness) = state, servo
                target = min(max(target, command - band), command + band)
                speed = kept * speed + gain * min(max(target - angle, -most), most)
                angle += _STEP * speed
                moved.append((angle, speed, target))
                expected.append((angle, stiffness * (target - angle)))
            self._state = moved
            self._expected.append(expected)
        while len(self._expected) > _KEPT / _STEP:
            self._expected.popleft()
