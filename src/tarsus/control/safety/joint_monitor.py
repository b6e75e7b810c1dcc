"""The joints as they were last sent: what breaks their bounds, how they come to rest, how they catch up.

Angles are sent at moments; the speed over a step is the difference of two angles over the step, the acceleration
the difference of two speeds over the time between the middles of their steps (the second divided difference). With
the acceleration A, a joint whose last step h had the speed v comes to rest within::

    stop(v, h) = max(0, |v| - A h / 2)^2 / (2 A)

whatever steps follow: the angles sent while it brakes are midpoint sums of a speed that falls as a straight line, and
these are at most its integral. A joint that always has this much room before its limit can always be stopped.
"""

from __future__ import annotations

import math

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.interventions import Violation
from tarsus.kinematics.verdict import ANGLE_TOLERANCE

__all__ = ["ROUNDING", "JointMonitor"]

ROUNDING = 1e-12
"""What rounding may add to an angle that is sent [rad], against its bounds on speed and acceleration."""


class JointMonitor:
    """Where each joint was last sent, how fast it went there, and where it may go next.

    Attributes
    ----------
    angles, speeds : list of float
        Joint angles as last sent, one after the other [rad], and the speeds of the last step [rad/s].
    """

    def __init__(self, bounds: GuardBounds) -> None:
        lower, upper = (bounds.limits[..., side].ravel().tolist() for side in (0, 1))
        self._bounds: list[tuple[float, float, float, float]] = list(
            zip(lower, upper, bounds.speed.ravel().tolist(), bounds.acceleration.ravel().tolist(), strict=True)
        )
        self._slow: list[float] = (bounds.recovery * bounds.speed).ravel().tolist()
        self.angles: list[float] = [min(max(0.0, low), high) for low, high, _, _ in self._bounds]
        self.speeds = [0.0] * len(lower)
        self._step = 0.0

    @property
    def at_rest(self) -> bool:
        """Whether no joint moved in the last step."""
        return not any(self.speeds)

    def place(self, angles: list[float], step: float) -> None:
        """Start at rest in some angles."""
        self.angles, self.speeds, self._step = angles, [0.0] * len(angles), step

    def forget_step(self) -> None:
        """Take a joint at rest for one that has long been so: after a gap, its length permits no sudden start."""
        if self.at_rest:
            self._step = 0.0

    def within(self, angles: list[float]) -> list[Violation]:
        """Return which angles are beyond a limit; bring those within that are beyond it by rounding."""
        faults = []
        for i, (angle, (low, high, _, _)) in enumerate(zip(angles, self._bounds, strict=True)):
            if not low <= angle <= high:
                bound = low if angle < low else high
                if abs(angle - bound) > ANGLE_TOLERANCE:
                    faults.append(Violation("limit", i // 3, i % 3, angle, bound))
                angles[i] = bound
        return faults

    def too_rash(self, angles: list[float], step: float) -> list[Violation]:
        """Return what breaks a bound if the joints are sent to `angles` within a step."""
        faults = []
        between = (step + self._step) / 2
        slack = ROUNDING / step
        joints = zip(angles, self.angles, self.speeds, self._bounds, strict=True)
        for i, (angle, last, speed, (low, high, fastest, most)) in enumerate(joints):
            now = (angle - last) / step
            size = now if now >= 0 else -now
            if size > fastest + slack:
                faults.append(Violation("speed", i // 3, i % 3, size, fastest))
            change = now - speed if now >= speed else speed - now
            if change > most * between + slack:
                faults.append(Violation("acceleration", i // 3, i % 3, change / between, most))
            # The part of a step in which it would brake already.
            rest = size - most * step / 2
            if rest > 0:
                room = high - angle if now > 0 else angle - low
                if rest * rest > 2 * most * (room + ROUNDING):
                    faults.append(Violation("braking", i // 3, i % 3, rest * rest / (2 * most), room))
        return faults

    def send(self, angles: list[float], step: float) -> None:
        """Take note that the joints are sent to `angles` within a step."""
        self.speeds = [(angle - last) / step for angle, last in zip(angles, self.angles, strict=True)]
        self.angles, self._step = angles, step

    def brake(self, step: float) -> None:
        """Send every joint on along its speed, braking as hard as it may."""
        self._send_at([0.0] * len(self.speeds), step)

    def distance(self, angles: list[float]) -> tuple[float, int]:
        """Return how far the joint is that is farthest from `angles` [rad], and which one."""
        apart = [abs(angle - last) for angle, last in zip(angles, self.angles, strict=True)]
        most = max(apart)
        return most, apart.index(most)

    def follow(self, before: list[float], angles: list[float], step: float) -> bool:
        """Send the joints nearer to where they are commanded, and tell whether they are there, as fast as commanded.

        Parameters
        ----------
        before, angles : list of float
            The commanded angles of the last step and of this [rad].
        step : float
            The time step [s].
        """
        met, wanted = True, []
        for last, old, new, slow, (_, _, fastest, most) in zip(
            self.angles, before, angles, self._slow, self._bounds, strict=True
        ):
            gap, commanded = old - last, (new - old) / step
            # Half of the acceleration is left for following what the command itself does.
            closing = min(stoppable_speed(abs(gap), most / 2, step), slow)
            wanted.append(min(max(commanded, -fastest), fastest) + math.copysign(closing, gap))
            met = met and abs(gap) <= most * step * step / 2
        if met and not self.too_rash(angles, step):
            self.send(angles, step)
            return True
        self._send_at(wanted, step)
        return False

    def _send_at(self, wanted: list[float], step: float) -> None:
        """Send the joints on at the speeds that are wanted, as nearly as their bounds permit."""
        between = (step + self._step) / 2
        angles = []
        for speed, last, old, (low, high, fastest, most) in zip(
            wanted, self.angles, self.speeds, self._bounds, strict=True
        ):
            change = most * between
            # Each of these intervals meets the ones before, but for rounding: the last is the one that is kept.
            now = min(max(speed, -stoppable_speed(last - low, most, step)), stoppable_speed(high - last, most, step))
            now = min(max(now, old - change), old + change)
            now = min(max(now, -fastest), fastest)
            angles.append(min(max(last + now * step, low), high))
        self.send(angles, step)


def stoppable_speed(room: float, acceleration: float, step: float) -> float:
    """Return the highest speed of a step after which a joint can still be stopped within a room [rad/s].

    Parameters
    ----------
    room : float
        How far it may go, this step included [rad].
    acceleration : float
        The most it may have [rad/s^2].
    step : float
        The time step [s].
    """
    half = acceleration * step / 2
    # The step alone uses the room up, or the room is that of the step and of `stop` after it.
    return room / step if room <= half * step else math.sqrt(2 * acceleration * room) - half
