"""Findings of `tarsus robots check`: missing values, implausible values, and the gaits that are possible."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from typing import Any

from tarsus.errors import InputError, UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.stroke import max_stroke
from tarsus.kinematics.stance import default_body_height
from tarsus.plausibility.checks import plausibility_warnings
from tarsus.plausibility.gait_trials import NO_STROKE, GaitTrial, try_gaits
from tarsus.report.robot_summary import robot_summary
from tarsus.robot.estimates import MASS_KEYS, estimated_keys
from tarsus.robot.joint_limits import UNKNOWN_SPEED
from tarsus.robot.robot import Robot, masses_advice

__all__ = ["Check", "check_robot", "longest_stroke", "missing_values"]

Check = dict[str, Any]

# Speed limit of a joint whose servo's speed is unknown [deg/s].
_ASSUMED = math.degrees(UNKNOWN_SPEED)


def check_robot(robot: Robot) -> Check:
    """Check what a robot file lacks, which of its values are not plausible, and with which gaits the robot can walk.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Returns
    -------
    dict
        `problems`: why the robot can't walk with its own gait, empty if it can; `missing`: unknown values and their
        consequences; `estimated`: keys whose values are guesses; `warnings`: implausible values; `gaits`: a short walk
        with each gait; `longest_stroke_mm`: straight ahead with the robot's gait, or None.
    """
    trials = try_gaits(robot)
    own, problems = _own_gait(robot, trials)
    return {
        "robot": robot_summary(robot),
        "possible": not problems,
        "problems": problems,
        "missing": list(missing_values(robot)),
        "estimated": list(estimated_keys(robot)),
        "warnings": [
            {**dataclasses.asdict(warning), "text": warning.text()} for warning in plausibility_warnings(robot)
        ],
        "gaits": [_trial(trial) for trial in trials],
        "longest_stroke_mm": None if own is None else _milli(own.longest_stroke),
    }


def longest_stroke(robot: Robot) -> tuple[float | None, list[str]]:
    """Return the longest stroke straight ahead with the robot's own gait, and why there is none.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Returns
    -------
    longest : float or None
        Longest stroke [mm]; None if the gait or the stance is not possible.
    problems : list of str
        Why the robot can't walk; empty if it can.
    """
    try:
        longest = max_stroke(robot, Gait.named(robot.gait.name, legs=robot.legs))
    except (InputError, UnreachableError) as error:
        return None, [str(error)]
    return longest * 1000, [NO_STROKE] if longest == 0 else []


def _own_gait(robot: Robot, trials: tuple[GaitTrial, ...]) -> tuple[GaitTrial | None, list[str]]:
    """Return the trial of the robot's own gait, and why it fails; None as the trial where the gait does not exist."""
    possible = ", ".join(trial.gait for trial in trials if trial.possible)
    advice = f"set [gait] name to one that is possible: {possible}" if possible else "no gait is possible"
    try:
        name = Gait.named(robot.gait.name, legs=robot.legs).name
    except InputError as error:
        return None, [f"{error}; {advice}"]
    own = next(trial for trial in trials if trial.gait == name)
    problems = [f"{name} gait: {problem}" for problem in own.problems]
    return own, [*problems, advice] if problems else []


def _trial(trial: GaitTrial) -> dict[str, Any]:
    return {
        "gait": trial.gait,
        "possible": trial.possible,
        "problems": list(trial.problems),
        "longest_stroke_mm": _milli(trial.longest_stroke),
        "least_margin_mm": _milli(trial.least_margin),
    }


def _milli(length: float | None) -> float | None:
    return None if length is None else length * 1000


def missing_values(robot: Robot) -> Iterator[str]:
    """Yield the values that the robot file does not give, each with its consequence.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    unknown = [key for key, mass in zip(MASS_KEYS, (robot.body_mass, robot.link_mass), strict=True) if mass is None]
    if unknown:
        yield (
            f"{', '.join(unknown)}: without them there are no torques, and the stability margin is that of the "
            f"body's centre, with massless links; {masses_advice(robot)}"
        )
    if robot.body_size is None:
        yield "body.size_mm: without it, the body is the flat polygon of the coxa axes"
    servos = [servo for row in robot.servos for servo in row]
    if None in servos:
        yield f"leg.servo: without it, joint speeds are limited to {_ASSUMED:.0f} deg/s"
    slow = sorted({servo.name for servo in servos if servo is not None and servo.no_load_speed is None})
    for name in slow:
        yield f"no_load_rad_s of the servo {name}: without it, joint speeds are limited to {_ASSUMED:.0f} deg/s"
    if robot.gait.body_height is None:
        yield f"gait.body_height_mm: {default_body_height(robot) * 1000:.0f} mm is assumed, from the leg lengths"
    if robot.gait.swing_height is None:
        yield "gait.swing_height_mm: 1/4 of the body height is assumed"
