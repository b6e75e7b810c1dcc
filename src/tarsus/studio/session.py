"""A session of one visitor, independent of the transport: messages in, messages out, frames while driving."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, TypeAlias

from tarsus.studio.driving import Driver
from tarsus.studio.error_messages import error_message
from tarsus.studio.history import History
from tarsus.studio.live import Live
from tarsus.studio.machine.calibration import CalibrationText, calibration_message, calibration_or_problem
from tarsus.studio.machine.driven_run import DrivenRun
from tarsus.studio.machine.hardware import Hardware
from tarsus.studio.messages import client as ask
from tarsus.studio.messages.general import Done, ErrorMessage
from tarsus.studio.messages.machine import BringUpMessage
from tarsus.studio.messages.motion import DriveFrame
from tarsus.studio.messages.pose import Bounds, StateMessage
from tarsus.studio.messages.state import BodyState, JointsState, RobotChoice, StudioState, WalkOptions
from tarsus.studio.parsing import read
from tarsus.studio.poses import drag_foothold, drag_joints
from tarsus.studio.robots import choice_of_document, choice_of_preset, choice_of_text, robot_message
from tarsus.studio.state_text import state_of, text_of
from tarsus.studio.views import Views, fitted
from tarsus.studio.walks import MOST_SAMPLES
from tarsus.studio.welcome import welcome_message

if TYPE_CHECKING:
    from tarsus.studio.messages import ClientMessage, ServerMessage

__all__ = ["BOUNDS", "Session"]

BOUNDS = Bounds(message_bytes=256 * 1024, messages_per_s=120, plan_samples=MOST_SAMPLES, idle_s=0)
"""Default limits of a session."""

Answers: TypeAlias = "Iterator[ServerMessage]"


class Session:
    """A session of one visitor.

    No message raises an exception: invalid and impossible requests are answered by an error, and leave the state
    unchanged.

    Parameters
    ----------
    start : StudioState, optional
        Initial state.
    bounds : Bounds
        Limits, which are sent to the client.
    public : bool
        Whether this is a public server, which is sent to the client.
    run : DrivenRun, optional
        The run of a machine that the view Drive drives; then only that view is available.
    hardware : Hardware, optional
        The servos of the computer on which the session runs; left out, it has no access to any.
    calibration : CalibrationText, optional
        The calibration whose pulses are shown beside joint angles.
    """

    def __init__(
        self,
        start: StudioState | None = None,
        *,
        bounds: Bounds = BOUNDS,
        public: bool = False,
        run: DrivenRun | None = None,
        hardware: Hardware | None = None,
        calibration: CalibrationText | None = None,
    ) -> None:
        self._start = StudioState() if start is None else start
        self._history = History(self._start)
        self._views = Views()
        self._bounds = bounds
        self._public = public
        self._calibration = calibration
        self._live = Live(run, hardware, public=public)
        self._sent_state: StudioState | None = None

    @property
    def state(self) -> StudioState:
        """The present state."""
        return self._history.present

    @property
    def driving(self) -> bool:
        """Whether a robot is being driven, or its servos are brought up, so that `frame` returns messages."""
        return self._live.is_on

    @property
    def is_planning(self) -> bool:
        """Whether the next frame may take longer, because a change of state has to be planned."""
        return self._live.is_planning

    def receive(self, text: str | bytes) -> list[ServerMessage]:
        """Answer a message in JSON.

        Parameters
        ----------
        text : str or bytes
            JSON.
        """
        message = read(text, most=self._bounds.message_bytes)
        if isinstance(message, ErrorMessage):
            return [message, self._done(message.id)]
        return self.handle(message)

    def handle(self, message: ClientMessage) -> list[ServerMessage]:
        """Answer a message.

        Parameters
        ----------
        message : ClientMessage
            The message.

        Returns
        -------
        list of ServerMessage
            The answers; the last is `Done`.
        """
        answers: list[ServerMessage] = []
        try:
            self._live.require_available(message)
            answers.extend(_HANDLERS[type(message)](self, message))
        except Exception as error:  # every error is answered, and the session continues
            answers.append(error_message(error, id=message.id))
        if self._live.closed:  # while this was handled in another thread
            self._live.close()
        answers.append(self._done(message.id, with_state=getattr(message, "commit", True)))
        return answers

    def frame(self, dt: float) -> DriveFrame | BringUpMessage | ErrorMessage | None:
        """Return the live robot after another tick, or what has changed in its bring-up; None if there is neither.

        Parameters
        ----------
        dt : float
            Time since the last frame [s].
        """
        return self._live.frame(dt)

    def close(self) -> None:
        """End driving and bring-up, so that a machine stops; to be called when the visitor leaves."""
        self._live.close()

    def _done(self, id: int | None, *, with_state: bool = False) -> Done:
        text = None
        if with_state and self.state != self._sent_state:
            self._sent_state = self.state
            text = text_of(self.state)
        history = self._history
        return Done(type="done", id=id, undo=history.can_undo, redo=history.can_redo, state=text)

    def _everything(self, state: StudioState, *, id: int) -> Answers:
        """Yield the robot, the state, and the content of its view."""
        robot = self._views.results.robot(state)
        yield robot_message(robot, state.robot, id=id)
        if self._calibration is not None:
            yield calibration_or_problem(self._calibration, robot, id=id)
        yield StateMessage(type="state", id=id, state=state)
        yield from self._views.shown(state, id=id)

    def _take(self, state: StudioState, *, id: int, commit: bool) -> Answers:
        """Change to a state, after everything that it needs has been computed."""
        state = fitted(state, self._views.results.robot(state))
        answers = list(self._everything(state, id=id))
        self._live.end_driving()
        self._history.change(state, commit=commit)
        yield from answers

    def _hello(self, message: ask.Hello) -> Answers:
        live = self._live
        offers: dict[str, Any] = {"hardware": live.hardware_offer, "run": live.run_offer}
        yield welcome_message(self._bounds, public=self._public, **offers, id=message.id)
        state = self.state
        if message.state is not None and live.run is None:
            try:
                state = state_of(message.state)
                state = fitted(state, self._views.results.robot(state))
            except Exception as error:  # an invalid link: report it, and start with the default state
                yield error_message(error, id=message.id)
                state = self.state
        self._history = History(state)
        self._sent_state = None
        yield from self._everything(state, id=message.id)

    def _ping(self, _message: ask.Ping) -> Answers:
        yield from ()

    def _view(self, message: ask.SetView) -> Answers:
        picture = self.state.picture if message.picture is None else message.picture
        state = self.state.model_copy(update={"view": message.view, "picture": picture})
        answers = [] if message.view == self.state.view else list(self._views.shown(state, id=message.id))
        if message.view != "drive":
            self._live.end_driving()
        self._history.look(message.view, picture)
        yield from answers

    def _preset(self, message: ask.SetRobot) -> Answers:
        yield from self._other_robot(choice_of_preset(message.preset), message)

    def _other_robot(self, choice: RobotChoice, message: ask.SetRobot | ask.SetToml) -> Answers:
        """Change to another robot, with default poses and walk: those of the present robot might make it fall."""
        reset = {"robot": choice, "joints": JointsState(), "body": BodyState(), "walk": WalkOptions()}
        yield from self._take(self.state.model_copy(update=reset), id=message.id, commit=message.commit)

    def _same_robot(self, choice: RobotChoice, message: ask.SetDocument | ask.SetToml) -> Answers:
        state = self.state.model_copy(update={"robot": choice})
        yield from self._take(state, id=message.id, commit=message.commit)

    def _document(self, message: ask.SetDocument) -> Answers:
        yield from self._same_robot(choice_of_document(message.document), message)

    def _toml(self, message: ask.SetToml) -> Answers:
        choice = choice_of_text(message.text, where="the file")
        name = choice.preset if choice.document is None else choice.document["name"]
        present = self._views.results.robot(self.state).name
        yield from (self._same_robot if name == present else self._other_robot)(choice, message)

    def _pulses(self, message: ask.SetCalibration) -> Answers:
        robot = self._views.results.robot(self.state)
        if message.text is None:
            self._calibration = None
            yield calibration_or_problem(None, robot, id=message.id)
            return
        found = CalibrationText(message.name or "the calibration", message.text)
        answer = calibration_message(found.name, found.of(robot), id=message.id)
        self._calibration = found
        yield answer

    def _joints(self, message: ask.SetJoints) -> Answers:
        yield from self._posed({"joints": message.joints}, message)

    def _body(self, message: ask.SetBody) -> Answers:
        yield from self._posed({"body": message.body}, message)

    def _posed(self, change: dict[str, Any], message: ask.ChangePose) -> Answers:
        """Change a pose; the answer is for the view of that pose, whatever the present view is."""
        state = self.state.model_copy(update=change)
        view = "joints" if "joints" in change else "sources" if state.view == "sources" else "body"
        shown = state.model_copy(update={"view": view})
        forces = message.commit or message.forces
        answers: list[ServerMessage] = [self._views.pose(shown, id=message.id, forces=forces)]
        if view == "sources":
            answers.append(self._views.source(shown, id=message.id))
        self._history.change(state, commit=message.commit)
        yield from answers

    def _drag(self, message: ask.DragFoot) -> Answers:
        robot, state = self._views.results.robot(self.state), self.state
        change: dict[str, Any]
        if state.view == "joints":
            change = {"joints": drag_joints(robot, state.joints, message.leg, message.position_mm)}
        else:
            change = {"body": drag_foothold(robot, state.body, message.leg, message.position_mm)}
        answers = list(self._posed(change, message))
        if message.commit:
            yield StateMessage(type="state", id=message.id, state=self.state)
        yield from answers

    def _walk(self, message: ask.SetWalk) -> Answers:
        state = self.state.model_copy(update={"walk": message.walk})
        answers: list[ServerMessage] = [self._views.walk(state, id=message.id)]
        if state.view == "loads":
            answers.append(self._loads_or_why(state, id=message.id))
        self._history.change(state, commit=message.commit)
        yield from answers

    def _loads_or_why(self, state: StudioState, *, id: int) -> ServerMessage:
        """Return the loads of a walk, or the error; the walk is valid without loads."""
        try:
            return self._views.loads(state, id=id)
        except Exception as error:
            return error_message(error, id=id)

    def _loads(self, message: ask.SetLoads) -> Answers:
        state = self.state.model_copy(update={"loads": message.loads})
        # The client relates loads to the walk that it received last, which may not be the walk of these loads.
        walk = [] if self._views.has_sent_walk(state) else [self._views.walk(state, id=message.id)]
        answer = self._views.loads(state, id=message.id)
        self._history.change(state, commit=message.commit)
        yield from walk
        yield answer

    def _physics(self, message: ask.SetPhysics) -> Answers:
        state = self.state.model_copy(update={"physics": message.physics})
        answers = list(self._views.terrain(state, id=message.id))
        if message.physics != self.state.physics and (message.physics.on or self.state.physics.on):
            # The client starts driving again when it sees that the physics has changed.
            self._live.end_driving()
        self._history.change(state, commit=message.commit)
        yield from answers

    def _simulate(self, message: ask.Simulate) -> Answers:
        yield self._views.simulated(self.state, id=message.id)

    def _servos(self, message: ask.SizeServos) -> Answers:
        yield self._views.servos(self.state, id=message.id)

    def _workspace(self, message: ask.ShowWorkspace) -> Answers:
        yield self._views.workspace(self.state, message.leg, id=message.id)

    def _source(self, message: ask.ChooseSource) -> Answers:
        state = self.state.model_copy(update={"source": message.source})
        answer = self._views.source(state, id=message.id)
        self._history.change(state, commit=message.commit)
        yield answer

    def _drive(self, message: ask.Drive) -> Answers:
        self._live.drive(message, self._driver)
        yield from ()

    def _driver(self, id: int) -> Driver:
        return Driver(self._views.results.robot(self.state), physics=self._views.live(self.state), id=id)

    def _command(self, message: ask.Command) -> Answers:
        self._live.command(message)
        yield from ()

    def _end_run(self, _message: ask.EndRun) -> Answers:
        self._live.end_run()
        yield from ()

    def _bring_up(self, message: ask.BringUp) -> Answers:
        self._live.bring_up_servos(message, self._views.results.robot(self.state))
        yield from ()

    def _answer(self, message: ask.Answer) -> Answers:
        self._live.answer(message)
        yield from ()

    def _undo(self, message: ask.Undo) -> Answers:
        self._live.end_driving()
        yield from self._everything(self._history.undo(), id=message.id)

    def _redo(self, message: ask.Redo) -> Answers:
        self._live.end_driving()
        yield from self._everything(self._history.redo(), id=message.id)

    def _open(self, message: ask.OpenState) -> Answers:
        yield from self._take(state_of(message.state), id=message.id, commit=message.commit)

    def _download(self, message: ask.Download) -> Answers:
        yield self._views.file(self.state, message.what, id=message.id)


_HANDLERS: dict[type[Any], Callable[[Session, Any], Answers]] = {
    ask.Hello: Session._hello,
    ask.Ping: Session._ping,
    ask.SetView: Session._view,
    ask.SetRobot: Session._preset,
    ask.SetDocument: Session._document,
    ask.SetToml: Session._toml,
    ask.SetCalibration: Session._pulses,
    ask.SetJoints: Session._joints,
    ask.SetBody: Session._body,
    ask.DragFoot: Session._drag,
    ask.SetWalk: Session._walk,
    ask.SetLoads: Session._loads,
    ask.SetPhysics: Session._physics,
    ask.Simulate: Session._simulate,
    ask.SizeServos: Session._servos,
    ask.ShowWorkspace: Session._workspace,
    ask.ChooseSource: Session._source,
    ask.Drive: Session._drive,
    ask.Command: Session._command,
    ask.EndRun: Session._end_run,
    ask.BringUp: Session._bring_up,
    ask.Answer: Session._answer,
    ask.Undo: Session._undo,
    ask.Redo: Session._redo,
    ask.OpenState: Session._open,
    ask.Download: Session._download,
}
