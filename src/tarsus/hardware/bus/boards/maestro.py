"""Pololu Maestro on its command port or serial line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tarsus.errors import CorruptAnswerError
from tarsus.hardware.bus.answers import Telemetry
from tarsus.hardware.bus.boards.board_bus import LONGEST_PULSE, SHORTEST_PULSE, BoardBus, runs
from tarsus.hardware.bus.capabilities import Capabilities
from tarsus.hardware.bus.checks import checked_ids, checked_numbers, checked_speed
from tarsus.hardware.bus.link import Link, hexadecimal
from tarsus.hardware.codec import maestro as codec
from tarsus.hardware.codec.packet import scan
from tarsus.hardware.transport.protocol import Transport
from tarsus.hardware.transport.wire import serial_seconds

__all__ = ["MaestroBus"]

_CAPABILITIES = Capabilities(
    unit="us",
    lowest=SHORTEST_PULSE,
    highest=LONGEST_PULSE,
    ids=range(codec.MOST_CHANNELS),
    ping="board",
    telemetry=frozenset(("alarms",)),
    torque_off="pulses",
    speed_limit=True,
)
_ERROR_BITS = 9


class MaestroBus(BoardBus):
    """A Mini Maestro with 12, 18 or 24 channels.

    Channels whose mode is set to *Input* in the Maestro Control Center are inputs.

    Its own watchdog is the serial timeout, after which channels do what is set for them "on startup or error"; both are
    set in Pololu's Maestro Control Center.

    Parameters
    ----------
    transport : Transport
        The command port of the board, or its serial line.
    device : int, optional
        Number of the board, for several boards on a line.
    checked : bool
        Whether commands have a CRC; it must match the setting in the Maestro Control Center.
    timeout : float
        Longest time until an answer begins, beyond its time on the wire [s].
    """

    inputs = range(codec.MOST_CHANNELS)

    def __init__(
        self, transport: Transport, *, device: int | None = None, checked: bool = False, timeout: float = 0.02
    ) -> None:
        super().__init__("maestro", transport, _CAPABILITIES)
        self._transport = transport
        self._link = Link(transport, self.name, scan, timeout=timeout)
        self._device, self._checked = device, checked

    def set_speed_limit(self, ids: Sequence[int], speed: float | None) -> bool:
        """Set the highest speed at which the pulses of channels change.

        Parameters
        ----------
        ids : sequence of int
            The channels.
        speed : float or None
            Speed [us/s]; None for no limit.
        """
        limit = checked_speed(self.name, self.capabilities, speed)
        # In units of 0.25 us per 10 ms, which is 25 us/s.
        value = 0 if limit is None else min(max(round(limit / 25.0), 1), 0x3FFF)
        for channel in checked_ids(self.name, self.capabilities, ids):
            self._link.send(codec.set_speed(channel, value, device=self._device, checked=self._checked))
        return True

    def read_inputs(self, numbers: Sequence[int]) -> tuple[float, ...]:
        """Return the levels of channels that are inputs, as shares of 5 V.

        Parameters
        ----------
        numbers : sequence of int
            The channels.

        Raises
        ------
        NoAnswerError, CorruptAnswerError
            If the board does not answer, or a channel is no input.
        """
        numbers = checked_numbers(self.name, "input", self.inputs, numbers)
        if not numbers:
            return ()
        levels = codec.levels_in(self._link.ask_board(self._asking(numbers), size=2 * len(numbers)))
        for number, level in zip(numbers, levels, strict=True):
            if level > codec.FULL_LEVEL:
                raise CorruptAnswerError(
                    self.name,
                    self.port,
                    expected=f"a level of channel {number} from 0 to {codec.FULL_LEVEL}",
                    received=f"{level}",
                    remedy="Set the mode of this channel to Input in the Maestro Control Center.",
                )
        return tuple(level / codec.FULL_LEVEL for level in levels)

    def input_seconds(self, numbers: Sequence[int]) -> float:
        """Return how long reading inputs takes on the wire [s].

        Parameters
        ----------
        numbers : sequence of int
            The channels.
        """
        return serial_seconds(len(self._asking(numbers)) + 2 * len(numbers), self._transport.baud)

    def _asking(self, numbers: Sequence[int]) -> bytes:
        return b"".join(codec.get_position(one, device=self._device, checked=self._checked) for one in numbers)

    def _goal_seconds(self, ids: Sequence[int]) -> float:
        size = sum(len(frame) for frame in self._frames(dict.fromkeys(ids, 0.0)))
        return serial_seconds(size, self._transport.baud)

    def _telemetry_seconds(self) -> float:
        asked = len(codec.get_errors(device=self._device, checked=self._checked)) + 2
        return serial_seconds(asked, self._transport.baud)

    def _frames(self, goals: Mapping[int, float]) -> list[bytes]:
        return [
            codec.set_targets(
                run[0],
                [codec.quarters(goals[channel]) for channel in run],
                device=self._device,
                checked=self._checked,
            )
            for run in runs(goals, codec.MOST_CHANNELS)
        ]

    def _send(self, goals: Mapping[int, float]) -> None:
        self._link.send(b"".join(self._frames(goals)))

    def _switch(self, ids: Sequence[int] | None, on: bool) -> None:
        if not on:
            self._send(dict.fromkeys(self.capabilities.ids if ids is None else ids, 0.0))

    def _board(self, id: int) -> str:
        del id
        self._measured()
        return "Maestro"

    def _measured(self) -> Telemetry:
        answer = self._link.ask_board(codec.get_errors(device=self._device, checked=self._checked), size=2)
        code = int.from_bytes(answer, "little")
        if code >> _ERROR_BITS:
            raise CorruptAnswerError(
                self.name,
                self.port,
                expected=f"errors of {_ERROR_BITS} bits",
                received=hexadecimal(answer),
                remedy="Check the baud rate, and that this is the board's command port.",
            )
        return Telemetry(alarms=codec.errors_in(code))
