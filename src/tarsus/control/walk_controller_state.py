"""What there is to see of a live walker."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tarsus.control.terrain.adaptation import TerrainAdaptation
from tarsus.control.transition.foothold_transfer import FootholdTransfer
from tarsus.control.transition.scheduler import TransitionScheduler
from tarsus.control.walk.foot_targets import FootTargets
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.time_scaling import TimeScaling
from tarsus.control.walk_state import WalkState
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT, StanceGeometry, stance_geometry_of, with_sway
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stability import stability_margin
from tarsus.robot.robot import Robot

__all__ = ["WalkControllerState"]

Floats = np.ndarray[Any, Any]


class WalkControllerState:
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
    _now: GaitState
    _time_scaling: TimeScaling
    _scheduler: TransitionScheduler
    _footholds: FootholdTransfer
    _target: Floats
    _frequency: float
    _walking: bool
    _beats: int
    _foot_targets: FootTargets
    _terrain: TerrainAdaptation

    def _stand(self, now: GaitState) -> StanceGeometry:
        return stance_geometry_of(with_sway(now.posture.value, now.cycles, now.beats), self._footholds.rest)

    @property
    def walk_state(self) -> WalkState:
        """What it does: standing, walking, stopping, or searching for ground."""
        if self._terrain.searches:
            return WalkState.SEARCHING
        if not self._walking:
            return WalkState.STANDING
        return WalkState.WALKING if self._target.any() else WalkState.STOPPING

    @property
    def gait(self) -> Gait:
        """Order of the steps."""
        return self._scheduler.doing.parameters.gait

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
        height = now.height(float(now.posture.value[SWING_HEIGHT])) + now.admittance_offset.value
        return np.stack([now.foot.real, now.foot.imag, height], axis=-1)

    @property
    def contacts(self) -> Floats:
        """Which feet are on the ground ``(legs,)``."""
        down = self._now.down.copy()
        down[self._foot_targets.legs] = False
        return down

    @property
    def angles(self) -> Floats:
        """The joint angles ``(legs, 3)`` [rad]."""
        return self._time_scaling.angles

    @property
    def twist(self) -> Floats:
        """The speed now: forward, left [m/s], turning [rad/s]."""
        return self._now.twist.value * self._time_scaling.rate

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
        doing = self._scheduler.doing
        duty_factor = self.gait.duty_factor
        stance_time = duty_factor * doing.cycle_timing.cycle_time
        share, _ = doing.there.feasible_fraction(
            way, stance_time=stance_time, duty_factor=duty_factor, hold=self._terrain.hold_time
        )
        return share
