"""The bring-up of a machine from a page: it runs the steps of `tarsus bring-up` in a thread."""

from __future__ import annotations

import atexit
import threading
from typing import TYPE_CHECKING, Literal

import numpy as np

from tarsus.hardware.bringup.beginning import begin
from tarsus.hardware.bringup.dialogue import Left, Topic
from tarsus.hardware.bringup.emulated_machine import EmulatedMachine
from tarsus.hardware.bringup.opening import bring_up_of, emulated_machine_of
from tarsus.hardware.bringup.reference_pose import reference_angles
from tarsus.hardware.bringup.wizard import BringUp
from tarsus.robot.robot import JOINTS, Robot
from tarsus.studio.encoding import degrees
from tarsus.studio.error_messages import error_message
from tarsus.studio.machine.hardware import Hardware
from tarsus.studio.machine.page_dialogue import LeavingClock, PageDialogue
from tarsus.studio.messages.machine import BringUpMessage

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["PageBringUp"]

# Longest wait for the servos to be released when the program ends [s].
_PATIENCE = 5.0


class PageBringUp:
    """A bring-up that begins at once, and asks its questions in a page.

    Parameters
    ----------
    hardware : Hardware
        The servos.
    robot : Robot
        A single robot.
    id : int
        Id of the message that began the bring-up; all its messages carry it.

    Raises
    ------
    InputError
        If another visitor uses the servos, or the file of the robot's name contains another robot.
    """

    def __init__(self, hardware: Hardware, robot: Robot, *, id: int) -> None:
        self.id, self._hardware, self._robot = id, hardware, robot
        hardware.take(self)
        try:
            self._robot_file, self._path = hardware.files(robot)
        except BaseException:
            hardware.leave(self)
            raise
        self._dialogue = PageDialogue(self._hold)
        self._emulated: EmulatedMachine | None = None
        self._wizard: BringUp | None = None
        self._end: Literal["done", "left", "failed"] | None = None
        self._problem: str | None = None
        self._sent: BringUpMessage | None = None
        self._thread = threading.Thread(target=self._perform, name="bring-up", daemon=True)
        # Releases the servos also where the program ends during the bring-up.
        atexit.register(self._end_now)
        self._thread.start()

    @property
    def is_over(self) -> bool:
        """Whether the bring-up has ended, and the page was told."""
        return self._sent is not None and self._sent.state in ("done", "left", "failed")

    def answer(self, number: int, key: str) -> None:
        """Answer a question.

        Parameters
        ----------
        number : int
            Number of the question.
        key : str
            Key of the choice.

        Raises
        ------
        InputError
            If the question is not asked now, or has no such choice.
        """
        self._dialogue.answer(number, key)

    def leave(self) -> None:
        """End the bring-up, and release the servos; the answers so far are saved."""
        self._dialogue.leave()

    def _end_now(self) -> None:
        self.leave()
        self._thread.join(_PATIENCE)

    def message(self) -> BringUpMessage | None:
        """Return the progress of the bring-up; None where it is the same as in the last message."""
        end, question = self._end, self._dialogue.question
        found = BringUpMessage(
            type="bring_up",
            id=self.id,
            state=end or ("moving" if question is None else "asking"),
            file=str(self._path),
            said=list(self._dialogue.said),
            question=None if end else question,
            known=0 if self._wizard is None else self._joints - len(self._wizard.calibration.missing),
            joints=self._joints,
            angles_deg=[round(angle, 1) for angle in degrees(self._angles())],
            emulated=self._emulated is not None,
            problem=self._problem,
        )
        if found == self._sent:
            return None
        self._sent = found
        return found

    @property
    def _joints(self) -> int:
        return self._robot.legs * len(JOINTS)

    def _angles(self) -> Float[np.ndarray, "legs 3"]:
        return reference_angles(self._robot) if self._emulated is None else self._emulated.angles

    def _hold(self, topic: Topic) -> None:
        if self._emulated is not None:
            self._emulated.hold(topic)

    def _perform(self) -> None:
        dialogue, clock = self._dialogue, self._hardware.clock
        try:
            found = begin(self._robot, self._robot_file, self._path, dialogue, emulated=True)
            self._emulated = emulated = emulated_machine_of(found, clock=clock)
            leaving = LeavingClock(clock, dialogue)
            self._wizard = bring_up_of(found, self._path, dialogue, emulated=emulated, clock=leaving)
            self._wizard.perform()
        except Left:
            self._finish("left")
        except Exception as error:  # every error is shown in the page
            self._problem = error_message(error, id=self.id).text
            self._finish("failed")
        else:
            self._finish("done")

    def _finish(self, end: Literal["done", "left", "failed"]) -> None:
        atexit.unregister(self._end_now)
        self._hardware.leave(self)
        self._end = end
