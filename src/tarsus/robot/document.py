"""Keys of a robot file for a robot: values that all legs share under `leg`, the others with each leg."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from decimal import Decimal
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from tarsus.errors import RobotFileError
from tarsus.robot.catalogue import figures_of, servo_catalogue
from tarsus.robot.robot import JOINTS, GaitDefaults, Robot, require_robot
from tarsus.robot.servo import Servo
from tarsus.robot.units import degrees, to_decimal, to_milli

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["decimal_document", "plain"]

_Flat: TypeAlias = dict[str, Any]


def decimal_document(robot: Robot) -> dict[str, Any]:
    """Return the tables and keys of the robot; numbers are decimals that read back to the same bits."""
    require_robot(robot)
    if robot.batch_shape:
        raise RobotFileError(
            f"robot {robot.name!r}",
            [f"a batch of designs {robot.batch_shape} can't be a robot file; choose one design with robot.item(...)"],
        )
    legs = [_leg(robot, i) for i in range(robot.legs)]
    shared = {key: value for key, value in legs[0].items() if all(_alike(leg.get(key), value) for leg in legs)}
    own = [{key: value for key, value in leg.items() if key not in shared} for leg in legs]
    entries = [_place(robot, i) | _gather(keys) for i, keys in enumerate(own)]
    tables = {
        "name": robot.name,
        "body": _body(robot),
        "leg": _gather(shared),
        "legs": entries,
        "gait": _gait(robot.gait),
        "sources": [_without_empty_note(vars(source) | {"of": list(source.of)}) for source in robot.sources],
    }
    return {key: table for key, table in tables.items() if table not in ({}, [])}


def plain(value: Any) -> Any:
    """Return a document with its decimals as ints and floats."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain(item) for item in value]
    if not isinstance(value, Decimal):
        return value
    whole = value == value.to_integral_value() and not (value.is_zero() and value.is_signed())
    return int(value) if whole else float(value)


def _leg(robot: Robot, i: int) -> _Flat:
    """Return the keys of a leg with the tables of its joints flattened."""
    flat: _Flat = {
        "coxa_mm": to_milli(_floats(robot.coxa)[i]),
        "femur_mm": to_milli(_floats(robot.femur)[i]),
        "tibia_mm": to_milli(_floats(robot.tibia)[i]),
    }
    offset, radius = _floats(robot.femur_axis_offset), _floats(robot.foot_radius)
    if not _all_zero(offset):
        flat["femur_axis_offset_mm"] = _list(to_milli, offset[i])
    if robot.link_mass is not None:
        flat |= {f"mass_kg.{joint}": to_decimal(_floats(robot.link_mass)[i, j]) for j, joint in enumerate(JOINTS)}
    flat |= _centres(robot, i)
    limits = _floats(robot.limits)[i]
    flat |= {f"limits_deg.{joint}": _list(degrees, limits[j]) for j, joint in enumerate(JOINTS)}
    servos = zip(JOINTS, robot.servos[i], strict=True)
    flat |= {f"servo.{joint}": _servo(servo) for joint, servo in servos if servo is not None}
    if not _all_zero(radius):
        flat["foot_radius_mm"] = to_milli(radius[i])
    return flat


def _centres(robot: Robot, i: int) -> _Flat:
    """Return the centres of mass of the links, except those at the middle, which is the default."""
    centres = {}
    for joint, centre in zip(JOINTS, _floats(robot.link_com)[i], strict=True):
        if not _alike(centre, _floats(getattr(robot, joint))[i] / 2):
            centres[f"com_mm.{joint}"] = to_milli(centre)
    return centres


def _gather(flat: _Flat) -> dict[str, Any]:
    """Return flattened keys as tables; the same servo in all three joints is not a table."""
    tables: dict[str, Any] = {}
    for key, value in flat.items():
        name, _, joint = key.partition(".")
        if joint:
            tables.setdefault(name, {})[joint] = value
        else:
            tables[name] = value
    servos = tables.get("servo", {})
    if len(servos) == len(JOINTS) and all(_alike(servo, servos["coxa"]) for servo in servos.values()):
        tables["servo"] = servos["coxa"]
    return tables


def _place(robot: Robot, i: int) -> dict[str, Any]:
    return {
        "name": robot.leg_names[i],
        "position_mm": _list(to_milli, _floats(robot.mount_position)[i]),
        "yaw_deg": degrees(float(_floats(robot.mount_yaw)[i])),
    }


def _body(robot: Robot) -> dict[str, Any]:
    body: dict[str, Any] = {}
    if robot.body_mass is not None:
        body["mass_kg"] = to_decimal(float(_floats(robot.body_mass)))
    if not _all_zero(_floats(robot.body_com)):
        body["com_mm"] = _list(to_milli, _floats(robot.body_com))
    if robot.body_size is not None:
        body["size_mm"] = _list(to_milli, _floats(robot.body_size))
    return body


def _gait(gait: GaitDefaults) -> dict[str, Any]:
    table: dict[str, Any] = {"name": gait.name}
    if gait.body_height is not None:
        table["body_height_mm"] = to_milli(gait.body_height)
    if gait.swing_height is not None:
        table["swing_height_mm"] = to_milli(gait.swing_height)
    return table


def _without_empty_note(source: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in source.items() if key != "note" or value}


def _servo(servo: Servo) -> str | dict[str, Any]:
    """Return the name of a servo whose data equal those of the catalogue, else its data."""
    return servo.name if servo_catalogue().get(servo.name) == servo else figures_of(servo)


def _alike(a: object, b: object) -> bool:
    # As text: -0.0 equals 0.0, but is another double.
    return repr(a) == repr(b)


def _all_zero(values: Float[np.ndarray, "..."]) -> bool:
    return not values.any() and not np.signbit(values).any()


def _floats(values: object) -> Float[np.ndarray, "..."]:
    return np.asarray(values, dtype=np.float64)


def _list(convert: Callable[[float], Decimal], values: Iterable[float]) -> list[Decimal]:
    return [convert(float(value)) for value in values]
