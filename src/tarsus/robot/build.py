"""Builds the robot from a checked robot file: merges the keys of each leg, and checks relations between keys."""

from __future__ import annotations

import math
from collections.abc import Sequence
from decimal import Decimal
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from tarsus.errors import RobotFileError
from tarsus.robot.catalogue import load_servo, servo_of
from tarsus.robot.document_problems import key_of
from tarsus.robot.robot import JOINTS, GaitDefaults, Robot, Source
from tarsus.robot.schema import JointTable, Leg, LegEntry, RobotFile, ServoFigures
from tarsus.robot.servo import Servo
from tarsus.robot.units import from_milli, radians

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["build_robot"]

# The keys of a leg with the tables of its joints flattened: ``"limits_deg.coxa"``.
_Flat: TypeAlias = dict[str, Any]
_NEEDED = ("coxa_mm", "femur_mm", "tibia_mm", *(f"limits_deg.{joint}" for joint in JOINTS))
_MASSES = tuple(f"mass_kg.{joint}" for joint in JOINTS)
_LEAST_DISTANCE_MM = 1.0


def build_robot(file: RobotFile, *, where: str) -> Robot:
    """Build the robot of a checked file; refuse one that is incomplete or inconsistent."""
    shared = _flatten(file.leg)
    legs = [shared | _flatten(entry) for entry in file.legs]
    problems = [*_missing(legs), *_same_name(file.legs), *_places(file.legs)]
    if problems:
        raise RobotFileError(where, problems)
    return Robot(
        name=file.name,
        leg_names=tuple(entry.name for entry in file.legs),
        mount_position=[_metres(entry.position_mm) for entry in file.legs],
        mount_yaw=[radians(entry.yaw_deg) for entry in file.legs],
        **_leg_arrays(legs),
        **_body_arrays(file),
        servos=tuple(tuple(_servo(leg.get(f"servo.{joint}")) for joint in JOINTS) for leg in legs),
        gait=GaitDefaults(
            name=file.gait.name,
            body_height=_metre(file.gait.body_height_mm),
            swing_height=_metre(file.gait.swing_height_mm),
        ),
        sources=tuple(
            Source(of=tuple(entry.of), source=entry.source, confidence=entry.confidence, note=entry.note)
            for entry in file.sources
        ),
    )


def _flatten(keys: Leg) -> _Flat:
    """Return the keys of a leg with the tables of its joints flattened, to be merged joint by joint."""
    flat: _Flat = {}
    for key in Leg.model_fields:
        value = getattr(keys, key)
        if key == "servo" and not isinstance(value, JointTable):
            flat |= {f"{key}.{joint}": value for joint in JOINTS if value is not None}
        elif isinstance(value, JointTable):
            parts = {f"{key}.{joint}": getattr(value, joint) for joint in JOINTS}
            flat |= {name: part for name, part in parts.items() if part is not None}
        elif value is not None:
            flat[key] = value
    return flat


def _missing(legs: Sequence[_Flat]) -> list[str]:
    masses_known = any(key in leg for key in _MASSES for leg in legs)
    problems = []
    for key in (*_NEEDED, *(_MASSES if masses_known else ())):
        without = [i for i, leg in enumerate(legs) if key not in leg]
        hint = "give the masses of all links of all legs, or of none" if key in _MASSES else "every leg needs it"
        if len(without) == len(legs):
            problems.append(f"leg.{key}: missing; {hint}, in [leg] for all legs alike or in each [[legs]]")
        else:
            problems += [f"legs[{i}].{key}: missing; {hint}, here or in [leg]" for i in without]
    return problems


def _same_name(entries: Sequence[LegEntry]) -> list[str]:
    first: dict[str, int] = {}
    problems = []
    for i, entry in enumerate(entries):
        if entry.name in first:
            problems.append(
                f'{key_of(("legs", i, "name"))} = "{entry.name}": legs[{first[entry.name]}] has the same name'
            )
        first.setdefault(entry.name, i)
    return problems


def _places(entries: Sequence[LegEntry]) -> list[str]:
    """Refuse legs at the same position, and legs out of counter-clockwise order."""
    points = np.array([[float(x) for x in entry.position_mm] for entry in entries])
    problems = []
    for i in range(len(points)):
        for j in range(i):
            if (distance := math.dist(points[i], points[j])) < _LEAST_DISTANCE_MM:
                problems.append(
                    f"legs[{i}].position_mm = {points[i].tolist()}: {distance:g} mm from legs[{j}]; "
                    f"it must be at least {_LEAST_DISTANCE_MM:g} mm"
                )
    return problems or _out_of_order(entries, points)


def _out_of_order(entries: Sequence[LegEntry], points: Float[np.ndarray, "*#batch 3"]) -> list[str]:
    x, y, _ = (points - points.mean(axis=0)).T
    # Rounding puts a leg straight ahead first, whatever the sign of its y.
    angles = np.round(np.degrees(np.arctan2(y, x)), 9) % 360
    order = np.argsort(angles, kind="stable")
    if (order == np.arange(len(order))).all():
        return []
    expected = ", ".join(f'"{entries[i].name}"' for i in order)
    return [f"legs: they must be listed counter-clockwise from the front left: {expected}"]


def _leg_arrays(legs: Sequence[_Flat]) -> dict[str, Any]:
    offset = [leg.get("femur_axis_offset_mm", (Decimal(0), Decimal(0))) for leg in legs]
    arrays: dict[str, Any] = {
        "coxa": [from_milli(leg["coxa_mm"]) for leg in legs],
        "femur": [from_milli(leg["femur_mm"]) for leg in legs],
        "tibia": [from_milli(leg["tibia_mm"]) for leg in legs],
        "limits": [[[radians(a) for a in leg[f"limits_deg.{joint}"]] for joint in JOINTS] for leg in legs],
        "femur_axis_offset": [_metres(pair) for pair in offset],
        "foot_radius": [from_milli(leg.get("foot_radius_mm", Decimal(0))) for leg in legs],
        "link_com": [[_centre(leg, joint) for joint in JOINTS] for leg in legs],
    }
    if all(key in leg for key in _MASSES for leg in legs):
        arrays["link_mass"] = [[float(leg[key]) for key in _MASSES] for leg in legs]
    return arrays


def _centre(leg: _Flat, joint: str) -> float:
    given = leg.get(f"com_mm.{joint}")
    return from_milli(leg[f"{joint}_mm"]) / 2 if given is None else from_milli(given)


def _body_arrays(file: RobotFile) -> dict[str, Any]:
    body = file.body
    return {
        "body_mass": None if body.mass_kg is None else float(body.mass_kg),
        "body_com": None if body.com_mm is None else _metres(body.com_mm),
        "body_size": None if body.size_mm is None else _metres(body.size_mm),
    }


def _metre(length: Decimal | None) -> float | None:
    return None if length is None else from_milli(length)


def _metres(lengths: Sequence[Decimal]) -> list[float]:
    return [from_milli(length) for length in lengths]


def _servo(entry: str | ServoFigures | None) -> Servo | None:
    if isinstance(entry, ServoFigures):
        return servo_of(entry.model_dump())
    return None if entry is None else load_servo(entry)
