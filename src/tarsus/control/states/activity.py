"""What a robot controller does at a time: walk, play a motion sequence, or rest on the belly."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self, TypeAlias

import numpy as np

from tarsus.arrays import read_only
from tarsus.control.command import Command
from tarsus.control.control_output import Snapshot
from tarsus.control.limitation import Limitation
from tarsus.control.readings import SensorReadings, ValidReadings
from tarsus.control.robot_state import RobotState
from tarsus.control.sensing.validation import ReadingsValidator, rejections
from tarsus.control.sequence import MotionSequence, SequencePlayer, SequenceSample
from tarsus.control.startup import fold, sit_down
from tarsus.control.walk_controller import WalkController
from tarsus.control.walk_state import WalkState
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["Activity", "Braking", "Playing", "Resting", "Walking", "way_back"]

# Fraction of the joints' acceleration with which they lose the speed that they have.
_SHARE = 0.8


class Walking:
    """Standing and walking, by a walk controller.

    Parameters
    ----------
    controller : WalkController
        The walk controller.

    Attributes
    ----------
    measured : ValidReadings
        The readings of the last tick.
    """

    def __init__(self, controller: WalkController) -> None:
        self.controller, self.measured = controller, ValidReadings()
        self._validator = ReadingsValidator(controller.robot)
        # What is rejected of readings that the controller does not get: of the others, it tells itself.
        self._rejected: list[Limitation] = []

    def step(self, command: Command, dt: float, readings: SensorReadings | None) -> None:
        """Advance by one tick."""
        felt = readings if getattr(readings, "has_ground_feedback", False) else None
        self.controller.step(command, dt, readings=felt)
        self.measured = self._validator.validate(readings, dt) if felt is None else self.controller.measured
        self._rejected = rejections(self.measured) if felt is None else []

    def joints_held(self) -> None:
        """Take note that the joints have been held where they are: they go on from rest."""
        self.controller.joints_held()

    @property
    def gait(self) -> Gait:
        """The order of the steps of all legs."""
        return self.controller.gait

    @property
    def stands(self) -> bool:
        """Whether the robot stands, every foot on the ground and no step under way."""
        return self.controller.walk_state is WalkState.STANDING

    @property
    def bears(self) -> Bool[np.ndarray, "legs"] | None:
        """Which feet bear load: array of bool, shape (legs,); None where the ground is not felt."""
        return self.controller.bears if self.controller.feels_ground else None

    @property
    def snapshot(self) -> Snapshot:
        """The robot now."""
        walk = self.controller
        vx, vy, wz = walk.twist.tolist()
        return Snapshot(
            walk.angles,
            walk.body,
            walk.feet,
            walk.contacts,
            belly=False,
            state=RobotState.STANDING if self.stands else RobotState.WALKING,
            activity=walk.walk_state.value,
            twist=(vx, vy, wz),
            limitations=(*walk.limitations, *self._rejected),
            felt=walk.feels_ground,
        )


class Braking:
    """Joints that lose the speed that they have at constant deceleration, before their limits.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles, speeds : array, shape (legs, 3)
        Joint angles [rad] and speeds [rad/s] at the start.
    acceleration : array
        Greatest accelerations of the joints, of which the least counts [rad/s^2].

    Attributes
    ----------
    duration : float
        Time until all joints are at rest [s].
    """

    def __init__(
        self, robot: Robot, angles: Float[np.ndarray, "legs 3"], speeds: Float[np.ndarray, "legs 3"], acceleration: Any
    ) -> None:
        self._angles, self._speeds = angles, speeds
        low, high = np.moveaxis(np.asarray(robot.limits), -1, 0)
        room = np.where(speeds > 0, high - angles, angles - low).clip(0.0)
        stopping = np.abs(speeds) / (_SHARE * float(np.min(acceleration)))
        self._stopping = np.minimum(stopping, 2 * room / np.abs(speeds).clip(1e-9)).clip(1e-9)
        self.duration = float(self._stopping.max())

    def at(self, time: float) -> Float[np.ndarray, "legs 3"]:
        """Return the joint angles at a time after the start [rad]: array, shape (legs, 3), read-only."""
        share = np.minimum(time / self._stopping, 1.0)
        return read_only(self._angles + self._speeds * self._stopping * share * (1 - share / 2))


class Playing:
    """Rising, sitting down or folding, by a planned motion sequence; can return to its start.

    Parameters
    ----------
    sequence, state : MotionSequence, RobotState
        What is played; what the robot does meanwhile.
    before, base : Activity, Pose or None
        What it did before, and does again where the sequence is played back to its start; the pose of that activity's
        ground frame.
    braking : Braking or None
        How the joints come to rest at the start of the sequence where it begins in the middle of a motion. It does not
        return there.
    """

    def __init__(
        self,
        sequence: MotionSequence,
        state: RobotState,
        *,
        before: Activity,
        base: Pose | None,
        braking: Braking | None,
    ) -> None:
        self.sequence, self.state, self.end, self.before, self.base = sequence, state, state.end, before, base
        self._player, self._felt = SequencePlayer(sequence), before.snapshot.felt
        self.braking, self._time = braking, 0.0
        self.returning = False

    def turn(self, *, back: bool) -> None:
        """Continue to the end, or return to the start; the joints' accelerations stay within their limits."""
        self.returning = back
        (self._player.reverse if back else self._player.resume)()

    def leads_to(self, goal: RobotState) -> bool:
        """Return whether the end of the sequence is on the way to a state that is wanted."""
        # There is no way back into the middle of a motion.
        return self.braking is not None or self.end is goal or (self.end, goal) == (RobotState.LYING, RobotState.FOLDED)

    @property
    def done(self) -> bool:
        """Whether the sequence is at its end, or back at its start where it returns."""
        return self._player.done

    def step(self, command: Command, dt: float, readings: SensorReadings | None) -> None:  # noqa: ARG002 - as of all activities
        """Advance by one tick."""
        if self._brakes is None:
            self._player.step(dt)
        else:
            self._time += dt

    def joints_held(self) -> None:
        """Take note that the joints have been held where they are: they go on from rest."""
        self._player.joints_held()

    @property
    def _brakes(self) -> Braking | None:
        """How the joints brake now; None once they are at rest."""
        return self.braking if self.braking is not None and self._time < self.braking.duration else None

    @property
    def snapshot(self) -> Snapshot:
        """The robot now."""
        now, braking = self._player.now, self._brakes
        angles = now.angles if braking is None else braking.at(self._time)
        # The feet slide as the joints brake.
        felt = self._felt or braking is not None
        return Snapshot(angles, now.body, None, now.contacts, now.belly, self.state, now.stage, felt=felt)


class Resting:
    """Lying on the belly.

    Parameters
    ----------
    sample, state : SequenceSample, RobotState
        How the robot lies; lying or folded.
    after : Playing, optional
        The sequence that has brought it there.

    Attributes
    ----------
    snapshot : Snapshot
        The robot, which does not move.
    after : Playing or None
        The sequence that has brought it there.
    """

    def __init__(self, sample: SequenceSample, state: RobotState, *, after: Playing | None = None) -> None:
        self.snapshot = Snapshot(
            sample.angles, sample.body, None, sample.contacts, belly=True, state=state, activity=str(state)
        )
        self.after = after

    @classmethod
    def after_sitting(cls, robot: Robot, stance: Float[np.ndarray, "legs 3"], state: RobotState) -> Self:
        """Return how a robot lies that has sat down from a stance, and folded its legs where that is the state.

        Parameters
        ----------
        robot : Robot
            A single robot.
        stance : array, shape (legs, 3)
            Joint angles of the stance [rad].
        state : RobotState
            Lying or folded.
        """
        sequence = sit_down(robot, stance)
        if state is RobotState.FOLDED:
            sequence = fold(robot, sequence.angles_end)
        return cls(sequence.at(sequence.duration), state)

    @classmethod
    def measured(cls, robot: Robot, angles: Any) -> Self:
        """Return how a robot lies with measured joint angles.

        Parameters
        ----------
        robot : Robot
            A single robot.
        angles : array, shape (legs, 3)
            Joint angles [rad].

        Raises
        ------
        InputError
            If they are not finite, or not one for each joint.
        """
        found = read_only(np.array(angles, dtype=float))
        if found.shape != (robot.legs, 3) or not np.isfinite(found).all():
            raise InputError(f"angles must be {robot.legs} x 3 finite numbers [rad]")
        contacts = np.zeros(robot.legs, dtype=bool)
        sample = SequenceSample(found, contacts, resting_pose(robot, found).body, str(RobotState.LYING), belly=True)
        return cls(sample, RobotState.LYING)

    def step(self, command: Command, dt: float, readings: SensorReadings | None) -> None:
        """Do nothing."""


Activity: TypeAlias = Walking | Playing | Resting
"""What moves all joints, tick by tick."""


def way_back(activity: Activity, change: RobotState) -> Activity:
    """Return what takes the place of a change that can't be planned: the same activity where there is no such way.

    A robot that has sat down from a stance stands up by playing that back: the feet are where they stood.

    Parameters
    ----------
    activity, change : Activity, RobotState
        What the robot does; the change, like rising.
    """
    down = activity.after if isinstance(activity, Resting) and change is RobotState.RISING else None
    if down is None or down.braking is not None or type(down.before) is not Walking:
        return activity
    down.state = RobotState.RISING
    down.turn(back=True)
    return down
