"""The beginning of a bring-up: a calibration that was begun before, or a new one for the chosen servos."""

from __future__ import annotations

import dataclasses
import datetime
from collections.abc import Mapping
from glob import glob
from pathlib import Path

from tarsus.errors import InputError
from tarsus.hardware.bringup.dialogue import Dialogue, Topic
from tarsus.hardware.bus.registry import BUSES, bus_kind
from tarsus.hardware.calibration.blank import new_calibration
from tarsus.hardware.calibration.bus_commands import usual_bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.transport.serial import list_ports
from tarsus.robot.robot import Robot

__all__ = ["EMULATED", "begin", "ports_of"]

EMULATED = "emulated"
"""Port of emulated servos, with which a bring-up can be tried without hardware."""

_TITLE = "Port and servos"


def begin(
    robot: Robot,
    robot_file: str,
    path: Path,
    dialogue: Dialogue,
    *,
    kind: str | None = None,
    port: str | None = None,
    emulated: bool = False,
) -> Calibration:
    """Return the calibration to be completed: that of the file, or a new one, which is saved.

    Parameters
    ----------
    robot : Robot
        A single robot.
    robot_file : str
        Name of its preset, or path of its file from the folder of the calibration file.
    path : Path
        The calibration file.
    dialogue : Dialogue
        Who answers the questions.
    kind : str, optional
        Kind of the servo bus; left out, it is asked for.
    port : str, optional
        Its port, empty to search for it; left out, it is asked for.
    emulated : bool
        Whether emulated servos are among the ports.

    Raises
    ------
    Left
        If whoever answers goes away.
    CalibrationError
        If the file is wrong, or can't be written.
    InputError
        If the file is for another robot, or another kind of bus.
    UnknownNameError
        If there is no such kind of bus.
    """
    if path.exists():
        found = Calibration.load(path)
        if found.robot != robot:
            raise InputError(
                f"{path} is the calibration of {found.robot_file}, which is not the robot {robot.name!r}: name another "
                "file, or move this one away"
            )
        if kind is not None and kind != found.buses[0].kind:
            raise InputError(f"{path} is for the bus {found.buses[0].kind}, not {kind}: name another file for {kind}")
        if port:
            found = found.replace(buses=(dataclasses.replace(found.buses[0], port=port), *found.buses[1:]))
        dialogue.say(f"resumed from {path}: {len(found.missing)} joints are not complete")
        return found
    if kind is None:
        kind = _asked_kind(robot, dialogue)
    if port is None:
        port = _asked_port(kind, dialogue, emulated=emulated)
    made = new_calibration(robot, robot_file, kind=kind, port=port)
    made = made.replace(date=datetime.datetime.now(tz=datetime.UTC).date())
    made.save(path)
    return made


def ports_of(kind: str) -> tuple[str, ...]:
    """Return the names of this machine's ports to which a bus of a kind may be connected.

    Parameters
    ----------
    kind : str
        Kind of the servo bus.
    """
    return tuple(sorted(glob("/dev/i2c-*"))) if bus_kind(kind).transport == "i2c" else list_ports()


def _asked_kind(robot: Robot, dialogue: Dialogue) -> str:
    usual = usual_bus(robot.servos[0][0]).name
    others = {str(number): name for number, name in enumerate((name for name in BUSES if name != usual), 1)}
    options = {"": BUSES[usual].title, **{key: BUSES[name].title for key, name in others.items()}}
    answer = dialogue.choose("Which servos or which board does the robot have?", options, topic=Topic(title=_TITLE))
    return others.get(answer, usual)


def _asked_port(kind: str, dialogue: Dialogue, *, emulated: bool) -> str:
    ports: Mapping[str, str] = {str(number): port for number, port in enumerate(ports_of(kind), 1)}
    without = {"e": "emulated servos, without hardware"} if emulated else {}
    options = {"": "search for it", **ports, **without}
    answer = dialogue.choose("To which port are they connected?", options, topic=Topic(title=_TITLE))
    return EMULATED if answer == "e" else ports.get(answer, "")
