"""A microcontroller that takes lines of pulse widths, with the sketch in examples/."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tarsus.errors import CorruptAnswerError, InputError
from tarsus.hardware.bus.boards.board_bus import BoardBus
from tarsus.hardware.bus.capabilities import Capabilities
from tarsus.hardware.bus.checks import checked_numbers, checked_time
from tarsus.hardware.bus.link import Link, hexadecimal
from tarsus.hardware.codec import lines as codec
from tarsus.hardware.codec.packet import scan
from tarsus.hardware.transport.protocol import Transport
from tarsus.hardware.transport.wire import serial_seconds

__all__ = ["LineBus"]

_MOST_CHANNELS = 32


class LineBus(BoardBus):
    """A board with the sketch ``pulse_lines``, or one of your own that reads the same lines.

    Parameters
    ----------
    transport : Transport
        The line.
    channels : int
        How many channels the board has.
    timeout : float
        Longest time until an answer begins, beyond its time on the wire [s].

    Raises
    ------
    InputError
        If there are not 1 to 32 channels.
    """

    inputs = range(codec.MOST_INPUTS)

    def __init__(self, transport: Transport, *, channels: int = 18, timeout: float = 0.05) -> None:
        if not 1 <= channels <= _MOST_CHANNELS:
            raise InputError(f"a board with lines of pulse widths has 1 to {_MOST_CHANNELS} channels, not {channels}")
        super().__init__(
            "lines",
            transport,
            Capabilities(
                unit="us",
                lowest=500,
                highest=2500,
                ids=range(channels),
                ping="board",
                torque_off="pulses",
                watchdog=(0.05, 60.0),
                watchdog_action="release",
            ),
        )
        self._transport = transport
        self._link = Link(transport, self.name, scan, timeout=timeout)
        self._pulses = dict.fromkeys(range(channels), 0)

    def set_watchdog(self, ids: Sequence[int], seconds: float | None) -> bool:
        """Make the board end all pulses if no line comes for some time, half a second when it has just started.

        Parameters
        ----------
        ids : sequence of int
            The channels; the watchdog is the same for all.
        seconds : float or None
            The time [s]; None for never.
        """
        super().set_watchdog(ids, seconds)
        limit = checked_time(self.name, self.capabilities, seconds)
        self._link.send(codec.watchdog(0 if limit is None else round(1e3 * limit)))
        return True

    def read_inputs(self, numbers: Sequence[int]) -> tuple[float, ...]:
        """Return the levels of inputs, 0 or 1.

        Parameters
        ----------
        numbers : sequence of int
            The inputs.

        Raises
        ------
        NoAnswerError, CorruptAnswerError
            If the board does not answer, its answer is damaged, or its sketch has fewer inputs.
        """
        numbers = checked_numbers(self.name, "input", self.inputs, numbers)
        if not numbers:
            return ()
        answer = self._link.ask_board(codec.INPUTS, end=codec.END)
        text = codec.content(answer)
        levels = None if text is None else codec.levels(text)
        if levels is None or max(numbers) >= len(levels):
            raise CorruptAnswerError(
                self.name,
                self.port,
                expected=f"'I' and the levels of {max(numbers) + 1} inputs or more, with its checksum",
                received=hexadecimal(answer) if text is None else repr(text),
                remedy="Check the baud rate, the sketch on the board, and its number of inputs.",
            )
        return tuple(float(levels[number]) for number in numbers)

    def input_seconds(self, numbers: Sequence[int]) -> float:
        """Return how long reading inputs takes on the wire [s].

        Parameters
        ----------
        numbers : sequence of int
            The inputs; all are read together.
        """
        del numbers
        size = len(codec.INPUTS) + len(codec.checked("I " + "0" * codec.MOST_INPUTS))
        return serial_seconds(size, self._transport.baud)

    def _goal_seconds(self, ids: Sequence[int]) -> float:
        # Each line sets all channels.
        del ids
        return serial_seconds(len(codec.pulses([1500] * len(self._pulses))), self._transport.baud)

    def _send(self, goals: Mapping[int, float]) -> None:
        self._pulses.update({channel: round(goal) for channel, goal in goals.items()})
        self._link.send(codec.pulses(tuple(self._pulses.values())))

    def _switch(self, ids: Sequence[int] | None, on: bool) -> None:
        if not on:
            self._send(dict.fromkeys(self._pulses if ids is None else ids, 0.0))

    def _board(self, id: int) -> str:
        del id
        answer = self._link.ask_board(codec.ASK, end=codec.END)
        text = codec.content(answer)
        channels = None if text is None else codec.identity(text)
        if channels != len(self._pulses):
            raise CorruptAnswerError(
                self.name,
                self.port,
                expected=f"'tarsus {len(self._pulses)}' with its checksum",
                received=hexadecimal(answer) if text is None else repr(text),
                remedy="Check the baud rate, the sketch on the board, and its number of channels.",
            )
        return "pulse lines"
