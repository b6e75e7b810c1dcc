"""Option `--pulses` of `tarsus walk` and `tarsus pose`: commands of the servos as files."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from tarsus.errors import InputError

if TYPE_CHECKING:
    from rich.table import Table

    from tarsus.gait.motion import Motion
    from tarsus.hardware.calibration.calibration import Calibration
    from tarsus.hardware.pulses.gait_cycle import GaitCycle
    from tarsus.kinematics.solution import IKSolution
    from tarsus.robot.robot import Robot

__all__ = ["calibration_of", "pose_pulses", "pulse_table", "pulses_option", "walk_pulses"]

_F = TypeVar("_F", bound=Callable[..., Any])
_TABLE, _HEADER = "pulses.csv", "gait_cycle.h"
# Lengths of walks [cycles] that are tried in turn until one has a constant speed in its middle.
_CYCLES = (8, 16, 32)


def pulses_option(text: str) -> Callable[[_F], _F]:
    """Return the option ``--pulses``.

    Parameters
    ----------
    text : str
        Help text, which says what the option writes.
    """
    return click.option("--pulses", type=click.Path(path_type=Path), metavar="CALIBRATION", help=text)


def walk_pulses(motion: Motion, options: dict[str, Any], calibration: Calibration, folder: Path) -> list[Path]:
    """Write the commands of a walk as a table, and one cycle of it as an Arduino header; return the paths.

    Parameters
    ----------
    motion : Motion
        The walk.
    options : dict
        Options of `tarsus walk` from which it was planned.
    calibration : Calibration
        The calibration of its robot.
    folder : Path
        Existing folder.

    Raises
    ------
    TarsusError
        If the calibration is incomplete, the walk exceeds its limits, or a file can't be written.
    """
    from tarsus.hardware.pulses.gait_cycle import gait_cycle_header
    from tarsus.hardware.pulses.table import write_pulses

    write_pulses(calibration, motion.angles, folder / _TABLE, time=motion.time)
    cycle = _steady_cycle(motion, options)
    title = f"{motion.robot.name}, {motion.gait.name}: one cycle of {motion.cycle_time:.3f} s"
    header = folder / _HEADER
    try:
        header.write_text(gait_cycle_header(calibration, cycle, title=title), encoding="ascii")
    except OSError as error:
        raise InputError(f"{header} can't be written: {error.strerror}") from None
    return [folder / _TABLE, header]


def pose_pulses(solution: IKSolution, calibration: Path, folder: Path) -> tuple[Calibration, list[list[int]], Path]:
    """Write the commands of a pose as a table; return the calibration, the commands by leg and the path.

    Parameters
    ----------
    solution : IKSolution
        The pose.
    calibration : Path
        The calibration file.
    folder : Path
        Existing folder.

    Raises
    ------
    TarsusError
        If the calibration is wrong or incomplete, the pose exceeds its limits, or the file can't be written.
    """
    import numpy as np

    from tarsus.hardware.pulses.table import whole_commands, write_pulses

    found = calibration_of(solution.robot, calibration)
    angles = np.asarray(solution.angles)
    write_pulses(found, angles[None], folder / _TABLE, time=np.zeros(1))
    commands: list[list[int]] = whole_commands(found, angles).tolist()
    return found, commands, folder / _TABLE


def calibration_of(robot: Robot, path: Path) -> Calibration:
    """Return the calibration of a robot, which must be complete.

    Parameters
    ----------
    robot : Robot
        The robot.
    path : Path
        The calibration file.

    Raises
    ------
    CalibrationError
        If something in the file is wrong or missing.
    InputError
        If it is for another robot.
    """
    from tarsus.hardware.calibration.calibration import Calibration

    found = Calibration.load(path)
    if found.robot != robot:
        raise InputError(f"{path} is the calibration of {found.robot_file}, which is not the robot {robot.name!r}")
    found.require_complete()
    return found


def pulse_table(calibration: Calibration, commands: list[list[int]]) -> Table:
    """Return the commands of a pose as a table.

    Parameters
    ----------
    calibration : Calibration
        The calibration.
    commands : list of list of int
        Commands by leg.
    """
    from rich.table import Table

    from tarsus.robot.robot import JOINTS

    table = Table(box=None, pad_edge=False)
    table.add_column("leg")
    for joint in JOINTS:
        table.add_column(joint, justify="right")
    for leg, row in enumerate(commands):
        cells = (f"{command} {unit}" for command, unit in zip(row, calibration.units[leg], strict=True))
        table.add_row(calibration.robot.leg_names[leg], *cells)
    return table


def _steady_cycle(motion: Motion, options: dict[str, Any]) -> GaitCycle:
    """Return a cycle of the walk at constant speed; for a walk that is too short, of a longer walk of the same kind."""
    from tarsus.cli.planning import DISTANCE, plan
    from tarsus.hardware.pulses.gait_cycle import gait_cycle

    same: dict[str, Any] = {"cycle": motion.cycle_time, "speed": None}
    cycles = motion.duration / motion.cycle_time
    key, way = "distance", (DISTANCE if options["distance"] is None else options["distance"]) / cycles
    if options["twist"] is not None:
        key, way = "duration", motion.cycle_time
    elif options["curve"] is not None:
        key, way = "curve", options["curve"] / cycles
    if key != "duration":
        same["stroke"] = motion.stroke * 1000
    for number in _CYCLES:
        with contextlib.suppress(InputError):
            return gait_cycle(motion)
        motion = plan(motion.robot, {**options, **same, key: way * number})
    return gait_cycle(motion)
