"""Tables and keys of calibration files, as pydantic models."""

from __future__ import annotations

import datetime
from dataclasses import dataclass
from decimal import Decimal
from typing import Annotated, Any, TypeAlias

from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import CoreSchema, core_schema

from tarsus.hardware.calibration.bus_commands import BUS_COMMANDS
from tarsus.robot.fields import Choice, JointRange, Number, Numbers, Text, refuse
from tarsus.robot.schema import tidy_schema

__all__ = [
    "BusEntry",
    "CalibrationFile",
    "FootSwitchTable",
    "ImuTable",
    "JointTable",
    "LegEntry",
    "SensorTable",
    "SupplyTable",
    "calibration_schema",
]

_LARGEST = 100_000
Name: TypeAlias = Annotated[str, Text()]
PulseWidth: TypeAlias = Annotated[Decimal, Number(-_LARGEST, _LARGEST, "us")]
Ticks: TypeAlias = Annotated[Decimal, Number(-_LARGEST, _LARGEST, "ticks")]
PulseRange: TypeAlias = Annotated[tuple[Decimal, ...], Numbers(2, Number(0, _LARGEST, "us"))]
TickRange: TypeAlias = Annotated[tuple[Decimal, ...], Numbers(2, Number(-_LARGEST, _LARGEST, "ticks"))]
AngleRange: TypeAlias = Annotated[tuple[Decimal, ...], JointRange(2, Number(-180, 180, "deg"))]
Volts: TypeAlias = Annotated[Decimal, Number(0.1, 100, "V")]


@dataclass(frozen=True)
class Whole:
    """A whole number from `low` to `high`; `what` describes it in messages."""

    low: int
    high: int
    what: str

    def check(self, value: object) -> int:
        """Return the number."""
        if isinstance(value, Decimal) and value.is_finite() and value == value.to_integral_value():
            value = int(value)
        if isinstance(value, bool) or not isinstance(value, int) or not self.low <= value <= self.high:
            raise refuse(f"must be {self.what} from {self.low} to {self.high}")
        return value

    def __get_pydantic_core_schema__(self, source: object, handler: object) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)

    def __get_pydantic_json_schema__(self, schema: object, handler: object) -> dict[str, Any]:
        return {"type": "integer", "minimum": self.low, "maximum": self.high}


@dataclass(frozen=True)
class Direction:
    """1 or -1."""

    def check(self, value: object) -> int:
        """Return the direction."""
        if isinstance(value, bool) or value not in (1, -1):
            raise refuse("must be 1 or -1")
        return int(value)

    def __get_pydantic_core_schema__(self, source: object, handler: object) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)

    def __get_pydantic_json_schema__(self, schema: object, handler: object) -> dict[str, Any]:
        return {"enum": [1, -1]}


@dataclass(frozen=True)
class Date:
    """A date, as TOML writes it, or as text in JSON."""

    def check(self, value: object) -> datetime.date:
        """Return the date."""
        if isinstance(value, datetime.datetime):
            return value.date()
        if isinstance(value, datetime.date):
            return value
        try:
            return datetime.date.fromisoformat(str(value))
        except ValueError:
            raise refuse("must be a date such as 2026-05-31, without quotes") from None

    def __get_pydantic_core_schema__(self, source: object, handler: object) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)

    def __get_pydantic_json_schema__(self, schema: object, handler: object) -> dict[str, Any]:
        return {"type": "string", "format": "date"}


class Table(BaseModel):
    """A table of the file; unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class BusEntry(Table):
    """A servo bus, or a board that drives servos."""

    name: Name = Field(description="Name, to which joints refer.")
    kind: Annotated[str, Choice(tuple(BUS_COMMANDS))] = Field(description="What it is.")
    port: Annotated[str, Text(empty=True)] = Field(
        default="", description="Serial port or I2C device. Default: it is searched for."
    )
    baud: Annotated[int, Whole(300, 10_000_000, "a whole number of bits per second")] | None = Field(
        default=None, description="Bits per second. Default: that of the kind."
    )
    addresses: list[Annotated[int, Whole(0x40, 0x7F, "a whole number")]] | None = Field(
        default=None, description="Addresses of PCA9685 boards; channels 16 to 31 are those of the second."
    )


class JointTable(Table):
    """How a joint is driven: command = zero + direction * scale * angle. What is not known yet is left out."""

    bus: Name | None = Field(
        default=None, description="Name of its bus. Default: the only one, or the only one with such numbers."
    )
    id: Annotated[int, Whole(0, 253, "a whole number")] | None = Field(default=None, description="Id of the servo.")
    channel: Annotated[int, Whole(0, 255, "a whole number")] | None = Field(
        default=None, description="Channel of the board."
    )
    zero_us: PulseWidth | None = Field(default=None, description="Pulse width at a joint angle of 0 [us].")
    zero_ticks: Ticks | None = Field(default=None, description="Position at a joint angle of 0 [ticks].")
    direction: Annotated[int, Direction()] | None = Field(
        default=None, description="1 where a greater command is a greater joint angle, else -1."
    )
    us_per_deg: Annotated[Decimal, Number(0.01, 1000, "us/deg")] | None = Field(
        default=None, description="Change of the pulse width for a degree [us/deg]."
    )
    ticks_per_deg: Annotated[Decimal, Number(0.01, 10_000, "ticks/deg")] | None = Field(
        default=None, description="Change of the position for a degree [ticks/deg]."
    )
    limits_us: PulseRange | None = Field(default=None, description="Least and greatest pulse width [us].")
    limits_ticks: TickRange | None = Field(default=None, description="Least and greatest position [ticks].")
    soft_limits_deg: AngleRange | None = Field(
        default=None, description="Narrower limits of the joint angle on this machine [deg]."
    )


class LegEntry(Table):
    """The joints of a leg."""

    name: Name = Field(description="Name of the leg in the robot file.")
    coxa: JointTable | None = None
    femur: JointTable | None = None
    tibia: JointTable | None = None


class SupplyTable(Table):
    """The supply of the servos."""

    voltage_v: Volts = Field(description="Nominal voltage [V].")
    least_v: Volts = Field(description="Voltage below which the servos must not run [V].")
    greatest_current_a: Annotated[Decimal, Number(0.1, 1000, "A")] | None = Field(
        default=None, description="Current that it can deliver [A]."
    )


class FootSwitchTable(Table):
    """Inputs of the foot switches."""

    bus: Name | None = Field(
        default=None, description="Name of the bus whose board has them. Default: the first one with inputs."
    )
    inputs: list[Annotated[int, Whole(-1, 255, "a whole number")]] = Field(
        description="Input of each leg, in the robot's order; -1 for a leg without a switch."
    )
    closed: bool = Field(default=True, description="Value of an input whose foot is on the ground.")
    thresholds_v: list[Annotated[Decimal, Number(0, 5, "V")]] | None = Field(
        default=None,
        description="Voltage above which the input of each leg is high [V]. Default: half of the highest one.",
    )
    hysteresis_v: Annotated[Decimal, Number(0, 5, "V")] = Field(
        default=Decimal("0.2"), description="Distance of the voltages at which an input goes high and low [V]."
    )


class ImuTable(Table):
    """An inertial sensor that sends lines of text: roll, pitch and yaw [deg]."""

    port: Name = Field(description="Its serial port.")
    baud: Annotated[int, Whole(300, 10_000_000, "a whole number of bits per second")] = Field(
        default=115200, description="Bits per second."
    )
    rpy_deg: Annotated[tuple[Decimal, ...], Numbers(3, Number(-180, 180, "deg"))] = Field(
        default=(Decimal(0), Decimal(0), Decimal(0)), description="Roll, pitch and yaw of the sensor in the body [deg]."
    )


class SensorTable(Table):
    """Sensors beside the servos."""

    foot_switches: FootSwitchTable | None = None
    imu: ImuTable | None = None


class CalibrationFile(Table):
    """The servos of one machine for Tarsus: pulse widths in us or positions in ticks, angles in degrees."""

    name: Name = Field(description="Name of the machine.")
    robot: Name = Field(description="A preset, or the path of the robot file from the folder of this file.")
    date: Annotated[datetime.date, Date()] | None = Field(default=None, description="When it was calibrated.")
    buses: list[BusEntry] = Field(min_length=1, max_length=20, description="The servo buses or boards.")
    legs: list[LegEntry] = Field(default=[], max_length=100, description="The legs, by their names in the robot file.")
    supply: SupplyTable | None = None
    sensors: SensorTable = SensorTable()


def calibration_schema() -> dict[str, Any]:
    """Return the JSON schema of a calibration file, for editors that complete and check TOML."""
    schema: dict[str, Any] = tidy_schema(CalibrationFile.model_json_schema())
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "Tarsus calibration"}
