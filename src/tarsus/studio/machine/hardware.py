"""The access of a studio to the servos of the computer on which it runs."""

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
    """Return why a session without access to hardware has none.

    Parameters
    ----------
    public : bool
        Whether its server is public.
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
        Where calibration files are.
    robot_file : Path, optional
        File of a robot that is no preset.
    calibration : Path, optional
        The calibration file; left out, one that is named after the robot.
    clock : Clock, optional
        The machine's.
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
            Who needs them.

        Raises
        ------
        InputError
            If someone else has them.
        """
        with self._lock:
            if self._owner not in (None, owner):
                raise InputError("another visitor uses the servos; one at a time can. Leave the bring-up there first")
            self._owner = owner

    def leave(self, owner: object) -> None:
        """Give the servos back.

        Parameters
        ----------
        owner : object
            Who had them.
        """
        with self._lock:
            if self._owner is owner:
                self._owner = None

    def files(self, robot: Robot) -> tuple[str, Path]:
        """Return what a calibration file calls a robot, and the path of its calibration file.

        A robot that is no preset and has no file yet gets one beside its calibration.

        Parameters
        ----------
        robot : Robot
            A single robot.

        Raises
        ------
        InputError
            If there is a file of that name with another robot.
        TarsusError
            If it can't be written.
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
