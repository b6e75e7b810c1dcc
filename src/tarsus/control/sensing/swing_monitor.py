"""Swing monitor: finds legs that are stopped in their swing, from the measured angles of their coxa joints."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence

from tarsus.control.readings import ValidReadings

__all__ = ["USUAL_LAG", "SwingMonitor"]

USUAL_LAG = 0.03
"""Usual lag of servo-driven joints behind their commands [s]."""

# A joint is stopped if it is behind by more than the first [rad] plus the second times its usual angle behind; first
# guess of that usual angle [rad], and how fast it is learnt [1/s].
_BEHIND, _TIMES, _AT_FIRST, _MEAN_RATE = 0.02, 3.0, 0.02, 1.0
# A joint that moves faster than this share of its commanded speed only lags, as servos do that are started suddenly.
_MOVES = 0.5
# Longest lag of a joint, from its command to the reading [s]; how fast the lag is learnt [1/s]; square of joint speeds
# below which a joint tells little of it [rad^2/s^2].
_LONGEST_LAG, _RATE, _SLOW = 0.12, 5.0, 0.5
# How fast the mean lag follows the learnt one [1/s]: slowly, as the first guess, the longest lag, should not count.
_LAG_RATE = 0.3
# Tolerance for the rounding of times [s].
_ROUNDING = 1e-9


class SwingMonitor:
    """Compares measured angles of swinging legs with those commanded a lag earlier; the lag is learnt.

    A servo is commanded in steps, which its joint smooths: the expected angle is the mean of the commands in a window
    as long as the longest of the last ticks. It moves evenly even where ticks differ in length.

    Attributes
    ----------
    lag : float
        Lag from a command to its reading, mean of the learnt one [s]; 0 where no angles are measured.
    """

    def __init__(self) -> None:
        self.lag, self._lag, self._usual = 0.0, _LONGEST_LAG, _AT_FIRST
        # How long each command lasted [s], and the command, latest first.
        self._commands = deque[tuple[float, list[float]]]()
        # Time [s]; by leg, the angle that was measured last, and when [rad], [s].
        self._now, self._measured = 0.0, dict[int, tuple[float, float]]()

    def step(self, commanded: list[float], valid: ValidReadings, dt: float, down: Sequence[bool]) -> list[int]:
        """Return the legs in the air whose coxa joints are stopped.

        Parameters
        ----------
        commanded : list of float
            Angles of the coxa joints that were commanded last [rad].
        valid, dt, down : ValidReadings, float, sequence of bool
            The readings; time since the last tick [s]; which feet should stand.
        """
        stopped, window = list[int](), self._note(commanded, dt)
        self._now += dt
        if not window or valid.joint_angles is None:
            return stopped
        lag, usual, held = self._lag, self._usual, self._before(window)
        newer, older = held[0][1], held[-1][1]
        # Where few joints are measured in a tick, what is learnt from each counts for the others, too.
        dt *= len(down) / max(len(down) - len(valid.predicted), 1)
        for leg, angles in enumerate(valid.joint_angles):
            if angles is None or leg in valid.predicted:
                continue
            before, at = self._measured.get(leg, (math.nan, 0.0))
            self._measured[leg] = angles[0], self._now
            if down[leg]:
                continue
            angle, speed, turned = angles[0], (newer[leg] - older[leg]) / window, 0.0
            for time, command in held:
                turned += time * command[leg]
            behind = turned / window - angle
            # Whether the leg is still commanded onwards: within the lag, its motion may have reversed.
            onwards = (commanded[leg] - angle) * speed > 0.0
            slow = (angle - before) * speed < _MOVES * speed * speed * (self._now - at)
            if onwards and slow and behind * speed > (_BEHIND + _TIMES * usual) * abs(speed):
                stopped.append(leg)
            else:
                usual += _MEAN_RATE * dt * (abs(behind) - usual)
                lag += _RATE * dt * behind * speed / (speed * speed + _SLOW)
                lag = min(max(lag, 0.0), _LONGEST_LAG)
                self.lag += _LAG_RATE * dt * (lag - self.lag)
        self._lag, self._usual = lag, usual
        return stopped

    def _note(self, commanded: list[float], dt: float) -> float:
        """Note a command, and return the longest of the last ticks; 0 as long as these are too few [s]."""
        commands = self._commands
        commands.appendleft((dt, commanded))
        times = [time for time, _ in commands]
        window, span = max(times), sum(times)
        longest = _LONGEST_LAG + window + dt + _ROUNDING
        if span <= longest:
            return 0.0
        while span - commands[-1][0] > longest:
            span -= commands.pop()[0]
        return window

    def _before(self, window: float) -> list[tuple[float, list[float]]]:
        """Return the commands in the window that ends a lag ago, latest first, each after its time there [s]."""
        held, end, lag, oldest = list[tuple[float, list[float]]](), 0.0, self._lag, self._lag + window + _ROUNDING
        for time, command in self._commands:
            start, end = end, end + time
            if start > oldest:
                break
            if end > lag:
                held.append((min(end, oldest) - max(start, lag), command))
        return held
