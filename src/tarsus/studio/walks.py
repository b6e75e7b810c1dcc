"""Planning of walks from the options of the view Walk, and their messages."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.pace import choose_pace
from tarsus.gait.path import BodyPath, curved_path, straight_path, twist_path
from tarsus.gait.plan import plan_walk
from tarsus.gait.stroke import longest_stroke
from tarsus.gait.walk_setup import WalkSetup, require_number
from tarsus.kinematics.mass import centre_of_mass
from tarsus.report.walk_summary import walk_summary
from tarsus.robot.robot import JOINTS, Robot
from tarsus.studio.encoding import degrees, millimetres, or_null, rows_of_flags
from tarsus.studio.messages.motion import JointSpeed, TimedLength, WalkEnd, WalkMessage
from tarsus.studio.messages.state import Curve, OwnGait, Straight, WalkOptions

__all__ = ["MOST_SAMPLES", "fewer_for_more_legs", "gait_of", "longest", "path_of", "plan", "walk_message"]

MOST_SAMPLES = 10_000
"""Greatest number of samples of a plan for six legs; about 2 MB as a message."""

_USUAL_LEGS = 6


def gait_of(robot: Robot, asked: str | OwnGait | None, *, turning: float = 0.0) -> Gait:
    """Return the requested gait.

    Parameters
    ----------
    robot : Robot
        A single robot.
    asked : str, OwnGait or None
        A name, duty factor and offsets, or None for the default of the robot.
    turning : float
        Angle by which the walk turns [rad].

    Raises
    ------
    UnknownNameError
        If the gait does not exist.
    InputError
        If the gait does not fit the number of legs, or its values are out of range.
    """
    if isinstance(asked, OwnGait):
        return Gait(duty_factor=asked.duty_factor, offsets=asked.offsets)
    return Gait.named(asked or robot.gait.name, legs=robot.legs, turning=turning)


def path_of(options: WalkOptions) -> BodyPath:
    """Return the requested path.

    Parameters
    ----------
    options : WalkOptions
        Options of the walk.

    Raises
    ------
    InputError
        If its length is zero.
    """
    path = options.path
    if isinstance(path, Straight):
        return straight_path(path.distance_mm / 1000, math.radians(path.heading_deg))
    if isinstance(path, Curve):
        return curved_path(math.radians(path.angle_deg), (path.centre_mm[0] / 1000, path.centre_mm[1] / 1000))
    vx, vy = path.velocity_mm_s
    return twist_path(vx / 1000, vy / 1000, math.radians(path.turn_deg_s), path.duration_s)


@dataclass(frozen=True)
class _Options:
    """Options in SI units, named as the arguments of `plan_walk`."""

    pace: dict[str, float | None]
    heights: dict[str, Any]

    @classmethod
    def of(cls, options: WalkOptions) -> _Options:
        return cls(
            pace={
                "stroke": _metres(options.stroke_mm),
                "speed": _metres(options.speed_mm_s),
                "cycle_time": options.cycle_time_s,
            },
            heights={
                "body_height": _metres(options.body_height_mm),
                "swing_height": _metres(options.swing_height_mm),
                "foot_distance": _metres(options.foot_distance_mm),
                "body_tilt": (math.radians(options.roll_deg), math.radians(options.pitch_deg)),
            },
        )


def _metres(mm: float | None) -> float | None:
    return None if mm is None else mm / 1000


def _setup_of(robot: Robot, options: WalkOptions) -> WalkSetup:
    gait = gait_of(robot, options.gait, turning=path_of(options).angle)
    return WalkSetup.of(robot, gait, **_Options.of(options).heights)


def plan(robot: Robot, options: WalkOptions) -> Motion:
    """Return the requested walk, unless it is too long.

    Parameters
    ----------
    robot : Robot
        A single robot.
    options : WalkOptions
        Options of the walk.

    Raises
    ------
    InputError
        If the walk has too many samples.
    TarsusError
        If the walk is not possible.
    """
    asked, path, setup = _Options.of(options), path_of(options), _setup_of(robot, options)
    pace = {n: None if v is None else require_number(n, v, zero=False) for n, v in asked.pace.items()}
    # Stroke and cycle time are chosen here to check the number of samples before the planning.
    assumed = setup.assumed(asked.heights["body_height"], asked.heights["swing_height"])
    stroke, cycle_time = choose_pace(setup, path, **pace, assumed=assumed)
    _check_length(robot, setup, path, stroke=stroke, cycle_time=cycle_time, rate=options.rate_hz)
    motion = plan_walk(
        robot,
        setup.gait,
        path,
        stroke=stroke,
        cycle_time=cycle_time,
        rate=options.rate_hz,
        strict=options.strict,
        **asked.heights,
    )
    return replace(motion, assumed=tuple(assumed))


def fewer_for_more_legs(samples: int, robot: Robot) -> int:
    """Return the number of samples that costs as much as the given number for six legs.

    Parameters
    ----------
    samples : int
        Samples of a robot with six legs.
    robot : Robot
        A single robot.
    """
    return int(samples * min(1.0, (_USUAL_LEGS / robot.legs) ** 2))


def _check_length(
    robot: Robot, setup: WalkSetup, path: BodyPath, *, stroke: float, cycle_time: float, rate: float
) -> None:
    most = fewer_for_more_legs(MOST_SAMPLES, robot)
    travel = float(path.travel(setup.rest).max())
    seconds = (travel / stroke * setup.gait.duty_factor + 2) * cycle_time
    if not seconds * rate <= most:
        raise InputError(
            f"the walk takes about {seconds:.3g} s: {seconds * rate:.3g} samples at {rate:g} Hz; the studio "
            f"plans at most {most} samples for {robot.legs} legs: use a shorter walk or a lower rate"
        )


def longest(robot: Robot, options: WalkOptions) -> float:
    """Return the longest possible stroke along the requested path [m].

    Parameters
    ----------
    robot : Robot
        A single robot.
    options : WalkOptions
        Options of the walk.

    Raises
    ------
    TarsusError
        If the robot can't stand or walk with these options.
    """
    return longest_stroke(_setup_of(robot, options), path_of(options).displacement)


def walk_message(motion: Motion, *, longest: float | None, id: int) -> WalkMessage:
    """Return a motion with its summary.

    Parameters
    ----------
    motion : Motion
        The walk, with uniform sampling.
    longest : float or None
        Longest possible stroke along its path [m], if known.
    id : int
        Id of the message that is answered.
    """
    summary = walk_summary(motion)
    rpy = np.array(motion.body.rpy)
    rpy[:, 2] = np.unwrap(rpy[:, 2])
    com = np.asarray(motion.body @ np.asarray(centre_of_mass(motion.robot, motion.angles))[:, None, :])[:, 0]
    count = len(motion.time)
    return WalkMessage(
        type="walk",
        id=id,
        rate_hz=(count - 1) / motion.duration,
        count=count,
        position_mm=millimetres(motion.body.position),
        rpy_deg=degrees(rpy),
        angles_deg=degrees(motion.angles),
        contacts=rows_of_flags(motion.contacts),
        reach=rows_of_flags(motion.reach) if motion.reach.any() else None,
        margin_mm=[or_null(value) for value in np.round(motion.margin * 1000, 2).tolist()],
        com_mm=millimetres(com[:, :2]),
        gait=motion.gait.name,
        duty_factor=motion.gait.duty_factor,
        offsets=[float(offset) for offset in motion.gait.offsets],
        duration_s=motion.duration,
        cycle_time_s=motion.cycle_time,
        steps=motion.steps,
        stroke_mm=motion.stroke * 1000,
        speed_mm_s=motion.speed * 1000,
        body_height_mm=motion.body_height * 1000,
        swing_height_mm=motion.swing_height * 1000,
        longest_stroke_mm=None if longest is None else longest * 1000,
        end=WalkEnd(**{key: float(value) for key, value in summary["end"].items()}),
        joint_speed=[_joint_speed(joint, summary["joint_speed"][joint]) for joint in JOINTS],
        least_margin=_timed_length(summary["least_margin"]),
        nearest_feet=_timed_length(summary["nearest_feet"]),
        nearest_legs=summary["nearest_feet"]["legs"],
        possible=summary["possible"],
        problems=summary["problems"],
        assumed=summary["assumed"],
    )


def _timed_length(found: dict[str, Any]) -> TimedLength:
    return TimedLength(mm=or_null(found["mm"]), at_s=float(found["at_s"]))


def _joint_speed(joint: str, found: dict[str, Any]) -> JointSpeed:
    return JointSpeed(
        joint=joint,  # type: ignore[arg-type] # one of the three
        deg_s=float(found["deg_s"]),
        leg=found["leg"],
        servo=found["servo"],
        no_load_deg_s=found["no_load_deg_s"],
        no_load_fraction=None if found["no_load_deg_s"] is None else float(found["limit_fraction"]),
    )
