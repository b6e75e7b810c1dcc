"""Joint angles as whole commands of the servos, and tables of them."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.storage import write_table
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["columns", "whole_commands", "write_pulses"]

# Angles at a limit may exceed it by the rounding of a conversion [rad].
_ROUNDING = 1e-6


def whole_commands(
    calibration: Calibration,
    angles: Float[np.ndarray, "*batch legs 3"],
    time: Float[np.ndarray, "*batch"] | None = None,
) -> Int[np.ndarray, "*batch legs 3"]:
    """Return the commands of joint angles as whole numbers within the limits.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    time : array, shape (...), optional
        Their times, for messages [s].

    Raises
    ------
    InputError
        If an angle is beyond the limits of the calibration, or not finite; the message names the joint and the time.
    CalibrationError
        If something is not known yet.
    """
    limits = calibration.limits
    excess = np.maximum(limits[..., 0] - angles, angles - limits[..., 1])
    wrong = ~(excess <= _ROUNDING)
    if wrong.any():
        worst = np.unravel_index(
            int(np.argmax(np.where(wrong, np.nan_to_num(excess, nan=np.inf), -np.inf))), wrong.shape
        )
        *at, leg, joint = (int(index) for index in worst)
        when = "" if time is None else f"at {float(time[tuple(at)]):.2f} s "
        low, high = np.degrees(limits[leg, joint])
        raise InputError(
            f"{when}the {calibration.joint_name(leg, joint)} is at {math.degrees(angles[worst]):.1f} deg; the "
            f"calibration allows {low:.1f} to {high:.1f} deg. Plan with these as limits_deg of the robot, or check "
            "zero, direction and limits of this servo"
        )
    low, high = np.ceil(calibration.command_limits[..., 0]), np.floor(calibration.command_limits[..., 1])
    return np.asarray(np.clip(np.rint(calibration.commands(angles)), low, high)).astype(int)


def columns(calibration: Calibration) -> list[str]:
    """Return the names of the joints' columns: ``LF_coxa_us``.

    Parameters
    ----------
    calibration : Calibration
        The calibration.
    """
    codes = [code.replace(" ", "_") for code in calibration.robot.leg_codes]
    return [
        f"{code}_{joint}_{calibration.units[leg][j]}"
        for leg, code in enumerate(codes)
        for j, joint in enumerate(JOINTS)
    ]


def write_pulses(
    calibration: Calibration,
    angles: Float[np.ndarray, "n legs 3"],
    path: str | os.PathLike[str],
    *,
    time: Sequence[float] | Float[np.ndarray, "n"],
) -> None:
    """Write the commands of joint angles as a table (CSV): a row for each time, a column for each servo.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.
    angles : array, shape (n, legs, 3)
        Joint angles [rad].
    path : path
        Where to write it.
    time : array, shape (n,)
        Times [s].

    Raises
    ------
    InputError
        If an angle is beyond the limits of the calibration, or the file can't be written.
    CalibrationError
        If something is not known yet.
    """
    times = np.asarray(time, dtype=float)
    commands = whole_commands(calibration, angles, times).reshape(len(times), -1)
    rows = ([f"{t:.4f}", *map(str, row)] for t, row in zip(times.tolist(), commands.tolist(), strict=True))
    write_table(path, ["time_s", *columns(calibration)], rows)
