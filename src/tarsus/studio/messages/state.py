"""The state of a visitor's studio: what undo takes back, and what a link restores exactly."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import Field

from tarsus.studio.messages.base import MOST_LEGS, Angle, Coordinate, Name, Number, Part, Positive, Triple

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
    """Which robot: a preset by its name, or a robot of one's own by the keys of its file."""

    preset: Name | None = "strider"
    document: Annotated[dict[str, Any] | None, Field(json_schema_extra={"ts": "RobotFile | null"})] = None


class JointsState(Part):
    """The view Joints: legs x (coxa, femur, tibia); null for those of the rest stance."""

    angles_deg: AnglesDeg | None = None


class BodyState(Part):
    """The view Body: how far the body is moved and turned over its feet, and where those are if they were dragged."""

    x_mm: Coordinate = 0.0
    y_mm: Coordinate = 0.0
    z_mm: Coordinate = 0.0
    roll_deg: Angle = 0.0
    pitch_deg: Angle = 0.0
    yaw_deg: Angle = 0.0
    body_height_mm: Coordinate | None = Field(default=None, description="Null for the robot's own.")
    knee: Literal["up", "down"] = "up"
    feet_mm: Points | None = Field(default=None, description="Legs x (x, y, z) in G; null for the rest stance.")


class Straight(Part):
    """A straight walk."""

    kind: Literal["straight"] = "straight"
    distance_mm: Coordinate = 500.0
    heading_deg: Angle = Field(default=0.0, description="From the front; 90 is to the left.")


class Curve(Part):
    """A walk round a centre on the floor."""

    kind: Literal["curve"]
    angle_deg: Angle = Field(description="Negative is clockwise.")
    centre_mm: tuple[Coordinate, Coordinate] = (0.0, 0.0)


class Twist(Part):
    """A walk at a constant twist."""

    kind: Literal["twist"]
    velocity_mm_s: tuple[Number, Number]
    turn_deg_s: Angle
    duration_s: Positive


Path: TypeAlias = Annotated[Straight | Curve | Twist, Field(discriminator="kind")]


class OwnGait(Part):
    """A gait without a name."""

    duty_factor: Positive = Field(description="Share of the cycle that a foot is down.")
    offsets: Annotated[tuple[Number, ...], Field(max_length=MOST_LEGS)] = Field(
        description="When in the cycle each leg touches down, from 0 to 1."
    )


class WalkOptions(Part):
    """The view Walk: every option of `plan_walk`; null leaves it to the plan, which then says what it took."""

    gait: Name | OwnGait | None = Field(default=None, description="Null for the robot's own.")
    path: Path = Straight()
    stroke_mm: Positive | None = None
    speed_mm_s: Positive | None = None
    cycle_time_s: Positive | None = None
    body_height_mm: Coordinate | None = None
    swing_height_mm: Positive | None = None
    roll_deg: Angle = 0.0
    pitch_deg: Angle = 0.0
    foot_distance_mm: Positive | None = None
    rate_hz: Positive = 100.0
    strict: bool = Field(default=True, description="Refuse what does not work; if false, show it with its problems.")


class LoadOptions(Part):
    """The view Loads, on top of the walk's options."""

    payload_kg: Positive = 0.0
    payload_at_mm: Triple = Field(default=(0.0, 0.0, 0.0), description="In the body frame B.")
    supply_v: Positive | None = Field(default=None, description="Null for that of the servos' figures.")
    inertial: bool = True
    capacity_ah: Positive | None = Field(default=None, description="Of the battery.")
    safety_factor: Positive = 3.0
    rule: Literal["factor", "continuous"] = "factor"


class SourceChoice(Part):
    """The view Sources: which document, filled in with which leg's numbers."""

    number: Literal["000", "001", "002", "003", "004"] = "000"
    leg: Annotated[int, Field(ge=0, lt=MOST_LEGS)] = 0


class Picture(Part):
    """How it is looked at: the server keeps it for the link, and makes nothing of it."""

    camera: Literal["free", "follow", "top", "side", "front"] = "free"
    eye_mm: Triple | None = None
    target_mm: Triple | None = None
    time_s: Positive = Field(default=0.0, description="Moment of the walk that is shown.")
    leg: Annotated[int, Field(ge=0, lt=MOST_LEGS)] | None = Field(
        default=None, description="The leg whose reachable zone is shown."
    )


class StudioState(Part):
    """The whole state of a visitor's studio."""

    view: View = "walk"
    robot: RobotChoice = RobotChoice()
    joints: JointsState = JointsState()
    body: BodyState = BodyState()
    walk: WalkOptions = WalkOptions()
    loads: LoadOptions = LoadOptions()
    source: SourceChoice = SourceChoice()
    picture: Picture = Picture()
