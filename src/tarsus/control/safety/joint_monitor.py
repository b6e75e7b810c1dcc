"""Bounds on joint angles, speeds and accelerations; braking and recovery within these bounds.

Angles are sent at discrete times. The speed of a step is the difference of two angles over the step; the acceleration
is the difference of two speeds over the time between the centres of their steps (the second divided difference). With
the acceleration A, a joint with speed v over its last step h comes to rest within the braking distance::

    max(0, |v| - A h / 2)^2 / (2 A)

however long the following steps are: the angles sent while braking are midpoint sums of a linearly decreasing speed,
which are at most its integral. A joint that keeps this distance from its limit can always be stopped before the limit.
"""

from __future__ import annotations

import math

import numpy as np

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.interventions import Intervention, InterventionKind
from tarsus.kinematics.reach import ANGLE_TOLERANCE
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["JointMonitor"]

# Rounding of a sent angle that is tolerated by the bounds on speed, acceleration and braking distance [rad].
_ROUNDING = 1e-12


class JointMonitor:
    """Last sent angles and speeds of the joints, and which angles may follow.

    Attributes
    ----------
    names : list of (str, str)
        For each joint: short name of its leg, and its own name.
    angles : list of float
        Last sent joint angles of all legs in one flat list [rad].
    speeds : list of float
        Joint speeds of the last step [rad/s].

    Parameters
    ----------
    robot, bounds : Robot, GuardBounds
        A single robot; the bounds.
    """

    def __init__(self, robot: Robot, bounds: GuardBounds) -> None:
        self.names = [(leg, joint) for leg in robot.leg_codes for joint in JOINTS]
        motion = np.stack([bounds.speed, bounds.acceleration], axis=-1)
        # Of each joint: lower and upper limit, greatest speed and acceleration.
        self._bounds: list[list[float]] = np.concatenate([bounds.limits, motion], axis=-1).reshape(-1, 4).tolist()
        self._recovery = bounds.recovery_speed
        self.start([min(max(0.0, low), high) for low, high, _, _ in self._bounds], 0.0)

    @property
    def at_rest(self) -> bool:
        """Whether no joint moved in the last step."""
        return not any(self.speeds)

    def start(self, angles: list[float], step: float) -> None:
        """Set the joints to angles, at rest.

        Parameters
        ----------
        angles, step : list of float, float
            Joint angles in one flat list [rad]; time step that led there [s].
        """
        self.angles, self.speeds, self._step = angles, [0.0] * len(angles), step

    def limit_violations(self, angles: list[float]) -> list[Intervention]:
        """Return the angles beyond a limit; clamp `angles` to the limits in place.

        Parameters
        ----------
        angles : list of float
            Joint angles in one flat list [rad]. Excess within the tolerance of inverse kinematics is only clamped.
        """
        violations = []
        for i, (angle, (low, high, _, _)) in enumerate(zip(angles, self._bounds, strict=True)):
            if not low <= angle <= high:
                bound = low if angle < low else high
                if abs(angle - bound) > ANGLE_TOLERANCE:
                    violations.append(Intervention(InterventionKind.JOINT_LIMIT, *self.names[i], angle, bound))
                angles[i] = bound
        return violations

    def motion_violations(self, angles: list[float], step: float) -> list[Intervention]:
        """Return the violated bounds on speed, acceleration and braking distance.

        Parameters
        ----------
        angles, step : list of float, float
            Joint angles at the end of the step, in one flat list [rad]; time step [s].
        """
        violations = []
        interval = (step + self._step) / 2
        tolerance = _ROUNDING / step
        joints = zip(angles, self.angles, self.speeds, self._bounds, strict=True)
        for i, (angle, last_angle, last_speed, (low, high, max_speed, max_acceleration)) in enumerate(joints):
            velocity = (angle - last_angle) / step
            speed = velocity if velocity >= 0 else -velocity
            if speed > max_speed + tolerance:
                violations.append(Intervention(InterventionKind.JOINT_SPEED, *self.names[i], speed, max_speed))
            change = velocity - last_speed if velocity >= last_speed else last_speed - velocity
            if change > max_acceleration * interval + tolerance:
                kind = InterventionKind.JOINT_ACCELERATION
                violations.append(Intervention(kind, *self.names[i], change / interval, max_acceleration))
            braking_speed = speed - max_acceleration * step / 2
            if braking_speed > 0:
                distance = high - angle if velocity > 0 else angle - low
                if braking_speed * braking_speed > 2 * max_acceleration * (distance + _ROUNDING):
                    needed = braking_speed * braking_speed / (2 * max_acceleration)
                    violations.append(Intervention(InterventionKind.BRAKING_DISTANCE, *self.names[i], needed, distance))
        return violations

    def send(self, angles: list[float], step: float) -> None:
        """Store the angles that are sent at the end of a step.

        Parameters
        ----------
        angles, step : list of float, float
            Joint angles in one flat list [rad]; time step [s].
        """
        self.speeds = [(angle - last) / step for angle, last in zip(angles, self.angles, strict=True)]
        self.angles, self._step = angles, step

    def brake(self, step: float, *, gap: bool = False) -> None:
        """Move every joint on along its velocity while braking at its greatest acceleration.

        Parameters
        ----------
        step, gap : float, bool
            Time step [s]; whether it is a gap, whose length must not let joints at rest start suddenly.
        """
        self._send_velocities([0.0] * len(self.speeds), step)
        if gap and self.at_rest:
            self._step = 0.0

    def distance_violations(self, angles: list[float], bound: float) -> list[Intervention]:
        """Return the joints that are farther from `angles` than a bound.

        Parameters
        ----------
        angles, bound : list of float, float
            Joint angles in one flat list [rad]; greatest distance [rad].
        """
        distances = [abs(angle - last) for angle, last in zip(angles, self.angles, strict=True)]
        kind, far = InterventionKind.COMMAND_DISTANCE, zip(self.names, distances, strict=True)
        return [Intervention(kind, *name, distance, bound) for name, distance in far if distance > bound]

    def recover(self, last_command: list[float], command: list[float], step: float) -> bool:
        """Move the joints towards the command; return whether they match its angles and velocities.

        Parameters
        ----------
        last_command, command, step : list of float, list of float, float
            Commanded angles of the last step and of this one, in flat lists [rad]; time step [s].
        """
        matches, velocities = True, []
        joints = zip(self.angles, last_command, command, self._bounds, strict=True)
        for last_angle, last, angle, (_, _, max_speed, max_acceleration) in joints:
            gap, commanded = last - last_angle, (angle - last) / step
            # Half of the acceleration is reserved for changes of the commanded velocity.
            closing = min(_stoppable_speed(abs(gap), max_acceleration / 2, step), self._recovery * max_speed)
            velocities.append(min(max(commanded, -max_speed), max_speed) + math.copysign(closing, gap))
            matches = matches and abs(gap) <= max_acceleration * step * step / 2
        if matches and not self.motion_violations(command, step):
            self.send(command, step)
            return True
        self._send_velocities(velocities, step)
        return False

    def _send_velocities(self, velocities: list[float], step: float) -> None:
        """Move the joints at the nearest velocities within their bounds."""
        interval = (step + self._step) / 2
        angles = []
        joints = zip(velocities, self.angles, self.speeds, self._bounds, strict=True)
        for velocity, last_angle, last_speed, (low, high, max_speed, max_acceleration) in joints:
            change = max_acceleration * interval
            # The intervals overlap up to rounding; the last one applied takes precedence.
            lowest = -_stoppable_speed(last_angle - low, max_acceleration, step)
            allowed = min(max(velocity, lowest), _stoppable_speed(high - last_angle, max_acceleration, step))
            allowed = min(max(allowed, last_speed - change), last_speed + change)
            allowed = min(max(allowed, -max_speed), max_speed)
            angles.append(min(max(last_angle + allowed * step, low), high))
        self.send(angles, step)


def _stoppable_speed(distance: float, acceleration: float, step: float) -> float:
    """Return the greatest speed of a step from which a joint can still stop within a distance, this step included."""
    half = acceleration * step / 2
    # Either the step alone uses the distance, or the step and the braking distance after it do.
    return distance / step if distance <= half * step else math.sqrt(2 * acceleration * distance) - half
