"""A run of a machine that is driven from the view Drive: the link between the run's loop and its studio's visitors."""

from __future__ import annotations

import dataclasses
import math
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.command import Command
from tarsus.control.control_output import ControlOutput
from tarsus.control.robot_controller import RobotController
from tarsus.errors import InputError
from tarsus.hardware.plant.pacer import Timing
from tarsus.hardware.plant.servo_plant import ServoPlant
from tarsus.hardware.plant.tick_record import TickRecord
from tarsus.hardware.transport.clock import Clock, SystemClock
from tarsus.robot.robot import JOINTS, Robot
from tarsus.studio.drive_frames import DriveFrames, command_of
from tarsus.studio.encoding import degrees, or_null
from tarsus.studio.messages import client as ask
from tarsus.studio.messages.machine import FrameMachine
from tarsus.studio.messages.motion import DriveFrame

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["DEADMAN", "DrivenRun"]

DEADMAN = 0.7
"""The robot stops after this time without a message from the driver [s]; while it walks, a page sends 20 a second."""

# How often rate and missed ticks are computed [s].
_TIMING_INTERVAL = 0.25
_NO_TWIST = (0.0, 0.0, 0.0)


class DrivenRun:
    """Source of the commands of a run: one visitor drives, and the robot stops when that visitor is not heard.

    The loop of the run calls `command`, `over` and `observe`; the studio calls everything else from another thread.

    Parameters
    ----------
    controller : RobotController
        The controller of the run.
    bus : str
        Name of what executes the angles, shown to visitors.
    deadman : float
        Time without a message after which the twist is 0 [s].
    clock : Clock, optional
        Clock of the machine.

    Attributes
    ----------
    plant : ServoPlant or None
        What executes the angles; None until it has been made.
    """

    def __init__(
        self, controller: RobotController, bus: str, *, deadman: float = DEADMAN, clock: Clock | None = None
    ) -> None:
        self.bus, self._controller, self._deadman = bus, controller, deadman
        self._clock: Clock = clock or SystemClock()
        self._lock = threading.Lock()
        self._driver: object | None = None
        self._command = Command()
        self._settings: ask.Command | None = None
        self._heard = self._clock.now()
        self._stopped = self._ended = False
        self._record: TickRecord | None = None
        self._fault = ""
        self._frames = DriveFrames(controller.robot)
        self.plant: ServoPlant | None = None
        self._timing: Timing | None = None
        self._timed = -math.inf
        # Checks the settings of commands beforehand: one that the controller of the run refuses would end the run.
        self._judge = RobotController(controller.robot)

    @property
    def robot(self) -> Robot:
        """The robot, with the joint limits of the machine."""
        return self._controller.robot

    # Called by the loop of the run.

    def command(self, time: float, output: ControlOutput, note: Callable[[str, str], None]) -> Command:  # noqa: ARG002
        """Return the command for the next tick."""
        self._frames.note(output)
        with self._lock:
            quiet = self._driver is None or self._clock.now() - self._heard > self._deadman
            if any(self._command.twist) and (quiet or self._ended):
                self._command = dataclasses.replace(self._command, twist=_NO_TWIST)
                self._stopped = not self._ended
                why = "the driver has left" if self._driver is None else f"nothing heard for {self._deadman:g} s"
                note("command", "stop" if self._ended else f"{why}: stop")
            return self._command

    def over(self, time: float, output: ControlOutput) -> bool:
        """Return whether the run is over: a visitor has ended it, and the robot stands still."""
        # A run that is ended before its first tick still executes one, as a recording needs it.
        return self._ended and output.at_rest and time > 0

    def observe(self, record: TickRecord) -> None:
        """Keep the record of a tick.

        Parameters
        ----------
        record : TickRecord
            What the plant did in the tick.
        """
        self._record = record
        if self.plant is not None and record.time - self._timed >= _TIMING_INTERVAL:
            self._timed, self._timing = record.time, self.plant.timing
        self._fault = record.fault or self._fault

    # Called by the studio.

    def take(self, driver: object) -> None:
        """Let a visitor drive.

        Parameters
        ----------
        driver : object
            The visitor.

        Raises
        ------
        InputError
            If another visitor drives.
        """
        with self._lock:
            if self._driver not in (None, driver):
                raise InputError(
                    "another visitor drives this robot, and one at a time can; close the other page, then try again"
                )
            self._driver, self._heard, self._stopped = driver, self._clock.now(), False

    def leave(self, driver: object) -> None:
        """End driving; the robot stops. Does nothing for a visitor who does not drive.

        Parameters
        ----------
        driver : object
            The visitor.
        """
        with self._lock:
            if self._driver is driver:
                self._driver = None

    def tell(self, driver: object, message: ask.Command) -> None:
        """Set the command; it holds until the next one, but its twist only as long as the visitor is heard.

        Parameters
        ----------
        driver : object
            The visitor.
        message : Command
            The command as received.

        Raises
        ------
        TarsusError
            If the controller would refuse it, or another visitor drives. The command is unchanged then.
        """
        command = command_of(message, legs=self.robot.legs)
        settings = message.model_copy(update={"id": 0, "velocity_mm_s": (0.0, 0.0), "turn_deg_s": 0.0, "state": None})
        if settings != self._settings:
            self._judge.step(dataclasses.replace(command, twist=_NO_TWIST, state=None), 0.01)
        self.take(driver)
        with self._lock:
            self._command, self._settings = command, settings

    def end(self, driver: object) -> None:
        """Stop the robot, and end the run.

        Parameters
        ----------
        driver : object
            The visitor.

        Raises
        ------
        InputError
            If another visitor drives.
        """
        self.take(driver)
        self._ended = True

    def frame(self, id: int) -> DriveFrame:
        """Return a frame: what is commanded, and what is measured.

        Parameters
        ----------
        id : int
            Id of the message that started driving.
        """
        return self._frames.frame(self._controller.output, id=id, machine=self._machine())

    def _machine(self) -> FrameMachine:
        record, timing = self._record, self._timing
        shape = (self.robot.legs, len(JOINTS))
        measured, sent, warm = (
            (np.full(shape, np.nan),) * 3 if record is None else (record.measured, record.sent, record.temperatures)
        )
        behind, late = self._worst(np.abs(measured - sent))
        temperature, warmest = self._worst(warm)
        flat = [None if np.isnan(angle) else angle for angle in degrees(measured)]
        problems = [self._fault] if self._fault else []
        return FrameMachine(
            angles_deg=flat,
            behind_deg=None if behind is None else or_null(np.degrees(behind), decimals=1),
            behind_joint=late,
            voltage_v=None if record is None or record.voltage is None else or_null(record.voltage, decimals=2),
            temperature_c=temperature,
            temperature_joint=warmest,
            rate_hz=0.0 if timing is None else round(timing.rate, 1),
            missed=0 if timing is None else timing.missed,
            stopped=self._stopped,
            problems=problems,
        )

    def _worst(self, values: Float[np.ndarray, "legs 3"]) -> tuple[float | None, str | None]:
        """Return the greatest of the known values, and the name of its joint; None for both where none is known."""
        if np.isnan(values).all():
            return None, None
        leg, joint = np.unravel_index(int(np.nanargmax(values)), values.shape)
        return float(values[leg, joint]), f"{self.robot.leg_names[int(leg)]} {JOINTS[int(joint)]}"
