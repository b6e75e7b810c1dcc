"""Pimoroni Servo2040 with the firmware for Chica, over USB."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tarsus.hardware.bus.answers import Telemetry
from tarsus.hardware.bus.boards.board_bus import LONGEST_PULSE, SHORTEST_PULSE, BoardBus, runs
from tarsus.hardware.bus.capabilities import Capabilities
from tarsus.hardware.bus.checks import checked_numbers
from tarsus.hardware.bus.link import Link
from tarsus.hardware.codec import servo2040 as codec
from tarsus.hardware.transport.protocol import Transport
from tarsus.hardware.transport.wire import serial_seconds

__all__ = ["Servo2040Bus"]

_CAPABILITIES = Capabilities(
    unit="us",
    lowest=SHORTEST_PULSE,
    highest=LONGEST_PULSE,
    ids=range(codec.CHANNELS),
    ping="board",
    telemetry=frozenset(("current", "voltage")),
    torque_off="pulses",
)
_TOUCH_SENSORS, _FULL_VOLTAGE = 6, 3.3


class Servo2040Bus(BoardBus):
    """A Servo2040 with 18 channels, six touch sensors, and measured current and voltage of its supply.

    All channels have pulses or none: switching one on or off switches all of them.

    Parameters
    ----------
    transport : Transport
        The port.
    timeout : float
        Longest time until an answer begins, beyond its time on the wire [s].
    """

    inputs = range(_TOUCH_SENSORS)

    def __init__(self, transport: Transport, *, timeout: float = 0.02) -> None:
        super().__init__("servo2040", transport, _CAPABILITIES)
        self._transport = transport
        self._link = Link(transport, self.name, codec.scan, timeout=timeout, header=bytes((codec.GET,)))

    def read_touch(self) -> tuple[float, ...]:
        """Return the voltages of the six touch sensors [V].

        Raises
        ------
        NoAnswerError, CorruptAnswerError
            If the board does not answer, or its answer is damaged.
        """
        return tuple(codec.voltage(value) for value in self._get(codec.TOUCH, _TOUCH_SENSORS))

    def read_inputs(self, numbers: Sequence[int]) -> tuple[float, ...]:
        """Return the voltages of touch sensors, as shares of 3.3 V.

        Parameters
        ----------
        numbers : sequence of int
            The sensors.

        Raises
        ------
        NoAnswerError, CorruptAnswerError
            If the board does not answer, or its answer is damaged.
        """
        numbers = checked_numbers(self.name, "input", self.inputs, numbers)
        voltages = self.read_touch() if numbers else ()
        return tuple(min(voltages[number] / _FULL_VOLTAGE, 1.0) for number in numbers)

    def input_seconds(self, numbers: Sequence[int]) -> float:
        """Return how long reading inputs takes on the wire [s].

        Parameters
        ----------
        numbers : sequence of int
            The sensors; all are read together.
        """
        del numbers
        return serial_seconds(
            len(codec.get(codec.TOUCH, _TOUCH_SENSORS)) + 3 + 2 * _TOUCH_SENSORS, self._transport.baud
        )

    def _goal_seconds(self, ids: Sequence[int]) -> float:
        # An upper bound: the baud rate of the port has no effect over USB, which is faster.
        return serial_seconds(len(self._frames(dict.fromkeys(ids, 0.0))), self._transport.baud)

    def _telemetry_seconds(self) -> float:
        # Two values of two bytes, after a header of three.
        return serial_seconds(len(codec.get(codec.CURRENT, 2)) + 3 + 4, self._transport.baud)

    def _frames(self, goals: Mapping[int, float]) -> bytes:
        chunks = runs(goals, codec.CHANNELS)
        return b"".join(codec.set_pins(run[0], [round(goals[channel]) for channel in run]) for run in chunks)

    def _send(self, goals: Mapping[int, float]) -> None:
        self._link.send(self._frames(goals))

    def _switch(self, ids: Sequence[int] | None, on: bool) -> None:
        del ids
        self._link.send(codec.set_pins(codec.RELAY, (int(on),)))

    def _board(self, id: int) -> str:
        self._get(id, 1)
        return "Servo2040"

    def _measured(self) -> Telemetry:
        current, voltage = self._get(codec.CURRENT, 2)
        return Telemetry(current=codec.current(current), voltage=codec.voltage(voltage))

    def _get(self, first: int, count: int) -> tuple[int, ...]:
        """Return the values of pins."""
        answers = self._link.ask(
            codec.get(first, count), (first,), 2 * count, belongs=lambda frame: frame.code == count
        )
        for error in answers.errors:
            # The link names the first pin as the servo's id; the error raised here names none.
            remedy = "Check that this is the board's port, and that the firmware for Chica is on it."
            raise type(error)(self.name, self.port, expected=error.expected, received=error.received, remedy=remedy)
        return codec.values_in(answers.values[first])
