"""Runs a scenario, tick by tick, without servos."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from tarsus.control.safety.guard import Guard, GuardBounds
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.setup import Setup
from tarsus.gait.spacing import default_foot_distance
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.robot.file import load_robot
from tarsus.robot.joint_limits import joint_limits
from tarsus.robot.robot import Robot
from tarsus.scenario.actor import Actor, Frame
from tarsus.scenario.drivable import require_drivable
from tarsus.scenario.recording import Event, Recording
from tarsus.scenario.scenario import Scenario
from tarsus.scenario.timed_command import TimedCommand
from tarsus.scenario.wording import command_text

__all__ = ["run_scenario"]

# How long a scenario without a duration goes on after its last command [s], and for how long what that command began
# may last.
_AFTER, _PATIENCE = 2.0, 120.0
# How long a limit may be absent and is still the same one [s].
_GAP = 0.1
# What is this near to a moment is at it [s].
_AT = 1e-9


def run_scenario(scenario: Scenario, *, robot: Robot | str | None = None, guard: bool = True) -> Recording:
    """Run a scenario through the walker and a guard, and record what happens.

    Commands are given at the first tick at or after their time. Where the guard does not let angles through, the
    walker waits until it does.

    Parameters
    ----------
    scenario : Scenario
        What the robot is told.
    robot : Robot or str, optional
        Which robot; the scenario's own where left out.
    guard : bool
        Whether a guard watches the angles.

    Raises
    ------
    InputError
        If no robot is named, a command names a gait that it can't walk, or a force is to be felt that nothing follows.
    UnknownNameError
        If a command names a leg that it has not.
    UnreachableError
        If the robot can't stand as it is to stand at the start.
    """
    if robot is None and not scenario.robot:
        raise InputError("the scenario names no robot: give one")
    chosen = scenario.robot if robot is None else robot
    return _Run(scenario, chosen if isinstance(chosen, Robot) else load_robot(chosen), guard=guard).recording()


class _Run:
    """A scenario on its way."""

    def __init__(self, scenario: Scenario, robot: Robot, *, guard: bool) -> None:
        require_drivable(scenario, robot)
        self._scenario, self._robot = scenario, robot
        self._time = 0.0
        self._events: list[Event] = []
        self._limits: dict[str, int] = {}
        gait = Gait.named(scenario.gait or robot.gait.name, legs=robot.legs)
        levelling: Any = scenario.levelling or None
        self._actor = Actor(
            robot,
            start=scenario.start,
            gait=gait,
            body_height=scenario.body_height,
            swing_height=scenario.swing_height,
            levelling=levelling,
            admittance=scenario.admittance,
            tell=self._tell,
        )
        speed, acceleration = joint_limits(robot, None, None)
        # Where a servo's speed is unknown, walker and guard have to assume the same.
        bounds = GuardBounds.of(robot, speed=speed, acceleration=acceleration)
        self._guard = Guard(robot, bounds=bounds, start=self._actor.now.angles) if guard else None
        self._states = ["passing"]
        self._frames = [self._actor.now]
        self._sent = [self._actor.now.angles]
        self._times = [0.0]
        self._commands = [(0.0, 0.0, 0.0)]
        self._random = np.random.default_rng(scenario.seed)

    def recording(self) -> Recording:
        """Run it to its end."""
        left = list(reversed(self._scenario.commands))
        while not self._ended(left):
            while left and left[-1].at <= self._time + _AT:
                self._give(left.pop())
            self._tick()
        return self._recorded()

    def _ended(self, left: list[TimedCommand]) -> bool:
        scenario = self._scenario
        if scenario.duration is not None:
            return self._time >= scenario.duration - _AT
        last = scenario.commands[-1].at if scenario.commands else 0.0
        late = self._time >= last + _AFTER - _AT
        return not left and late and (self._actor.over or self._time >= last + _PATIENCE)

    def _tell(self, kind: str, text: str) -> None:
        self._events.append(Event(self._time, self._time, kind, text))

    def _give(self, command: TimedCommand) -> None:
        self._tell("command", command_text(command))
        self._actor.orders.take(command)

    def _tick(self) -> None:
        scenario, number = self._scenario, len(self._times)
        time = number / scenario.rate
        if scenario.jitter:
            time += float(self._random.uniform(-0.5, 0.5)) * scenario.jitter
        dt, self._time = time - self._time, time
        frame = self._actor.step(dt) if self._states[-1] == "passing" else self._actor.now
        self._sent.append(self._watched(frame, dt))
        self._note(self._frames[-1], frame)
        self._frames.append(frame)
        self._times.append(time)
        self._commands.append(self._actor.orders.twist)

    def _watched(self, frame: Frame, dt: float) -> np.ndarray[Any, Any]:
        """Return the angles that are sent."""
        if self._guard is None:
            return frame.angles
        down, body = (None, None) if frame.belly else (frame.contacts, frame.body)
        logged = sum(self._guard.counts.values())
        told = self._guard.check(frame.angles, dt, down, body)
        new = sum(self._guard.counts.values()) - logged
        for found in self._guard.log[len(self._guard.log) - new :]:
            self._tell("guard", found.text())
        self._states.append(told.state)
        return told.angles

    def _note(self, before: Frame, frame: Frame) -> None:
        """Note what is new with this tick."""
        if frame.gait.name != before.gait.name:
            self._tell("gait", f"{frame.gait.name} from here on")
        if frame.doing != before.doing and self._actor.acting:
            self._tell("stage", frame.doing)
        present: dict[str, int] = {}
        for reason in frame.limited:
            # The same reason with another number is the same.
            kind = re.sub(r"[-+]?\d+(\.\d+)?", "", reason)
            if kind not in self._limits:
                self._tell("limit", reason)
            present[kind] = self._limits.get(kind, len(self._events) - 1)
            self._events[present[kind]] = self._events[present[kind]]._replace(until=self._time)
        # What comes and goes from tick to tick is one stretch.
        lately = {kind: n for kind, n in self._limits.items() if self._events[n].until > self._time - _GAP}
        self._limits = {**lately, **present}

    def _recorded(self) -> Recording:
        frames = self._frames
        done = np.array([frame.twist for frame in frames])
        counts: Mapping[str, int] = {} if self._guard is None else dict(self._guard.counts)
        return Recording(
            scenario=self._scenario,
            robot=self._robot,
            motion=self._motion(done),
            wished=_locked(np.array(self._commands)),
            done=_locked(done),
            cycle_times=_locked(np.array([frame.cycle_time for frame in frames])),
            belly=_locked(np.array([frame.belly for frame in frames])),
            upright=_locked(np.array([frame.upright for frame in frames])),
            doing=tuple(frame.doing for frame in frames),
            gaits=tuple(frame.gait.name for frame in frames),
            guard=() if self._guard is None else tuple(self._states),
            interventions=counts,
            events=tuple(sorted(self._events, key=lambda event: event.time)),
        )

    def _motion(self, done: np.ndarray[Any, Any]) -> Motion:
        """Return what was sent, as a motion."""
        frames, robot = self._frames, self._robot
        angles = np.array(self._sent)
        body = Pose(
            np.array([np.asarray(frame.body.rotation) for frame in frames]),
            np.array([np.asarray(frame.body.position) for frame in frames]),
        )
        feet = np.array([frame.feet for frame in frames])
        # Where the guard sent something else, the feet are where that takes them; the body's pose is as commanded.
        stopped = np.array([(a != frame.angles).any() for a, frame in zip(angles, frames, strict=True)])
        if stopped.any():
            feet[stopped] = (body @ forward_kinematics(robot, angles)[..., 3, :])[stopped]
        setup = Setup.of(
            robot,
            frames[0].gait,
            body_height=self._scenario.body_height,
            swing_height=self._scenario.swing_height,
            body_tilt=(0.0, 0.0),
            foot_distance=None,
        )
        past = _past(done, setup.rest)
        fastest = int(past.max(1).argmax())
        frame = frames[fastest]
        lies = any(each.belly for each in frames)
        return Motion(
            robot=robot,
            gait=frame.gait,
            time=np.array(self._times),
            body=body,
            feet=feet,
            contacts=np.array([frame.contacts for frame in frames]),
            angles=angles,
            reach=np.zeros((len(frames), robot.legs), dtype=np.int8),
            cycle_time=frame.cycle_time,
            stroke=float(past[fastest].max()) * frame.cycle_time * frame.gait.duty_factor,
            speed=float(past[fastest].max()),
            body_height=setup.body_height,
            swing_height=setup.swing_height,
            # Legs that are drawn in may come nearer to each other than walking ones.
            foot_distance=0.0 if lies else default_foot_distance(robot),
            assumed=tuple(setup.assumed(self._scenario.body_height, self._scenario.swing_height)),
        )


def _past(done: np.ndarray[Any, Any], rest: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return how fast each foot at rest would go past the body, for every twist ``(n, legs)`` [m/s]."""
    vx, vy, wz = (done[:, axis, None] for axis in range(3))
    return np.asarray(np.hypot(vx - wz * rest[:, 1], vy + wz * rest[:, 0]))


def _locked(array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    array.setflags(write=False)
    return array
