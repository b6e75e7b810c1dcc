"""What a client says. Every message is answered by any number of messages with its id, and in the end by `done`.

Messages that change the state have `commit`: false while a slider or a mouse is still moving, true where it comes to
rest. Undo goes from commit to commit. Of messages of the same type that wait, only the newest is worked on.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import Field

from tarsus.studio.messages.base import MOST_LEGS, Angle, Coordinate, Message, Name, Number, Positive, Triple
from tarsus.studio.messages.state import (
    BodyState,
    JointsState,
    LoadOptions,
    Picture,
    SourceChoice,
    View,
    WalkOptions,
)

__all__ = [
    "ChooseSource",
    "ClientMessage",
    "Command",
    "Download",
    "DragFoot",
    "Drive",
    "Hello",
    "OpenState",
    "Ping",
    "Redo",
    "SetBody",
    "SetDocument",
    "SetJoints",
    "SetLoads",
    "SetRobot",
    "SetToml",
    "SetView",
    "SetWalk",
    "ShowWorkspace",
    "SizeServos",
    "Undo",
]

Leg: TypeAlias = Annotated[int, Field(ge=0, lt=MOST_LEGS)]
StateText: TypeAlias = Annotated[str, Field(max_length=60_000)]


class Hello(Message):
    """The first message. Answers: welcome, then all that `open` answers."""

    type: Literal["hello"]
    state: StateText | None = Field(default=None, description="The state to go on with; null begins anew.")


class Ping(Message):
    """Nothing, to keep an idle session. Answer: done."""

    type: Literal["ping"]


class Change(Message):
    """A change of the state."""

    commit: bool = Field(default=True, description="Whether undo shall come back to what is here now.")


class SetView(Message):
    """Go to a view, or look at it differently; no step of undo. Answers, where the view changes: what it shows."""

    type: Literal["view"]
    view: View
    picture: Picture | None = None


class SetRobot(Change):
    """Take a preset; poses and walk begin anew. Answers: robot, state, what the view shows."""

    type: Literal["robot"]
    preset: Name


class SetDocument(Change):
    """Take a robot by the keys of its file; poses and walk stay. Answers: robot, state, what the view shows."""

    type: Literal["document"]
    document: Annotated[dict[str, Any], Field(json_schema_extra={"ts": "RobotFile"})]


class SetToml(Change):
    """Take a robot by the text of its file. Answers: robot, state, what the view shows."""

    type: Literal["toml"]
    text: Annotated[str, Field(max_length=200_000)]


class SetJoints(Change):
    """Turn joints; the robot rests as it would. Answer: pose."""

    type: Literal["joints"]
    joints: JointsState


class SetBody(Change):
    """Move the body over its feet. Answer: pose."""

    type: Literal["body"]
    body: BodyState


class DragFoot(Change):
    """Put one foot elsewhere: in the view Joints that leg's angles follow, else its foothold.

    Answers: pose, and with `commit` the state before it.
    """

    type: Literal["drag_foot"]
    leg: Leg
    position_mm: Triple = Field(description="In G.")


class SetWalk(Change):
    """Plan a walk. Answer: walk; in the view Loads also loads."""

    type: Literal["walk"]
    walk: WalkOptions


class SetLoads(Change):
    """Work out what the walk asks of the joints. Answer: loads, with walk where it was not sent since it changed."""

    type: Literal["loads"]
    loads: LoadOptions


class SizeServos(Message):
    """Choose servos for the walk and the payload; takes a second or two. Answer: servos."""

    type: Literal["servos"]


class ShowWorkspace(Message):
    """Tell what a leg reaches with the body as it is. Answer: zone."""

    type: Literal["workspace"]
    leg: Leg


class ChooseSource(Change):
    """Show a source document's equations with the live numbers. Answer: source."""

    type: Literal["source"]
    source: SourceChoice


class Drive(Message):
    """Begin or end live walking. While it is on, frames come by themselves, with this message's id."""

    type: Literal["drive"]
    on: bool


class Command(Message):
    """A command to the live robot, which holds until the next; null leaves a quantity unchanged. Answer: done."""

    type: Literal["command"]
    velocity_mm_s: tuple[Number, Number] = Field(description="Forward, left.")
    turn_deg_s: Angle
    body: tuple[Coordinate, Coordinate, Coordinate, Angle, Angle, Angle] | None = Field(
        default=None, description="x, y, z [mm], roll, pitch, yaw [deg] against the level body."
    )
    gait: Name | None = None
    body_height_mm: Coordinate | None = None
    swing_height_mm: Positive | None = None
    cycle_time_s: Positive | None = None
    state: Literal["standing", "lying", "folded"] | None = Field(default=None, description="Requested state.")


class Undo(Message):
    """Go back to the commit before. Answers: robot where it changed, state, what the view shows."""

    type: Literal["undo"]


class Redo(Message):
    """Take an undo back. Answers: as for undo."""

    type: Literal["redo"]


class OpenState(Change):
    """Take the state that a text holds. Answers: robot, state, what the view shows."""

    type: Literal["open"]
    state: StateText


class Download(Message):
    """Ask for a file. Answer: file."""

    type: Literal["download"]
    what: Literal["csv", "html", "toml", "angles"]


ClientMessage: TypeAlias = Annotated[
    Hello
    | Ping
    | SetView
    | SetRobot
    | SetDocument
    | SetToml
    | SetJoints
    | SetBody
    | DragFoot
    | SetWalk
    | SetLoads
    | SizeServos
    | ShowWorkspace
    | ChooseSource
    | Drive
    | Command
    | Undo
    | Redo
    | OpenState
    | Download,
    Field(discriminator="type"),
]
"""Any message of a client."""
