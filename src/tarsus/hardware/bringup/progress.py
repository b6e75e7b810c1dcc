"""What a bring-up knows so far: the calibration, saved after every answer."""

from __future__ import annotations

from pathlib import Path

from tarsus.errors import CalibrationError
from tarsus.hardware.bringup.dialogue import Dialogue
from tarsus.hardware.calibration.blank import new_calibration
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.robot.robot import JOINTS

__all__ = ["Progress"]


class Progress:
    """The calibration as far as it is known, and who answers what is not known yet.

    Parameters
    ----------
    calibration : Calibration
        As far as it is known.
    path : Path
        Where it is saved after every answer.
    dialogue : Dialogue
        Who answers the questions.

    Attributes
    ----------
    calibration : Calibration
        As far as it is known now.
    blank : Calibration
        What it was before the first answer.
    ask : Dialogue
        Who answers the questions.
    """

    def __init__(self, calibration: Calibration, path: Path, dialogue: Dialogue) -> None:
        self.calibration, self._path, self.ask = calibration, path, dialogue
        self.blank = new_calibration(calibration.robot, calibration.robot_file, kind=calibration.buses[0].kind)

    @property
    def joints(self) -> int:
        """How many joints the robot has."""
        return self.calibration.robot.legs * len(JOINTS)

    @property
    def assigned(self) -> set[int]:
        """Ids or channels whose joint is known."""
        return {joint.number for row in self.calibration.joints for joint in row if joint.number is not None}

    @property
    def leg_options(self) -> dict[str, str]:
        """Keys of the legs, for a question, and their names."""
        return {str(leg + 1): name for leg, name in enumerate(self.calibration.robot.leg_names)}

    def numbers(self, leg: int) -> tuple[tuple[int, int], ...]:
        """Return the joints of a leg whose servos are known, with their ids or channels.

        Parameters
        ----------
        leg : int
            Number of the leg.
        """
        joints = enumerate(self.calibration.joints[leg])
        return tuple((j, joint.number) for j, joint in joints if joint.number is not None)

    def keep(self, changed: Calibration) -> None:
        """Save a calibration, and go on with it.

        Parameters
        ----------
        changed : Calibration
            The calibration.

        Raises
        ------
        TarsusError
            If the file can't be written.
        """
        changed.save(self._path)
        self.calibration = changed

    def keep_joint(self, leg: int, j: int, **changes: object) -> bool:
        """Keep changes of a joint, unless they contradict what is known; return whether they were kept.

        Parameters
        ----------
        leg, j : int
            Numbers of the leg and the joint.
        **changes
            Fields of `JointCalibration`.
        """
        try:
            changed = self.calibration.with_joint(leg, j, **changes)
        except CalibrationError as error:
            self.ask.say("; ".join(error.problems))
            return False
        self.keep(changed)
        return True
