"""Planning of a walk from command line options, in millimetres and degrees."""

from __future__ import annotations

import math
from typing import Any

import click

from tarsus.errors import CollisionError, UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.path import BodyPath, curved_path, straight_path, twist_path
from tarsus.gait.plan import plan_walk
from tarsus.load.deflection import compensate_deflection
from tarsus.plausibility.checks import plausibility_warnings
from tarsus.robot.file import load_robot
from tarsus.robot.robot import Robot

__all__ = ["DISTANCE", "path_of", "plan", "with_changes"]

DISTANCE = 500.0
"""Distance of a straight walk by default [mm]."""

# Options that determine the path, with the options that depend on them.
_PATH_OPTIONS = {"distance": ("heading",), "curve": ("centre",), "twist": ("duration",)}
_LENGTHS = ("stroke", "speed", "body_height", "swing_height", "foot_distance")


def plan(name: str | Robot, options: dict[str, Any]) -> Motion:
    """Plan the walk given by the options.

    Parameters
    ----------
    name : str or Robot
        Name of the robot, path of its file, or the robot itself.
    options : dict
        Options of `tarsus walk`, None if not given.

    Raises
    ------
    UsageError
        If options contradict each other.
    TarsusError
        If the robot, the gait or the walk is not possible, or the stiffness of its joints is unknown and needed.
    """
    path = path_of(options)
    robot = name if isinstance(name, Robot) else load_robot(name)
    gait = Gait.named(options["gait"] or robot.gait.name, legs=robot.legs, turning=path.angle)
    tilt = options["tilt"] or (0.0, 0.0)
    lengths: dict[str, Any] = {key: None if options[key] is None else options[key] / 1000 for key in _LENGTHS}
    try:
        motion = plan_walk(
            robot,
            gait,
            path,
            cycle_time=options["cycle"],
            body_tilt=(math.radians(tilt[0]), math.radians(tilt[1])),
            stance_width=(options["stance_width"] or 0.0) / 1000,
            rate=options["rate"],
            **lengths,
        )
    except (UnreachableError, CollisionError) as error:
        if isinstance(name, str) and plausibility_warnings(robot):
            error.args = (f"{error}. The robot file has implausible values: see `tarsus robots check {name}`",)
        raise
    return compensate_deflection(motion) if options.get("compensate") else motion


def with_changes(options: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """Return the options with changes of a walk.

    Parameters
    ----------
    options : dict
        Options of `tarsus walk`, None if not given.
    changes : dict
        Options of a `WalkChange`.
    """
    changed: dict[str, Any] = {
        key: value.name if isinstance(value, Gait) else value * 1000 for key, value in changes.items()
    }
    changed["stance_width"] = (options["stance_width"] or 0.0) + changed.get("stance_width", 0.0)
    return {**options, **changed}


def path_of(options: dict[str, Any]) -> BodyPath:
    """Return the body path given by the options.

    Parameters
    ----------
    options : dict
        Options of `tarsus walk`, None if not given.

    Raises
    ------
    UsageError
        If options contradict each other.
    InputError
        If the path has no length.
    """
    kinds = [
        kind for kind, dependent in _PATH_OPTIONS.items() if any(options[key] is not None for key in (kind, *dependent))
    ]
    if len(kinds) > 1:
        raise click.UsageError(f"--{kinds[0]} and --{kinds[1]}, with their dependent options, exclude each other")
    if kinds == ["curve"]:
        if options["curve"] is None:
            raise click.UsageError("--centre needs --curve, the angle to walk around it")
        x, y = options["centre"] or (0.0, 0.0)
        return curved_path(math.radians(options["curve"]), (x / 1000, y / 1000))
    if kinds == ["twist"]:
        if options["twist"] is None or options["duration"] is None:
            raise click.UsageError("--twist and --duration must be given together")
        vx, vy, wz = options["twist"]
        return twist_path(vx / 1000, vy / 1000, math.radians(wz), options["duration"])
    distance = DISTANCE if options["distance"] is None else options["distance"]
    return straight_path(distance / 1000, math.radians(options["heading"] or 0.0))
