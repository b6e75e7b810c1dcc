"""The recorder of a run: it notes every tick and makes a recording of them."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.command import Command
from tarsus.control.control_output import ControlOutput
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.loop.recording import Event, Recording, Unmet
from tarsus.control.readings import SensorReadings
from tarsus.control.robot_controller import RobotController
from tarsus.control.robot_state import RobotState
from tarsus.control.sensing.plain_values import as_items, as_vector
from tarsus.gait.motion import Motion
from tarsus.gait.walk_setup import WalkSetup
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import stack_poses

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Recorder"]

# A limitation that comes back within this time counts as the same one [s].
_GAP = 0.1


class Recorder:
    """Notes every tick of a run.

    Parameters
    ----------
    controller : RobotController
        The controller whose run is recorded.
    """

    def __init__(self, controller: RobotController) -> None:
        self._controller = controller
        self._command = Command()
        self._outputs = [controller.output]
        self._times = [0.0]
        self._twists = [self._command.twist]
        self._measured: list[Any] = []
        self._events: list[Event] = []
        # Commands that were not met by the time they were replaced, by the number of their limitation's event.
        self._unmet: dict[int, Unmet] = {}
        # Limitations that are present or were lately, by key: the number of their event, and the last limitation.
        self._present: dict[tuple[str, ...], tuple[int, Limitation]] = {}

    @property
    def time(self) -> float:
        """The time of the last tick [s]."""
        return self._times[-1]

    def note(self, kind: str, text: str) -> None:
        """Note an event at the time of the last tick; its kind and text are those of `Event`."""
        self._events.append(Event(self.time, self.time, kind, text))

    def command(self, command: Command) -> None:
        """Note the command for the next tick.

        Each part of the last command that it replaces is unmet if it is still limited now.
        """
        if command is self._command:
            return
        for number, unmet in self._unmet_now.items():
            new, old = (_part(each, unmet.limitation.kind) for each in (command, self._command))
            if new is not None and new != old:
                self._unmet[number] = unmet
        self._command = command

    @property
    def _unmet_now(self) -> dict[int, Unmet]:
        """What is limited in the last two ticks, by the number of its event: some come and go from tick to tick."""
        lately, events = self._times[-2:][0], self._events
        known = [each for each in self._present.values() if events[each[0]].until >= lately]
        return {number: Unmet(events[number].time, self.time, limitation) for number, limitation in known}

    def tick(self, time: float, output: ControlOutput, readings: SensorReadings) -> None:
        """Note a tick.

        Parameters
        ----------
        time, output, readings : float, ControlOutput, SensorReadings
            End of the tick [s]; what the controller gave out; what the plant measured before that.
        """
        before = self._outputs[-1]
        self._measured.append(readings.joint_angles)
        self._times.append(time)
        for found in output.interventions:
            self.note("guard", found.text())
        if output.gait.name != before.gait.name:
            self.note("gait", f"{output.gait.name} from here on")
        if output.state != before.state and RobotState.FAULT in (output.state, before.state):
            self.note("state", str(output.state))
        if output.activity != before.activity and output.state.end is not output.state:
            self.note("stage", output.activity)
        self._note_limitations(output.limitations)
        self._outputs.append(output)
        self._twists.append(self._command.twist)

    def _note_limitations(self, limitations: tuple[Limitation, ...]) -> None:
        """Note the limitations of a tick; one that comes and goes from tick to tick is one event."""
        time, present = self.time, dict[tuple[str, ...], tuple[int, Limitation]]()
        for limitation in limitations:
            number, _ = self._present.get(limitation.key, (len(self._events), limitation))
            if number == len(self._events):
                self.note("limit", limitation.text())
            self._events[number] = self._events[number]._replace(until=time)
            present[limitation.key] = number, limitation
        lately = {key: known for key, known in self._present.items() if self._events[known[0]].until > time - _GAP}
        self._present = lately | present

    def recording(self, *, name: str, rate: float) -> Recording:
        """Return the recording of the run, with its name and its nominal number of ticks per second [1/s]."""
        outputs, unmet = self._outputs, self._unmet | self._unmet_now
        twist = np.array([output.twist for output in outputs])
        guard = tuple(output.guard for output in outputs)
        # What is measured before an output shows how the angles of the last output were executed; NaN where it is no
        # number.
        legs = self._controller.robot.legs
        measured = [as_items(angles, (legs, 3)) or [None] * legs for angles in (*self._measured, None)]
        return Recording(
            robot=self._controller.robot,
            name=name,
            rate=rate,
            compliant=self._controller.compliant,
            motion=self._motion(twist),
            twist_commanded=np.array(self._twists),
            twist=twist,
            cycle_times=np.array([output.cycle_time for output in outputs]),
            belly=np.array([output.belly for output in outputs]),
            measured_angles=np.array([[*map(as_vector, items)] for items in measured]),
            states=tuple(str(output.state) for output in outputs),
            activities=tuple(output.activity for output in outputs),
            gaits=tuple(output.gait.name for output in outputs),
            guard=guard if any(guard) else (),
            interventions=dict(Counter(found.kind for output in outputs[1:] for found in output.interventions)),
            unmet=tuple(sorted(unmet.values(), key=lambda each: each.time)),
            events=tuple(self._events),
        )

    def _motion(self, twist: Float[np.ndarray, "n 3"]) -> Motion:
        """Return what the controller gave out, as a motion."""
        outputs, robot, controller = self._outputs, self._controller.robot, self._controller
        angles = np.array([output.angles for output in outputs])
        body = stack_poses([output.body for output in outputs])
        feet = np.array([output.feet for output in outputs])
        # Where the guard gave out other angles, the feet follow from these, with the body's pose as commanded.
        held = np.array([output.state is RobotState.FAULT for output in outputs])
        feet[held] = (body @ forward_kinematics(robot, angles)[..., 3, :])[held]
        heights: dict[str, Any] = {"body_height": controller.body_height, "swing_height": controller.swing_height}
        setup = WalkSetup.of(robot, outputs[0].gait, **heights)
        # Speed of each rest foothold relative to the body.
        vx, vy, wz = twist.T[..., None]
        passing = np.hypot(vx - wz * setup.rest[:, 1], vy + wz * setup.rest[:, 0])
        fastest = int(passing.max(1).argmax())
        output, speed = outputs[fastest], float(passing[fastest].max())
        return Motion(
            robot=robot,
            gait=output.gait,
            time=np.array(self._times),
            body=body,
            feet=feet,
            contacts=np.array([output.contacts for output in outputs]),
            angles=angles,
            reach=np.zeros((len(outputs), robot.legs), dtype=np.int8),
            cycle_time=output.cycle_time,
            stroke=speed * output.cycle_time * output.gait.duty_factor,
            speed=speed,
            body_height=setup.body_height,
            swing_height=setup.swing_height,
            # Folded legs may be closer to each other than walking ones.
            foot_distance=0.0 if any(output.belly for output in outputs) else setup.foot_distance,
            assumed=tuple(setup.assumed(**heights)),
        )


def _part(command: Command, kind: LimitationKind) -> Any:
    """Return the part of a command that a kind of limitation is about, or else all of it; None if it is left as is."""
    if kind is LimitationKind.FOOT_TARGET:
        return command.foot_targets or command.foot_velocities
    return getattr(command, kind.value, command)
