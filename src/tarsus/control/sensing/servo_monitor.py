"""Servo monitor: finds servos that do not follow their commands, by the measured joint angles."""

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

# How often joints are looked at, but for rounding [s].
_PERIOD = 0.04 * (1 - 1e-6)
# A joint may lag behind its command for so long [s].
_LAG = 0.15
# Error beyond which a servo gives more than its stall torque, if it works [rad]. Hobby servos give it at 0.1 rad.
_ERROR = 0.15
# The same of a servo that gives less than this share of its stall torque, where that is measured [rad].
_IDLE_ERROR, _IDLE = 0.07, 0.3
# Speed towards its command of a joint whose servo works, whatever torque it gives at that [rad/s].
_MOVES = 1.0
# How long a joint has to be off by this error until it has failed, and the time in which half of it is forgotten [s]. A
# greater error counts for more, by its square and up to these factors: where the torque is not measured, and of an idle
# servo. One that pulls works: its leg is caught, or lies on an edge.
_FAILED_AFTER, _MEMORY = 1.5, 2.0
_MOST_WEIGHT, _MOST_IDLE = 6.0, 15.0
# Index of the femur joint.
_FEMUR = 1
# Share that counts where the foot touches the ground, which may stall the servo, and no torque is measured.
_STALLED = 0.2
# The same of a coxa or tibia where neither torque nor touch is known.
_MAY_BE_STALLED = 0.5
# Where neither torque nor touch tells: error of a femur that the ground has pushed up, by the second [rad], more than
# nearly any that holds on, and the greatest factor then; what counts at most of one that is held up, each time until
# its foot touches: its leg may lie on an edge. Without contacts, the ground may stall it.
_GIVES_WAY, _PUSHED, _MOST_GIVING_WAY, _RAISED = 0.6, 0.3, 30.0, 0.8
# A joint whose command moves by so much within a time [rad], [s], and that moves by less than this share of it, is
# stuck; it has failed once that is so twice in a row.
_COMMANDED, _WITHIN, _SHARE, _ONCE = 0.15, 1.0, 0.4, 1.0


class FailedJoints(UserDict[int, int]):
    """Legs with a joint that has failed, and the joint.

    Parameters
    ----------
    legs : int
        How many legs the robot has.

    Raises
    ------
    InputError
        If the robot has no such leg or joint, as it is set.
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

    A servo that is loaded gives way, and one that is slow lags behind. One that is dead, limp or stuck is off by more
    than its stall torque explains, for longer than any lag; the more it is off, the sooner it is found. The ground may
    stall a servo that works. Its torque tells, where that is measured: such a servo pulls, and is found only if its
    joint does not move with its commands. Otherwise, contact does: it presses its foot on the ground.

    Parameters
    ----------
    stall_torque : array, shape (legs, 3)
        Stall torques of the servos [N m]; NaN where unknown.

    Attributes
    ----------
    failed : FailedJoints
        Legs with a joint that has failed, and the joint.
    """

    def __init__(self, stall_torque: Float[np.ndarray, "legs 3"]) -> None:
        self._stall_torque, self.failed = stall_torque, FailedJoints(len(stall_torque))
        # Durations and commands of the last ticks, and the sum of the durations [s].
        self._commands: deque[tuple[float, Float[np.ndarray, "legs 3"]]] = deque()
        # It looks at once, and so in the ticks in which the body is looked at: the others are short.
        self._span = self._time = self._since = self._wait = 0.0
        self._evidence: Float[np.ndarray, "2 legs 3"] | None = None
        # Legs whose feet touched as joints were last looked at.
        self._touched = set[int]()
        # Of femurs that were off when joints were last looked at: what has counted since the foot touched or the femur
        # was not held up, and its lowest angle since [rad].
        self._raised = dict[int, tuple[float, float]]()
        # Least and greatest of what was measured and commanded, since joints were last looked at for whether they are
        # stuck.
        self._ranges: tuple[Float[np.ndarray, "2 legs 3"], Float[np.ndarray, "2 legs 3"]] | None = None
        self._last: Float[np.ndarray, "legs 3"] | None = None

    def step(self, commanded: Float[np.ndarray, "legs 3"], valid: ValidReadings, dt: float) -> None:
        """Take in what is measured in a tick.

        Parameters
        ----------
        commanded : array, shape (legs, 3)
            Commanded until now [rad].
        valid, dt : ValidReadings, float
            The readings; legs without measured joint angles are not monitored; time since the last tick [s].
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
        """Change the evidence against joints by their errors; those of legs that are not measured are NaN."""
        measured = np.array([leg or (math.nan,) * 3 for leg in valid.joint_angles or ()])
        last, self._last = measured if self._last is None else self._last, measured
        touched, self._touched = self._touched, {leg for leg, touches in enumerate(valid.contacts or ()) if touches}
        # A foot that presses on moving ground loses touch for a moment, in which its servo is stalled as before.
        touching = touched | self._touched
        raised, self._raised = self._raised, {}
        stuck = self._stuck(np.stack([measured, commanded]), valid, dt)
        if self._evidence is not None:
            self._evidence *= 0.5 ** (dt / _MEMORY)
        # No joint is further from all recent commands than from the last one.
        off = np.abs(measured - commanded)
        if stuck is None and not (off > (_ERROR if self._evidence is None else _IDLE_ERROR)).any():
            return
        if self._evidence is None:
            self._evidence = np.zeros((2, *commanded.shape))
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
        # What tells against a leg that has failed does not count if it is to be used again.
        self._evidence[:, list(self.failed)] = 0.0

    def _torque(self, valid: ValidReadings, leg: int, joint: int) -> float:
        """Return the measured torque of a joint over the stall torque of its servo; NaN where it is unknown."""
        of_leg = valid.torques[leg] if valid.torques else None
        return abs(of_leg[joint]) / float(self._stall_torque[leg, joint]) if of_leg else math.nan

    def _stuck(
        self, angles: Float[np.ndarray, "2 legs 3"], valid: ValidReadings, dt: float
    ) -> Bool[np.ndarray, "legs 3"] | None:
        """Return which joints have not moved with their commands, at the end of a time in which any is so.

        `angles` are those measured and those commanded [rad].
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
        # The ground may stall a femur that presses its foot down: what it does once that has lifted tells.
        if any(leg in self._touched and self._torque(valid, leg, _FEMUR) > _IDLE for leg in pressed):
            return None
        self._ranges, self._time = None, 0.0
        return stuck if stuck.any() else None


def _of_femur(
    raised: tuple[float, float] | None, angle: float, error: float, dt: float, *, up: bool, touches: bool | None
) -> tuple[float, tuple[float, float]]:
    """Return for how much an error of a femur counts, and what is kept of it; the ground may hold the leg up.

    Parameters
    ----------
    raised : (float, float) or None
        What was kept at the last look; None if the femur was not off.
    angle, error, dt : float
        Measured angle [rad]; error [rad]; time since the last look [s].
    up, touches : bool, bool or None
        Whether the femur is higher than commanded; whether the foot touches the ground, None where that is unknown.
    """
    if touches or not up:
        return dt * (_STALLED if touches else 1.0) * _over(error, _ERROR, most=_MOST_WEIGHT), (0.0, angle)
    counted, lowest = raised or (0.0, angle - error)
    gives_way, known = error > _GIVES_WAY and angle - lowest > _PUSHED, touches is not None
    counts = dt * _over(error, _ERROR, most=_MOST_GIVING_WAY if gives_way and known else _MOST_WEIGHT)
    if not gives_way:
        counts = min(counts, _RAISED - counted) if known else _STALLED * counts
    return counts, (counted + counts, min(lowest, angle))


def _over(error: float, bound: float, *, most: float) -> float:
    """Return the square of an error over its bound, up to a greatest one; 0 below the bound."""
    return min((error / bound) ** 2, most) if error > bound else 0.0
