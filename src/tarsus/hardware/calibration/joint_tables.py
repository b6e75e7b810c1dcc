"""The joints of a calibration from the tables of its file."""

from __future__ import annotations

from collections.abc import Callable

from tarsus.errors import nearest_name
from tarsus.hardware.calibration.bus_commands import BUS_COMMANDS, BusCommands
from tarsus.hardware.calibration.lines import Place
from tarsus.hardware.calibration.parts import JointCalibration
from tarsus.hardware.calibration.schema import BusEntry, CalibrationFile, JointTable, LegEntry
from tarsus.robot.document_problems import Location
from tarsus.robot.robot import JOINTS, Robot
from tarsus.robot.units import per_radian, radians

__all__ = ["entries_by_leg", "joints_from_tables", "place_in_file"]


def entries_by_leg(
    legs: list[LegEntry], robot: Robot, position: Callable[[Location], str]
) -> tuple[dict[int, int], list[str]]:
    """Return the number of each leg's entry by the number of the leg, and what is wrong with their names.

    Parameters
    ----------
    legs : list of LegEntry
        The entries.
    robot : Robot
        The robot.
    position : callable
        Says in which line a place is.
    """
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


def joints_from_tables(
    file: CalibrationFile, robot: Robot, entries: dict[int, int], position: Callable[[Location], str]
) -> tuple[tuple[tuple[JointCalibration, ...], ...], list[str]]:
    """Return the joints by leg, and what is wrong with their keys.

    Parameters
    ----------
    file : CalibrationFile
        The file.
    robot : Robot
        The robot.
    entries : dict
        As from `entries_by_leg`.
    position : callable
        Says in which line a place is.
    """
    rows, problems = [], []
    for leg in range(robot.legs):
        row = []
        for name in JOINTS:
            entry = file.legs[entries[leg]] if leg in entries else None
            table = (entry and getattr(entry, name)) or JointTable()
            place = place_in_file(("legs", leg, name), entries)
            try:
                row.append(_joint(table, file.buses))
            except ValueError as error:
                problems.append(f"{robot.leg_names[leg]} {name}{position(place)}: {error}")
                row.append(JointCalibration(bus=file.buses[0].name))
        rows.append(tuple(row))
    return tuple(rows), problems


def place_in_file(place: Place, entries: dict[int, int]) -> Place:
    """Return a place with the number of the leg's entry for the number of the leg.

    Parameters
    ----------
    place : tuple
        Path to a key.
    entries : dict
        As from `entries_by_leg`.
    """
    if place[0] != "legs" or not isinstance(place[1], int):
        return place
    # For a leg without an entry, the place is the whole list of legs.
    return ("legs", entries[place[1]], *place[2:]) if place[1] in entries else ("legs",)


def _only_bus(buses: list[BusEntry], given: str | None, fits: Callable[[BusCommands], bool]) -> str:
    """Return the given name of a bus, or else the name of the only bus, or of the only one that fits."""
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
