"""The state of a session: undo reverts it, and a link restores it exactly."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import Field

from tarsus.studio.messages.base import MOST_LEGS, Angle, Coordinate, Name, Number, Part, Positive, Triple
from tarsus.studio.messages.physics import PhysicsOptions

__all__ = [
    "BodyState",
    "Curve",
    "JointsState",
    "LoadOptions",
    "OwnGait",
    "Picture",
    "RobotChoice",
    "SourceChoice",
    "Straight",
    "StudioState",
    "Twist",
    "View",
    "WalkOptions",
]

View: TypeAlias = Literal["joints", "body", "walk", "drive", "loads", "robot", "sources"]
"""The seven views."""

AnglesDeg: TypeAlias = Annotated[tuple[Angle, ...], Field(max_length=3 * MOST_LEGS)]
Points: TypeAlias = Annotated[tuple[Coordinate, ...], Field(max_length=3 * MOST_LEGS)]


class RobotChoice(Part):
    """Choice of the robot: a preset by its name, or a custom robot by the keys of its file."""

    preset: Name | None = "strider"
    document: Annotated[dict[str, Any] | None, Field(json_schema_extra={"ts": "RobotFile | null"})] = None


class JointsState(Part):
    """The view Joints: legs x (coxa, femur, tibia); null for the default stance."""

    angles_deg: AnglesDeg | None = None


class BodyState(Part):
    """The view Body: body pose relative to the feet, and footholds that were dragged."""

    x_mm: Coordinate = 0.0
    y_mm: Coordinate = 0.0
    z_mm: Coordinate = 0.0
    roll_deg: Angle = 0.0
    pitch_deg: Angle = 0.0
    yaw_deg: Angle = 0.0
    body_height_mm: Coordinate | None = Field(default=None, description="Null for the default of the robot.")
    knee: Literal["up", "down"] = "up"
    feet_mm: Points | None = Field(default=None, description="Legs x (x, y, z) in G; null for the default stance.")


class Straight(Part):
    """A straight walk."""

    # Without a default, as the text of a state omits those, and a path needs its kind.
    kind: Literal["straight"]
    distance_mm: Coordinate = 500.0
    heading_deg: Angle = Field(default=0.0, description="Direction, 90 is to the left.")


class Curve(Part):
    """A walk around a centre on the ground."""

    kind: Literal["curve"]
    angle_deg: Angle = Field(description="Negative is clockwise.")
    centre_mm: tuple[Coordinate, Coordinate] = (0.0, 0.0)


class Twist(Part):
    """A walk with a constant twist."""

    kind: Literal["twist"]
    velocity_mm_s: tuple[Number, Number]
    turn_deg_s: Angle
    duration_s: Positive


Path: TypeAlias = Annotated[Straight | Curve | Twist, Field(discriminator="kind")]


class OwnGait(Part):
    """A custom gait."""

    duty_factor: Positive = Field(description="Stance time as a fraction of the cycle time.")
    offsets: Annotated[tuple[Number, ...], Field(max_length=MOST_LEGS)] = Field(
        description="Phase of the touch-down of each leg, from 0 to 1."
    )


class WalkOptions(Part):
    """The view Walk: the options of `plan_walk`; for null, the plan chooses a value and reports it."""

    gait: Name | OwnGait | None = Field(default=None, description="Null for the default of the robot.")
    path: Path = Straight(kind="straight")
    stroke_mm: Positive | None = None
    speed_mm_s: Positive | None = None
    cycle_time_s: Positive | None = None
    body_height_mm: Coordinate | None = None
    swing_height_mm: Positive | None = None
    roll_deg: Angle = 0.0
    pitch_deg: Angle = 0.0
    foot_distance_mm: Positive | None = None
    rate_hz: Positive = 100.0
    strict: bool = Field(
        default=True, description="Whether impossible walks are rejected; if false, they are shown with their problems."
    )


class LoadOptions(Part):
    """The view Loads, in addition to the options of the walk."""

    payload_kg: Positive = 0.0
    payload_at_mm: Triple = Field(default=(0.0, 0.0, 0.0), description="In the body frame B.")
    supply_v: Positive | None = Field(default=None, description="Null for the voltage of the servo data.")
    inertial: bool = True
    capacity_ah: Positive | None = Field(default=None, description="Of the battery.")
    safety_factor: Positive = 3.0
    rule: Literal["factor", "continuous"] = "factor"


class SourceChoice(Part):
    """The view Sources: the document, and the leg whose values are used."""

    number: Literal["000", "001", "002", "003", "004"] = "000"
    leg: Annotated[int, Field(ge=0, lt=MOST_LEGS)] = 0


class Picture(Part):
    """Camera and time of the 3D view, which the server stores for links only."""

    camera: Literal["free", "follow", "top", "side", "front"] = "free"
    eye_mm: Triple | None = None
    target_mm: Triple | None = None
    time_s: Positive = Field(default=0.0, description="Playback time.")
    leg: Annotated[int, Field(ge=0, lt=MOST_LEGS)] | None = Field(
        default=None, description="Leg whose workspace is shown."
    )


class StudioState(Part):
    """The whole state of a session."""

    view: View = "walk"
    robot: RobotChoice = RobotChoice()
    joints: JointsState = JointsState()
    body: BodyState = BodyState()
    walk: WalkOptions = WalkOptions()
    physics: PhysicsOptions = PhysicsOptions()
    loads: LoadOptions = LoadOptions()
    source: SourceChoice = SourceChoice()
    picture: Picture = Picture()
