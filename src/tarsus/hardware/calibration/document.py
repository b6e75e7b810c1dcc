"""A calibration as the tables and keys of its file, and back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from decimal import Decimal
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from tarsus.errors import CalibrationError, RobotFileError, nearest_name
from tarsus.hardware.calibration.bus_commands import BUS_COMMANDS, BusCommands
from tarsus.hardware.calibration.contradictions import contradictions
from tarsus.hardware.calibration.fields import CalibrationFields
from tarsus.hardware.calibration.lines import Place, line_of
from tarsus.hardware.calibration.parts import BusSettings, FootSwitches, JointCalibration, Mounting, SupplySettings
from tarsus.hardware.calibration.schema import (
    BusEntry,
    CalibrationFile,
    FootSwitchTable,
    ImuTable,
    JointTable,
    LegEntry,
    SensorTable,
    SupplyTable,
)
from tarsus.robot.document_problems import Location, Wording, problem_lines
from tarsus.robot.file import load_robot
from tarsus.robot.preset_names import preset_names
from tarsus.robot.robot import JOINTS, Robot
from tarsus.robot.units import degrees, per_degree, per_radian, radians, to_decimal

__all__ = ["decimal_document", "fields_from_document"]

_TABLES: dict[str, type[BaseModel]] = {
    "": CalibrationFile,
    "buses": BusEntry,
    "legs": LegEntry,
    "supply": SupplyTable,
    "sensors": SensorTable,
    "foot_switches": FootSwitchTable,
    "imu": ImuTable,
    "coxa": JointTable,
    "femur": JointTable,
    "tibia": JointTable,
}


def fields_from_document(
    document: Mapping[str, Any],
    *,
    where: str,
    folder: Path,
    robot: Robot | None = None,
    lines: dict[Place, int] | None = None,
) -> CalibrationFields:
    """Return the values of a calibration from the keys of its file.

    Parameters
    ----------
    document : mapping
        The tables and keys.
    where : str
        Name of the document in messages.
    folder : Path
        Folder from which the path of the robot file is taken.
    robot : Robot, optional
        The robot; that of the file where left out.
    lines : dict, optional
        Lines of tables and keys, as from `key_lines`.

    Raises
    ------
    CalibrationError
        If something in it is wrong, or contradicts the robot; a line of the message for each problem.
    """
    known = lines or {}

    def position(place: Location) -> str:
        line = line_of(tuple(place), known)
        return "" if line is None else f" (line {line})"

    try:
        file = CalibrationFile.model_validate(document)
    except ValidationError as error:
        wording = Wording(table_of=_table_of, other_place=_other_place, position=position, whole="the calibration")
        raise CalibrationError(where, problem_lines(error, wording)) from None
    robot = _robot(file.robot, folder, where + position(("robot",))) if robot is None else robot
    entries, problems = _by_leg(file.legs, robot, position)
    joints, found = _joints(file, robot, entries, position)
    problems += found
    buses = tuple(
        BusSettings(
            name=entry.name, kind=entry.kind, port=entry.port, baud=entry.baud, addresses=tuple(entry.addresses or ())
        )
        for entry in file.buses
    )
    switches = _switches(file)
    if not problems:
        for each in contradictions(robot, buses, joints, switches, _supply(file.supply)):
            place = _in_file(each.place, entries)
            problems.append(f"{each.text}{position(place)}")
    if problems:
        raise CalibrationError(where, problems)
    return CalibrationFields(
        name=file.name,
        robot=robot,
        robot_file=file.robot,
        date=file.date,
        buses=buses,
        joints=joints,
        supply=_supply(file.supply),
        foot_switches=switches,
        imu=_imu(file.sensors.imu),
    )


def decimal_document(calibration: CalibrationFields) -> dict[str, Any]:
    """Return the tables and keys of a calibration; numbers are decimals that read back to the same bits.

    Parameters
    ----------
    calibration : CalibrationFields
        The calibration.
    """
    document: dict[str, Any] = {"name": calibration.name, "robot": calibration.robot_file}
    if calibration.date is not None:
        document["date"] = calibration.date
    document["buses"] = [_bus_table(bus) for bus in calibration.buses]
    if calibration.supply is not None:
        supply = calibration.supply
        values = {
            "voltage_v": supply.voltage,
            "least_v": supply.least_voltage,
            "greatest_current_a": supply.greatest_current,
        }
        document["supply"] = {key: to_decimal(value) for key, value in values.items() if value is not None}
    sensors = _sensor_table(calibration)
    if sensors:
        document["sensors"] = sensors
    document["legs"] = [
        {"name": calibration.robot.leg_names[leg]}
        | {name: _joint_table(calibration, leg, j) for j, name in enumerate(JOINTS)}
        for leg in range(calibration.robot.legs)
    ]
    return document


def _table_of(location: Location) -> type[BaseModel]:
    inside = [part for part in location[:-1] if isinstance(part, str)]
    return _TABLES[inside[-1] if inside else ""]


def _other_place(name: str, _table: type[BaseModel]) -> str:
    headers: dict[str, type[BaseModel]] = {
        "[[buses]]": BusEntry,
        "[supply]": SupplyTable,
        "the table of a joint": JointTable,
    }
    return " or ".join(header for header, table in headers.items() if name in table.model_fields and name != "name")


def _robot(name: str, folder: Path, where: str) -> Robot:
    try:
        return load_robot(name if name in preset_names() else folder / name)
    except RobotFileError as error:
        raise CalibrationError(where, [f"the robot file: {error}"]) from None


def _by_leg(legs: list[LegEntry], robot: Robot, position: Any) -> tuple[dict[int, int], list[str]]:
    """Return the number of each leg's entry by the number of the leg, and what is wrong with their names."""
    found: dict[int, int] = {}
    problems = []
    for number, entry in enumerate(legs):
        place = position(("legs", number, "name"))
        if entry.name not in robot.leg_names:
            nearest = nearest_name(entry.name, robot.leg_names)
            hint = f"did you mean {nearest!r}?" if nearest else f"there are: {', '.join(robot.leg_names)}"
            problems.append(f"legs[{number}].name = {entry.name!r}{place}: {robot.name!r} has no such leg; {hint}")
            continue
        leg = robot.leg_names.index(entry.name)
        if leg in found:
            problems.append(f"legs[{number}].name = {entry.name!r}{place}: that leg is there already")
        found[leg] = number
    return found, problems


def _joints(
    file: CalibrationFile, robot: Robot, entries: dict[int, int], position: Any
) -> tuple[tuple[tuple[JointCalibration, ...], ...], list[str]]:
    """Return the joints by leg, and what is wrong with their keys."""
    rows, problems = [], []
    for leg in range(robot.legs):
        row = []
        for name in JOINTS:
            entry = file.legs[entries[leg]] if leg in entries else None
            table = (entry and getattr(entry, name)) or JointTable()
            place = _in_file(("legs", leg, name), entries)
            try:
                row.append(_joint(table, file.buses))
            except ValueError as error:
                problems.append(f"{robot.leg_names[leg]} {name}{position(place)}: {error}")
                row.append(JointCalibration(bus=file.buses[0].name))
        rows.append(tuple(row))
    return tuple(rows), problems


def _in_file(place: Place, entries: dict[int, int]) -> Place:
    """Return a place with the number of the leg's entry for the number of the leg."""
    if place[0] == "legs" and isinstance(place[1], int) and place[1] in entries:
        return ("legs", entries[place[1]], *place[2:])
    return place


def _only_bus(buses: list[BusEntry], given: str | None, fits: Callable[[BusCommands], bool]) -> str:
    """Return the name of the bus that is given, or that of the only one that there is, or that fits."""
    if given is not None:
        return given
    fitting = [bus for bus in buses if bus.kind in BUS_COMMANDS and fits(BUS_COMMANDS[bus.kind])]
    if len(buses) > 1 and len(fitting) != 1:
        raise ValueError(f"bus: missing; there are {len(buses)}: {', '.join(bus.name for bus in buses)}")
    return fitting[0].name if len(buses) > 1 else buses[0].name


def _joint(table: JointTable, buses: list[BusEntry]) -> JointCalibration:
    """Return a joint; raise ValueError for keys that don't fit the bus."""
    pulses = any(getattr(table, key) is not None for key in ("channel", "zero_us", "us_per_deg", "limits_us"))
    name = _only_bus(buses, table.bus, lambda kind: (kind.unit == "us") == pulses)
    kind = next((BUS_COMMANDS[bus.kind] for bus in buses if bus.name == name), None)
    if kind is None:
        return JointCalibration(bus=name)
    unit, other = kind.unit, "ticks" if kind.unit == "us" else "us"
    wrong = [
        f"zero_{other}",
        f"{other}_per_deg",
        f"limits_{other}",
        "id" if kind.number_key == "channel" else "channel",
    ]
    right = [f"zero_{unit}", f"{unit}_per_deg", f"limits_{unit}", kind.number_key]
    for key, instead in zip(wrong, right, strict=True):
        if getattr(table, key) is not None:
            raise ValueError(f"{key} does not fit the bus {name!r} ({kind.text}); write {instead}")
    zero, scale, limits, number = (getattr(table, key) for key in right)
    soft = table.soft_limits_deg
    return JointCalibration(
        bus=name,
        number=number,
        zero=None if zero is None else float(zero),
        direction=table.direction,
        scale=None if scale is None else per_radian(scale),
        limits=None if limits is None else (float(limits[0]), float(limits[1])),
        soft_limits=None if soft is None else (radians(soft[0]), radians(soft[1])),
    )


def _supply(table: SupplyTable | None) -> SupplySettings | None:
    if table is None:
        return None
    current = table.greatest_current_a
    return SupplySettings(
        voltage=float(table.voltage_v),
        least_voltage=float(table.least_v),
        greatest_current=None if current is None else float(current),
    )


def _switches(file: CalibrationFile) -> FootSwitches | None:
    table = file.sensors.foot_switches
    if table is None:
        return None
    inputs = tuple(None if number < 0 else number for number in table.inputs)
    with_inputs = [bus.name for bus in file.buses if bus.kind in BUS_COMMANDS and BUS_COMMANDS[bus.kind].inputs]
    name = table.bus or (with_inputs or [file.buses[0].name])[0]
    thresholds = tuple(float(volts) for volts in table.thresholds_v or ())
    return FootSwitches(
        bus=name, inputs=inputs, closed=table.closed, thresholds=thresholds, hysteresis=float(table.hysteresis_v)
    )


def _imu(table: ImuTable | None) -> Mounting | None:
    if table is None:
        return None
    roll, pitch, yaw = (radians(angle) for angle in table.rpy_deg)
    return Mounting(port=table.port, baud=table.baud, rpy=(roll, pitch, yaw))


def _bus_table(bus: BusSettings) -> dict[str, Any]:
    table: dict[str, Any] = {"name": bus.name, "kind": bus.kind}
    if bus.port:
        table["port"] = bus.port
    if bus.baud is not None:
        table["baud"] = Decimal(bus.baud)
    if bus.addresses:
        table["addresses"] = [Decimal(address) for address in bus.addresses]
    return table


def _joint_table(calibration: CalibrationFields, leg: int, j: int) -> dict[str, Any]:
    joint, kind = calibration.joints[leg][j], calibration.kind(leg, j)
    table: dict[str, Any] = {"bus": joint.bus} if len(calibration.buses) > 1 else {}
    if joint.number is not None:
        table[kind.number_key] = Decimal(joint.number)
    if joint.zero is not None:
        table[f"zero_{kind.unit}"] = to_decimal(joint.zero)
    if joint.direction is not None:
        table["direction"] = Decimal(joint.direction)
    if joint.scale is not None:
        table[f"{kind.unit}_per_deg"] = per_degree(joint.scale)
    if joint.limits is not None:
        table[f"limits_{kind.unit}"] = [to_decimal(limit) for limit in joint.limits]
    if joint.soft_limits is not None:
        table["soft_limits_deg"] = [degrees(limit) for limit in joint.soft_limits]
    return table


def _sensor_table(calibration: CalibrationFields) -> dict[str, Any]:
    sensors: dict[str, Any] = {}
    switches, imu = calibration.foot_switches, calibration.imu
    if switches is not None:
        inputs = [Decimal(-1 if number is None else number) for number in switches.inputs]
        table: dict[str, Any] = {"bus": switches.bus} if len(calibration.buses) > 1 else {}
        table |= {"inputs": inputs} | ({} if switches.closed else {"closed": False})
        if switches.thresholds:
            table["thresholds_v"] = [to_decimal(volts) for volts in switches.thresholds]
            table["hysteresis_v"] = to_decimal(switches.hysteresis)
        sensors["foot_switches"] = table
    if imu is not None:
        sensors["imu"] = {
            "port": imu.port,
            "baud": Decimal(imu.baud),
            "rpy_deg": [degrees(angle) for angle in imu.rpy],
        }
    return sensors
