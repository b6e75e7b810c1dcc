"""A machine to try a bring-up on: emulated servos with mixed-up ids, directions and zeros, and hands that hold legs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import PortError
from tarsus.hardware.bringup.beginning import EMULATED
from tarsus.hardware.bringup.dialogue import Topic
from tarsus.hardware.bringup.reference_pose import reference_angles
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.registry import bus_kind, bus_over
from tarsus.hardware.calibration.blank import nominal_calibration
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.calibration.parts import FootSwitches
from tarsus.hardware.emulation.registry import emulate
from tarsus.hardware.transport.clock import Clock, SystemClock
from tarsus.hardware.transport.memory import MemoryI2c, MemoryTransport
from tarsus.representation import represented
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["EmulatedMachine"]

# Greatest offset of zeros from their nominal values, and of joints from the reference pose at first [rad].
_OFF, _AWAY = math.radians(5), math.radians(10)
# How near to its limits a hand brings a joint [rad].
_NEAR = math.radians(5)


@represented("truth")
class EmulatedMachine:
    """A robot as someone has built it: what is plugged where, and which way it turns, is to be found out.

    The same robot and kind of servos always make the same machine, so that a bring-up can be resumed.

    Parameters
    ----------
    robot : Robot
        A single robot.
    kind : str
        Kind of its servo bus.
    clock : Clock, optional
        The machine's.

    Attributes
    ----------
    truth : Calibration
        What a bring-up has to find.
    servos : mapping of int to EmulatedServo
        The servos by id or channel.
    """

    def __init__(self, robot: Robot, kind: str, *, clock: Clock | None = None) -> None:
        self._clock: Clock = clock or SystemClock()
        self.truth = _mixed_up(nominal_calibration(robot, robot.name, kind=kind, port=EMULATED))
        numbers = [joint.number for row in self.truth.joints for joint in row]
        self._line: Any = emulate(kind, sorted(number for number in numbers if number is not None))
        self.servos = self._line.servos
        away = np.random.default_rng(1).uniform(-_AWAY, _AWAY, (robot.legs, len(JOINTS)))
        self._place(reference_angles(robot) + away)
        self._press(None)

    @property
    def angles(self) -> Float[np.ndarray, "legs 3"]:
        """The joint angles now ``(legs, 3)`` [rad]."""
        positions = [[self.servos[joint.number].position for joint in row] for row in self.truth.joints]
        return self.truth.angles(np.array(positions))

    def open(self, kind: str, port: str) -> Bus:
        """Return the bus of its servos.

        Parameters
        ----------
        kind : str
            Kind of the bus.
        port : str
            Its port: ``"emulated"``.

        Raises
        ------
        PortError
            If the bus or the port is another one.
        """
        known = self.truth.buses[0].kind
        if (kind, port) != (known, EMULATED):
            remedy = "Begin with another calibration file."
            raise PortError(kind, port, expected=f"{known} on {EMULATED}", received=f"{kind} on {port}", remedy=remedy)
        if bus_kind(kind).transport == "i2c":
            return bus_over(kind, MemoryI2c(self._line, self._clock, port=port))
        return bus_over(kind, MemoryTransport(self._line, self._clock, port=port))

    def hold(self, topic: Topic) -> None:
        """Do what a question asks a hand to do: hold a limp leg, turn a joint to an end of its travel, press a foot.

        Parameters
        ----------
        topic : Topic
            What the question is about.
        """
        self._press(None)
        if topic.leg is None or not topic.pose:
            return
        robot, angles = self.truth.robot, self.angles.copy()
        if topic.pose == "pressed":
            self._press(topic.leg)
            return
        if topic.pose == "reference":
            angles[topic.leg] = reference_angles(robot)[topic.leg]
        elif topic.joint is not None:
            low, high = self.truth.limits[topic.leg, topic.joint]
            angles[topic.leg, topic.joint] = low + _NEAR if topic.pose == "one end" else high - _NEAR
        self._place(angles)

    def _press(self, leg: int | None) -> None:
        switches = self.truth.foot_switches
        if switches is not None:
            on = {number: at == leg for at, number in enumerate(switches.inputs) if number is not None}
            self._line.levels = {number: float(pressed == switches.closed) for number, pressed in on.items()}

    def _place(self, angles: Float[np.ndarray, "legs 3"]) -> None:
        for row, commands in zip(self.truth.joints, self.truth.commands(angles).tolist(), strict=True):
            for joint, command in zip(row, commands, strict=True):
                servo = self.servos[joint.number]
                if not servo.torque:
                    servo.place(command)


def _mixed_up(calibration: Calibration) -> Calibration:
    """Return the calibration with other ids, directions and zeros."""
    random = np.random.default_rng(0)
    known = [joint.number for row in calibration.joints for joint in row if joint.number is not None]
    numbers = random.permutation(known)
    for leg, row in enumerate(calibration.joints):
        for j, joint in enumerate(row):
            assert joint.scale is not None
            assert joint.limits is not None
            direction = int(random.choice((-1, 1)))
            centre = float(np.asarray(calibration.robot.limits)[leg, j].mean())
            zero = sum(joint.limits) / 2 - direction * joint.scale * (centre + random.uniform(-_OFF, _OFF))
            changes = {"number": None, "direction": direction, "zero": round(zero, 1)}
            calibration = calibration.with_joint(leg, j, **changes)
    for at, number in enumerate(numbers.tolist()):
        calibration = calibration.with_joint(*divmod(at, len(JOINTS)), number=number)
    count, legs = calibration.buses[0].properties.inputs, calibration.robot.legs
    if count < legs:
        return calibration
    # On a Maestro the switches take the last channels, as the servos have the first ones.
    first = count - legs if calibration.buses[0].kind == "maestro" else 0
    inputs = tuple(int(number) for number in random.permutation(range(first, first + legs)))
    switches = FootSwitches(bus=calibration.buses[0].name, inputs=inputs, closed=bool(random.integers(2)))
    return calibration.replace(foot_switches=switches)
