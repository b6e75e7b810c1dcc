"""A calibration as the tables and keys of its file."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

from tarsus.hardware.calibration.fields import CalibrationFields
from tarsus.hardware.calibration.parts import BusSettings
from tarsus.robot.robot import JOINTS
from tarsus.robot.units import degrees, per_degree, to_decimal

__all__ = ["decimal_document"]


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
