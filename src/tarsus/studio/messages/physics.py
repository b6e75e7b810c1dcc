"""Messages on physics: its options, the terrain, a simulated walk, and what a driven robot does in physics."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from tarsus.studio.messages.base import Message, Name, Number, Part

__all__ = [
    "FramePhysics",
    "PhysicsOffer",
    "PhysicsOptions",
    "SimulatedJoint",
    "SimulatedMessage",
    "TerrainChoice",
    "TerrainField",
    "TerrainKind",
    "TerrainMessage",
    "TerrainParameterRange",
]

TerrainName: TypeAlias = Literal["flat", "ramp", "step", "stairs", "blocks", "smooth", "gaps", "box"]


class TerrainChoice(Part):
    """Choice of the terrain."""

    kind: TerrainName = "flat"
    values: Annotated[dict[Name, Number], Field(max_length=20, json_schema_extra={"ts": "Record<string, number>"})] = (
        Field(default={}, description="Parameters of the kind [mm, deg]; those left out have their default.")
    )


class PhysicsOptions(Part):
    """Physics in the views Walk and Drive."""

    on: bool = Field(default=False, description="Whether the robot is shown in physics.")
    terrain: TerrainChoice = TerrainChoice()
    servos: Literal["catalogue", "ideal"] = "catalogue"
    sensors: Literal["ideal", "hobby", "smart", "blind"] = Field(
        default="ideal", description="What the controller reads while driving."
    )


class TerrainParameterRange(Part):
    """A parameter of a kind of terrain, and the range of its slider."""

    name: str
    unit: Literal["mm", "deg", ""]
    default: float
    least: float
    most: float
    step: float


class TerrainKind(Part):
    """A kind of terrain."""

    kind: TerrainName
    parameters: list[TerrainParameterRange]


class PhysicsOffer(Part):
    """What physics the server has."""

    missing: str | None = Field(description="Why there is no physics, and what to install; null where there is.")
    terrains: list[TerrainKind]


class TerrainField(Part):
    """A height field: each cell is two triangles, which share the edge from its least x, y to its greatest."""

    rows: int
    columns: int
    corners_mm: list[float] = Field(description="Least x and y, greatest x and y.")
    heights_mm: list[float] = Field(description="Rows along y x columns along x, ascending.")


class TerrainMessage(Message):
    """The terrain as the physics engine has it."""

    type: Literal["terrain"]
    kind: TerrainName
    friction: float
    level: bool = Field(description="Whether there is level ground without end at height 0.")
    boxes_mm: list[float] = Field(description="n x (least x, y, z, greatest x, y, z).")
    triangles_mm: list[float] = Field(description="n x 3 x (x, y, z), counter-clockwise seen from outside.")
    field: TerrainField | None


class SimulatedJoint(Part):
    """Torques of one kind of joint, of the leg where each is greatest."""

    joint: Literal["coxa", "femur", "tibia"]
    peak_nm: float
    rms_nm: float
    planned_peak_nm: float | None
    planned_rms_nm: float | None
    saturated_fraction: float = Field(description="Of the time, at the servo's maximum torque.")


class SimulatedMessage(Message):
    """The planned walk in physics, without feedback; the samples are those of the plan at `rate_hz`."""

    type: Literal["simulated"]
    rate_hz: float
    count: int = Field(description="Number of samples n.")
    position_mm: list[float] = Field(description="n x (x, y, z) of B in G.")
    rpy_deg: list[float] = Field(description="n x (roll, pitch, yaw), yaw unwrapped.")
    angles_deg: list[float] = Field(description="n x legs x (coxa, femur, tibia).")
    contacts: list[str] = Field(description="n texts, a character per leg, 1 for a foot in contact.")
    margin_mm: list[float | None] = Field(description="n; null without a foot in contact.")
    com_mm: list[float] = Field(description="n x (x, y) of the centre of mass in G.")
    forces_n: list[float] = Field(description="n x legs x (x, y, z), ground on foot in G.")
    slip_mm_s: list[float] = Field(description="n x legs: speed of the contact point over the ground.")
    saturated: list[str] = Field(description="n texts, a character per joint, 1 for a servo at its maximum torque.")
    tilt_deg: list[float] = Field(description="n: angle between the body and the planned one.")
    ok: bool = Field(description="Whether it neither fell nor stalled.")
    verdict: str
    problems: list[str]
    way_ratio: float | None = Field(description="Way over the planned one; null for a walk on the spot.")
    turn_ratio: float | None
    deviation_mm: float = Field(description="Greatest horizontal distance from the plan.")
    sag_mm: float
    slip_mm: float = Field(description="Way that a foot slides, mean of all feet.")
    joints: list[SimulatedJoint]
    energy_j: float
    fell_at_s: float | None
    assumed: list[str]


class FramePhysics(Part):
    """A driven robot in physics, where the frame itself has what is commanded."""

    position_mm: list[float]
    rpy_deg: list[float]
    angles_deg: list[float]
    contacts: str
    forces_n: list[float] = Field(description="Legs x (x, y, z), ground on foot in G.")
    slip_mm_s: list[float] = Field(description="Of each foot.")
    saturated: str = Field(description="A character per joint, 1 for a servo at its maximum torque.")
    tilt_deg: float = Field(description="Angle between the body and the commanded one.")
    deviation_mm: float = Field(description="Horizontal distance from where it is commanded to be.")
    fallen: bool = Field(description="Whether it has fallen since driving started.")
    problems: list[str] = Field(description="Falls, and servos at their maximum torque within the last half second.")
