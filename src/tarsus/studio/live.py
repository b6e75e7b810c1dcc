"""What moves in a session between messages: the robot that is driven, and the servos that are brought up."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from tarsus.errors import InputError, SimulationError, TarsusError
from tarsus.robot.robot import Robot
from tarsus.studio.driving import Driven
from tarsus.studio.error_messages import error_message
from tarsus.studio.machine.driven_run import DrivenRun
from tarsus.studio.machine.hardware import Hardware, why_no_hardware
from tarsus.studio.machine.page_bring_up import PageBringUp
from tarsus.studio.machine.run_driver import RunDriver
from tarsus.studio.messages import client as ask
from tarsus.studio.messages.general import ErrorMessage
from tarsus.studio.messages.machine import BringUpMessage, HardwareOffer, RunOffer
from tarsus.studio.messages.motion import DriveFrame

if TYPE_CHECKING:
    from tarsus.studio.messages import ClientMessage

__all__ = ["Live"]

# Messages that are available while the session belongs to a run, and messages that may change the robot.
_WHILE_RUNNING = (ask.Hello, ask.Ping, ask.Drive, ask.Command, ask.EndRun)
_OTHER_ROBOT = (ask.Hello, ask.SetRobot, ask.SetDocument, ask.SetToml, ask.Undo, ask.Redo, ask.OpenState)


class Live:
    """The robot that a visitor drives, and the bring-up of its servos.

    Parameters
    ----------
    run : DrivenRun, optional
        The run of a machine that the session belongs to.
    hardware : Hardware, optional
        The servos of the computer on which the session runs.
    public : bool
        Whether the server of the session is public.
    """

    def __init__(self, run: DrivenRun | None, hardware: Hardware | None, *, public: bool) -> None:
        self.run, self._hardware, self._public = run, hardware, public
        self._driver: Driven | None = None
        self._bring_up: PageBringUp | None = None
        self.closed = False

    @property
    def run_offer(self) -> RunOffer | None:
        """The run that the first answer offers; None without one."""
        return None if self.run is None else RunOffer(bus=self.run.bus)

    @property
    def hardware_offer(self) -> HardwareOffer:
        """Whether there is access to servos, and why not, for the first answer."""
        return HardwareOffer(missing=why_no_hardware(public=self._public) if self._hardware is None else None)

    @property
    def is_on(self) -> bool:
        """Whether `frame` returns messages."""
        return self._driver is not None or self._bring_up is not None

    @property
    def is_planning(self) -> bool:
        """Whether computing the next frame may take longer than a frame lasts."""
        return self._driver is not None and self._driver.is_planning

    @property
    def bring_up(self) -> PageBringUp | None:
        """The bring-up under way; None where there is none."""
        return self._bring_up

    def require_available(self, message: ClientMessage) -> None:
        """Refuse messages that would disturb a bring-up, by changing the robot, or a run, by long computations.

        Parameters
        ----------
        message : ClientMessage
            The message.

        Raises
        ------
        InputError
            If it is not available now.
        """
        if self._bring_up is not None and isinstance(message, _OTHER_ROBOT):
            raise InputError("the servos of this robot are being brought up; leave the bring-up first")
        if self.run is None or isinstance(message, _WHILE_RUNNING):
            return
        if not (isinstance(message, ask.SetView) and message.view == "drive"):
            raise InputError("a robot runs: only the view Drive is available until the run ends")

    def frame(self, dt: float) -> DriveFrame | BringUpMessage | ErrorMessage | None:
        """Return what has changed in the bring-up, else the next frame of the robot that is driven.

        Parameters
        ----------
        dt : float
            Time since the last frame [s].
        """
        brought = self._brought_up()
        if brought is not None or self._driver is None:
            return brought
        try:
            return self._driver.step(dt)
        except Exception as error:  # every error is answered; a refused command leaves the robot as it is
            answer = error_message(error, id=self._driver.id)
            if isinstance(error, SimulationError) or not isinstance(error, TarsusError):
                self.end_driving()
            return answer

    def drive(self, message: ask.Drive, driver: Callable[[int], Driven]) -> None:
        """Start or stop driving.

        Parameters
        ----------
        message : Drive
            What is asked for.
        driver : callable
            Returns the driver of an ideally executed or a simulated robot, given the id of the message.
        """
        self.end_driving()
        if message.on:
            self._driver = driver(message.id) if self.run is None else RunDriver(self.run, id=message.id)

    def command(self, message: ask.Command) -> None:
        """Command the robot that is driven, if there is one.

        Parameters
        ----------
        message : Command
            The command as received.
        """
        if self._driver is not None:
            self._driver.command(message)

    def end_run(self) -> None:
        """Stop the robot, and end the run.

        Raises
        ------
        InputError
            If this visitor does not drive a run.
        """
        if not isinstance(self._driver, RunDriver):
            raise InputError("no run is driven from this page, so there is none to end")
        self._driver.end_run()

    def end_driving(self) -> None:
        """End driving."""
        if self._driver is not None:
            self._driver.close()
            self._driver = None

    def bring_up_servos(self, message: ask.BringUp, robot: Robot) -> None:
        """Begin, resume or leave the bring-up.

        Parameters
        ----------
        message : BringUp
            What is asked for.
        robot : Robot
            A single robot.

        Raises
        ------
        InputError
            If there is no access to servos, or another visitor uses them.
        """
        if self._hardware is None:
            raise InputError(why_no_hardware(public=self._public))
        if not message.on:
            if self._bring_up is not None:
                self._bring_up.leave()
        elif self._bring_up is None:
            self._bring_up = PageBringUp(self._hardware, robot, id=message.id)

    def answer(self, message: ask.Answer) -> None:
        """Answer a question of the bring-up.

        Parameters
        ----------
        message : Answer
            The answer.

        Raises
        ------
        InputError
            If it is not asked now.
        """
        if self._bring_up is None:
            raise InputError("no servos are being brought up, so nothing is asked")
        self._bring_up.answer(message.number, message.key)

    def close(self) -> None:
        """End driving and bring-up when the visitor leaves, so that a machine stops."""
        self.closed = True
        self.end_driving()
        if self._bring_up is not None:
            self._bring_up.leave()

    def _brought_up(self) -> BringUpMessage | None:
        if self._bring_up is None:
            return None
        message = self._bring_up.message()
        if self._bring_up.is_over:
            self._bring_up = None
        return message
