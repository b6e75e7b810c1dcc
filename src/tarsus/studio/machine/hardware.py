"""A studio's access to the servos of the computer on which it runs."""

from __future__ import annotations

import os
import sys
import threading
from pathlib import Path

from tarsus.errors import InputError
from tarsus.hardware.transport.clock import Clock, SystemClock
from tarsus.robot.file import list_robots, load_robot, save_robot
from tarsus.robot.robot import Robot
from tarsus.studio.files import file_name

__all__ = ["Hardware", "why_no_hardware"]


def why_no_hardware(*, public: bool) -> str:
    """Return why a session has no access to hardware.

    Parameters
    ----------
    public : bool
        Whether the server of the session is public.
    """
    if sys.platform == "emscripten":
        return (
            "the studio in the browser has no access to the ports of this computer: install Tarsus, and start tarsus "
            "studio, or tarsus bring-up in a terminal"
        )
    if public:
        return (
            "a public studio has no access to hardware, as any visitor could move the servos: start tarsus studio on "
            "the computer that they are connected to"
        )
    return "this studio was started without access to hardware: start tarsus studio on the computer with the servos"


class Hardware:
    """The servos that are connected to this computer, for one visitor at a time.

    Parameters
    ----------
    folder : Path
        Folder of calibration files.
    robot_file : Path, optional
        File of a robot that is not a preset.
    calibration : Path, optional
        The calibration file; one that is named after the robot where left out.
    clock : Clock, optional
        Clock of the machine.
    """

    def __init__(
        self,
        folder: Path,
        *,
        robot_file: Path | None = None,
        calibration: Path | None = None,
        clock: Clock | None = None,
    ) -> None:
        self.clock: Clock = clock or SystemClock()
        self._folder, self._robot_file, self._calibration = folder, robot_file, calibration
        self._lock = threading.Lock()
        self._owner: object | None = None

    def take(self, owner: object) -> None:
        """Reserve the servos.

        Parameters
        ----------
        owner : object
            Whoever is to use them.

        Raises
        ------
        InputError
            If they are reserved for another owner.
        """
        with self._lock:
            if self._owner not in (None, owner):
                raise InputError("another visitor uses the servos; one at a time can. Leave the bring-up there first")
            self._owner = owner

    def leave(self, owner: object) -> None:
        """Release the reservation; nothing happens where another owner has it.

        Parameters
        ----------
        owner : object
            Whoever used the servos.
        """
        with self._lock:
            if self._owner is owner:
                self._owner = None

    def files(self, robot: Robot) -> tuple[str, Path]:
        """Return a robot's name or file, as its calibration file states it, and the path of that calibration file.

        For a robot that is neither a preset nor in a file yet, a robot file is written to the folder.

        Parameters
        ----------
        robot : Robot
            A single robot.

        Raises
        ------
        InputError
            If the file of that name contains another robot.
        TarsusError
            If the robot file can't be read or written.
        """
        if robot.name in list_robots() and load_robot(robot.name) == robot:
            return robot.name, self._calibration or self._folder / f"{robot.name}.calibration.toml"
        file = self._robot_file
        if file is None or load_robot(file) != robot:
            file = self._folder / file_name(robot, "", "toml")
        if not file.exists():
            save_robot(robot, file)
        elif load_robot(file) != robot:
            raise InputError(
                f"{file} is another robot than the one of this page, and a calibration belongs to a file: give the "
                "robot another name, or export it over that file"
            )
        calibration = self._calibration or file.with_name(f"{file.stem}.calibration.toml")
        return os.path.relpath(file, calibration.parent), calibration
