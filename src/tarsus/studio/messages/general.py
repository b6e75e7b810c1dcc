"""Further messages of the server: errors, the end of an answer, files, and the equations of the source documents."""

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
    """A problem in a robot file."""

    key: str | None = Field(description="Path of the key, such as legs[2].position_mm; null if the problem has no key.")
    text: str


class ErrorMessage(Part):
    """A request is not possible; the state is unchanged."""

    type: Literal["error"]
    id: int | None = Field(description="Null if the id of a malformed message is unknown.")
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
    dropped: bool = Field(default=False, description="Whether a newer message of the same type replaced it.")
    undo: bool = Field(default=False, description="Whether there is something to undo.")
    redo: bool = False
    state: str | None = Field(default=None, description="State as URL-safe text; null if unchanged.")


class FileMessage(Message):
    """An exported file."""

    type: Literal["file"]
    name: str
    mime: str
    text: str


class PlayerData(Part):
    """Data of the offline player, as JSON in its element `#motion`."""

    robot: RobotMessage
    walk: WalkMessage
    loads: LoadsMessage | None = Field(description="Null if the masses of the robot are unknown.")


class MathNode(Part):
    """An element of presentation MathML: a tag, and either text or children."""

    tag: Literal["mrow", "mi", "mn", "mo", "mtext", "mfrac", "msup", "msub", "msqrt"]
    text: str | None = None
    children: list[MathNode] = Field(default_factory=list)


class Equation(Part):
    """An equation of a source document with live values."""

    key: str
    name: str
    symbol: MathNode
    formula: MathNode | None = Field(description="Null for a given quantity.")
    numbers: MathNode | None = Field(description="The formula with the values substituted.")
    plain: str = Field(description="The whole equation as text.")
    value: float | None
    unit: str
    ours: str | None = Field(description="The same quantity in Tarsus, such as coxa or tibia + 90 deg.")
    printed_value: str | None = Field(description="Value printed in the document for its robot.")
    note: str | None


class Erratum(Part):
    """An erratum of a document, with the results of both formulas."""

    printed: str
    correct: str
    reason: str
    printed_formula: MathNode | None
    correct_formula: MathNode | None
    printed_value: float | None
    correct_value: float | None
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
