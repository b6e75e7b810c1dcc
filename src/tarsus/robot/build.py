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
from tarsus.robot.leg_words import end_in_name, side_in_name
from tarsus.robot.ring import ring
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
# Makes complex numbers of x and y.
_COMPLEX = np.array([1, 1j])


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
            name=file.gait.name if "name" in file.gait.model_fields_set else _usual_gait(len(legs)),
            body_height=_metre(file.gait.body_height_mm),
            swing_height=_metre(file.gait.swing_height_mm),
        ),
        sources=tuple(
            Source(of=tuple(entry.of), source=entry.source, confidence=entry.confidence, note=entry.note)
            for entry in file.sources
        ),
    )


def _usual_gait(legs: int) -> str:
    """Return the name of the gait for robots whose file names none."""
    return "creep" if legs == 4 else "wave" if legs % 2 else "tripod"


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
    extent = float(np.ptp(points, axis=0).max())
    if extent < _LEAST_DISTANCE_MM:
        return [
            (
                f"legs.position_mm: all coxa axes lie within {extent:.4g} mm of each other; two must be at least "
                f"{_LEAST_DISTANCE_MM:g} mm apart. Likely cause: these look like m instead of mm"
            )
        ]
    problems = []
    for i in range(len(points)):
        for j in range(i):
            if (distance := math.dist(points[i], points[j])) < _LEAST_DISTANCE_MM:
                place = f"[{', '.join(f'{x:g}' for x in points[i])}]"
                problems.append(
                    f"legs[{i}].position_mm = {place}: {distance:g} mm from legs[{j}], "
                    f'"{entries[j].name}"; it must be at least {_LEAST_DISTANCE_MM:g} mm. Likely cause: x or y of one '
                    "of the two has the wrong sign"
                )
    return problems or _out_of_order(entries, points)


# Other frames in which positions may have been typed: the matrix that turns them into x forward, y left, by rows, and
# the frame in words. The last two exchange the axes.
_FRAMES = (
    ((1, 0, 0, -1), "y points right; here y points left"),
    ((-1, 0, 0, 1), "x points backward; here x points forward"),
    ((0, 1, 1, 0), "x and y are exchanged; here x points forward and y left"),
    ((0, 1, -1, 0), "x points right and y forward; here x points forward and y left"),
)


def _out_of_order(entries: Sequence[LegEntry], points: Float[np.ndarray, "n 3"]) -> list[str]:
    plane = points[:, :2] - points[:, :2].mean(axis=0)
    yaw = np.array([radians(entry.yaw_deg) for entry in entries])
    directions = np.stack([np.cos(yaw), np.sin(yaw)], axis=-1)
    order = ring(plane @ _COMPLEX, directions @ _COMPLEX)
    if order == list(range(len(order))):
        return []
    expected = ", ".join(f'"{entries[i].name}"' for i in order)
    cause = _why_out_of_order([entry.name for entry in entries], plane, directions)
    return [f"legs: they must be listed counter-clockwise from the front left: {expected}{cause}"]


def _why_out_of_order(
    names: Sequence[str], plane: Float[np.ndarray, "n 2"], directions: Float[np.ndarray, "n 2"]
) -> str:
    """Return the likely cause of a wrong order: another frame, if the names fit it, or a clockwise list."""
    listed = list(range(len(names)))
    if not _names_fit(names, plane):
        for (xx, xy, yx, yy), words in _FRAMES:
            turn = np.array([[xx, yx], [xy, yy]])
            turned = plane @ turn
            if ring(turned @ _COMPLEX, directions @ turn @ _COMPLEX) == listed and _names_fit(names, turned):
                return f". Likely cause: {words}"
    order = ring(plane @ _COMPLEX, directions @ _COMPLEX)
    step = [(b - a) % len(order) for a, b in zip(order, [*order[1:], order[0]], strict=True)]
    if step.count(1) == len(order):
        return f'. Likely cause: the list does not start with "{names[order[0]]}"'
    if step.count(len(order) - 1) == len(order):
        return ". Likely cause: they are listed clockwise"
    misplaced = [names[leg] for at, leg in enumerate(order) if at != leg]
    if len(misplaced) == 2:
        return f'. Likely cause: "{misplaced[0]}" and "{misplaced[1]}" are exchanged'
    return ". Likely cause: they are listed side by side or by number, instead of around the body"


def _names_fit(names: Sequence[str], plane: Float[np.ndarray, "n 2"]) -> bool:
    """Return whether no leg is on another side or at another end than its name says."""
    said = np.array([(end_in_name(name), side_in_name(name)) for name in names])
    return bool((said * np.round(plane, 6) >= 0).all())


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
