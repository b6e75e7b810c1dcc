"""Messages of a client. Each is answered by any number of messages with its id, the last of which is `done`.

Messages that change the state have `commit`: false during the movement of a slider or mouse, true at its end. Undo goes
from commit to commit. Of several queued messages of a type, only the newest is processed.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import Field

from tarsus.studio.messages.base import MOST_LEGS, Angle, Coordinate, Message, Name, Number, Positive, Triple
from tarsus.studio.messages.physics import PhysicsOptions
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
    "Answer",
    "BringUp",
    "ChooseSource",
    "ClientMessage",
    "Command",
    "Download",
    "DragFoot",
    "Drive",
    "EndRun",
    "Hello",
    "OpenState",
    "Ping",
    "Redo",
    "SetBody",
    "SetCalibration",
    "SetDocument",
    "SetJoints",
    "SetLoads",
    "SetPhysics",
    "SetRobot",
    "SetToml",
    "SetView",
    "SetWalk",
    "ShowWorkspace",
    "Simulate",
    "SizeServos",
    "Undo",
]

Leg: TypeAlias = Annotated[int, Field(ge=0, lt=MOST_LEGS)]
StateText: TypeAlias = Annotated[str, Field(max_length=60_000)]


class Hello(Message):
    """The first message. Answers: welcome, and the answers to `open`."""

    type: Literal["hello"]
    state: StateText | None = Field(default=None, description="State to restore; null for the default.")


class Ping(Message):
    """No operation; keeps an idle session open. Answer: done."""

    type: Literal["ping"]


class Change(Message):
    """A change of the state."""

    commit: bool = Field(default=True, description="Whether undo returns to the state after this change.")


class ChangePose(Change):
    """A change of the pose."""

    forces: bool = Field(
        default=False, description="Whether the answer has forces and torques; with `commit` it always has."
    )


class SetView(Message):
    """Change the view or the camera, which is not an undo step. Answers, if the view changes: its content."""

    type: Literal["view"]
    view: View
    picture: Picture | None = None


class SetRobot(Change):
    """Select a preset, and reset poses and walk. Answers: robot, state, content of the view."""

    type: Literal["robot"]
    preset: Name


class SetDocument(Change):
    """Change the robot by the keys of its file; poses and walk are kept. Answers: robot, state, content of the view."""

    type: Literal["document"]
    document: Annotated[dict[str, Any], Field(json_schema_extra={"ts": "RobotFile"})]


class SetToml(Change):
    """Change the robot by the text of its file; a robot of another name resets poses and walk.

    Answers: robot, state, content of the view.
    """

    type: Literal["toml"]
    text: Annotated[str, Field(max_length=200_000)]


class SetCalibration(Message):
    """Show the pulses of a calibration beside joint angles, or, for null, no longer. Answer: calibration."""

    type: Literal["calibration"]
    name: Name | None = Field(default=None, description="Name of its file.")
    text: Annotated[str, Field(max_length=200_000)] | None = None


class SetJoints(ChangePose):
    """Set joint angles; the resting pose follows. Answer: pose."""

    type: Literal["joints"]
    joints: JointsState


class SetBody(ChangePose):
    """Set the body pose relative to the feet. Answer: pose."""

    type: Literal["body"]
    body: BodyState


class DragFoot(ChangePose):
    """Move one foot: in the view Joints by changing the joint angles, else the foothold.

    Answers: pose; with `commit`, state before it.
    """

    type: Literal["drag_foot"]
    leg: Leg
    position_mm: Triple = Field(description="In G.")


class SetWalk(Change):
    """Plan a walk. Answer: walk; in the view Loads also loads."""

    type: Literal["walk"]
    walk: WalkOptions


class SetLoads(Change):
    """Compute the joint loads of the walk. Answer: loads; walk before it if the walk has changed since it was sent."""

    type: Literal["loads"]
    loads: LoadOptions


class SetPhysics(Change):
    """Change the options of physics; a robot that is driven stops being so. Answer: terrain, where physics is on."""

    type: Literal["physics"]
    physics: PhysicsOptions


class Simulate(Message):
    """Simulate the walk in physics, which takes a second or two. Answer: simulated."""

    type: Literal["simulate"]


class SizeServos(Message):
    """Size servos for the walk and the payload, which takes a second or two. Answer: servos."""

    type: Literal["servos"]


class ShowWorkspace(Message):
    """Compute the workspace of a leg for the present body pose. Answer: workspace."""

    type: Literal["workspace"]
    leg: Leg


class ChooseSource(Change):
    """Show the equations of a source document with live values. Answer: source."""

    type: Literal["source"]
    source: SourceChoice


class Drive(Message):
    """Start or stop driving. While it is on, frames are sent with the id of this message."""

    type: Literal["drive"]
    on: bool


class EndRun(Message):
    """Stop the robot that is driven, and end the run that this server belongs to. Answer: done."""

    type: Literal["end_run"]


class Command(Message):
    """A command to the live robot, which holds until the next; null leaves a quantity unchanged. Answer: done."""

    type: Literal["command"]
    velocity_mm_s: tuple[Number, Number] = Field(description="Forward, left.")
    turn_deg_s: Angle
    body: tuple[Coordinate, Coordinate, Coordinate, Angle, Angle, Angle] | None = Field(
        default=None, description="x, y, z [mm], roll, pitch, yaw [deg] relative to the level body."
    )
    gait: Name | None = None
    body_height_mm: Coordinate | None = None
    swing_height_mm: Positive | None = None
    cycle_time_s: Positive | None = None
    state: Literal["standing", "lying", "folded"] | None = Field(default=None, description="Requested state.")


class BringUp(Message):
    """Begin, resume or leave the bring-up of this robot's servos. While it is on, bring_up is sent with this id."""

    type: Literal["bring_up"]
    on: bool


class Answer(Message):
    """Answer a question of the bring-up. Answer: done; the next question follows when it is asked."""

    type: Literal["answer"]
    number: int
    key: Annotated[str, Field(max_length=20)] = Field(description="Key of one of the choices.")


class Undo(Message):
    """Return to the previous commit. Answers: robot, state, content of the view."""

    type: Literal["undo"]


class Redo(Message):
    """Revert an undo. Answers: as for undo."""

    type: Literal["redo"]


class OpenState(Change):
    """Restore a state from its text. Answers: robot, state, content of the view."""

    type: Literal["open"]
    state: StateText


class Download(Message):
    """Export a file. Answer: file."""

    type: Literal["download"]
    what: Literal["csv", "html", "toml", "angles"]


ClientMessage: TypeAlias = Annotated[
    Hello
    | Ping
    | SetView
    | SetRobot
    | SetDocument
    | SetToml
    | SetCalibration
    | SetJoints
    | SetBody
    | DragFoot
    | SetWalk
    | SetLoads
    | SetPhysics
    | Simulate
    | SizeServos
    | ShowWorkspace
    | ChooseSource
    | Drive
    | Command
    | EndRun
    | BringUp
    | Answer
    | Undo
    | Redo
    | OpenState
    | Download,
    Field(discriminator="type"),
]
"""Any message of a client."""
