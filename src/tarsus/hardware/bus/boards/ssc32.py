"""Lynxmotion SSC-32 and SSC-32U."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tarsus.errors import CorruptAnswerError
from tarsus.hardware.bus.boards.board_bus import BoardBus
from tarsus.hardware.bus.capabilities import Capabilities
from tarsus.hardware.bus.checks import checked_ids, checked_numbers, checked_speed
from tarsus.hardware.bus.link import Link, hexadecimal
from tarsus.hardware.codec import ssc32 as codec
from tarsus.hardware.codec.packet import scan
from tarsus.hardware.transport.protocol import Transport
from tarsus.hardware.transport.wire import serial_seconds

__all__ = ["Ssc32Bus"]

# The board itself limits pulse widths to this range.
_CAPABILITIES = Capabilities(
    unit="us",
    lowest=500,
    highest=2500,
    ids=range(32),
    ping="board",
    torque_off="pulses",
    speed_limit=True,
)


class Ssc32Bus(BoardBus):
    """An SSC-32 or SSC-32U with 32 channels, and the digital inputs A to F as inputs 0 to 5.

    Parameters
    ----------
    transport : Transport
        The line.
    timeout : float
        Longest time until an answer begins, beyond its time on the wire [s].
    """

    inputs = range(len(codec.INPUTS))

    def __init__(self, transport: Transport, *, timeout: float = 0.02) -> None:
        super().__init__("ssc32", transport, _CAPABILITIES)
        self._transport = transport
        self._link = Link(transport, self.name, scan, timeout=timeout)
        self._speeds: dict[int, int] = {}

    def set_speed_limit(self, ids: Sequence[int], speed: float | None) -> bool:
        """Set the highest speed at which pulses change; it is sent with each goal from the next one on.

        Parameters
        ----------
        ids : sequence of int
            The channels.
        speed : float or None
            Speed [us/s]; None for no limit.
        """
        limit = checked_speed(self.name, self.capabilities, speed)
        for channel in checked_ids(self.name, self.capabilities, ids):
            self._speeds.pop(channel, None)
            if limit is not None:
                self._speeds[channel] = min(max(round(limit), 1), 65535)
        return True

    def read_inputs(self, numbers: Sequence[int]) -> tuple[float, ...]:
        """Return the levels of digital inputs, 0 or 1.

        Parameters
        ----------
        numbers : sequence of int
            The inputs: 0 for A.

        Raises
        ------
        NoAnswerError, CorruptAnswerError
            If the board does not answer, or its answer is damaged.
        """
        numbers = checked_numbers(self.name, "input", self.inputs, numbers)
        if not numbers:
            return ()
        answer = self._link.ask_board(codec.query_inputs(*numbers), size=len(numbers))
        levels = codec.read_inputs(answer)
        if levels is None:
            raise CorruptAnswerError(
                self.name,
                self.port,
                expected=f"{len(numbers)} times 0 or 1",
                received=hexadecimal(answer),
                remedy="Check the baud rate: buttons and lamps of the SSC-32U tell and set it.",
            )
        return tuple(map(float, levels))

    def input_seconds(self, numbers: Sequence[int]) -> float:
        """Return how long reading inputs takes on the wire [s].

        Parameters
        ----------
        numbers : sequence of int
            The inputs.
        """
        return serial_seconds(len(codec.query_inputs(*numbers)) + len(numbers), self._transport.baud)

    def _goal_seconds(self, ids: Sequence[int]) -> float:
        size = len(codec.move(dict.fromkeys(ids, 1500), speeds=self._speeds))
        return serial_seconds(size, self._transport.baud)

    def _send(self, goals: Mapping[int, float]) -> None:
        pulses = {channel: round(goal) for channel, goal in goals.items()}
        self._link.send(codec.move(pulses, speeds=self._speeds))

    def _switch(self, ids: Sequence[int] | None, on: bool) -> None:
        if not on:
            self._link.send(codec.move(dict.fromkeys(self.capabilities.ids if ids is None else ids, 0)))

    def _board(self, id: int) -> str:
        del id
        answer = self._link.ask_board(codec.VERSION, end=codec.END)
        if not (answer[:-1].isascii() and answer[:-1].decode("ascii").isprintable()):
            raise CorruptAnswerError(
                self.name,
                self.port,
                expected="the board's version",
                received=hexadecimal(answer),
                remedy="Check the baud rate: buttons and lamps of the SSC-32U tell and set it.",
            )
        return answer[:-1].decode("ascii")
