"""What the server says besides: errors, the end of an answer, files, and the source documents' equations."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tarsus.studio.messages.base import Message, Part
from tarsus.studio.messages.motion import LoadsMessage, WalkMessage
from tarsus.studio.messages.pose import RobotMessage

__all__ = [
    "Done",
    "Equation",
    "Erratum",
    "ErrorMessage",
    "FileMessage",
    "MathNode",
    "PlayerData",
    "Problem",
    "SourceMessage",
]


class Problem(Part):
    """One thing that is wrong in a robot file."""

    key: str | None = Field(description="Path of the key, such as legs[2].position_mm; null where there is none.")
    text: str


class ErrorMessage(Part):
    """What was asked for is not possible; the state is what it was."""

    type: Literal["error"]
    id: int | None = Field(description="Null where the message was so malformed that its id is unknown.")
    kind: Literal[
        "message",
        "limit",
        "input",
        "unknown_name",
        "robot_file",
        "missing_data",
        "unreachable",
        "stroke",
        "collision",
        "unavailable",
        "internal",
    ]
    text: str
    problems: list[Problem] = Field(default_factory=list)
    longest_stroke_mm: float | None = None


class Done(Part):
    """The end of an answer."""

    type: Literal["done"]
    id: int | None
    dropped: bool = Field(default=False, description="Whether a newer message of the same type took its place.")
    undo: bool = Field(default=False, description="Whether there is something to undo.")
    redo: bool = False
    state: str | None = Field(default=None, description="The state as a short URL-safe text; null: unchanged.")


class FileMessage(Message):
    """A file to save."""

    type: Literal["file"]
    name: str
    mime: str
    text: str


class PlayerData(Part):
    """What the self-contained page of a walk holds, as JSON in its element `#motion`."""

    robot: RobotMessage
    walk: WalkMessage
    loads: LoadsMessage | None = Field(description="Null where the robot's masses are unknown.")


class MathNode(Part):
    """A piece of presentation MathML: a tag, and either text or children."""

    tag: Literal["mrow", "mi", "mn", "mo", "mtext", "mfrac", "msup", "msub", "msqrt"]
    text: str | None = None
    children: list[MathNode] = Field(default_factory=list)


class Equation(Part):
    """A line of a source document, with the live numbers in it."""

    key: str
    name: str
    symbol: MathNode
    formula: MathNode | None = Field(description="Null where the number is given.")
    numbers: MathNode | None = Field(description="The formula with the numbers filled in.")
    plain: str = Field(description="All of it in one line of text.")
    value: float | None
    unit: str
    ours: str | None = Field(description="The same in Tarsus' own words, such as coxa or tibia + 90 deg.")
    printed_value: str | None = Field(description="What the document prints for its own robot.")
    note: str | None


class Erratum(Part):
    """A mistake in a document, and what it would make of the live numbers."""

    printed: str
    right: str
    why: str
    printed_formula: MathNode | None
    right_formula: MathNode | None
    printed_value: float | None
    right_value: float | None
    unit: str


class SourceMessage(Message):
    """One of the five source documents."""

    type: Literal["source"]
    number: str
    title: str
    about: str
    leg: int
    equations: list[Equation]
    errata: list[Erratum]
