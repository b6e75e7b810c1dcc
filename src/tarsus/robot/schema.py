"""The robot file's tables and keys, as pydantic models.

Importing this module imports pydantic, which takes longer than the rest of Tarsus together; so it is imported only
where a file is read.
"""

from __future__ import annotations

from decimal import Decimal
from typing import Annotated, Any, TypeAlias

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag, model_validator

from tarsus.robot.fields import REFUSED, Choice, Number, Numbers, ServoName, Text, refuse

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
]

GAIT_NAMES = ("tripod", "tetrapod", "amble", "ripple", "wave")
"""Names that `[gait] name` may have."""

# Below a micrometre or a milligram a number is a slip, and a length could round to zero in metres.
Length: TypeAlias = Annotated[Decimal, Number(0.001, 10_000, "mm")]
LengthOrZero: TypeAlias = Annotated[Decimal, Number(0, 10_000, "mm")]
Coordinate: TypeAlias = Annotated[Decimal, Number(-10_000, 10_000, "mm")]
Point: TypeAlias = Annotated[tuple[Decimal, ...], Numbers(3, Number(-10_000, 10_000, "mm"))]
Offset: TypeAlias = Annotated[tuple[Decimal, ...], Numbers(2, Number(-10_000, 10_000, "mm"))]
Size: TypeAlias = Annotated[tuple[Decimal, ...], Numbers(3, Number(0.001, 10_000, "mm"))]
Range: TypeAlias = Annotated[tuple[Decimal, ...], Numbers(2, Number(-180, 180, "deg"), ordered=True)]
Mass: TypeAlias = Annotated[Decimal, Number(0.000001, 10_000, "kg")]
MassOrZero: TypeAlias = Annotated[Decimal, Number(0, 10_000, "kg")]
Volts: TypeAlias = Annotated[Decimal, Number(0, 1000, "V")]
Torque: TypeAlias = Annotated[Decimal, Number(0, 10_000, "N m")]
Name: TypeAlias = Annotated[str, Text()]
Remark: TypeAlias = Annotated[str, Text(empty=True)]


class Table(BaseModel):
    """Any table of the file: a key that it does not know is refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class JointTable(Table):
    """A table with one entry for each joint."""


class JointMasses(JointTable):
    """Masses of the links, servos included [kg]. All three, or leave the table out where they are unknown."""

    coxa: MassOrZero | None = None
    femur: MassOrZero | None = None
    tibia: MassOrZero | None = None


class JointCentres(JointTable):
    """Where the links' centres of mass are, along the link from its inner joint [mm]; left out: the middle."""

    coxa: Coordinate | None = None
    femur: Coordinate | None = None
    tibia: Coordinate | None = None


class JointLimits(JointTable):
    """Lowest and highest angle of each joint [deg].

    All zero: the leg straight out, level. Coxa positive: counter-clockwise seen from above. Femur and tibia positive:
    the foot goes up. So a standing leg, knee up, has a positive femur and a negative tibia.
    """

    coxa: Range | None = None
    femur: Range | None = None
    tibia: Range | None = None


class ServoFigures(Table):
    """A servo's own figures, for one that the catalogue does not have."""

    name: Name = Field(description="The model.")
    stall_torque_nm: Torque = Field(description="Torque at which it stops [N m]; kg.cm times 0.0980665.")
    torque_at_v: Volts | None = Field(default=None, description="Supply for the stall torque [V].")
    rated_torque_nm: Torque | None = Field(
        default=None, description="Torque that the maker rates for lasting use [N m]."
    )
    no_load_rad_s: Annotated[Decimal, Number(0, 10_000, "rad/s")] | None = Field(
        default=None, description="Speed without load [rad/s]; 1.047 divided by the seconds for 60 deg."
    )
    speed_at_v: Volts | None = Field(default=None, description="Supply for the speed [V].")
    stall_current_a: Annotated[Decimal, Number(0, 1000, "A")] | None = Field(
        default=None, description="Current when stalled [A]."
    )
    mass_g: Annotated[Decimal, Number(0, 100_000, "g")] | None = Field(default=None, description="Mass [g].")
    supply_min_v: Volts | None = Field(default=None, description="Lowest supply [V]; together with supply_max_v.")
    supply_max_v: Volts | None = Field(default=None, description="Highest supply [V]; together with supply_min_v.")
    travel_deg: Annotated[Decimal, Number(0, 36_000, "deg")] | None = Field(
        default=None, description="Range of the output shaft [deg]."
    )
    maker: Remark = Field(default="", description="Who makes it.")
    control: Remark = Field(default="", description="How it is commanded.")
    gear: Remark = Field(default="", description="Of what its gears are.")
    feedback: Remark = Field(default="", description="What it reports.")
    confidence: Remark = Field(default="", description="How sure the figures are.")
    source: Remark = Field(default="", description="Where the figures come from.")
    note: Remark = Field(default="", description="What else is known.")

    @model_validator(mode="after")
    def _supply_has_two_ends(self) -> ServoFigures:
        lowest, highest = self.supply_min_v, self.supply_max_v
        if (lowest is None) != (highest is None):
            raise refuse("supply_min_v and supply_max_v go together: give both or neither")
        if lowest is not None and highest is not None and lowest > highest:
            raise refuse(f"supply_min_v is {lowest} V, more than supply_max_v, {highest} V")
        return self


# Tags tell pydantic which kind of servo entry it reads; they turn up in the paths of its errors.
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
        custom_error_message="must be the name of a servo, or a table with the servo's own figures",
    ),
]


class JointServos(JointTable):
    """The servo of each joint: a name in the catalogue, or a table with the servo's own figures."""

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
            "or a table with the servo's own figures"
        ),
    ),
]


class Leg(Table):
    """What every leg has alike."""

    coxa_mm: LengthOrZero | None = Field(default=None, description="Coxa axis to femur axis, outward [mm].")
    femur_mm: Length | None = Field(default=None, description="Femur axis to knee [mm].")
    tibia_mm: Length | None = Field(default=None, description="Knee to foot [mm].")
    femur_axis_offset_mm: Offset | None = Field(
        default=None,
        description="How far the femur axis lies beside and above the coxa axis: [sideways, vertical] [mm].",
    )
    mass_kg: JointMasses | None = None
    com_mm: JointCentres | None = None
    limits_deg: JointLimits | None = None
    servo: AnyServo | None = Field(
        default=None,
        description="A servo of the catalogue, one for each joint, or a table with the servo's own figures.",
    )
    foot_radius_mm: LengthOrZero | None = Field(default=None, description="Radius of the foot's ball [mm].")


class LegEntry(Leg):
    """One leg: its name and place, and whatever of [leg] is different for it."""

    name: Name = Field(description="What the leg is called, such as front left.")
    position_mm: Point = Field(description="Where the coxa axis is: x forward, y left, z up [mm].")
    yaw_deg: Annotated[Decimal, Number(-360, 360, "deg")] = Field(
        description="Where the leg points: 0 is forward, 90 is left [deg]."
    )


class Body(Table):
    """The body, without the legs."""

    mass_kg: Mass | None = Field(default=None, description="Mass, with battery and electronics [kg].")
    com_mm: Point | None = Field(default=None, description="Centre of mass: x forward, y left, z up [mm].")
    size_mm: Size | None = Field(
        default=None,
        description="Length, width and height of its box [mm]; left out: the flat polygon of the coxa axes.",
    )


class Gait(Table):
    """How this robot walks unless told otherwise."""

    name: Annotated[str, Choice(GAIT_NAMES)] = Field(default="tripod", description="The gait.")
    body_height_mm: Length | None = Field(default=None, description="Height of the body's origin over the ground [mm].")
    swing_height_mm: Length | None = Field(default=None, description="How high a swinging foot is lifted [mm].")


class SourceEntry(Table):
    """Where numbers of this file come from, and how sure they are."""

    of: list[Name] = Field(description="The keys it speaks of, such as leg.coxa_mm.")
    source: Name = Field(description="Where they were found.")
    confidence: Annotated[str, Choice(("A", "A-", "B", "C", "guess"))] = Field(
        description="How sure: A read in the primary file, B in a secondary copy, C general knowledge, or guess."
    )
    note: Remark = Field(default="", description="What else is known.")


class RobotFile(Table):
    """A legged robot for Tarsus: millimetres, degrees, kilograms; x forward, y left, z up."""

    name: Name = Field(description="What the robot is called.")
    body: Body = Body()
    leg: Leg = Leg()
    legs: list[LegEntry] = Field(
        min_length=4, max_length=100, description="The legs, counter-clockwise from the front left."
    )
    gait: Gait = Gait()
    sources: list[SourceEntry] = Field(default=[], description="Where the numbers of this file come from.")


def robot_schema() -> dict[str, Any]:
    """Return the JSON schema of a robot file, for editors that complete and check TOML."""
    schema: dict[str, Any] = _tidy(RobotFile.model_json_schema())
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "Tarsus robot"}


def _tidy(node: Any) -> Any:
    """Leave out what means nothing in TOML: null, which it does not have, and titles made from the keys."""
    if isinstance(node, list):
        return [_tidy(item) for item in node]
    if not isinstance(node, dict):
        return node
    tidied = {key: _tidy(value) for key, value in node.items() if key not in ("title", "default")}
    choices = [choice for choice in tidied.pop("anyOf", []) if choice != {"type": "null"}]
    return {**choices[0], **tidied} if choices else tidied
