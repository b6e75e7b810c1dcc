"""The guard: an independent watcher between whatever makes joint angles and whoever turns them into motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, get_args

import numpy as np

from tarsus.arrays import Array
from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.feet_monitor import FeetMonitor
from tarsus.control.safety.inputs import read_angles, read_body, read_contacts, read_step
from tarsus.control.safety.interventions import GuardOutput, Intervention, InterventionLog, Violation
from tarsus.control.safety.joint_monitor import JointMonitor
from tarsus.control.safety.sit_down import SitDown
from tarsus.errors import InputError, TarsusError, UnknownNameError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_stance
from tarsus.robot.robot import Robot

__all__ = ["Guard", "GuardBounds", "GuardOutput", "Intervention", "Policy", "Recover", "State"]

Policy = Literal["hold", "sit"]
Recover = Literal["near", "reset"]
State = Literal["passing", "holding", "sitting", "recovering"]

# Longer than this no step is: whatever it is, it is no time [s].
_ABSURD = 3600.0


class Guard:
    """Lets joint angles through that break no bound; else brakes, holds, and recovers.

    It shares nothing with what it watches but the robot and the equations of forward kinematics. Whatever it is
    given, what it returns is finite, within the joints' limits, and, as angles over `GuardOutput.time`, within their
    bounds on speed and acceleration (but for 1e-12 rad of rounding).

    Angles that break a bound are not sent. Every joint brakes at once, as hard as it may, along the way it goes, and is
    held where it comes to rest; with the policy ``"sit"`` the body is then lowered onto its belly, with the feet where
    they are. When the commanded angles come near the held ones again, or after `reset`, the joints catch up with them.

    Parameters
    ----------
    robot : Robot
        A single robot.
    bounds : GuardBounds, optional
        What is let through; `GuardBounds.of` the robot where left out.
    policy : {"hold", "sit"}
        Whether the robot is held, or then sits down.
    recover : {"near", "reset"}
        Whether it recovers when the commanded angles come near the held ones, or only after `reset`.
    start : array, shape (legs, 3), optional
        The joint angles where the robot is, at rest [rad]. Left out, the first angles that pass are taken for them;
        and if the first don't pass, the stance that walks start from.
    log_size : int
        How many interventions `log` keeps.

    Raises
    ------
    InputError
        If the robot is a batch of designs, the bounds are for another number of legs, or `start` is not of finite
        angles within the limits.
    UnknownNameError
        If there is no such policy or way to recover.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        bounds: GuardBounds | None = None,
        policy: Policy = "hold",
        recover: Recover = "near",
        start: Array | None = None,
        log_size: int = 1000,
    ) -> None:
        for kind, name, known in (("policy", policy, get_args(Policy)), ("way to recover", recover, get_args(Recover))):
            if name not in known:
                raise UnknownNameError.of(kind, str(name), known)
        self.bounds = GuardBounds.of(robot) if bounds is None else bounds
        if robot.batch_shape or len(self.bounds.limits) != robot.legs:
            raise InputError(f"bounds for {len(self.bounds.limits)} legs don't fit {robot.name!r}: {robot.legs} legs")
        if log_size < 1:
            raise InputError(f"log_size is {log_size}; it must be at least 1")
        self._robot, self._policy, self._recover = robot, policy, recover
        self._joints = JointMonitor(self.bounds)
        self._feet = FeetMonitor(robot, self.bounds)
        self._record = InterventionLog(robot, log_size)
        self._state: State = "passing"
        self._time, self._pending, self._at_rest_for = 0.0, 0.0, 0.0
        self._sitting: SitDown | None = None
        self._seated = self._released = False
        # What was commanded the step before, where it could be read.
        self._before: list[float] | None = None
        self._started = start is not None
        if start is not None:
            self._joints.place(self._checked_start(start), 0.0)

    def _checked_start(self, start: Array) -> list[float]:
        angles = read_angles(start, self._robot.legs)
        faults = [angles] if isinstance(angles, Violation) else self._joints.within(angles)
        if isinstance(angles, Violation) or faults:
            why = "; ".join(found.text() for found in InterventionLog(self._robot, 1).note(faults, 0.0))
            raise InputError(f"start of a guard must be finite joint angles within the limits, legs x 3: {why}")
        return angles

    @property
    def state(self) -> State:
        """What it does: ``"passing"``, ``"holding"``, ``"sitting"`` or ``"recovering"``."""
        return self._state

    @property
    def time(self) -> float:
        """The sum of all sane time steps [s]."""
        return self._time

    @property
    def counts(self) -> Mapping[str, int]:
        """How often each kind of intervention began; one that lasts for many ticks counts once."""
        return self._record.counts

    @property
    def log(self) -> tuple[Intervention, ...]:
        """The last interventions that began, the oldest first."""
        return tuple(self._record.log)

    def summary(self) -> str:
        """Return the counts, and the worst of each kind, as text in mm and degrees."""
        return self._record.summary(self._time, self._state)

    def reset(self) -> None:
        """Let the robot recover, from wherever it is held, to whatever is commanded that breaks no bound.

        The joints catch up at the bounds' share ``recovery`` of their speed, each for itself: see to it that the
        commanded angles are not far, or that the feet may drag.
        """
        self._released = self._state in ("holding", "sitting")

    def check(self, angles: Array, dt: float, contacts: Array | None = None, body: Pose | None = None) -> GuardOutput:
        """Return what may be sent for what is commanded.

        Parameters
        ----------
        angles : array, shape (legs, 3)
            The commanded joint angles [rad]. Anything else, NaN included, is an intervention and no error.
        dt : float
            Time since the last tick [s].
        contacts : array of bool, shape (legs,), optional
            Which feet are said to be down; left out, balance and feet are not checked.
        body : Pose, optional
            The pose of B in G, of which the attitude counts; left out, the plane of the feet is taken for level.

        Returns
        -------
        GuardOutput
            The angles that may be sent, and what was wrong with the commanded ones.
        """
        step, faults = self._clock(read_step(dt))
        command = read_angles(angles, self._robot.legs)
        if isinstance(command, Violation):
            faults.append(command)
        else:
            faults += self._joints.within(command)
            if step > 0 and self._state == "passing" and self._started:
                faults += self._joints.too_rash(command, step)
            faults += self._look_at_feet(command, contacts, body)
        readable = None if isinstance(command, Violation) else command
        if not self._started and faults:
            self._start_in_stance()
        elif step > 0:
            self._move(readable, step, faults)
            self._before = readable
        elif self._state != "holding":
            self._hold()
        return self._told(faults)

    def _clock(self, dt: float) -> tuple[float, list[Violation]]:
        """Return the time that passes, and what is wrong with it; steps too short wait until they make one."""
        bounds = self.bounds
        if bounds.shortest <= dt <= bounds.longest:
            step, faults = dt + self._pending, []
        elif bounds.longest < dt <= _ABSURD:
            step, faults = dt + self._pending, [Violation("gap", -1, -1, dt, bounds.longest)]
        else:
            step, faults = 0.0, [Violation("time_step", -1, -1, dt, bounds.shortest)]
            if 0 < dt < bounds.shortest:
                self._pending += dt
                step = self._pending if self._pending >= bounds.shortest else 0.0
        if step > 0:
            self._time, self._pending = self._time + step, 0.0
        return step, faults

    def _look_at_feet(self, command: list[float], contacts: Array | None, body: Pose | None) -> list[Violation]:
        """Return what is wrong with contacts and body, or with the feet."""
        down = None if contacts is None else read_contacts(contacts, self._robot.legs)
        rows = None if body is None else read_body(body)
        if isinstance(down, Violation) or isinstance(rows, Violation):
            return [fault for fault in (down, rows) if isinstance(fault, Violation)]
        return self._feet.faults(command, down, rows)

    def _start_in_stance(self) -> None:
        """Start where walks do, for want of angles that pass; where there is no such stance, with the legs straight."""
        try:
            found = inverse_kinematics(self._robot, default_stance(self._robot))
            angles = read_angles(found.angles, self._robot.legs)
        except TarsusError:
            angles = list(self._joints.angles)
        if not isinstance(angles, Violation) and not self._joints.within(angles):
            self._joints.place(angles, 0.0)
        self._started = True
        self._hold()

    def _move(self, command: list[float] | None, step: float, faults: list[Violation]) -> None:
        """Send the joints on: as commanded, towards it, or to rest. A command that is not near is a fault more."""
        if command is None or faults:
            if self._state in ("passing", "recovering"):
                self._hold()
        elif self._state == "passing":
            self._pass(command, step)
            return
        elif self._may_recover(command, faults):
            self._catch_up(command, step)
            return
        self._stay(step, gap=any(fault.kind == "gap" for fault in faults))

    def _pass(self, command: list[float], step: float) -> None:
        if self._started:
            self._joints.send(command, step)
        else:
            self._joints.place(command, step)
            self._started = True
        self._feet.passed()

    def _hold(self) -> None:
        self._state, self._sitting = "holding", None
        self._released, self._seated, self._at_rest_for = False, False, 0.0
        self._feet.forget()

    def _may_recover(self, command: list[float], faults: list[Violation]) -> bool:
        """Return whether the joints may catch up with a command that breaks no bound but is somewhere else."""
        if self._released:
            return True
        farthest, joint = self._joints.distance(command)
        catching_up = self._state == "recovering"
        # Once on the way, twice the distance is near, lest it go to and fro.
        near = (2 if catching_up else 1) * self.bounds.near
        if farthest > near:
            faults.append(Violation("away", joint // 3, joint % 3, farthest, near))
            if catching_up:
                self._hold()
            return False
        return catching_up or self._recover == "near"

    def _catch_up(self, command: list[float], step: float) -> None:
        self._state, self._sitting = "recovering", None
        # How fast the command goes is not known before its second tick.
        if self._before is None:
            self._joints.brake(step)
        elif self._joints.follow(self._before, command, step):
            self._state = "passing"
            self._feet.passed()

    def _stay(self, step: float, *, gap: bool) -> None:
        """Brake, hold, and sit down where that is the policy."""
        if self._sitting is not None and not gap and self._sitting.step(step):
            return
        if self._sitting is not None:
            self._state, self._sitting, self._seated = "holding", None, not gap
        self._joints.brake(step)
        if gap:
            self._joints.forget_step()
        self._at_rest_for = self._at_rest_for + step if self._joints.at_rest and not gap else 0.0
        if self._policy == "sit" and not self._seated and self._at_rest_for > self.bounds.sit_after:
            down, up = self._feet.down, self._feet.up
            self._state = "sitting"
            self._sitting = SitDown(self._robot, self.bounds, self._joints, down=down, up=up)

    def _told(self, faults: list[Violation]) -> GuardOutput:
        found: tuple[Intervention, ...] = ()
        if faults:
            found = self._record.note(faults, self._time)
        else:
            self._record.quiet()
        angles = np.array(self._joints.angles).reshape(self._robot.legs, 3)
        angles.setflags(write=False)
        return GuardOutput(angles, self._state == "passing", self._state, self._time, found)
