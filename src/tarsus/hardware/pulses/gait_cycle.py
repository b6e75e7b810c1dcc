"""One cycle of a walk as a table of commands for an Arduino sketch (`PROGMEM`)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.pulses.table import columns, whole_commands

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["GaitCycle", "gait_cycle", "gait_cycle_header"]

# Analogue servos take a command every 20 ms.
_RATE = 50.0
# A cycle repeats if its ends differ by less [rad].
_CLOSED = math.radians(0.2)


class GaitCycle(NamedTuple):
    """A cycle of steady walking.

    Attributes
    ----------
    frame : float
        Duration of a frame [s].
    angles : array, shape (frames, legs, 3)
        Joint angles [rad]; the first frame follows the last.
    """

    frame: float
    angles: Float[np.ndarray, "frames legs 3"]


def gait_cycle(motion: Motion, *, rate: float = _RATE) -> GaitCycle:
    """Return one cycle of a walk at constant speed, which can be repeated.

    Parameters
    ----------
    motion : Motion
        A walk.
    rate : float
        Approximate number of frames per second [1/s].

    Raises
    ------
    InputError
        If the walk has no whole cycle at constant speed.
    """
    cycle, time = motion.cycle_time, motion.time
    frames = max(2, round(cycle * rate))
    # The two cycles in the middle of the walk.
    start = motion.duration / 2 - cycle
    at = start + np.arange(2 * frames + 1) * (cycle / frames)
    flat = motion.angles.reshape(len(time), -1)
    both = np.stack([np.interp(at, time, column) for column in flat.T], axis=-1)
    first, second = both[: frames + 1], both[frames:]
    if start < 0 or np.abs(first - second).max() > _CLOSED:
        raise InputError(
            f"the walk takes {motion.duration:.2f} s, and has no two cycles of {cycle:.2f} s at constant speed in its "
            "middle; a longer one has"
        )
    return GaitCycle(cycle / frames, both[:frames].reshape(frames, motion.robot.legs, 3))


def gait_cycle_header(calibration: Calibration, cycle: GaitCycle, *, title: str) -> str:
    """Return a C header with the commands of a cycle, for AVR boards in flash memory.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.
    cycle : GaitCycle
        The cycle.
    title : str
        What it is.

    Raises
    ------
    InputError
        If an angle is beyond the limits of the calibration.
    CalibrationError
        If something is not known yet.
    """
    frames = len(cycle.angles)
    times = np.arange(frames) * cycle.frame
    commands = whole_commands(calibration, cycle.angles, times).reshape(frames, -1).tolist()
    joints = [joint for row in calibration.joints for joint in row]
    boards = [bus.name for bus in calibration.buses]
    units = sorted({unit for row in calibration.units for unit in row})
    lines = [
        f"// {title.encode('ascii', 'replace').decode()}",
        f"// {frames} frames of {len(joints)} servos in {' and '.join(units)}: {2 * frames * len(joints)} bytes.",
        f"// Columns: {', '.join(columns(calibration))}".encode("ascii", "replace").decode(),
        "#ifndef GAIT_CYCLE_H",
        "#define GAIT_CYCLE_H",
        "#include <stdint.h>",
        "#if defined(__AVR__)",
        "#include <avr/pgmspace.h>",
        "#elif !defined(PROGMEM)",
        "#define PROGMEM",
        "#endif",
        f"#define GAIT_FRAMES {frames}",
        f"#define GAIT_SERVOS {len(joints)}",
        f"#define GAIT_FRAME_US {round(cycle.frame * 1e6)}UL",
        f"static const uint8_t gait_numbers[GAIT_SERVOS] PROGMEM = {{{_row(joint.number for joint in joints)}}};",
    ]
    if len(boards) > 1:
        lines.append(f"// Boards: {', '.join(boards)}".encode("ascii", "replace").decode())
        at = _row(boards.index(joint.bus) for joint in joints)
        lines.append(f"static const uint8_t gait_boards[GAIT_SERVOS] PROGMEM = {{{at}}};")
    lines.append("static const uint16_t gait_cycle[GAIT_FRAMES][GAIT_SERVOS] PROGMEM = {")
    lines += [f"  {{{_row(row)}}}," for row in commands]
    return "\n".join([*lines, "};", "#endif", ""])


def _row(numbers: Iterable[int | None]) -> str:
    return ", ".join(str(number) for number in numbers)
