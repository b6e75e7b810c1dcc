"""Motion sequences: stages from rest to rest, one after the other."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.sequence.stage import Stage
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.walk_setup import require_number
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose, stack_poses
from tarsus.representation import represented
from tarsus.robot.joint_limits import JointLimits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["MotionSequence", "SequenceSample"]


class SequenceSample(NamedTuple):
    """State of a motion sequence at one time.

    Attributes
    ----------
    angles : array, shape (legs, 3)
        Joint angles [rad].
    contacts : array of bool, shape (legs,)
        Stationary feet on the ground.
    body : Pose
        Pose of B in G.
    stage : str
        Name of the stage.
    belly : bool
        Whether the body lies on the ground.
    """

    angles: Float[np.ndarray, "legs 3"]
    contacts: Bool[np.ndarray, "legs"]
    body: Pose
    stage: str
    belly: bool


@represented()
@dataclass(frozen=True, eq=False, kw_only=True)
class MotionSequence:
    """Named stages one after the other, each from rest to rest: standing up, sitting down, folding.

    Attributes
    ----------
    robot : Robot
        A single robot.
    stages : tuple of Stage
        At least one stage; each starts where the one before it ends.
    joint_limits : JointLimits
        Joint speeds and accelerations that are not exceeded.
    """

    robot: Robot
    stages: tuple[Stage, ...]
    joint_limits: JointLimits

    @cached_property
    def starts(self) -> tuple[float, ...]:
        """Start time of each stage, and the end time of the last one [s]."""
        return (0.0, *np.cumsum([stage.duration for stage in self.stages]).tolist())

    @property
    def duration(self) -> float:
        """Duration [s]."""
        return self.starts[-1]

    @property
    def angles_end(self) -> Float[np.ndarray, "legs 3"]:
        """Joint angles at the end, shape (legs, 3) [rad]."""
        return self.stages[-1].angles_end

    def stage_at(self, time: float) -> tuple[Stage, float]:
        """Return the stage at a time [s], clamped to the sequence, and the elapsed fraction of its duration."""
        index = min(max(int(np.searchsorted(self.starts, time, side="right")) - 1, 0), len(self.stages) - 1)
        stage = self.stages[index]
        elapsed = (time - self.starts[index]) / stage.duration if stage.duration else 1.0
        return stage, min(max(elapsed, 0.0), 1.0)

    def at(self, time: float) -> SequenceSample:
        """Return the sample at a time.

        Parameters
        ----------
        time : float
            Time since the start, clamped to the sequence [s].

        Raises
        ------
        InputError
            If the time is not finite.
        """
        if not math.isfinite(time):
            raise InputError(f"time is {time} s; it must be a finite number")
        stage, elapsed = self.stage_at(time)
        if time >= self.duration:
            return SequenceSample(stage.angles_end, stage.contacts_end, stage.end, stage.name, stage.belly)
        if elapsed == 0:
            return SequenceSample(stage.angles, stage.contacts, stage.start, stage.name, stage.belly)
        fractions = np.array([elapsed])
        angles, body = stage.angles_at(fractions)[0], stage.body_at(fractions)[0]
        return SequenceSample(angles, stage.contacts, body, stage.name, stage.belly)

    def to_motion(self, *, rate: float = 100.0, standing: bool = False) -> Motion:
        """Return the sequence as a sampled motion, to plot it, to store it, or to compute its joint loads.

        Parameters
        ----------
        rate : float
            Samples per second [1/s].
        standing : bool
            Whether to include only the time from the first to the last stage in which the body is off the ground.
            While the body lies on the ground, contact forces and stability margins are undefined.

        Raises
        ------
        InputError
            If the rate is not finite or not greater than 0, or `standing` is set and the body is never off the ground.
        """
        rate = require_number("rate", rate, zero=False)
        stages = [index for index, stage in enumerate(self.stages) if not (standing and stage.belly)]
        if not stages:
            raise InputError("the body lies on the ground in every stage; a motion with standing=True would be empty")
        first, last = self.starts[stages[0]], self.starts[stages[-1] + 1]
        time = np.arange(max(math.ceil((last - first) * rate - 1e-9), 1) + 1) / rate
        samples = [self.at(min(first + t, last)) for t in time.tolist()]
        angles = np.array([sample.angles for sample in samples])
        body = stack_poses([sample.body for sample in samples])
        return Motion(
            robot=self.robot,
            gait=Gait(duty_factor=0.5, offsets=(0.0,) * self.robot.legs, name="none"),
            time=time,
            body=body,
            feet=body @ forward_kinematics(self.robot, angles)[..., 3, :],
            contacts=np.array([sample.contacts for sample in samples]),
            angles=angles,
            reach=np.zeros((time.size, self.robot.legs), dtype=np.int8),
            cycle_time=float(time[-1]),
            stroke=0.0,
            speed=0.0,
            body_height=float(self.stages[-1].end.position[2]),
            swing_height=max(stage.swing_height for stage in self.stages),
            foot_distance=0.0,
        )
