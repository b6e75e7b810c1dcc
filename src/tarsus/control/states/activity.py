"""Activities of a robot controller, one at a time: walking, playing a motion sequence, resting on the belly."""

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

# Fraction of the greatest joint acceleration with which joints brake.
_SHARE = 0.8


class Walking:
    """Standing and walking, with the angles of a walk controller.

    Parameters
    ----------
    controller : WalkController
        The walk controller.

    Attributes
    ----------
    measured : ValidReadings
        The part of the readings of the last tick that passed validation.
    """

    def __init__(self, controller: WalkController) -> None:
        self.controller, self.measured = controller, ValidReadings()
        self._validator = ReadingsValidator(controller.robot)
        # Rejections of readings that the controller does not get; it reports those of the others itself.
        self._rejected: list[Limitation] = []

    def step(self, command: Command, dt: float, readings: SensorReadings | None) -> None:
        """Advance by one tick."""
        felt = readings if getattr(readings, "has_ground_feedback", False) else None
        self.controller.step(command, dt, readings=felt)
        self.measured = self._validator.validate(readings, dt) if felt is None else self.controller.measured
        self._rejected = rejections(self.measured) if felt is None else []

    def joints_held(self) -> None:
        """Note that the joints have been held in place: they continue from rest."""
        self.controller.joints_held()

    @property
    def gait(self) -> Gait:
        """Order of the steps of all legs."""
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
        """The present state of the robot."""
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
    """Joints that brake from their present speeds at constant deceleration, and stop within their limits.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles, speeds : array, shape (legs, 3)
        Joint angles [rad] and speeds [rad/s] at the start.
    acceleration : array
        Greatest accelerations of the joints; all brake with a share of the least, harder only near a limit [rad/s^2].

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
    """Rising, sitting down or folding, by playing a planned motion sequence, forward or back to its start.

    Parameters
    ----------
    sequence, state : MotionSequence, RobotState
        The sequence; the state of the robot while it is played.
    before, base : Activity, Pose or None
        The activity before, which continues once the sequence has been played back to its start; the pose of that
        activity's ground frame.
    braking : Braking or None
        How the joints come to rest before the sequence where it is begun during a motion. Such a sequence is not played
        back.
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
        """Return whether the sequence is to be played to its end for a wanted state."""
        # A sequence begun during a motion can't return into that motion.
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
        """Note that the joints have been held in place: they continue from rest."""
        self._player.joints_held()

    @property
    def _brakes(self) -> Braking | None:
        """How the joints brake before the sequence; None once they are at rest."""
        return self.braking if self.braking is not None and self._time < self.braking.duration else None

    @property
    def snapshot(self) -> Snapshot:
        """The present state of the robot."""
        now, braking = self._player.now, self._brakes
        angles = now.angles if braking is None else braking.at(self._time)
        # The feet slide while the joints brake.
        felt = self._felt or braking is not None
        return Snapshot(angles, now.body, None, now.contacts, now.belly, self.state, now.stage, felt=felt)


class Resting:
    """Lying on the belly.

    Parameters
    ----------
    sample, state : SequenceSample, RobotState
        Pose of the robot; LYING or FOLDED.
    after : Playing, optional
        The sequence that has brought the robot there.

    Attributes
    ----------
    snapshot : Snapshot
        The state of the robot, which does not move.
    after : Playing or None
        The sequence that has brought the robot there; None if it started there.
    """

    def __init__(self, sample: SequenceSample, state: RobotState, *, after: Playing | None = None) -> None:
        self.snapshot = Snapshot(
            sample.angles, sample.body, None, sample.contacts, belly=True, state=state, activity=str(state)
        )
        self.after = after

    @classmethod
    def after_sitting(cls, robot: Robot, stance: Float[np.ndarray, "legs 3"], state: RobotState) -> Self:
        """Return the activity of a robot that has sat down from a stance and, for the state FOLDED, folded its legs.

        Parameters
        ----------
        robot : Robot
            A single robot.
        stance : array, shape (legs, 3)
            Joint angles of the stance [rad].
        state : RobotState
            LYING or FOLDED.
        """
        sequence = sit_down(robot, stance)
        if state is RobotState.FOLDED:
            sequence = fold(robot, sequence.angles_end)
        return cls(sequence.at(sequence.duration), state)

    @classmethod
    def measured(cls, robot: Robot, angles: Any) -> Self:
        """Return the activity of a robot that lies with measured joint angles.

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
        """Do nothing: the robot does not move."""


Activity: TypeAlias = Walking | Playing | Resting
"""What moves all joints, tick by tick; a robot controller has one activity at a time."""


def way_back(activity: Activity, change: RobotState) -> Activity:
    """Return the activity to go on with where a change of state can't be planned; the same one if there is no other.

    A robot that has sat down from a stance stands up by playing that sequence back: its feet are where they stood.

    Parameters
    ----------
    activity, change : Activity, RobotState
        The present activity; the change, such as RISING.
    """
    down = activity.after if isinstance(activity, Resting) and change is RobotState.RISING else None
    if down is None or down.braking is not None or not isinstance(down.before, Walking):
        return activity
    down.state = RobotState.RISING
    down.turn(back=True)
    return down
