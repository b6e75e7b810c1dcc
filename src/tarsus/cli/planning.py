"""From the options of `tarsus walk`, in millimetres and degrees, to a motion."""

from __future__ import annotations

import math
from typing import Any

import click

from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.path import BodyPath, curved_path, straight_path, twist_path
from tarsus.gait.plan import plan_walk
from tarsus.robot.file import load_robot

__all__ = ["path_of", "plan"]

_DISTANCE = 500.0
# Options that say where to, with those that go with them.
_WAYS = {"distance": ("heading",), "curve": ("centre",), "twist": ("duration",)}
_LENGTHS = ("stroke", "speed", "body_height", "swing_height", "foot_distance")


def plan(name: str, asked: dict[str, Any]) -> Motion:
    """Return the walk that the options ask for.

    Parameters
    ----------
    name : str
        The robot's name or file.
    asked : dict
        The options of `tarsus walk`, None where not given.

    Raises
    ------
    UsageError
        If options contradict each other.
    TarsusError
        If the robot, the gait or the walk is not possible.
    """
    path = path_of(asked)
    robot = load_robot(name)
    gait = Gait.named(asked["gait"] or robot.gait.name, legs=robot.legs)
    tilt = asked["tilt"] or (0.0, 0.0)
    lengths: dict[str, Any] = {key: None if asked[key] is None else asked[key] / 1000 for key in _LENGTHS}
    return plan_walk(
        robot,
        gait,
        path,
        cycle_time=asked["cycle"],
        body_tilt=(math.radians(tilt[0]), math.radians(tilt[1])),
        rate=asked["rate"],
        **lengths,
    )


def path_of(asked: dict[str, Any]) -> BodyPath:
    """Return the path that the options ask for.

    Parameters
    ----------
    asked : dict
        The options of `tarsus walk`, None where not given.

    Raises
    ------
    UsageError
        If options contradict each other.
    InputError
        If the path goes nowhere.
    """
    ways = [way for way, with_it in _WAYS.items() if any(asked[key] is not None for key in (way, *with_it))]
    if len(ways) > 1:
        raise click.UsageError(f"--{ways[0]} and --{ways[1]}, with what goes with each, exclude each other")
    if ways == ["curve"]:
        if asked["curve"] is None:
            raise click.UsageError("--centre needs --curve: by what angle to walk round it")
        x, y = asked["centre"] or (0.0, 0.0)
        return curved_path(math.radians(asked["curve"]), (x / 1000, y / 1000))
    if ways == ["twist"]:
        if asked["twist"] is None or asked["duration"] is None:
            raise click.UsageError("--twist and --duration go together")
        vx, vy, wz = asked["twist"]
        return twist_path(vx / 1000, vy / 1000, math.radians(wz), asked["duration"])
    distance = _DISTANCE if asked["distance"] is None else asked["distance"]
    return straight_path(distance / 1000, math.radians(asked["heading"] or 0.0))
