"""How fast a walk goes: stroke and cycle time, completed from what is given."""

from __future__ import annotations

import math

import numpy as np

from tarsus.errors import InputError, StrokeError
from tarsus.gait.path import BodyPath
from tarsus.gait.setup import Setup
from tarsus.gait.spacing import feet_distance
from tarsus.gait.stroke import longest_stroke, steady_solution, unit_twist

__all__ = ["choose_pace"]

_SHARE_OF_MAX_STROKE = 0.6
_SHARE_OF_SERVO_SPEED = 0.5
_CYCLE_TIME = 1.0
# Moments of a swing at which joint speeds are looked at, most in a cycle, and the step of their differences [cycles].
_MOMENTS_OF_SWING = 100
_MOST_MOMENTS = 2000
_DIFFERENCE = 1e-5


def choose_pace(
    setup: Setup,
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
    setup : Setup
        Robot and gait.
    path : Path
        Where the body goes.
    stroke, speed, cycle_time : float, optional
        What is given, see `plan_walk`; checked already.
    assumed : list of str
        Takes what had to be assumed.

    Raises
    ------
    InputError
        If all three are given and contradict each other.
    StrokeError
        If no stroke is given, and none works.
    """
    duty_factor = setup.gait.duty_factor
    if speed is None and path.duration is not None and (stroke is None or cycle_time is None):
        speed = float(path.travel(setup.rest).max()) / path.duration
    if stroke is None and speed is not None and cycle_time is not None:
        return speed * cycle_time * duty_factor, cycle_time
    if stroke is None:
        stroke = _usual_stroke(setup, path)
        assumed.append(f"stroke {stroke * 1000:.1f} mm: {_SHARE_OF_MAX_STROKE:g} of the longest that works")
    if speed is None:
        return stroke, _servo_cycle_time(setup, path, stroke, assumed) if cycle_time is None else cycle_time
    if cycle_time is None:
        return stroke, stroke / (speed * duty_factor)
    if not math.isclose(stroke, speed * cycle_time * duty_factor, rel_tol=1e-6):
        raise InputError(
            f"stroke {stroke:g} m, speed {speed:g} m/s and cycle time {cycle_time:g} s contradict each other: with "
            f"duty factor {duty_factor:.3f} the stroke would be {speed * cycle_time * duty_factor:.4f} m; "
            "leave one of the three out"
        )
    return stroke, cycle_time


def _usual_stroke(setup: Setup, path: BodyPath) -> float:
    stroke = _SHARE_OF_MAX_STROKE * longest_stroke(setup, path.displacement)
    if stroke == 0:
        raise StrokeError(_why_no_stroke(setup), 0.0)
    return stroke


def _why_no_stroke(setup: Setup) -> str:
    """Say why not even stepping on the spot works."""
    apart = float(feet_distance(setup.rest)[0])
    if apart < setup.foot_distance:
        return (
            f"even standing, two feet are {apart * 1000:.1f} mm apart; "
            f"at least {setup.foot_distance * 1000:.1f} mm are asked for"
        )
    solution = steady_solution(setup, np.zeros(3), np.arange(48) / 48)
    return f"even without a stroke a leg can't step on the spot: {solution.explain().splitlines()[0]}"


def _servo_cycle_time(setup: Setup, path: BodyPath, stroke: float, assumed: list[str]) -> float:
    """Return the cycle time at which no joint exceeds half its servo's speed, at least a second."""
    speeds = [[None if s is None else s.no_load_speed for s in leg] for leg in setup.robot.servos]
    if any(speed is None for leg in speeds for speed in leg):
        assumed.append(f"cycle time {_CYCLE_TIME:g} s: the robot file does not tell how fast every servo is")
        return _CYCLE_TIME
    count = min(math.ceil(_MOMENTS_OF_SWING / (1 - setup.gait.duty_factor)), _MOST_MOMENTS)
    phases = (np.arange(count)[:, None] / count + np.array([-0.5, 0.5]) * _DIFFERENCE).ravel()
    twist = unit_twist(setup.rest, path.displacement) * stroke
    solution = steady_solution(setup, twist, phases)
    if not solution.ok.all():
        return _CYCLE_TIME  # the walk can't be: where its joints would jump to says nothing of its pace
    angles = np.asarray(solution.angles).reshape(count, 2, setup.robot.legs, 3)
    per_cycle = np.abs(angles[:, 1] - angles[:, 0]).max(0) / _DIFFERENCE
    needed = float((per_cycle / np.array(speeds, dtype=float)).max()) / _SHARE_OF_SERVO_SPEED
    if needed > _CYCLE_TIME:
        assumed.append(f"cycle time {needed:.3f} s: no joint faster than half its servo's speed without load")
        return needed
    assumed.append(f"cycle time {_CYCLE_TIME:g} s")
    return _CYCLE_TIME
