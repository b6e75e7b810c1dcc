"""Walking without failed legs: the robot with the remaining legs, its gait, and the motion to its stance."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from tarsus.arrays import read_only
from tarsus.control.command import Command
from tarsus.control.control_output import Snapshot
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.readings import CHANNELS, SensorReadings, Vector
from tarsus.control.sensing.plain_values import as_items, as_vector
from tarsus.control.sensing.servo_monitor import ServoMonitor
from tarsus.control.states.activity import Braking, Walking
from tarsus.control.walk_controller import WalkController
from tarsus.errors import TarsusError
from tarsus.gait.gait import Gait
from tarsus.gait.stance.support_stance import support_stance
from tarsus.gait.swing import horizontal_profile
from tarsus.incremental import complete
from tarsus.load.servo_limits import at_supply
from tarsus.robot.remaining import remaining_robot, turned_robot
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["LegFailures", "ReducedWalking"]

_T = TypeVar("_T")

_SITS = "the robot sits down: it can't walk without"
_CAUSE = "the joint has failed: the robot walks on without this leg"
# Pose in which a failed leg is held up: angle of the femur, and distance of the tibia from its lower limit [rad].
_FEMUR_UP, _FROM_LIMIT = 1.0, 0.1
# Motion of the legs to their new stance: fraction of the greatest joint speed that it uses, and its least time [s].
_SPEED_SHARE, _LEAST_TIME = 0.15, 1.0


class ReducedWalking(Walking):
    """Standing and walking on the remaining legs, which are turned towards the places of the failed ones.

    The gait is ripple or wave, whichever is faster; where neither keeps the robot stable, one leg is in the air at a
    time, with a body shift.

    Parameters
    ----------
    robot : Robot
        The robot with all of its legs.
    failed, now : mapping of int to int, Snapshot
        Failed legs, with the failed joint of each; the present state of the robot.
    speeds : array, shape (legs, 3)
        Present joint speeds [rad/s].
    slope : complex
        Rise of the ground along x and y of the body, on which that is kept as it is [m/m]; 0 where none is felt.
    options
        As for `WalkController`.

    Attributes
    ----------
    failed : dict of int to int
        Failed legs, with the failed joint of each.

    Raises
    ------
    TarsusError
        If fewer than four legs are left, or these can't support the robot.
    """

    def __init__(
        self,
        robot: Robot,
        failed: Mapping[int, int],
        now: Snapshot,
        speeds: Float[np.ndarray, "legs 3"],
        slope: complex = 0j,
        **options: Any,
    ) -> None:
        self.failed = dict(failed)
        self._robot, self._legs = robot, [leg for leg in range(robot.legs) if leg not in failed]
        rest = remaining_robot(robot, self._legs)
        super().__init__(_fastest_walk(rest, **options))
        if slope:
            self.controller.begin_on(slope)
        # Joint angles of the remaining legs where those of the walk controller, with its turned legs, are 0 [rad].
        self._zero = np.zeros((len(self._legs), 3))
        self._zero[:, 0] = np.asarray(self.controller.robot.mount_yaw) - np.asarray(rest.mount_yaw)
        offsets = np.zeros(robot.legs)
        offsets[self._legs] = self.controller.gait.offsets
        self._gait = dataclasses.replace(self.controller.gait, offsets=tuple(offsets.tolist()))
        self._dropped = list[Limitation]()
        self._left_out = tuple(
            Limitation(kind=LimitationKind.GAIT, cause=_CAUSE, leg=robot.leg_names[leg], joint=JOINTS[joint])
            for leg, joint in failed.items()
        )
        self._braking = Braking(robot, now.angles, speeds, self.controller.joint_acceleration)
        self._end = np.array(now.angles)
        for leg in failed:
            low, high = np.asarray(robot.limits)[leg].T
            self._end[leg] = np.clip(0.0, low[0], high[0]), min(_FEMUR_UP, high[1]), low[2] + _FROM_LIMIT
        self._end[self._legs] = self.controller.angles + self._zero
        speed = _SPEED_SHARE * float(self.controller.joint_speed.min())
        self._duration = max(float(np.abs(self._end - now.angles).max()) / speed, _LEAST_TIME)
        self._time = 0.0

    def step(self, command: Command, dt: float, readings: SensorReadings | None) -> None:
        """Advance by one tick; until the legs are in their new stance, commands and readings are ignored."""
        points = {**(command.foot_targets or {}), **(command.foot_velocities or {})}
        not_met: dict[str, Any] = {"kind": LimitationKind.FOOT_TARGET, "asked": 1.0, "granted": 0.0}
        failed = zip(self.failed, self._left_out, strict=True)
        self._dropped = [dataclasses.replace(why, **not_met) for leg, why in failed if points.get(leg) is not None]
        if self._time < self._duration:
            self._time += dt
            return
        legs = {leg: index for index, leg in enumerate(self._legs)}
        targets = {legs[leg]: point for leg, point in (command.foot_targets or {}).items() if leg in legs} or None
        velocities = {legs[leg]: each for leg, each in (command.foot_velocities or {}).items() if leg in legs} or None
        command = dataclasses.replace(command, gait=None, foot_targets=targets, foot_velocities=velocities)
        super().step(command, dt, None if readings is None else self._of_legs(readings))
        valid = self.measured
        angles = valid.joint_angles and _turned(valid.joint_angles, self._zero[:, 0])
        torques, contacts = self._of_all(valid.torques), self._of_all(valid.contacts)
        self.measured = valid._replace(joint_angles=self._of_all(angles), torques=torques, contacts=contacts)

    @property
    def gait(self) -> Gait:
        """Order of the steps of the remaining legs; the failed ones are given the offset 0."""
        return self._gait

    @property
    def stands(self) -> bool:
        """Whether the robot stands, every remaining foot on the ground and no step under way."""
        return self._time >= self._duration and super().stands

    @property
    def snapshot(self) -> Snapshot:
        """The present state of the robot."""
        now = super().snapshot
        share, contacts = min(self._time / self._duration, 1.0), np.zeros(self._robot.legs, dtype=bool)
        start = self._braking.at(self._time)
        angles = start + horizontal_profile(share) * (self._end - start)
        contacts[self._legs] = now.contacts
        if share >= 1:
            angles[self._legs] = now.angles + self._zero
        return now._replace(
            angles=read_only(angles),
            feet=None,
            contacts=contacts,
            limitations=(*self._left_out, *self._dropped, *now.limitations),
            # The feet slide on the way to their new stance.
            felt=now.felt or share < 1,
        )

    def _of_all(self, measured: tuple[_T | None, ...] | None) -> tuple[_T | None, ...] | None:
        """Return the values of the remaining legs as values of all legs, None for the failed ones."""
        found = dict(zip(self._legs, measured or (), strict=False))
        return None if measured is None else tuple(found.get(leg) for leg in range(self._robot.legs))

    def _of_legs(self, readings: SensorReadings) -> SensorReadings:
        """Return the readings of the remaining legs, with coxa angles as the walk controller counts them."""
        values = self._left({name: getattr(readings, name) for name in CHANNELS})
        if "joint_angles" in values:
            values["joint_angles"] = _turned(map(as_vector, values["joint_angles"]), -self._zero[:, 0])
        ages = dict(readings.age) | self._left(readings.age) if isinstance(readings.age, dict) else readings.age
        return dataclasses.replace(readings, **values, age=ages)

    def _left(self, values: dict[str, Any]) -> dict[str, Any]:
        """Return the items of the remaining legs, from those values that have an item for each leg."""
        legs = self._robot.legs
        items = {name: as_items(value, (legs, 3), (legs,)) for name, value in values.items()}
        return {name: [each[leg] for leg in self._legs] for name, each in items.items() if each is not None}


def _turned(legs: Iterable[Vector | None], coxae: Float[np.ndarray, "legs"]) -> tuple[Vector | None, ...]:
    """Return joint angles with an angle added to that of each coxa; None for legs without a measurement."""
    pairs = zip(legs, coxae.tolist(), strict=True)
    return tuple(angles and (angles[0] + coxa, *angles[1:]) for angles, coxa in pairs)


def _fastest_walk(robot: Robot, **options: Any) -> WalkController:
    """Return a walk in the faster of ripple and wave, each in its best-supported stance, or else with a body shift."""
    heights = {name: options.get(name) for name in ("body_height", "swing_height")}

    def walk(gait: Gait) -> WalkController:
        turned = turned_robot(robot, complete(support_stance(robot, gait, **heights)))
        return WalkController(turned, gait, **options)

    walks, legs = [], robot.legs
    for name in ("ripple", "wave"):
        with suppress(TarsusError):
            walks.append(walk(Gait.named(name, legs=legs)))
    if not walks:
        return walk(Gait(1 - 2 / (3 * legs), tuple(leg / legs for leg in range(legs)), body_shift=True))
    return max(walks, key=lambda each: each.top_speed((1.0, 0.0, 0.0)))


class LegFailures:
    """Failed legs, found by measured joint angles or set from outside; a robot that can't walk without them sits down.

    Parameters
    ----------
    robot : Robot
        A single robot.
    options
        As for `WalkController`.

    Attributes
    ----------
    failed : FailedJoints
        Failed legs, with the failed joint of each; callers that know better may change it. A leg that is removed is
        used again once the robot has lain down and risen. Legs and joints that the robot does not have are refused.
    """

    def __init__(self, robot: Robot, **options: Any) -> None:
        stall = np.array([[at_supply(servo, None)[0] for servo in row] for row in robot.servos])
        self._robot, self._options, self._monitor = robot, options, ServoMonitor(stall)
        self.failed = self._monitor.failed
        self._not_walkable, self._cause = dict[int, int](), ""

    def following(self, activity: Walking, now: Snapshot, dt: float) -> Walking:
        """Return the activity that follows a tick: a new one, without the failed legs, where another leg has failed.

        Parameters
        ----------
        activity : Walking
            The present activity.
        now, dt : Snapshot, float
            State of the robot before the tick; length of the tick [s].
        """
        self._monitor.step(now.angles, activity.measured, dt)
        lost = activity.failed if isinstance(activity, ReducedWalking) else {}
        if self.sits or self.failed.keys() <= lost.keys():
            return activity
        after, slope = activity.snapshot, activity.controller.slope
        speeds = (after.angles - now.angles) / dt
        try:
            return ReducedWalking(self._robot, self.failed, after, speeds, slope, **self._options)
        except TarsusError as error:
            self._not_walkable, self._cause = dict(self.failed), str(error)
        return activity

    @property
    def sits(self) -> bool:
        """Whether the robot has to sit down, as it can't walk without the failed legs."""
        return bool(self._not_walkable) and self._not_walkable.keys() <= self.failed.keys()

    @property
    def limitations(self) -> tuple[Limitation, ...]:
        """Why the robot sits down."""
        names = " and ".join(self._robot.leg_names[leg] for leg in self.failed)
        found = Limitation(kind=LimitationKind.STATE, cause=f"{_SITS}: {self._cause}", leg=names)
        return (found,) if self.sits else ()
