"""Tables and keys of robot files, as pydantic models."""

from __future__ import annotations

from decimal import Decimal
from typing import Annotated, Any, TypeAlias

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, model_validator

from tarsus.robot.fields import REFUSED, Choice, JointRange, Number, Numbers, ServoName, Text, refuse

__all__ = [
    "GAIT_NAMES",
    "JOINTS_TAG",
    "TAGS",
    "Body",
    "Gait",
    "JointServos",
    "JointTable",
    "Leg",
    "LegEntry",
    "RobotFile",
    "ServoFigures",
    "SourceEntry",
    "robot_schema",
    "tidy_schema",
]

GAIT_NAMES = ("tripod", "tetrapod", "amble", "ripple", "wave", "creep")
"""Names that `[gait] name` may have."""

# Lengths below 1 um and masses below 1 mg are typing errors, and would lose digits in SI units.
Length: TypeAlias = Annotated[Decimal, Number(0.001, 10_000, "mm")]
LengthOrZero: TypeAlias = Annotated[Decimal, Number(0, 10_000, "mm")]
Coordinate: TypeAlias = Annotated[Decimal, Number(-10_000, 10_000, "mm")]
Point: TypeAlias = Annotated[tuple[Decimal, ...], Numbers(3, Number(-10_000, 10_000, "mm"))]
Offset: TypeAlias = Annotated[tuple[Decimal, ...], Numbers(2, Number(-10_000, 10_000, "mm"))]
Size: TypeAlias = Annotated[tuple[Decimal, ...], Numbers(3, Number(0.001, 10_000, "mm"))]
Range: TypeAlias = Annotated[tuple[Decimal, ...], JointRange(2, Number(-180, 180, "deg"))]
Mass: TypeAlias = Annotated[Decimal, Number(0.000001, 10_000, "kg")]
MassOrZero: TypeAlias = Annotated[Decimal, Number(0, 10_000, "kg")]
Volts: TypeAlias = Annotated[Decimal, Number(0, 1000, "V")]
Torque: TypeAlias = Annotated[Decimal, Number(0, 10_000, "N m")]
# Loads and servo models divide by these two, which an unknown value leaves empty.
StallTorque: TypeAlias = Annotated[Decimal, Number(0.0001, 10_000, "N m")]
Speed: TypeAlias = Annotated[Decimal, Number(0.001, 10_000, "rad/s")]
Name: TypeAlias = Annotated[str, Text()]
Label: TypeAlias = Annotated[str, Text(label=True)]
Remark: TypeAlias = Annotated[str, Text(empty=True)]


class Table(BaseModel):
    """A table of the file; unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class JointTable(Table):
    """A table with one entry for each joint."""


class JointMasses(JointTable):
    """Masses of the links, servos included [kg]. Give all three, or omit the table where they are unknown."""

    coxa: MassOrZero | None = None
    femur: MassOrZero | None = None
    tibia: MassOrZero | None = None


class JointCentres(JointTable):
    """Centres of mass of the links, along the link from its inner joint [mm]. Default: the middle."""

    coxa: Coordinate | None = None
    femur: Coordinate | None = None
    tibia: Coordinate | None = None


class JointLimits(JointTable):
    """Lower and upper limit of each joint [deg].

    At zero the leg is straight and level. Coxa positive: counter-clockwise seen from above. Femur and tibia positive:
    the foot moves up. A standing leg, knee up, has a positive femur and a negative tibia angle.
    """

    coxa: Range | None = None
    femur: Range | None = None
    tibia: Range | None = None


class ServoFigures(Table):
    """Data of a servo that is not in the catalogue."""

    name: Name = Field(description="Name of the model.")
    stall_torque_nm: StallTorque = Field(description="Stall torque [N m]; kg.cm times 0.0980665.")
    torque_at_v: Volts | None = Field(default=None, description="Supply voltage of the stall torque [V].")
    rated_torque_nm: Torque | None = Field(default=None, description="Rated continuous torque [N m].")
    no_load_rad_s: Speed | None = Field(
        default=None, description="No-load speed [rad/s]; 1.047 divided by the seconds for 60 deg."
    )
    speed_at_v: Volts | None = Field(default=None, description="Supply voltage of the no-load speed [V].")
    stall_current_a: Annotated[Decimal, Number(0, 1000, "A")] | None = Field(
        default=None, description="Stall current [A]."
    )
    mass_g: Annotated[Decimal, Number(0, 100_000, "g")] | None = Field(default=None, description="Mass [g].")
    supply_min_v: Volts | None = Field(default=None, description="Least supply voltage [V]; requires supply_max_v.")
    supply_max_v: Volts | None = Field(default=None, description="Greatest supply voltage [V]; requires supply_min_v.")
    travel_deg: Annotated[Decimal, Number(0, 36_000, "deg")] | None = Field(
        default=None, description="Range of the output shaft [deg]."
    )
    maker: Remark = Field(default="", description="Manufacturer.")
    control: Remark = Field(default="", description="Command interface.")
    gear: Remark = Field(default="", description="Gear material.")
    feedback: Remark = Field(default="", description="Feedback.")
    confidence: Remark = Field(default="", description="Confidence of the data.")
    source: Remark = Field(default="", description="Source of the data.")
    note: Remark = Field(default="", description="Remarks.")

    @model_validator(mode="after")
    def _supply_has_two_ends(self) -> ServoFigures:
        lowest, highest = self.supply_min_v, self.supply_max_v
        if (lowest is None) != (highest is None):
            raise refuse("supply_min_v and supply_max_v: give both or neither")
        if lowest is not None and highest is not None and lowest > highest:
            raise refuse(f"supply_min_v is {lowest} V, greater than supply_max_v, {highest} V")
        return self


# Tags of the kinds of servo entries; pydantic inserts them into the paths of its errors.
JOINTS_TAG, _FIGURES_TAG, _NAME_TAG = TAGS = ("(joints)", "(figures)", "(name)")


def _kind_of_one(value: object) -> str | None:
    if isinstance(value, str):
        return _NAME_TAG
    return _FIGURES_TAG if isinstance(value, dict) else None


def _kind_of_any(value: object) -> str | None:
    if isinstance(value, dict) and value.keys() & {"coxa", "femur", "tibia"}:
        return JOINTS_TAG
    return _kind_of_one(value)


OneServo: TypeAlias = Annotated[
    Annotated[str, ServoName(), Tag(_NAME_TAG)] | Annotated[ServoFigures, Tag(_FIGURES_TAG)],
    Discriminator(
        _kind_of_one,
        custom_error_type=REFUSED,
        custom_error_message="must be the name of a servo, or a table with the data of the servo",
    ),
]


class JointServos(JointTable):
    """The servo of each joint: a name in the catalogue, or a table with the data of the servo."""

    coxa: OneServo | None = None
    femur: OneServo | None = None
    tibia: OneServo | None = None


AnyServo: TypeAlias = Annotated[
    Annotated[str, ServoName(), Tag(_NAME_TAG)]
    | Annotated[ServoFigures, Tag(_FIGURES_TAG)]
    | Annotated[JointServos, Tag(JOINTS_TAG)],
    Discriminator(
        _kind_of_any,
        custom_error_type=REFUSED,
        custom_error_message=(
            "must be the name of a servo, a table { coxa = ..., femur = ..., tibia = ... }, "
            "or a table with the data of the servo"
        ),
    ),
]


class Leg(Table):
    """Values shared by all legs."""

    coxa_mm: LengthOrZero | None = Field(default=None, description="Coxa axis to femur axis, outward [mm].")
    femur_mm: Length | None = Field(default=None, description="Femur axis to knee [mm].")
    tibia_mm: Length | None = Field(default=None, description="Knee to foot [mm].")
    femur_axis_offset_mm: Offset | None = Field(
        default=None,
        description="Offset of the femur axis from the coxa axis: [sideways, vertical] [mm].",
    )
    mass_kg: JointMasses | None = None
    com_mm: JointCentres | None = None
    limits_deg: JointLimits | None = None
    servo: AnyServo | None = Field(
        default=None,
        description="A servo of the catalogue, one for each joint, or a table with the data of the servo.",
    )
    foot_radius_mm: LengthOrZero | None = Field(default=None, description="Radius of the spherical foot [mm].")


class LegEntry(Leg):
    """One leg: its name and position, and values that differ from [leg]."""

    name: Label = Field(description="Name of the leg, such as front left.")
    position_mm: Point = Field(description="Position of the coxa axis: x forward, y left, z up [mm].")
    yaw_deg: Annotated[Decimal, Number(-360, 360, "deg")] = Field(
        description="Direction of the leg: 0 is forward, 90 is left [deg]."
    )


class Body(Table):
    """The body, without the legs."""

    mass_kg: Mass | None = Field(default=None, description="Mass, including battery and electronics [kg].")
    com_mm: Point | None = Field(default=None, description="Centre of mass: x forward, y left, z up [mm].")
    size_mm: Size | None = Field(
        default=None,
        description="Length, width and height of its box [mm]. Default: the flat polygon of the coxa axes.",
    )


class Gait(Table):
    """Default settings of the robot's walks."""

    name: Annotated[str, Choice(GAIT_NAMES)] = Field(
        default="tripod", description="The gait. Default: tripod; for four legs creep, for an odd number wave."
    )
    body_height_mm: Length | None = Field(
        default=None, description="Height of the body's origin above the ground [mm]."
    )
    swing_height_mm: Length | None = Field(default=None, description="Swing height [mm].")


class SourceEntry(Table):
    """Source of numbers in this file, and their confidence."""

    of: list[Name] = Field(description="The keys concerned, such as leg.coxa_mm.")
    source: Name = Field(description="Where the numbers were found.")
    confidence: Annotated[str, Choice(("A", "A-", "B", "C", "guess"))] = Field(
        description="Confidence: A from the primary source, B from a secondary copy, C general knowledge, or guess."
    )
    note: Remark = Field(default="", description="Remarks.")


class RobotFile(Table):
    """A legged robot for Tarsus: millimetres, degrees, kilograms; x forward, y left, z up."""

    name: Label = Field(description="Name of the robot.")
    body: Body = Body()
    leg: Leg = Leg()
    legs: list[LegEntry] = Field(
        min_length=4, max_length=100, description="The legs, counter-clockwise from the front left."
    )
    gait: Gait = Gait()
    sources: list[SourceEntry] = Field(default=[], description="Sources of the numbers in this file.")


def robot_schema() -> dict[str, Any]:
    """Return the JSON schema of a robot file, for editors that complete and check TOML."""
    schema: dict[str, Any] = tidy_schema(RobotFile.model_json_schema())
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "Tarsus robot"}


def tidy_schema(node: Any) -> Any:
    """Remove what has no meaning in TOML: null, and titles derived from the keys."""
    if isinstance(node, list):
        return [tidy_schema(item) for item in node]
    if not isinstance(node, dict):
        return node
    tidied = {key: tidy_schema(value) for key, value in node.items() if key not in ("title", "default")}
    choices = [choice for choice in tidied.pop("anyOf", []) if choice != {"type": "null"}]
    return {**choices[0], **tidied} if choices else tidied
