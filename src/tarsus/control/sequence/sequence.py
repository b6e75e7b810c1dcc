"""A sequence of stages: what the joints, the feet and the body do from one rest to another."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tarsus.control.sequence.joint_rates import JointRates
from tarsus.control.sequence.stage import Stage
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.setup import require_number
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

__all__ = ["MotionSequence", "SequenceSample"]

Floats = np.ndarray[Any, np.dtype[np.float64]]


class SequenceSample(NamedTuple):
    """What a sequence has at one moment.

    Joint angles ``(legs, 3)`` [rad], which feet are on the ground ``(legs,)`` and stay where they are, the body's
    pose in G, the name of the stage, and whether the body itself rests on the ground. Also read for many moments,
    with one more leading axis.
    """

    angles: Floats
    contacts: np.ndarray[Any, np.dtype[np.bool_]]
    body: Pose
    stage: str
    belly: bool


@dataclass(frozen=True, eq=False, kw_only=True)
class MotionSequence:
    """Named stages, one after the other, each from rest to rest: getting up, sitting down, folding.

    Attributes
    ----------
    robot : Robot
        A single robot.
    stages : tuple of Stage
        At least one; each starts where the one before ends.
    pace : JointRates
        The speeds and accelerations that no joint exceeds.
    """

    robot: Robot
    stages: tuple[Stage, ...]
    pace: JointRates

    @cached_property
    def starts(self) -> tuple[float, ...]:
        """When each stage starts, and when the last one ends [s]."""
        return (0.0, *np.cumsum([stage.duration for stage in self.stages]).tolist())

    @property
    def duration(self) -> float:
        """How long it takes [s]."""
        return self.starts[-1]

    @property
    def angles_end(self) -> Floats:
        """The joint angles that it ends in ``(legs, 3)`` [rad]."""
        return self.stages[-1].angles_end

    def stage_at(self, time: float) -> tuple[Stage, float]:
        """Return the stage at a moment, and the share of its time that is gone.

        Parameters
        ----------
        time : float
            Since the start [s]; what is before the start or after the end counts as there.
        """
        index = min(int(np.searchsorted(self.starts, time, side="right")) - 1, len(self.stages) - 1)
        stage = self.stages[max(index, 0)]
        excluded = (time - self.starts[max(index, 0)]) / stage.duration if stage.duration else 1.0
        return stage, min(max(excluded, 0.0), 1.0)

    def at(self, time: float) -> SequenceSample:
        """Return what the robot does at a moment.

        Parameters
        ----------
        time : float
            Since the start [s]; what is before the start or after the end counts as there.

        Raises
        ------
        InputError
            If it is not a finite number.
        """
        if not math.isfinite(time):
            raise InputError(f"time is {time}; it must be a finite number of seconds")
        stage, share = self.stage_at(time)
        if time >= self.duration:
            return SequenceSample(stage.angles_end, stage.contacts_end, stage.end, stage.name, stage.belly)
        if share == 0:
            return SequenceSample(stage.angles, stage.contacts, stage.start, stage.name, stage.belly)
        shares = np.array([share])
        return SequenceSample(
            stage.angles_at(shares)[0], stage.contacts, stage.body_at(shares)[0], stage.name, stage.belly
        )

    def to_motion(self, *, rate: float = 100.0, standing: bool = False) -> Motion:
        """Return the sequence sampled in time, as walks are: to plot it, to store it, to work out its loads.

        Parameters
        ----------
        rate : float
            Samples per second [1/s].
        standing : bool
            Whether to leave out the time before and after, in which the body rests on the ground: with the belly
            down the feet bear nothing that could be told, so that loads and margins mean something for the rest only.

        Raises
        ------
        InputError
            If the rate is not finite and greater than 0; or if the body never stands, and that is asked for.
        """
        rate = require_number("rate", rate, zero=False)
        first, last = self._standing() if standing else (0.0, self.duration)
        time = np.arange(max(math.ceil((last - first) * rate - 1e-9), 1) + 1) / rate
        moments = [self.at(min(first + t, last)) for t in time.tolist()]
        angles = np.array([moment.angles for moment in moments])
        body = Pose(*(np.array([getattr(m.body, name) for m in moments]) for name in ("rotation", "position")))
        return Motion(
            robot=self.robot,
            gait=Gait(duty_factor=0.5, offsets=(0.0,) * self.robot.legs, name="none"),
            time=time,
            body=body,
            feet=body @ forward_kinematics(self.robot, angles)[..., 3, :],
            contacts=np.array([moment.contacts for moment in moments]),
            angles=angles,
            reach=np.zeros((time.size, self.robot.legs), dtype=np.int8),
            cycle_time=float(time[-1]),
            stroke=0.0,
            speed=0.0,
            body_height=float(self.stages[-1].end.position[2]),
            swing_height=max(stage.swing_height for stage in self.stages),
            foot_distance=0.0,
        )

    def _standing(self) -> tuple[float, float]:
        """Return when the body first leaves the ground, and when it is last off it."""
        off = [i for i, stage in enumerate(self.stages) if not stage.belly]
        if not off:
            raise InputError("the body rests on the ground all the time; there is no part in which it stands")
        return self.starts[off[0]], self.starts[off[-1] + 1]
