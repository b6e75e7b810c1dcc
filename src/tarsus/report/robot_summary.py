"""Numbers of a robot, as printed by `tarsus robots`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tarsus.errors import InputError, UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.stroke import max_stroke
from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.stance import default_body_height
from tarsus.robot.file import robot_to_dict
from tarsus.robot.robot import JOINTS, Robot, Source

__all__ = ["Check", "check_robot", "dimensions", "robot_summary"]

Check = dict[str, Any]

_SOURCE_FIELDS = ("source", "confidence", "note")


def robot_summary(robot: Robot) -> dict[str, Any]:
    """Return the main numbers of a robot, with units in the keys; None if unknown.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    servos = sorted({servo.name for row in robot.servos for servo in row if servo is not None})
    lengths = {f"{joint}_mm": (getattr(robot, joint) * 1000).tolist() for joint in JOINTS}
    return {
        "name": robot.name,
        "legs": robot.legs,
        **{key: values[0] if len(set(values)) == 1 else values for key, values in lengths.items()},
        "body_mm": None if robot.body_size is None else (np.asarray(robot.body_size) * 1000).tolist(),
        "mass_kg": float(total_mass(robot)) if robot.has_masses else None,
        "servos": servos,
        "gait": robot.gait.name,
        "body_height_mm": default_body_height(robot) * 1000,
    }


def dimensions(robot: Robot) -> list[dict[str, Any]]:
    """Return every number of a robot file with its source.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Returns
    -------
    list of dict
        In the order of the file: key, value, number of the source in the file (from 1), and the text, confidence and
        note of that source; None if the file names no source.
    """
    rows = []
    for key, source_keys, value in _keys(robot_to_dict(robot)):
        source = _source_of(source_keys, robot.sources)
        details = (
            dict.fromkeys(_SOURCE_FIELDS)
            if source is None
            else {name: getattr(source, name) for name in _SOURCE_FIELDS}
        )
        number = None if source is None else robot.sources.index(source) + 1
        rows.append({"key": key, "value": value, "source_number": number, **details})
    return rows


def _keys(document: dict[str, Any]) -> Iterator[tuple[str, tuple[str, ...], Any]]:
    """Yield the numbers of a robot file: key, the keys under which a source may list it, value."""
    for table in ("body", "leg", "gait"):
        for key, value in document.get(table, {}).items():
            yield f"{table}.{key}", (f"{table}.{key}", table), value
    for leg in document["legs"]:
        for key, value in leg.items():
            if key != "name":
                yield f"{leg['name']}: {key}", (f"legs.{key}", f"leg.{key}", "legs"), value


def _source_of(names: tuple[str, ...], sources: tuple[Source, ...]) -> Source | None:
    """Return the source of a key, by the first of its names that a source lists."""
    for name in names:
        for source in sources:
            if any(of == name or of.startswith(f"{name}.") for of in source.of if "." in name or of == name):
                return source
    return None


def check_robot(robot: Robot) -> Check:
    """Check what a robot file lacks, and whether the robot can walk.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Returns
    -------
    dict
        `problems`: why the robot can't walk, empty if it can; `missing`: unknown values and their consequences;
        `longest_stroke_mm`: straight ahead with the robot's gait, or None.
    """
    problems: list[str] = []
    longest = None
    try:
        longest = max_stroke(robot, Gait.named(robot.gait.name, legs=robot.legs)) * 1000
        if longest == 0:
            problems.append(
                "the longest stroke is 0: in the rest stance a leg can't be lifted, or two feet are too close"
            )
    except (InputError, UnreachableError) as error:
        problems.append(str(error))
    return {
        "robot": robot_summary(robot),
        "possible": not problems,
        "problems": problems,
        "missing": list(_missing(robot)),
        "longest_stroke_mm": longest,
    }


def _missing(robot: Robot) -> Iterator[str]:
    if robot.body_mass is None:
        yield "body.mass_kg: without it, no torques, and a stability margin of the body's centre"
    if robot.link_mass is None:
        yield "leg.mass_kg: without it, no torques, and massless links"
    if robot.body_size is None:
        yield "body.size_mm: without it, the body is the flat polygon of the coxa axes"
    servos = [servo for row in robot.servos for servo in row]
    if None in servos:
        yield "leg.servo: without it, no verdict on joint speeds"
    slow = sorted({servo.name for servo in servos if servo is not None and servo.no_load_speed is None})
    for name in slow:
        yield f"no_load_rad_s of the servo {name}: without it, no verdict on joint speeds"
    if robot.gait.body_height is None:
        yield f"gait.body_height_mm: {default_body_height(robot) * 1000:.0f} mm is assumed, from the leg lengths"
    if robot.gait.swing_height is None:
        yield "gait.swing_height_mm: 1/4 of the body height is assumed"
