"""Planning a walk: from a gait and a path to joint angles over time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.errors import CollisionError, InputError, StrokeError
from tarsus.gait.cycle import tilted_body
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.path import Path, carry
from tarsus.gait.stroke import (
    default_foot_distance,
    default_lift,
    feet_distance,
    max_stroke,
    steady_solution,
)
from tarsus.gait.swing import swing
from tarsus.gait.timing import BodyClock, plan_steps
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.stance import default_clearance, default_stance
from tarsus.robot.robot import Robot

__all__ = ["plan_walk"]

_SHARE_OF_MAX_STROKE = 0.6
_SHARE_OF_SERVO_SPEED = 0.5
_CYCLE_TIME = 1.0
# Steps shorter than this share of a stroke are not worth lifting a foot for.
_LEAST_STEP = 0.01
_MOST_SAMPLES = 2_000_000


@dataclass(frozen=True)
class _Request:
    """What a walk is to be like, complete: nothing left to be assumed but the pace."""

    robot: Robot
    gait: Gait
    path: Path
    rest: np.ndarray[Any, Any]
    clearance: float
    lift: float
    body_tilt: tuple[float, float]
    foot_distance: float

    @property
    def travel(self) -> float:
        """How far the foot that goes farthest goes past the body over the whole path [m]."""
        return float(self.path.travel(self.rest).max())

    def longest_stroke(self) -> float:
        return max_stroke(
            self.robot,
            self.gait,
            self.path.displacement,
            self.clearance,
            lift=self.lift,
            body_tilt=self.body_tilt,
            foot_distance=self.foot_distance,
        )


def plan_walk(  # noqa: PLR0913 - what a walk can be told is one list, all of it optional
    robot: Robot,
    gait: Gait,
    path: Path,
    *,
    stroke: float | None = None,
    speed: float | None = None,
    cycle_time: float | None = None,
    clearance: float | None = None,
    lift: float | None = None,
    body_tilt: Sequence[float] = (0.0, 0.0),
    foot_distance: float | None = None,
    rate: float = 100.0,
    strict: bool = True,
) -> Motion:
    """Plan a walk along a path, from standing to standing.

    Each leg has its clock; a foot that touches down at time `t` and stays for the stance time `Ts` is placed where the
    body has its rest foothold in the middle of the stance: ``T_ground_body(t + Ts / 2) @ rest``. The body starts and
    stops along smooth ramps of one cycle each. So strokes are symmetric about the rest footholds, a curved walk's
    are arcs about its centre, the path's distance and angle come out exactly, and the walk ends in the stance that
    it began in.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait
        Its gait.
    path : Path
        Where the body goes.
    stroke : float, optional
        How far the foot that goes farthest goes past the body in one stance [m]. Left out, it follows from speed
        and cycle time, or is 0.6 of the longest that works.
    speed : float, optional
        Speed of that foot past the body [m/s]: on a straight walk, the body's. Left out, it follows from stroke and
        cycle time, or from the path's duration.
    cycle_time : float, optional
        Duration of a cycle [s]. Left out, it follows from stroke and speed; where neither speed nor duration is
        given, it is 1 s, or longer where a joint would else exceed half its servo's no-load speed.
    clearance : float, optional
        Height of the body's origin over the ground [m]; the robot's own where left out.
    lift : float, optional
        Lift of the swinging feet [m]; the robot's own where left out.
    body_tilt : (roll, pitch)
        Tilt of the body against the ground while walking [rad].
    foot_distance : float, optional
        Least distance between two feet [m]; two foot radii and 10 mm where left out.
    rate : float
        Samples per second [1/s].
    strict : bool
        Whether a stroke out of the workspace, or feet too near to each other, are refused. If not, the motion comes
        with its reach codes and problems.

    Returns
    -------
    Motion
        Sampled at ``k / rate``, from the first lift-off until all feet stand.

    Raises
    ------
    InputError
        If an argument is not finite or out of its range, or stroke, speed and cycle time contradict each other.
    UnreachableError
        If a leg reaches the ground nowhere at that clearance.
    StrokeError
        If the stroke leaves the workspace; the message says which leg, and the longest stroke that works.
    CollisionError
        If two feet come nearer to each other than allowed.
    """
    if robot.batch_shape:
        raise InputError(f"plan_walk takes a single robot, not a batch {robot.batch_shape}")
    gait.require_legs(robot.legs)
    assumed = _defaults_taken(robot, clearance, lift)
    _check(stroke=stroke, speed=speed, cycle_time=cycle_time, rate=rate, foot_distance=foot_distance, lift=lift)
    clearance = default_clearance(robot) if clearance is None else clearance
    lift = default_lift(robot) if lift is None else lift
    request = _Request(
        robot=robot,
        gait=gait,
        path=path,
        rest=default_stance(robot, clearance, lift=lift) + np.array([0.0, 0.0, clearance]),
        clearance=float(clearance),
        lift=lift,
        body_tilt=_tilt(body_tilt),
        foot_distance=default_foot_distance(robot) if foot_distance is None else foot_distance,
    )
    stroke, cycle_time = _pace(request, stroke, speed, cycle_time, assumed)
    motion = _sample(request, stroke=stroke, cycle_time=cycle_time, rate=rate, assumed=tuple(assumed))
    if strict:
        _refuse(request, motion)
    return motion


def _defaults_taken(robot: Robot, clearance: float | None, lift: float | None) -> list[str]:
    """Say which heights neither the caller nor the robot file gives."""
    assumed = []
    if clearance is None and robot.gait.clearance is None:
        assumed.append(f"clearance {default_clearance(robot) * 1000:.0f} mm: from the lengths of femur and tibia")
    if lift is None and robot.gait.lift is None:
        assumed.append(f"lift {default_lift(robot) * 1000:.0f} mm: a quarter of the clearance")
    if not robot.has_masses:
        assumed.append(
            "the robot file gives no masses: the stability margin is that of the body's centre of mass, "
            "the links counted as massless"
        )
    return assumed


def _check(**values: float | None) -> None:
    for name, value in values.items():
        if value is not None and not 0 <= value < math.inf:
            raise InputError(f"{name} is {value}; it must be a finite number, not negative")
        if value == 0 and name not in ("lift", "foot_distance"):
            raise InputError(f"{name} is 0; it must be greater than 0")


def _tilt(body_tilt: Sequence[float]) -> tuple[float, float]:
    roll, pitch = (float(v) for v in body_tilt)
    if not (abs(roll) < math.pi / 2 and abs(pitch) < math.pi / 2):
        raise InputError(f"body_tilt is ({roll}, {pitch}) rad; roll and pitch must be between -pi/2 and pi/2")
    return roll, pitch


def _pace(
    request: _Request, stroke: float | None, speed: float | None, cycle_time: float | None, assumed: list[str]
) -> tuple[float, float]:
    """Complete stroke and cycle time from what is given."""
    duty = request.gait.duty
    if speed is None and request.path.duration is not None and (stroke is None or cycle_time is None):
        speed = request.travel / request.path.duration
    if stroke is None and speed is not None and cycle_time is not None:
        return speed * cycle_time * duty, cycle_time
    if stroke is None:
        stroke = _SHARE_OF_MAX_STROKE * request.longest_stroke()
        if stroke == 0:
            raise StrokeError(_why_no_stroke(request), 0.0)
        assumed.append(f"stroke {stroke * 1000:.1f} mm: {_SHARE_OF_MAX_STROKE:g} of the longest that works")
    if speed is None:
        return stroke, _servo_cycle_time(request, stroke, assumed) if cycle_time is None else cycle_time
    if cycle_time is None:
        return stroke, stroke / (speed * duty)
    if not math.isclose(stroke, speed * cycle_time * duty, rel_tol=1e-6):
        raise InputError(
            f"stroke {stroke} m, speed {speed} m/s and cycle time {cycle_time} s contradict each other: with duty "
            f"factor {duty:.3f} the stroke would be {speed * cycle_time * duty:.4f} m; leave one of the three out"
        )
    return stroke, cycle_time


def _servo_cycle_time(request: _Request, stroke: float, assumed: list[str]) -> float:
    """Return the cycle time at which no joint exceeds half its servo's speed, at least a second."""
    speeds = [[None if s is None else s.no_load_speed for s in leg] for leg in request.robot.servos]
    if any(speed is None for leg in speeds for speed in leg):
        assumed.append(f"cycle time {_CYCLE_TIME:g} s: the robot file does not tell how fast every servo is")
        return _CYCLE_TIME
    phases = np.arange(200) / 200
    twist = np.asarray(request.path.displacement) * (stroke / request.travel)
    _, solution = steady_solution(
        request.robot,
        request.gait,
        twist,
        clearance=request.clearance,
        lift=request.lift,
        body_tilt=request.body_tilt,
        phases=phases,
    )
    angles = np.asarray(solution.angles)
    per_cycle = np.abs(np.roll(angles, -1, axis=0) - np.roll(angles, 1, axis=0)).max(0) / (2 * phases[1])
    needed = float((per_cycle / np.array(speeds, dtype=float)).max()) / _SHARE_OF_SERVO_SPEED
    if needed > _CYCLE_TIME:
        assumed.append(f"cycle time {needed:.3f} s: no joint faster than half its servo's speed without load")
        return needed
    assumed.append(f"cycle time {_CYCLE_TIME:g} s")
    return _CYCLE_TIME


def _sample(request: _Request, *, stroke: float, cycle_time: float, rate: float, assumed: tuple[str, ...]) -> Motion:
    """Work out the motion at every sample."""
    speed = stroke / (request.gait.duty * cycle_time)
    clock = BodyClock.of(rate=speed / request.travel, ramp=cycle_time)
    least_step = _LEAST_STEP * stroke / request.travel
    steps = plan_steps(request.gait, clock, cycle_time=cycle_time, least_step=min(least_step, 0.25))
    # Rounding must not add a sample where the end falls on one.
    count = math.ceil((steps.end - steps.start) * rate - 1e-6) + 1
    if count > _MOST_SAMPLES:
        raise InputError(
            f"the walk takes {steps.end - steps.start:.0f} s: {count} samples at {rate:g} a second; "
            f"at most {_MOST_SAMPLES} are planned at once"
        )
    time = np.arange(count) / rate
    # After the last touchdown every leg stands; far behind it no rounding tells otherwise.
    moments = np.where(time >= steps.end - steps.start - 1e-9, steps.end + 2 * cycle_time, time + steps.start)
    last, following, swung, contacts = steps.at(moments)
    place = request.path.place(clock.share(moments))
    rest = request.rest
    start = carry(request.path.place(last), rest[:, None, :])[..., 0, :]
    end = carry(request.path.place(following), rest[:, None, :])[..., 0, :]
    feet = np.where(contacts[..., None], start, swing(start, end, swung, np.asarray(request.lift)))
    body = tilted_body(place, clearance=np.asarray(request.clearance), body_tilt=request.body_tilt)
    solution = inverse_kinematics(request.robot, feet, body)
    return Motion(
        robot=request.robot,
        gait=request.gait,
        time=time,
        body=body,
        feet=feet,
        contacts=contacts,
        angles=solution.angles,
        reach=solution.reach,
        cycle_time=cycle_time,
        stroke=stroke,
        speed=speed,
        clearance=request.clearance,
        lift=request.lift,
        foot_distance=request.foot_distance,
        assumed=assumed,
    )


def _refuse(request: _Request, motion: Motion) -> None:
    """Raise if the walk leaves the workspace or the feet come too near."""
    if (motion.reach != 0).any():
        longest = request.longest_stroke()
        advice = f"the longest stroke that works here is {longest * 1000:.1f} mm" if longest else "no stroke works here"
        reason = motion.problems[0]
        raise StrokeError(
            f"a stroke of {motion.stroke * 1000:.1f} mm is too long: {reason}. As planned, {advice}", longest
        )
    distance, pair = feet_distance(motion.feet)
    worst = int(np.argmin(distance))
    if distance[worst] < request.foot_distance - 1e-9:
        legs = " and ".join(request.robot.leg_codes[i] for i in pair[worst])
        raise CollisionError(
            f"the feet of {legs} come as near as {distance[worst] * 1000:.1f} mm at {motion.time[worst]:.2f} s; "
            f"at least {request.foot_distance * 1000:.1f} mm are asked for. A stroke of at most "
            f"{request.longest_stroke() * 1000:.1f} mm keeps them apart"
        )


def _why_no_stroke(request: _Request) -> str:
    """Say why not even standing in the rest stance works."""
    twist = np.zeros(3)
    feet, solution = steady_solution(
        request.robot,
        request.gait,
        twist,
        clearance=request.clearance,
        lift=request.lift,
        body_tilt=request.body_tilt,
        phases=np.arange(48) / 48,
    )
    if bool(np.all(solution.ok)):
        return (
            f"even standing, two feet are {float(feet_distance(feet)[0].min()) * 1000:.1f} mm apart; "
            f"at least {request.foot_distance * 1000:.1f} mm are asked for"
        )
    return f"even without a stroke a leg can't step on the spot: {solution.explain().splitlines()[0]}"
