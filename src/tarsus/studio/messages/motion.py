"""Messages of the server on motions: walks, loads, servos, frames of driving."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from tarsus.studio.messages.base import Message, Part
from tarsus.studio.messages.machine import FrameMachine
from tarsus.studio.messages.physics import FramePhysics

__all__ = [
    "Candidate",
    "DriveFrame",
    "JointLoad",
    "JointSpeed",
    "LoadsMessage",
    "ServosMessage",
    "TimedLength",
    "WalkEnd",
    "WalkMessage",
]


class TimedLength(Part):
    """A length and its time."""

    mm: float | None
    at_s: float


class WalkEnd(Part):
    """Final position and heading of the body."""

    x_mm: float
    y_mm: float
    turned_deg: float


class JointSpeed(Part):
    """Greatest speed of one kind of joint."""

    joint: Literal["coxa", "femur", "tibia"]
    deg_s: float
    leg: str
    servo: str | None
    no_load_deg_s: float | None
    no_load_fraction: float | None


class WalkMessage(Message):
    """A complete walk, for playback in the browser: `rate_hz` samples per second, from 0 s."""

    type: Literal["walk"]
    rate_hz: float
    count: int = Field(description="Number of samples n.")
    position_mm: list[float] = Field(description="n x (x, y, z) of B in G.")
    rpy_deg: list[float] = Field(description="n x (roll, pitch, yaw), yaw unwrapped.")
    angles_deg: list[float] = Field(description="n x legs x (coxa, femur, tibia).")
    contacts: list[str] = Field(description="n texts, a character per leg, 1 for a foot in contact.")
    reach: list[str] | None = Field(description="n texts, a code of Reach per leg; null if all feet are reachable.")
    margin_mm: list[float | None] = Field(description="n; null without a foot in contact.")
    com_mm: list[float] = Field(description="n x (x, y) of the centre of mass over the ground in G.")
    gait: str
    duty_factor: float
    offsets: list[float] = Field(description="Phase of the touch-down of each leg, from 0 to 1.")
    duration_s: float
    cycle_time_s: float
    steps: int
    stroke_mm: float
    speed_mm_s: float
    body_height_mm: float
    swing_height_mm: float
    longest_stroke_mm: float | None
    end: WalkEnd
    joint_speed: list[JointSpeed]
    least_margin: TimedLength
    nearest_feet: TimedLength
    nearest_legs: list[str]
    possible: bool
    problems: list[str]
    assumed: list[str]


class JointLoad(Part):
    """Loads of one joint over the walk."""

    leg: str
    joint: Literal["coxa", "femur", "tibia"]
    servo: str | None
    peak_nm: float
    peak_at_s: float
    peak_cause: str
    rms_nm: float
    peak_speed_deg_s: float
    peak_power_w: float
    stall_nm: float | None
    factor: float | None
    utilisation: float | None
    thermal_ratio: float | None
    grade: str = Field(description="good, marginal, stalls or burns, cannot stand, unknown.")
    text: str


class LoadsMessage(Message):
    """Joint loads at the samples of the walk that was sent last."""

    type: Literal["loads"]
    torques_nm: list[float] = Field(description="n x legs x (coxa, femur, tibia).")
    forces_n: list[float] = Field(description="n x legs x (x, y, z), ground on foot in G.")
    joints: list[JointLoad] = Field(description="In the order of the legs.")
    worst: list[str] = Field(description="Names of the most loaded coxa, femur and tibia.")
    grade: str
    carried: bool
    balanced: bool
    weight_n: float
    distance_m: float
    energy_j: float
    cost_of_transport: float | None
    peak_current_a: float | None
    mean_current_a: float | None
    battery_min: float | None
    supply_warning: str | None
    assumed: list[str]


class Candidate(Part):
    """Suitable servos of the catalogue."""

    name: str
    coxa: str
    femur: str
    tibia: str
    factor: float | None
    thermal_ratio: float | None
    servo_mass_kg: float
    robot_mass_kg: float


class ServosMessage(Message):
    """Result of the servo sizing."""

    type: Literal["servos"]
    sufficient: bool
    balanced: bool
    worst: list[str] = Field(description="Verdicts on the most loaded coxa, femur and tibia with the present servos.")
    candidates: list[Candidate] = Field(description="The same servo in all joints, lightest first.")
    mixed: Candidate | None = Field(description="The lightest servo for each kind of joint.")
    payload_kg: float | None = Field(description="Greatest payload of the present servos.")
    maximum_payload_kg: float | None
    advice: list[str]
    left_out: Annotated[dict[str, Any], Field(json_schema_extra={"ts": "Record<string, string>"})]
    assumed: list[str]


class DriveFrame(Message):
    """State of the live robot after a tick, as commanded; sent 60 times a second while driving."""

    type: Literal["frame"]
    time_s: float
    state: Literal["lying", "folded", "rising", "standing", "walking", "sitting", "folding", "fault"]
    activity: str = Field(description="Walk state, stage of rising, sitting or folding, or the state.")
    guard: str = Field(description="State of the guard: passing, holding, sitting or recovering.")
    gait: str
    position_mm: list[float]
    rpy_deg: list[float]
    heading_deg: float = Field(description="Yaw of the body in G, from -180 to 180.")
    angles_deg: list[float]
    contacts: str
    belly: bool = Field(description="Whether the body rests on the ground.")
    margin_mm: float | None = Field(description="Null where no foot is on the ground, or the body is.")
    com_mm: list[float] | None = Field(
        description="(x, y) of the centre of mass over the ground in G; null while the body rests on the ground."
    )
    twist: list[float] = Field(description="Present twist: forward, left [mm/s], turn [deg/s].")
    limitations: list[str] = Field(description="Why the command is not met in full.")
    intervention_count: int = Field(description="Number of interventions of the guard since driving started.")
    interventions: list[str] = Field(description="The latest interventions, newest first, at most five.")
    physics: FramePhysics | None = Field(default=None, description="Null as planned, without physics.")
    machine: FrameMachine | None = Field(default=None, description="Null without servos.")
