"""What the server says of things that stand still: the robot, a pose, a leg's zone."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from tarsus.studio.messages.base import Message, Part
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
    """What this server takes at most; a client that keeps to it is never refused."""

    message_bytes: int
    messages_per_s: float
    plan_samples: int
    idle_s: float = Field(description="A session that says nothing for so long is ended; 0 where it never is.")


class Welcome(Message):
    """The first answer: what there is here."""

    type: Literal["welcome"]
    version: str
    robots: list[str] = Field(description="Names of the presets.")
    gaits: list[str]
    servos: list[str] = Field(description="Names in the catalogue.")
    public: bool = Field(description="Whether this is a public server: the simulator, and nothing else.")
    bounds: Bounds
    robot_schema: Schema = Field(description="JSON schema of a robot file: descriptions and bounds of its keys.")


class Dimension(Part):
    """One number of the robot file, and where it comes from."""

    key: str
    value: Annotated[Any, Field(json_schema_extra={"ts": "unknown"})]
    source: str | None
    confidence: str | None
    note: str | None


class RobotMessage(Message):
    """The robot, sent once: all that forward kinematics needs.

    The points of a leg in B, with c, f, t for its angles: the coxa axis is at ``mount``. From there the femur axis is
    ``coxa`` outward and ``femur_axis_offset`` to the left of outward and up. The knee is ``femur (cos f outward +
    sin f up)`` farther, the foot ``tibia (cos(f + t) outward + sin(f + t) up)`` farther still. Outward is
    ``(cos(yaw + c), sin(yaw + c), 0)``, its left ``(-sin(yaw + c), cos(yaw + c), 0)``, yaw that of the mount. The body
    takes B into G by ``Rz(yaw) Ry(pitch) Rx(roll)`` and its position.
    """

    type: Literal["robot"]
    name: str
    preset: str | None = Field(description="The preset's name while nothing of it is changed.")
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
    gaits: list[str] = Field(description="Those that a robot of so many legs has.")
    stance_mm: list[float] | None = Field(description="Rest footholds in G, body over the origin; null: none.")
    stance_angles_deg: list[float] | None
    longest_stroke_mm: float | None = Field(description="Straight ahead with its own gait.")
    document: Annotated[dict[str, Any], Field(json_schema_extra={"ts": "RobotFile"})]
    dimensions: list[Dimension]
    missing: list[str] = Field(description="What the file does not say, and what that costs.")
    problems: list[str] = Field(description="Why the robot can't walk; empty where it can.")


class StateMessage(Message):
    """The state after something else than the client's own inputs changed it: all inputs take these values."""

    type: Literal["state"]
    state: StudioState


class LegProblem(Part):
    """Why a leg can't have its foot where it should be."""

    leg: int
    reach: Literal["TOO_FAR", "TOO_NEAR", "COXA_LIMIT", "FEMUR_LIMIT", "TIBIA_LIMIT", "BELOW_GROUND"]
    miss_mm: float = Field(description="How far the foot is from where it should be.")
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
    """The robot standing or resting."""

    type: Literal["pose"]
    view: View
    position_mm: list[float] = Field(description="Of B in G.")
    rpy_deg: list[float]
    angles_deg: list[float] = Field(description="Legs x (coxa, femur, tibia); the nearest where a leg can't reach.")
    feet_mm: list[float] = Field(description="Legs x (x, y, z) in G: where the feet should be.")
    contacts: str = Field(description="A character a leg, 1 where the foot stands.")
    points_down: str = Field(description="Legs x (coxa axis, femur axis, knee, foot), 1 where one touches the ground.")
    corners_down: int = Field(description="How many corners of the body's box touch the ground.")
    margin_mm: float | None = Field(description="Null where nothing stands.")
    stable: bool
    com_mm: list[float] = Field(description="Centre of mass in G.")
    support_mm: list[float] = Field(description="Corners (x, y) of the polygon of all that touches.")
    forces_n: list[float] | None = Field(description="Legs x (x, y, z), ground on foot; null where undetermined.")
    torques_nm: list[float] | None = Field(description="Legs x (coxa, femur, tibia); null where undetermined.")
    legs: list[LegProblem]
    limits: list[BrokenLimit]
    text: str = Field(description="How it stands, in words.")
    problems: list[str]
    feasible_fraction: float | None = Field(description="How far towards the requested body pose is possible, 0 to 1.")


class WorkspaceMessage(Message):
    """What a leg reaches, as closed outlines in B: they move with the body. Empty where it reaches nothing there."""

    type: Literal["workspace"]
    leg: int
    ground_mm: list[float] = Field(description="Points (x, y, z) of the outline on the ground.")
    plane_mm: list[float] = Field(description="Points (x, y, z) of the outline in the leg's present plane.")
    nearest_mm: float | None = Field(description="Straight out on the ground, from the coxa axis.")
    farthest_mm: float | None
