"""The guard: an independent monitor between the source of joint angles and the servos."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from tarsus.arrays import Array, read_only
from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.feet_monitor import FeetMonitor
from tarsus.control.safety.inputs import read_angles, read_contacts, read_time_step, read_up
from tarsus.control.safety.interventions import GuardOutput, GuardState, Intervention, InterventionKind, InterventionLog
from tarsus.control.safety.joint_monitor import JointMonitor
from tarsus.control.safety.sit_down import SitDown
from tarsus.errors import InputError, TarsusError, UnknownNameError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_stance
from tarsus.representation import represented
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Guard", "Policy", "Recovery"]

Policy = Literal["hold", "sit"]
Recovery = Literal["near", "reset"]


@represented("state", "time", "counts", "bounds")
class Guard:
    """Passes joint angles that violate no bound; otherwise brakes, holds and recovers.

    The guard shares nothing with what it monitors but the robot and the equations of forward kinematics. For any input,
    the angles it returns are finite and within the joint limits, and, as a function of `GuardOutput.time`, within the
    bounds on speed and acceleration (up to 1e-12 rad of rounding).

    A command that violates a bound is not sent. All joints brake at their greatest acceleration along their direction
    of motion and hold their position. With the policy ``"sit"``, the body is then lowered to the ground while the feet
    stay in place. The joints return to the command once it is near the held angles, or after `reset`.

    Parameters
    ----------
    robot : Robot
        A single robot.
    bounds : GuardBounds, optional
        The bounds; `GuardBounds.of` the robot by default.
    policy : {"hold", "sit"}
        Whether the robot holds its position, or sits down after holding it for a time.
    recover : {"near", "reset"}
        Whether the guard recovers as soon as the command is near the held angles, or only after `reset`.
    start : array, shape (legs, 3), optional
        Joint angles of the robot at the start, at rest [rad]. By default the first command that violates no bound
        sets them, or the default stance if the first command violates one.
    log_size : int
        Capacity of `log`.

    Attributes
    ----------
    bounds : GuardBounds
        The bounds.
    state : GuardState
        What the guard does with the commands.
    counts : mapping of InterventionKind to int
        How many interventions of each kind began; one that lasts several ticks counts once.
    time : float
        Sum of all time steps above 0 and up to an hour [s]; short ones count once they add up to a valid one.

    Raises
    ------
    InputError
        If the robot is a batch of designs, the bounds are for another number of legs, `log_size` is less than 1, or
        `start` is not an array of finite angles within the limits.
    UnknownNameError
        If `policy` or `recover` is unknown.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        bounds: GuardBounds | None = None,
        policy: Policy = "hold",
        recover: Recovery = "near",
        start: Float[Array, "legs 3"] | None = None,
        log_size: int = 1000,
    ) -> None:
        require_robot(robot)
        for kind, name, known in (("policy", policy, get_args(Policy)), ("recovery", recover, get_args(Recovery))):
            if name not in known:
                raise UnknownNameError.of(kind, str(name), known)
        self.bounds = GuardBounds.of(robot) if bounds is None else bounds
        if robot.batch_shape or len(self.bounds.limits) != robot.legs:
            raise InputError(f"the bounds are for {len(self.bounds.limits)} legs; {robot.name!r} has {robot.legs}")
        if log_size < 1 or log_size % 1:
            raise InputError(f"log_size is {log_size}; it must be a whole number of at least 1")
        self._robot, self._policy, self._recover = robot, policy, recover
        self._joints = JointMonitor(robot, self.bounds)
        self._feet = FeetMonitor(robot, self.bounds)
        # Time steps that are too short accumulate until they are long enough.
        self.time = self._pending = 0.0
        self._log = InterventionLog(int(log_size))
        self.counts = self._log.counts
        self.state = GuardState.PASSING
        self._time_at_rest = 0.0
        self._sit_down: SitDown | None = None
        self._seated = self._reset_requested = False
        self._last_command: list[float] | None = None
        self._started = start is not None
        if start is not None:
            self._start_at(start)

    def _start_at(self, start: Float[Array, "legs 3"]) -> None:
        violations: list[Intervention] = []
        angles = read_angles(start, self._joints.names, violations)
        if angles is not None:
            violations += self._joints.limit_violations(angles)
        if angles is None or violations:
            reasons = "; ".join(violation.text() for violation in violations)
            raise InputError(f"start must be an array of finite angles within the limits, shape (legs, 3): {reasons}")
        self._joints.start(angles, 0.0)

    @property
    def log(self) -> tuple[Intervention, ...]:
        """The latest interventions at the tick they began, oldest first."""
        return tuple(self._log.latest)

    def summary(self) -> str:
        """Return the counts and the worst intervention of each kind as text, in mm and degrees."""
        total = sum(self.counts.values())
        lines = [f"{total} intervention{'s' * (total != 1)} in {self.time:.2f} s, state: {self.state}"]
        lines += [f"  {number} x {self._log.worst[kind].text()}" for kind, number in self.counts.items()]
        return "\n".join(lines)

    def reset(self) -> None:
        """Let the guard recover to the next command that violates no bound, however far away it is.

        Each joint moves on its own at the fraction `GuardBounds.recovery_speed` of its speed. Feet in stance may drag
        if the command is far from the held angles.
        """
        self._reset_requested = self.state in (GuardState.HOLDING, GuardState.SITTING)

    def check(self, angles: Any, dt: float, contacts: Any = None, body: Pose | None = None) -> GuardOutput:
        """Check a command and return the joint angles to send.

        Parameters
        ----------
        angles : array, shape (legs, 3)
            Commanded joint angles [rad]. Any other input is an intervention, not an error.
        dt : float
            Time since the last tick [s].
        contacts : array of bool, shape (legs,), optional
            Feet in stance. Without contacts, stability margin and feet are not checked.
        body : Pose, optional
            Pose of B in G, of which only the attitude is used; by default the plane of the stance feet is horizontal.

        Returns
        -------
        GuardOutput
            The joint angles to send, and the violations of the command.
        """
        violations: list[Intervention] = []
        self._pending += read_time_step(dt, self.bounds, violations)
        step = self._pending if self._pending >= self.bounds.min_time_step else 0.0
        self.time, self._pending = self.time + step, self._pending - step
        command = read_angles(angles, self._joints.names, violations)
        if command is not None:
            violations += self._joints.limit_violations(command)
            if step > 0 and self.state is GuardState.PASSING and self._started:
                violations += self._joints.motion_violations(command, step)
            violations += self._feet_violations(command, contacts, body)
        if not self._started and violations:
            self._start_in_stance()
        elif step > 0:
            self._advance(command, step, violations)
            self._last_command = command
        elif self.state is not GuardState.HOLDING:
            self._hold()
        interventions = self._log.record(violations, self.time)
        sent = read_only(np.array(self._joints.angles).reshape(self._robot.legs, 3))
        return GuardOutput(sent, self.state is GuardState.PASSING, self.state, self.time, interventions)

    def _feet_violations(self, command: list[float], contacts: Any, body: Pose | None) -> list[Intervention]:
        """Return the violations of contacts and body pose if these are invalid, else those of the feet."""
        invalid: list[Intervention] = []
        stance = None if contacts is None else read_contacts(contacts, self._robot.legs, invalid)
        up = None if body is None else read_up(body, invalid)
        return invalid or self._feet.violations(command, stance, up)

    def _start_in_stance(self) -> None:
        """Start in the default stance because the first command is invalid; without a stance, at zero angles."""
        with suppress(TarsusError):
            self._start_at(inverse_kinematics(self._robot, default_stance(self._robot)).angles)
        self._started = True
        self._hold()

    def _advance(self, command: list[float] | None, step: float, violations: list[Intervention]) -> None:
        """Pass the command, recover, or hold; a valid command too far away to recover adds a violation."""
        if command is None or violations:
            if self.state in (GuardState.PASSING, GuardState.RECOVERING):
                self._hold()
        elif self.state is GuardState.PASSING:
            if self._started:
                self._joints.send(command, step)
            else:
                self._joints.start(command, step)
                self._started = True
            self._feet.accept()
            return
        elif self._may_recover(command, violations):
            self._recover_to(command, step)
            return
        self._stay(step, gap=any(found.kind is InterventionKind.TIME_GAP for found in violations))

    def _hold(self) -> None:
        self.state, self._sit_down = GuardState.HOLDING, None
        self._reset_requested, self._seated, self._time_at_rest = False, False, 0.0
        self._feet.reset_distances()

    def _may_recover(self, command: list[float], violations: list[Intervention]) -> bool:
        """Return whether the joints may move towards a valid command."""
        if self._reset_requested:
            return True
        recovering = self.state is GuardState.RECOVERING
        # Hysteresis: twice the distance while recovering.
        far = self._joints.distance_violations(command, (2 if recovering else 1) * self.bounds.recovery_distance)
        violations += far
        if far and recovering:
            self._hold()
        return not far and (recovering or self._recover == "near")

    def _recover_to(self, command: list[float], step: float) -> None:
        self.state, self._sit_down = GuardState.RECOVERING, None
        # The velocity of the command is unknown before its second tick.
        if self._last_command is None:
            self._joints.brake(step)
        elif self._joints.recover(self._last_command, command, step):
            self.state = GuardState.PASSING
            self._feet.accept()

    def _stay(self, step: float, *, gap: bool) -> None:
        """Brake and hold; with the policy "sit", sit down after a time at rest."""
        if self._sit_down is not None:
            if not gap and self._sit_down.step(step):
                return
            self.state, self._sit_down, self._seated = GuardState.HOLDING, None, not gap
        self._joints.brake(step, gap=gap)
        self._time_at_rest = self._time_at_rest + step if self._joints.at_rest and not gap else 0.0
        if self._policy == "sit" and not self._seated and self._time_at_rest > self.bounds.sit_delay:
            self.state = GuardState.SITTING
            self._sit_down = SitDown(self._robot, self.bounds, self._joints, self._feet)
