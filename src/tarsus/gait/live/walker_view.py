"""What there is to see of a live walker."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.gait.live.agenda import Agenda
from tarsus.gait.live.footing import Footing
from tarsus.gait.live.manipulation import Manipulation
from tarsus.gait.live.moment import Moment
from tarsus.gait.live.own_time import OwnTime
from tarsus.gait.live.posture import LIFT, stand_of, swayed
from tarsus.gait.live.stand import Stand
from tarsus.gait.live.underfoot import Underfoot
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stability import stability_margin
from tarsus.robot.robot import Robot

__all__ = ["WalkerView"]

Floats = np.ndarray[Any, Any]


class WalkerView:
    """The state of a walker, as others may read it.

    Attributes
    ----------
    robot : Robot
        Who walks.
    time : float
        How long it has been walked [s].
    """

    robot: Robot
    time: float
    _now: Moment
    _own: OwnTime
    _agenda: Agenda
    _footing: Footing
    _target: Floats
    _frequency: float
    _walking: bool
    _beats: int
    _hands: Manipulation
    _underfoot: Underfoot

    def _stand(self, now: Moment) -> Stand:
        return stand_of(swayed(now.posture.value, now.cycles, now.beats), self._footing.rest)

    @property
    def mode(self) -> str:
        """``"standing"``, ``"walking"``; ``"stopping"``, on the way to standing; ``"searching"`` for ground."""
        if self._underfoot.searches:
            return "searching"
        if not self._walking:
            return "standing"
        return "walking" if self._target.any() else "stopping"

    @property
    def gait(self) -> Gait:
        """Order of the steps."""
        return self._agenda.doing.manner.gait

    @property
    def cycle_time(self) -> float:
        """Duration of a cycle [s]."""
        return 1 / self._frequency

    @property
    def place(self) -> tuple[float, float, float]:
        """Where the heading frame is in G: x, y [m], yaw [rad]."""
        return self._now.origin.real, self._now.origin.imag, self._now.yaw

    @property
    def body(self) -> Pose:
        """The body's pose in G."""
        now, stand = self._now, self._stand(self._now)
        heading = Pose.from_rpy(0.0, 0.0, now.yaw, (now.origin.real, now.origin.imag, float(now.elevation.value[0])))
        return heading @ Pose(stand.rotation, stand.position)

    @property
    def feet(self) -> Floats:
        """The feet in G ``(legs, 3)`` [m]."""
        now = self._now
        height = now.height(float(now.posture.value[LIFT])) + now.give_way.value
        return np.stack([now.foot.real, now.foot.imag, height], axis=-1)

    @property
    def contacts(self) -> Floats:
        """Which feet are on the ground ``(legs,)``."""
        down = self._now.down.copy()
        down[self._hands.legs] = False
        return down

    @property
    def angles(self) -> Floats:
        """The joint angles ``(legs, 3)`` [rad]."""
        return self._own.angles

    @property
    def twist(self) -> Floats:
        """The speed now: forward, left [m/s], turning [rad/s]."""
        return self._now.twist.value * self._own.rate

    @property
    def margin(self) -> float:
        """Static stability margin [m]."""
        return float(stability_margin(self.robot, self.angles, self.body, self.contacts))

    def top_speed(self, direction: Sequence[float]) -> float:
        """Return the largest multiple of a twist that the robot can walk at for good.

        Parameters
        ----------
        direction : (vx, vy, wz)
            The twist [m/s, m/s, rad/s].

        Raises
        ------
        InputError
            If it is not three finite numbers, or all are 0.
        """
        try:
            way = np.array([float(speed) for speed in direction])
        except (TypeError, ValueError):
            way = np.zeros(0)
        if way.shape != (3,) or not np.isfinite(way).all() or not way.any():
            raise InputError(f"direction is {direction!r}; it must be three finite numbers, not all 0: vx, vy, wz")
        doing = self._agenda.doing
        duty = self.gait.duty
        stance_time = duty * doing.tempo.cycle_time
        share, _ = doing.there.largest_share(way, stance_time=stance_time, duty=duty, hold=self._underfoot.hold)
        return share
