"""Numbers of a robot, as printed by `tarsus robots`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.stance import default_body_height
from tarsus.robot.estimates import source_of
from tarsus.robot.file import robot_to_dict
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["dimensions", "robot_summary"]

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
        source = source_of(source_keys, robot.sources)
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
