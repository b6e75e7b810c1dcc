"""Servo monitor: finds servos that do not follow their commands, from measured joint angles."""

from __future__ import annotations

import math
from collections import UserDict, deque
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.readings import ValidReadings
from tarsus.errors import InputError
from tarsus.robot.robot import JOINTS, require_leg_number

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["FailedJoints", "ServoMonitor"]

# Time between looks at the joints, less a margin for rounding [s].
_PERIOD = 0.04 * (1 - 1e-6)
# Greatest time by which a joint may lag behind its command [s].
_LAG = 0.15
# Error threshold, above the error at which a working servo gives its stall torque: 0.1 rad for hobby servos [rad].
_ERROR = 0.15
# Error threshold of an idle servo [rad]; share of its stall torque below which it is idle, where torque is measured.
_IDLE_ERROR, _IDLE = 0.07, 0.3
# Speed of a joint towards its command above which its servo works, whatever its torque [rad/s].
_MOVES = 1.0
# How long a joint has to be off by its threshold to have failed, and the half-life of this evidence [s]. A greater
# error counts for more, by its square and up to these factors: where torque is not measured, and of an idle servo. A
# servo that pulls works: its leg is caught, or lies on an edge.
_FAILED_AFTER, _MEMORY = 1.5, 2.0
_MOST_WEIGHT, _MOST_IDLE = 6.0, 15.0
# Index of the femur joint.
_FEMUR = 1
# Share of evidence that counts where no torque is measured and the foot touches the ground, which may stall the servo.
_STALLED = 0.2
# That share for a coxa or tibia where neither torque nor contact is known.
_MAY_BE_STALLED = 0.5
# For a femur above its command, torque not measured and its foot not known to touch. It gives way to the ground beyond
# the first error and the second rise [rad], more than nearly any that works; the third is the greatest factor then, if
# contacts are known. Otherwise its leg may lie on an edge, and at most the fourth [s] counts until its foot touches; or
# the ground may stall it, if contacts are unknown.
_GIVES_WAY, _PUSHED, _MOST_GIVING_WAY, _RAISED = 0.6, 0.3, 30.0, 0.8
# A joint is stuck if its command moves by more than the first [rad] in the second [s], and the joint by less than the
# third, a share of that. The fourth is the evidence each time: a joint has failed once stuck twice in a row.
_COMMANDED, _WITHIN, _SHARE, _ONCE = 0.15, 1.0, 0.4, 1.0


class FailedJoints(UserDict[int, int]):
    """Legs with a failed joint, by index, and the index of that joint.

    Parameters
    ----------
    legs : int
        How many legs the robot has.

    Raises
    ------
    InputError
        If a leg or joint is set that the robot does not have.
    """

    def __init__(self, legs: int) -> None:
        super().__init__()
        self._legs = legs

    def __setitem__(self, leg: int, joint: int) -> None:
        """Note that a joint of a leg has failed."""
        require_leg_number("failed", leg, self._legs)
        if joint not in range(len(JOINTS)):
            known = ", ".join(f"{index} ({name})" for index, name in enumerate(JOINTS))
            raise InputError(f"failed: joint {joint!r} of leg {leg} is unknown; joints are {known}")
        super().__setitem__(leg, joint)


class ServoMonitor:
    """Compares measured joint angles with those that were commanded a moment ago.

    A loaded servo yields, and a slow one lags. A dead, limp or stuck servo is off by more than its stall torque
    explains, for longer than any lag; the greater its error, the sooner it is found. The ground may stall a working
    servo. Where torque is measured, it shows that such a servo pulls; it is then found only if its joint does not move
    with its commands. Otherwise contact shows that it presses its foot on the ground.

    Parameters
    ----------
    stall_torque : array, shape (legs, 3)
        Stall torques of the servos [N m]; NaN where unknown.

    Attributes
    ----------
    failed : FailedJoints
        Legs with a failed joint, and that joint.
    """

    def __init__(self, stall_torque: Float[np.ndarray, "legs 3"]) -> None:
        self._stall_torque, self.failed = stall_torque, FailedJoints(len(stall_torque))
        # Durations and commands of the last ticks, and the sum of the durations [s].
        self._commands: deque[tuple[float, Float[np.ndarray, "legs 3"]]] = deque()
        # The first look is immediate, and so in the same ticks as the looks at the body: all other ticks are short.
        self._span = self._time = self._since = self._wait = 0.0
        # Evidence against each joint, by its error and by being stuck [s]; the least error that counts [rad].
        self._evidence, self._least = np.zeros((2, *stall_torque.shape)), _ERROR
        # Legs whose feet touched the ground at the last look.
        self._touched = set[int]()
        # Of femurs that were off at the last look: evidence since the foot last touched or the femur was not above its
        # command [s], and the femur's lowest angle since [rad].
        self._raised = dict[int, tuple[float, float]]()
        # Least and greatest of the measured and of the commanded angles since joints were last checked for being stuck
        # [rad].
        self._ranges: tuple[Float[np.ndarray, "2 legs 3"], Float[np.ndarray, "2 legs 3"]] | None = None
        self._last: Float[np.ndarray, "legs 3"] | None = None

    def step(self, commanded: Float[np.ndarray, "legs 3"], valid: ValidReadings, dt: float) -> None:
        """Take in the readings of a tick.

        Parameters
        ----------
        commanded : array, shape (legs, 3)
            Joint angles commanded until now [rad].
        valid, dt : ValidReadings, float
            The readings, of which legs without joint angles are not monitored; time since the last tick [s].
        """
        self._commands.append((dt, commanded))
        self._span += dt
        while self._span > _LAG + dt:
            self._span -= self._commands.popleft()[0]
        if valid.joint_angles is None:
            return
        self._since += dt
        if self._since >= self._wait:
            self._look(commanded, valid, self._since)
            self._since, self._wait = 0.0, _PERIOD

    def _look(self, commanded: Float[np.ndarray, "legs 3"], valid: ValidReadings, dt: float) -> None:
        """Update the evidence against joints by their errors, which are NaN for legs that are not measured."""
        measured = np.array([leg or (math.nan,) * 3 for leg in valid.joint_angles or ()])
        last, self._last = measured if self._last is None else self._last, measured
        touched, self._touched = self._touched, {leg for leg, touches in enumerate(valid.contacts or ()) if touches}
        # A foot that presses on moving ground loses contact for a moment, while its servo remains stalled.
        touching = touched | self._touched
        raised, self._raised = self._raised, {}
        stuck = self._stuck(np.stack([measured, commanded]), valid, dt)
        self._evidence *= 0.5 ** (dt / _MEMORY)
        # A joint's error against all recent commands is at most that against the last one.
        off = np.abs(measured - commanded)
        if stuck is None and not (off > self._least).any():
            return
        self._least = _IDLE_ERROR
        recent = np.array([angles for _, angles in self._commands])
        over, under = measured - np.maximum.reduce(recent), np.minimum.reduce(recent) - measured
        errors = np.maximum(over, under)
        for leg, joint in np.argwhere(errors > _IDLE_ERROR).tolist():
            now, before, asked = (float(angles[leg, joint]) for angles in (measured, last, commanded))
            error, torque = float(errors[leg, joint]), self._torque(valid, leg, joint)
            touches = leg in touching or (False if valid.contacts and valid.contacts[leg] is not None else None)
            if not math.isnan(torque):
                moves = (now - before) * math.copysign(1.0, asked - now) > _MOVES * dt
                counts = dt * _over(error, _IDLE_ERROR, most=_MOST_IDLE) * (torque < _IDLE and not moves)
            elif joint == _FEMUR:
                up = bool(over[leg, joint] > 0.0)
                counts, self._raised[leg] = _of_femur(raised.get(leg), now, error, dt, up=up, touches=touches)
            else:
                share = _MAY_BE_STALLED if touches is None else _STALLED if touches else 1.0
                counts = dt * share * _over(error, _ERROR, most=_MOST_WEIGHT)
            self._evidence[0, leg, joint] += counts
        if stuck is not None:
            self._evidence[1] += _ONCE * stuck
        for _, leg, joint in np.argwhere(self._evidence > _FAILED_AFTER).tolist():
            self.failed.setdefault(leg, joint)
        # Evidence against a failed leg is dropped, so that it does not count should the leg be used again.
        self._evidence[:, list(self.failed)] = 0.0

    def _torque(self, valid: ValidReadings, leg: int, joint: int) -> float:
        """Return the measured torque of a joint over the stall torque of its servo; NaN where it is unknown."""
        of_leg = valid.torques[leg] if valid.torques else None
        return abs(of_leg[joint]) / float(self._stall_torque[leg, joint]) if of_leg else math.nan

    def _stuck(
        self, angles: Float[np.ndarray, "2 legs 3"], valid: ValidReadings, dt: float
    ) -> Bool[np.ndarray, "legs 3"] | None:
        """Return which joints have not moved with their commands, at the end of a period in which some have not.

        `angles` are the measured and the commanded ones [rad].
        """
        low, high = self._ranges or (angles, angles)
        self._ranges = low, high = np.minimum(low, angles), np.maximum(high, angles)
        self._time += dt
        if self._time < _WITHIN:
            return None
        moved, wanted = high - low
        with np.errstate(invalid="ignore"):
            stuck: np.ndarray = (wanted > _COMMANDED) & (moved < _SHARE * wanted)
            pressed = np.flatnonzero((stuck & (angles[0] > angles[1]))[:, _FEMUR]).tolist()
        # The ground may stall a femur that presses its foot down: wait for what it does once the foot has lifted.
        if any(leg in self._touched and self._torque(valid, leg, _FEMUR) > _IDLE for leg in pressed):
            return None
        self._ranges, self._time = None, 0.0
        return stuck if stuck.any() else None


def _of_femur(
    raised: tuple[float, float] | None, angle: float, error: float, dt: float, *, up: bool, touches: bool | None
) -> tuple[float, tuple[float, float]]:
    """Return the evidence of a femur's error [s] and what is kept for the next look; the ground may hold the leg up.

    Parameters
    ----------
    raised : (float, float) or None
        What was kept at the last look: evidence [s] and lowest angle [rad]; None if the femur was not off.
    angle, error, dt : float
        Measured angle [rad]; error [rad]; time since the last look [s].
    up, touches : bool, bool or None
        Whether the femur is higher than commanded; whether the foot touches the ground, None where that is unknown.
    """
    if touches or not up:
        # A femur above its command whose foot touches bears load: the ground stalls it, unless it gives way far.
        share = _STALLED * (not up or error > _GIVES_WAY) if touches else 1.0
        return dt * share * _over(error, _ERROR, most=_MOST_WEIGHT), (0.0, angle)
    counted, lowest = raised or (0.0, angle - error)
    gives_way, known = error > _GIVES_WAY and angle - lowest > _PUSHED, touches is not None
    counts = dt * _over(error, _ERROR, most=_MOST_GIVING_WAY if gives_way and known else _MOST_WEIGHT)
    if not gives_way:
        counts = min(counts, _RAISED - counted) if known else _STALLED * counts
    return counts, (counted + counts, min(lowest, angle))


def _over(error: float, bound: float, *, most: float) -> float:
    """Return the square of an error over its bound, at most `most`; 0 below the bound."""
    return min((error / bound) ** 2, most) if error > bound else 0.0
