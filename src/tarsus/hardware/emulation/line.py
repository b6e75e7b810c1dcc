"""Emulated servos on a serial line: when they answer, and what their faults do to the bytes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tarsus.hardware.emulation.servo import EmulatedServo
from tarsus.hardware.emulation.servos import EmulatedServos
from tarsus.hardware.transport.protocol import Delivery
from tarsus.hardware.transport.wire import serial_seconds
from tarsus.representation import represented

__all__ = ["EmulatedLine"]


@represented("baud", "ids", "supply", "faults")
class EmulatedLine(EmulatedServos):
    """Servos, or a board with servos, on a serial line; a kind of it for each protocol.

    Parameters
    ----------
    servos : mapping of int to EmulatedServo
        Servos by id or channel.
    baud : int
        Bits per second.
    turnaround : float
        Time from a request to the answer [s].
    **shared
        ``supply`` and ``faults``, passed on to `EmulatedServos`.
    """

    # Whether the computer's port powers what answers, so that it goes on answering when the servos' supply fails.
    _fed_by_port = False

    def __init__(
        self, servos: Mapping[int, EmulatedServo], *, baud: int, turnaround: float = 50e-6, **shared: Any
    ) -> None:
        super().__init__(servos, **shared)
        self.baud, self.turnaround = baud, turnaround
        self._buffer = b""

    def receive(self, data: bytes, now: float) -> Sequence[Delivery]:
        """Take bytes in, and return what is sent in answer.

        Parameters
        ----------
        data : bytes
            What the computer sent.
        now : float
            When the last byte was on the wire [s].
        """
        self.advance(now)
        deliveries = [Delivery(now, data)] if self.faults.echo else []
        if not (self._fed_by_port or self.supply.up(now)):
            self._buffer = b""
            return deliveries
        self._heard = now
        self._buffer += data
        at = now
        for id, answer in self._answers():
            if id in self.faults.missing:
                continue
            whole = self.faults.delivered(id, self._together(id, answer))
            at += self._delay(id) + serial_seconds(len(whole), self.baud)
            deliveries.append(Delivery(at + self.faults.late.get(id, 0.0), whole))
        return deliveries

    def _answers(self) -> Iterable[tuple[int, bytes]]:
        """Carry out the requests in the buffer, and return the answers with their ids; by default nobody answers."""
        return ()

    def _delay(self, id: int) -> float:
        """Return the time from a request, or from the answer before, to the answer of a servo [s]."""
        del id
        return self.turnaround

    def _together(self, id: int, answer: bytes) -> bytes:
        """Return what two servos with one id make of an answer: a wire that either of them pulls low is low."""
        if id not in self.faults.duplicate or not answer:
            return answer
        # The second servo holds another position, so that its data and its checksum differ.
        other = bytes(byte ^ 0x15 if at > 4 else byte for at, byte in enumerate(answer))
        both = bytes(one & two for one, two in zip(answer, other, strict=True))
        return both if both != answer else answer[:-1] + bytes((answer[-1] ^ 0x01,))
