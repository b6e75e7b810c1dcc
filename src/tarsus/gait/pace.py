"""Pace of a walk: stroke and cycle time, derived from the arguments given."""

from __future__ import annotations

import math

import numpy as np

from tarsus.errors import InputError, StrokeError
from tarsus.gait.path import BodyPath
from tarsus.gait.spacing import feet_distance
from tarsus.gait.stroke import first_failure, longest_stroke, steady_solution, unit_twist
from tarsus.gait.walk_setup import WalkSetup
from tarsus.robot.joint_limits import joint_limits, servo_speeds

__all__ = ["choose_pace"]

_FRACTION_OF_MAX_STROKE = 0.6
_FRACTION_OF_SPEED_LIMIT = 0.5
_CYCLE_TIME = 1.0
# Samples of the joint speeds per swing, and at most per cycle; time step of their differences [cycles].
_SAMPLES_PER_SWING = 100
_MOST_SAMPLES = 2000
_DIFFERENCE = 1e-5


def choose_pace(
    setup: WalkSetup,
    path: BodyPath,
    *,
    stroke: float | None,
    speed: float | None,
    cycle_time: float | None,
    assumed: list[str],
) -> tuple[float, float]:
    """Return stroke [m] and cycle time [s].

    Parameters
    ----------
    setup : WalkSetup
        Robot and gait.
    path : BodyPath
        Path of the body.
    stroke, speed, cycle_time : float, optional
        Arguments of `plan_walk`, checked already.
    assumed : list of str
        Assumptions made here are appended.

    Raises
    ------
    InputError
        If all three are given and inconsistent.
    StrokeError
        If no stroke is given and none is possible.
    """
    duty_factor = setup.gait.duty_factor
    if speed is None and path.duration is not None and (stroke is None or cycle_time is None):
        speed = float(path.travel(setup.rest).max()) / path.duration
    if stroke is None and speed is not None and cycle_time is not None:
        return speed * cycle_time * duty_factor, cycle_time
    if stroke is None:
        stroke = _usual_stroke(setup, path)
        assumed.append(f"stroke {stroke * 1000:.1f} mm: {_FRACTION_OF_MAX_STROKE:g} of the longest possible")
    if speed is None:
        return stroke, _servo_cycle_time(setup, path, stroke, assumed) if cycle_time is None else cycle_time
    if cycle_time is None:
        return stroke, stroke / (speed * duty_factor)
    expected = speed * cycle_time * duty_factor
    if not math.isclose(stroke, expected, rel_tol=1e-6):
        raise InputError(
            f"stroke {stroke * 1000:g} mm, speed {speed * 1000:g} mm/s and cycle time {cycle_time:g} s are inconsistent"
            f": with duty factor {duty_factor:.3f} the stroke would be {expected * 1000:.1f} mm; "
            "omit one of the three"
        )
    return stroke, cycle_time


def _usual_stroke(setup: WalkSetup, path: BodyPath) -> float:
    stroke = _FRACTION_OF_MAX_STROKE * longest_stroke(setup, path.displacement)
    if stroke == 0:
        raise StrokeError(_why_no_stroke(setup), 0.0)
    return stroke


def _why_no_stroke(setup: WalkSetup) -> str:
    """Return why stepping on the spot is impossible."""
    distance = float(feet_distance(setup.rest)[0])
    if distance < setup.foot_distance:
        return (
            f"in the rest stance two feet are {distance * 1000:.1f} mm apart, "
            f"less than the required foot distance of {setup.foot_distance * 1000:.1f} mm"
        )
    solution = steady_solution(setup, np.zeros(3), np.arange(48) / 48)
    return f"stepping on the spot is impossible: {first_failure(solution)}"


def _servo_cycle_time(setup: WalkSetup, path: BodyPath, stroke: float, assumed: list[str]) -> float:
    """Return the cycle time at which no joint exceeds half its speed limit, at least 1 s."""
    count = min(math.ceil(_SAMPLES_PER_SWING / (1 - setup.gait.duty_factor)), _MOST_SAMPLES)
    phases = (np.arange(count)[:, None] / count + np.array([-0.5, 0.5]) * _DIFFERENCE).ravel()
    twist = unit_twist(setup.rest, path.displacement) * stroke
    solution = steady_solution(setup, twist, phases)
    if not solution.ok.all():
        return _CYCLE_TIME  # joint speeds of an impossible walk are meaningless
    angles = np.asarray(solution.angles).reshape(count, 2, setup.robot.legs, 3)
    per_cycle = np.abs(angles[:, 1] - angles[:, 0]).max(0) / _DIFFERENCE
    needed = float((per_cycle / joint_limits(setup.robot).speed).max()) / _FRACTION_OF_SPEED_LIMIT
    if needed > _CYCLE_TIME:
        known = all(speed is not None for leg in servo_speeds(setup.robot) for speed in leg)
        limit = "the no-load speed of its servo" if known else "its speed limit"
        assumed.append(f"cycle time {needed:.3f} s: no joint exceeds half {limit}")
        return needed
    assumed.append(f"cycle time {_CYCLE_TIME:g} s")
    return _CYCLE_TIME
