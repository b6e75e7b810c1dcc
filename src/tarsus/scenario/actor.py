"""The robot as a scenario drives it: it lies, gets up, walks, sits down, all in one ground frame."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tarsus.control.pose.admittance import Admittance
from tarsus.control.pose.levelling import LevellingMode
from tarsus.control.sequence.player import SequencePlayer
from tarsus.control.sequence.sequence import MotionSequence, SequenceSample
from tarsus.control.startup.planner import fold, sit_down, stand_up
from tarsus.control.startup.power_off import power_off_order
from tarsus.control.walk_controller import WalkController
from tarsus.errors import TarsusError
from tarsus.gait.gait import Gait
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot
from tarsus.scenario.active_commands import ActiveCommands
from tarsus.scenario.commands import PowerOff, Sit, StandUp
from tarsus.scenario.timed_command import TimedCommand

__all__ = ["Actor", "Frame"]

Floats = np.ndarray[Any, Any]

# A robot whose joints are slower than this is at rest [rad/s].
_AT_REST = 1e-3
_STILL = (0.0, 0.0, 0.0)


class Frame(NamedTuple):
    """What the robot does at a moment.

    Joint angles ``(legs, 3)`` [rad], the body's pose and the feet ``(legs, 3)`` in G [m], which feet are on the ground,
    whether the belly is, whether it stands or walks (and is not lying, getting up or going down), what it is doing, its
    twist [m/s, m/s, rad/s], the gait, the cycle's duration [s], and why the command is not met in full.
    """

    angles: Floats
    body: Pose
    feet: Floats
    contacts: Floats
    belly: bool
    upright: bool
    doing: str
    twist: tuple[float, float, float]
    gait: Gait
    cycle_time: float
    limited: tuple[str, ...]


class Actor:
    """A robot that is told commands and makes joint angles.

    Parameters
    ----------
    robot : Robot
        A single robot.
    start : {"standing", "sitting", "folded"}
        How it is found.
    gait : Gait
        The gait it starts with.
    body_height, swing_height : float, optional
        Of the stance that it starts in or gets up to [m].
    levelling : {"level", "follow"}, optional
        What it does on ground that is not level.
    admittance : Admittance, optional
        How its feet give way to the forces on them.
    tell : callable
        Told what happens: what kind of thing, and in words.

    Raises
    ------
    UnreachableError
        If it can't stand or sit so.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        start: str,
        gait: Gait,
        body_height: float | None,
        swing_height: float | None,
        levelling: LevellingMode | None,
        admittance: Admittance | None,
        tell: Callable[[str, str], None],
    ) -> None:
        self.robot, self._tell = robot, tell
        self._first = {"body_height": body_height, "swing_height": swing_height}
        self._levelling, self._admittance = levelling, admittance
        self.orders = ActiveCommands(robot)
        self._base = Pose.from_rpy(0.0, 0.0, 0.0, (0.0, 0.0, 0.0))
        self._gait, self._cycle_time = gait, 0.0
        self._player: SequencePlayer | None = None
        self._act: TimedCommand | None = None
        self._controller: WalkController | None = self._new_walker()
        self._lies: SequenceSample | None = None
        self._rate = 0.0
        if start != "standing":
            sequence = sit_down(robot, self._controller.angles)
            sequence = fold(robot, sequence.angles_end) if start == "folded" else sequence
            self._controller, self._lies = None, sequence.at(sequence.duration)
            self._base = _plane(self._lies.body).inverse()
        self.now = self._frame()

    def _new_walker(self) -> WalkController:
        return WalkController(
            self.robot,
            self._gait,
            body_height=self._first["body_height"],
            swing_height=self._first["swing_height"],
            levelling=self._levelling,
            admittance=self._admittance,
        )

    @property
    def acting(self) -> bool:
        """Whether it is getting up, going down or folding."""
        return self._player is not None

    # A tick.

    @property
    def over(self) -> bool:
        """Whether nothing is going on that ends by itself: no act, no coming to a stop."""
        stopping = self._controller is not None and self.orders.twist == _STILL and not self._at_rest()
        return not (self.orders.acts or self._player or stopping)

    def step(self, dt: float) -> Frame:
        """Go on by one tick.

        Parameters
        ----------
        dt : float
            The time since the last one [s].
        """
        if self._player is None and self.orders.acts:
            self._try_act()
        before = self.now.angles
        if self._player is not None:
            self._player.step(dt)
        elif self._controller is not None:
            self._walk(self._controller, dt)
        self.now = self._frame()
        self._rate = float(np.abs(self.now.angles - before).max()) / dt
        if self._player is not None and self._player.done:
            self._end_act(self._player.sequence)
        return self.now

    def _walk(self, controller: WalkController, dt: float) -> None:
        readings = self.orders.feeling.readings(controller.feet, controller.body, controller.contacts)
        controller.step(self.orders.command(), dt, readings=readings)
        self._gait, self._cycle_time = controller.gait, controller.cycle_time

    def _at_rest(self) -> bool:
        still = self._rate < _AT_REST
        return still and (self._controller is None or self._controller.mode == "standing")

    def _frame(self) -> Frame:
        if self._player is not None:
            return self._shown(self._player.now)
        controller = self._controller
        if controller is None:
            assert self._lies is not None  # one of the three is always there
            return self._shown(self._lies._replace(belly=True, stage="lying"))
        return Frame(
            controller.angles,
            self._base @ controller.body,
            np.asarray(self._base @ controller.feet),
            controller.contacts,
            belly=False,
            upright=True,
            doing=controller.mode,
            twist=(float(controller.twist[0]), float(controller.twist[1]), float(controller.twist[2])),
            gait=controller.gait,
            cycle_time=controller.cycle_time,
            limited=controller.limited,
        )

    def _shown(self, instant: SequenceSample) -> Frame:
        body = self._base @ instant.body
        feet = np.asarray(body @ forward_kinematics(self.robot, instant.angles)[..., 3, :])
        return Frame(
            instant.angles,
            body,
            feet,
            instant.contacts,
            belly=instant.belly,
            upright=False,
            doing=instant.stage,
            twist=_STILL,
            gait=self._gait,
            cycle_time=self._cycle_time,
            limited=(),
        )

    # Getting up and lying down.

    def _try_act(self) -> None:
        """Begin the next act as soon as the robot is at rest; one that can't be is refused with the reason."""
        act = self.orders.acts[0]
        stands = self._controller is not None
        if stands and isinstance(act, StandUp):
            self._refuse("it stands already", act)
        elif stands and not isinstance(act, Sit):
            self._refuse("it stands; let it sit first", act)
        elif not stands and isinstance(act, Sit):
            self._refuse("it sits already", act)
        elif self._at_rest():
            self._begin(self.orders.acts.popleft())

    def _refuse(self, why: str, act: TimedCommand) -> None:
        self.orders.acts.remove(act)
        self._tell("refused", f"{act.word}: {why}")

    def _begin(self, act: TimedCommand) -> None:
        angles = self.now.angles
        try:
            if isinstance(act, PowerOff):
                falls = power_off_order(self.robot, angles).falls
                self._tell("power", "joints released: coxae, femurs, tibiae; " + ("; ".join(falls) or "nothing falls"))
                return
            sequence = self._plan(act, angles)
        except TarsusError as error:
            self._tell("refused", f"{act.word}: {error}")
            return
        start = sequence.stages[0].start
        self._base = _plane(self.now.body) @ _plane(start).inverse()
        self._player, self._act = SequencePlayer(sequence), act

    def _plan(self, act: TimedCommand, angles: Floats) -> MotionSequence:
        if isinstance(act, StandUp):
            return stand_up(
                self.robot, angles, body_height=self._first["body_height"], swing_height=self._first["swing_height"]
            )
        return sit_down(self.robot, angles) if isinstance(act, Sit) else fold(self.robot, angles)

    def _end_act(self, sequence: MotionSequence) -> None:
        end = sequence.at(sequence.duration)
        self._player, self._lies = None, end
        if isinstance(self._act, StandUp):
            self._base = self._base @ _plane(end.body)
            self._controller, self._lies = self._new_walker(), None
            self.orders.forget_hands_back()
        else:
            self._controller = None
        self._act = None


def _plane(body: Pose) -> Pose:
    """Return where a body's heading frame is on the ground."""
    yaw = float(np.asarray(body.rpy)[2])
    return Pose.from_rpy(0.0, 0.0, yaw, (float(body.position[0]), float(body.position[1]), 0.0))
