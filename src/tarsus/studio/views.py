"""Content of the seven views for a state."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, TypeAlias

from tarsus.errors import TarsusError, UnreachableError
from tarsus.studio.error_messages import error_message
from tarsus.studio.files import angles_csv, file_name, text_file, toml_of, walk_csv
from tarsus.studio.leg_workspace import workspace_message
from tarsus.studio.loads import loads_message, servos_message
from tarsus.studio.messages.general import FileMessage, SourceMessage
from tarsus.studio.messages.motion import LoadsMessage, ServosMessage, WalkMessage
from tarsus.studio.messages.physics import SimulatedMessage, TerrainMessage
from tarsus.studio.messages.pose import PoseMessage, WorkspaceMessage
from tarsus.studio.messages.state import BodyState, JointsState, OwnGait, StudioState
from tarsus.studio.physics.live import LivePhysics
from tarsus.studio.physics.terrains import terrain_message
from tarsus.studio.physics.walk import simulated_message
from tarsus.studio.player import player_data, player_page
from tarsus.studio.poses import require_leg
from tarsus.studio.results import Results
from tarsus.studio.sources.page import source_message
from tarsus.studio.standing import resting_message, standing_message
from tarsus.studio.walks import walk_message

if TYPE_CHECKING:
    from tarsus.gait.motion import Motion
    from tarsus.robot.robot import Robot
    from tarsus.studio.messages import ServerMessage

__all__ = ["Views", "fitted"]

Answers: TypeAlias = "Iterator[ServerMessage]"


def fitted(state: StudioState, robot: Robot) -> StudioState:
    """Return the state without values for another number of legs.

    Parameters
    ----------
    state : StudioState
        A state, possibly of another robot.
    robot : Robot
        A single robot.
    """
    changes: dict[str, object] = {}
    count = 3 * robot.legs
    if state.joints.angles_deg is not None and len(state.joints.angles_deg) != count:
        changes["joints"] = JointsState()
    if state.body.feet_mm is not None and len(state.body.feet_mm) != count:
        changes["body"] = state.body.model_copy(update={"feet_mm": None})
    if isinstance(state.walk.gait, OwnGait) and len(state.walk.gait.offsets) != robot.legs:
        changes["walk"] = state.walk.model_copy(update={"gait": None})
    if state.source.leg >= robot.legs:
        changes["source"] = state.source.model_copy(update={"leg": 0})
    if state.picture.leg is not None and state.picture.leg >= robot.legs:
        changes["picture"] = state.picture.model_copy(update={"leg": None})
    return state.model_copy(update=changes)


class Views:
    """Creates the messages that show a state; each result is computed once."""

    def __init__(self) -> None:
        self.results = Results()
        self._sent: Motion | None = None

    def shown(self, state: StudioState, *, id: int) -> Answers:
        """Yield the content of the view; if it is not possible, the error and the robot in its default stance.

        Parameters
        ----------
        state : StudioState
            The state.
        id : int
            Id of the message that is answered.
        """
        try:
            yield from self.terrain(state, id=id)
        except TarsusError as error:
            # The rest of the view does not need physics.
            yield error_message(error, id=id)
        try:
            if state.view in ("walk", "loads"):
                yield self.walk(state, id=id)
            else:
                yield self.pose(state, id=id)
            if state.view == "loads":
                yield self.loads(state, id=id)
            if state.view == "sources":
                yield self.source(state, id=id)
        except TarsusError as error:
            yield error_message(error, id=id)
            yield self._default_pose(state, id=id)

    def pose(self, state: StudioState, *, id: int, forces: bool = True) -> PoseMessage:
        """Return the pose of the present view, with contact forces and torques where they are wanted."""
        if state.view == "joints":
            return resting_message(self.results.resting(state), id=id, view="joints", forces=forces)
        if state.view in ("body", "sources"):
            return standing_message(self.results.standing(state), id=id, view=state.view, forces=forces)
        return self._default_pose(state, id=id)

    def _default_pose(self, state: StudioState, *, id: int) -> PoseMessage:
        """Return the default stance; for a robot that can't stand, the resting pose with all angles zero."""
        plain = state.model_copy(update={"body": BodyState(), "joints": JointsState()})
        try:
            return standing_message(self.results.standing(plain), id=id, view=state.view)
        except UnreachableError:
            return resting_message(self.results.resting(plain), id=id, view=state.view)

    def walk(self, state: StudioState, *, id: int) -> WalkMessage:
        """Return the walk."""
        motion = self.results.walk(state)
        message = walk_message(motion, longest=self.results.longest(state), id=id)
        self._sent = motion
        return message

    def has_sent_walk(self, state: StudioState) -> bool:
        """Return whether the walk of the state was sent last."""
        return self.results.walk(state) is self._sent

    def terrain(self, state: StudioState, *, id: int) -> Iterator[TerrainMessage]:
        """Yield the terrain where physics is on, in the views that show it."""
        if state.physics.on and state.view in ("walk", "drive"):
            yield terrain_message(self.results.terrain(state), state.physics.terrain, id=id)

    def simulated(self, state: StudioState, *, id: int) -> SimulatedMessage:
        """Return the walk in physics."""
        return simulated_message(self.results.simulated(state), id=id)

    def live(self, state: StudioState) -> LivePhysics | None:
        """Return a driven robot in physics; None where physics is off."""
        if not state.physics.on:
            return None
        return LivePhysics(self.results.robot(state), state.physics, self.results.terrain(state))

    def loads(self, state: StudioState, *, id: int) -> LoadsMessage:
        """Return the joint loads of the walk."""
        return loads_message(self.results.loads(state), state.loads, id=id)

    def servos(self, state: StudioState, *, id: int) -> ServosMessage:
        """Return the suitable servos."""
        return servos_message(self.results.loads(state), state.loads, id=id)

    def workspace(self, state: StudioState, leg: int, *, id: int) -> WorkspaceMessage:
        """Return the workspace of a leg for the body pose that the view shows."""
        robot = self.results.robot(state)
        require_leg(robot, leg)
        body, angles = self.results.shown(state)
        return workspace_message(robot, leg, body, float(angles[leg, 0]), id=id)

    def source(self, state: StudioState, *, id: int) -> SourceMessage:
        """Return a source document with the values of the pose of the view Body."""
        require_leg(self.results.robot(state), state.source.leg)
        return source_message(self.results.standing(state), state.source, state.walk, id=id)

    def file(self, state: StudioState, what: str, *, id: int) -> FileMessage:
        """Return an exported file."""
        robot = self.results.robot(state)
        if what == "toml":
            return text_file(file_name(robot, "", "toml"), toml_of(robot), id=id)
        if what == "angles":
            return text_file(file_name(robot, "angles", "csv"), angles_csv(robot, self.results.shown(state)[1]), id=id)
        motion = self.results.walk(state)
        if what == "csv":
            return text_file(file_name(robot, "walk", "csv"), walk_csv(motion), id=id)
        data = player_data(motion, choice=state.robot, options=state.loads)
        return text_file(file_name(robot, "walk", "html"), player_page(data), id=id)
