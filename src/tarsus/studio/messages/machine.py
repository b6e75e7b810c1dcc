"""Messages of the server on machines: what the servos of a robot that runs measure, and the bring-up of a new one."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tarsus.studio.messages.base import Message, Part

__all__ = ["BringUpMessage", "CalibrationMessage", "Choice", "FrameMachine", "HardwareOffer", "Question", "RunOffer"]


class HardwareOffer(Part):
    """Whether this session has access to servos."""

    missing: str | None = Field(description="Why it has none; null if it has.")


class RunOffer(Part):
    """The run that this server belongs to; then only the view Drive is available."""

    bus: str = Field(description="Servos: real or emulated, and their buses.")


class FrameMachine(Part):
    """What the servos of a robot that runs measure, where the frame itself has what is commanded."""

    angles_deg: list[float | None] = Field(
        description="Legs x (coxa, femur, tibia); null for a joint that is not measured."
    )
    behind_deg: float | None = Field(description="Greatest difference of commanded and measured angles.")
    behind_joint: str | None
    voltage_v: float | None = Field(description="Lowest of the supply.")
    temperature_c: float | None = Field(description="Of the warmest servo.")
    temperature_joint: str | None
    rate_hz: float = Field(description="Ticks per second.")
    missed: int = Field(description="Ticks that came too late.")
    stopped: bool = Field(description="Whether the deadman has stopped the robot, as nothing was heard of the driver.")
    problems: list[str] = Field(description="Faults, and what else the servos report.")


class Choice(Part):
    """A possible answer."""

    key: str
    text: str


class Question(Part):
    """A question with its possible answers, of which the first is the usual one."""

    number: int = Field(description="Answers have the number of their question.")
    title: str = Field(description="The step to which it belongs.")
    text: str
    choices: list[Choice]
    leg: int | None = Field(description="Leg to highlight.")
    joint: int | None = Field(description="Joint of that leg to highlight: coxa, femur, tibia.")


class BringUpMessage(Message):
    """How far a bring-up is; sent whenever that changes."""

    type: Literal["bring_up"]
    state: Literal["asking", "moving", "done", "left", "failed"]
    file: str = Field(description="The calibration file, saved after every answer.")
    said: list[str] = Field(description="What was told lately, the latest last.")
    question: Question | None = Field(description="Null while servos move, and in the end.")
    known: int = Field(description="Number of joints that are calibrated.")
    joints: int
    angles_deg: list[float] = Field(
        description="Legs x (coxa, femur, tibia): where emulated servos are; of real ones the reference pose."
    )
    emulated: bool
    problem: str | None = Field(description="Why it failed.")


class CalibrationMessage(Message):
    """The calibration whose pulses are shown: the command of a joint at an angle is zero + per_deg * angle.

    All lists are legs x (coxa, femur, tibia), and empty without a calibration that fits the robot.
    """

    type: Literal["calibration"]
    name: str | None = Field(description="Name of its file; null for none.")
    problem: str | None = Field(description="Why it does not fit the robot.")
    unit: list[str] = Field(description="us or ticks.")
    zero: list[float]
    per_deg: list[float]
    low: list[int] = Field(description="Least command.")
    high: list[int] = Field(description="Greatest command.")
    low_deg: list[float] = Field(description="Least angle.")
    high_deg: list[float] = Field(description="Greatest angle.")
