"""A calibration from the tables and keys of its file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from tarsus.errors import CalibrationError, RobotFileError
from tarsus.hardware.calibration.bus_commands import BUS_COMMANDS
from tarsus.hardware.calibration.contradictions import contradictions
from tarsus.hardware.calibration.fields import CalibrationFields
from tarsus.hardware.calibration.joint_tables import entries_by_leg, joints_from_tables, place_in_file
from tarsus.hardware.calibration.lines import Place, line_of
from tarsus.hardware.calibration.parts import BusSettings, FootSwitches, Mounting, SupplySettings
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
from tarsus.robot.robot import Robot
from tarsus.robot.units import radians

__all__ = ["fields_from_document"]

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
    entries, problems = entries_by_leg(file.legs, robot, position)
    joints, found = joints_from_tables(file, robot, entries, position)
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
            place = place_in_file(each.place, entries)
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
