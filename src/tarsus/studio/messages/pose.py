"""Messages of the server on the robot, its pose, and the workspace of a leg."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from tarsus.studio.messages.base import Message, Part
from tarsus.studio.messages.machine import HardwareOffer, RunOffer
from tarsus.studio.messages.physics import PhysicsOffer
from tarsus.studio.messages.state import StudioState, View

__all__ = [
    "Bounds",
    "BrokenLimit",
    "Dimension",
    "LegProblem",
    "PoseMessage",
    "RobotMessage",
    "StateMessage",
    "Welcome",
    "WorkspaceMessage",
]

Schema = Annotated[dict[str, Any], Field(json_schema_extra={"ts": "Record<string, unknown>"})]


class Bounds(Part):
    """Limits of the server; clients that respect them are never rejected."""

    message_bytes: int
    messages_per_s: float
    plan_samples: int
    idle_s: float = Field(description="Time without messages after which a session ends; 0 for no limit.")


class Welcome(Message):
    """The first answer: presets, gaits, servos, and limits."""

    type: Literal["welcome"]
    version: str
    robots: list[str] = Field(description="Names of the presets.")
    gaits: list[str]
    servos: list[str] = Field(description="Names in the servo catalogue.")
    public: bool = Field(description="Whether this is a public server, without access to hardware.")
    bounds: Bounds
    physics: PhysicsOffer
    run: RunOffer | None = Field(description="Null without a run: then all views are available.")
    hardware: HardwareOffer
    robot_schema: Schema = Field(description="JSON schema of a robot file: descriptions and bounds of its keys.")


class Dimension(Part):
    """A value of the robot file, with its source."""

    key: str
    value: Annotated[Any, Field(json_schema_extra={"ts": "unknown"})]
    source: str | None
    confidence: str | None
    note: str | None


class RobotMessage(Message):
    """The robot, sent once, with everything that forward kinematics needs.

    The points of a leg in B, with c, f, t for its angles: the coxa axis is at ``mount``. From there the femur axis is
    ``coxa`` outward and ``femur_axis_offset`` to the left of outward and up. The knee is ``femur (cos f outward +
    sin f up)`` farther, the foot ``tibia (cos(f + t) outward + sin(f + t) up)`` farther still. Outward is
    ``(cos(yaw + c), sin(yaw + c), 0)``, its left ``(-sin(yaw + c), cos(yaw + c), 0)``, yaw that of the mount. The body
    takes B into G by ``Rz(yaw) Ry(pitch) Rx(roll)`` and its position.
    """

    type: Literal["robot"]
    name: str
    preset: str | None = Field(description="Name of the preset, if it is unchanged.")
    leg_names: list[str]
    leg_codes: list[str] = Field(description="Short names: LF, LM, LR, RR, RM, RF.")
    mount_mm: list[float] = Field(description="Legs x (x, y, z) in B.")
    mount_yaw_deg: list[float]
    coxa_mm: list[float]
    femur_mm: list[float]
    tibia_mm: list[float]
    femur_axis_offset_mm: list[float] = Field(description="Legs x (to the left of outward, up).")
    limits_deg: list[float] = Field(description="Legs x (coxa, femur, tibia) x (lowest, highest).")
    foot_radius_mm: list[float]
    body_size_mm: list[float] | None = Field(description="Box centred on B's origin; null: polygon of coxa axes.")
    mass_kg: float | None
    servos: list[str | None] = Field(description="Legs x (coxa, femur, tibia).")
    stall_torque_nm: list[float | None] = Field(description="Legs x (coxa, femur, tibia), as in the catalogue.")
    body_height_mm: float
    swing_height_mm: float
    gait: str
    gaits: list[str] = Field(description="Gaits for this number of legs.")
    stance_mm: list[float] | None = Field(
        description="Footholds of the default stance in G, body over the origin; null if there is none."
    )
    stance_angles_deg: list[float] | None
    longest_stroke_mm: float | None = Field(description="Straight ahead with the default gait.")
    document: Annotated[dict[str, Any], Field(json_schema_extra={"ts": "RobotFile"})]
    dimensions: list[Dimension]
    missing: list[str] = Field(description="Values that the file lacks, and the consequences.")
    problems: list[str] = Field(description="Why the robot can't walk; empty if it can.")


class StateMessage(Message):
    """The state after a change that is not from the inputs of the client, which take these values."""

    type: Literal["state"]
    state: StudioState


class LegProblem(Part):
    """A foot that does not reach its target."""

    leg: int
    reach: Literal["TOO_FAR", "TOO_NEAR", "COXA_LIMIT", "FEMUR_LIMIT", "TIBIA_LIMIT", "BELOW_GROUND"]
    miss_mm: float = Field(description="Distance of the foot from its target.")
    text: str


class BrokenLimit(Part):
    """A joint beyond its limits."""

    leg: int
    joint: Literal["coxa", "femur", "tibia"]
    angle_deg: float
    low_deg: float
    high_deg: float
    text: str


class PoseMessage(Message):
    """The standing or resting robot."""

    type: Literal["pose"]
    view: View
    position_mm: list[float] = Field(description="Of B in G.")
    rpy_deg: list[float]
    angles_deg: list[float] = Field(
        description="Legs x (coxa, femur, tibia); the nearest solution for a leg out of reach."
    )
    feet_mm: list[float] = Field(description="Legs x (x, y, z) in G: targets of the feet.")
    contacts: str = Field(description="A character per leg, 1 for a foot in contact.")
    points_down: str = Field(description="Legs x (coxa axis, femur axis, knee, foot), 1 for points on the ground.")
    corners_down: int = Field(description="Number of corners of the body's box on the ground.")
    margin_mm: float | None = Field(description="Null without contacts.")
    stable: bool
    com_mm: list[float] = Field(description="Centre of mass in G.")
    support_mm: list[float] = Field(description="Corners (x, y) of the support polygon of all contact points.")
    forces_n: list[float] | None = Field(description="Legs x (x, y, z), ground on foot; null if undetermined.")
    torques_nm: list[float] | None = Field(description="Legs x (coxa, femur, tibia); null if undetermined.")
    legs: list[LegProblem]
    limits: list[BrokenLimit]
    text: str = Field(description="Description of the pose.")
    problems: list[str]
    feasible_fraction: float | None = Field(description="How far towards the requested body pose is possible, 0 to 1.")


class WorkspaceMessage(Message):
    """Workspace of a leg as closed outlines in B, which move with the body; empty if it has none there."""

    type: Literal["workspace"]
    leg: int
    ground_mm: list[float] = Field(description="Points (x, y, z) of the outline on the ground.")
    plane_mm: list[float] = Field(description="Points (x, y, z) of the outline in the present plane of the leg.")
    nearest_mm: float | None = Field(description="Straight outward on the ground, from the coxa axis.")
    farthest_mm: float | None
