"""Emulated servos on a serial line: when they answer, and what their faults do to the bytes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from tarsus.hardware.emulation.faults import Faults
from tarsus.hardware.emulation.servo import EmulatedServo
from tarsus.hardware.emulation.supply import Supply
from tarsus.hardware.transport.protocol import Delivery
from tarsus.hardware.transport.wire import serial_seconds
from tarsus.representation import represented

__all__ = ["EmulatedLine"]


@represented("baud", "ids")
class EmulatedLine:
    """Servos, or a board with servos, on a serial line; a kind of it for each protocol.

    Parameters
    ----------
    servos : mapping of int to EmulatedServo
        Servos by id or channel.
    baud : int
        Bits per second.
    supply : Supply, optional
        What feeds them.
    faults : Faults, optional
        What goes wrong.
    turnaround : float
        Time from a request to the answer [s].

    Attributes
    ----------
    servos : mapping of int to EmulatedServo
        Servos by id or channel.
    supply : Supply
        What feeds them.
    faults : Faults
        What goes wrong.
    """

    def __init__(
        self,
        servos: Mapping[int, EmulatedServo],
        *,
        baud: int,
        supply: Supply | None = None,
        faults: Faults | None = None,
        turnaround: float = 50e-6,
    ) -> None:
        self.servos = dict(servos)
        self.baud, self.turnaround = baud, turnaround
        self.supply, self.faults = supply or Supply(), faults or Faults()
        self._buffer = b""
        self._heard: float | None = None

    @property
    def ids(self) -> tuple[int, ...]:
        """Ids or channels of the servos."""
        return tuple(self.servos)

    @property
    def plugged(self) -> bool:
        """Whether the line is connected."""
        return not self.faults.unplugged

    def advance(self, now: float) -> None:
        """Move the servos on to a time, as at each request.

        Parameters
        ----------
        now : float
            The time [s].
        """
        silent = 0.0 if self._heard is None else now - self._heard
        self._watch(silent, now)
        self.supply.advance(now, self.servos.values())
        if not self.supply.up(now):
            self._started_anew()

    def positions(self, now: float) -> dict[int, float]:
        """Return where the shafts are, by id.

        Parameters
        ----------
        now : float
            The time [s].
        """
        self.advance(now)
        return {id: servo.position for id, servo in self.servos.items()}

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
        if not self.supply.up(now):
            self._buffer = b""
            return deliveries
        self._buffer += data
        at = now
        for id, answer in self._answers():
            if id in self.faults.missing:
                continue
            whole = self.faults.delivered(id, self._together(id, answer))
            at += self.turnaround + serial_seconds(len(whole), self.baud)
            deliveries.append(Delivery(at + self.faults.late.get(id, 0.0), whole))
        return deliveries

    def _answers(self) -> Iterable[tuple[int, bytes]]:
        """Carry out the requests in the buffer, and return the answers with their ids; by default nobody answers."""
        return ()

    def _watch(self, silent: float, now: float) -> None:
        """Carry out what the watchdog does after a time without requests; by default there is none."""

    def _started_anew(self) -> None:
        """Forget what is lost without supply."""

    def _together(self, id: int, answer: bytes) -> bytes:
        """Return what two servos with one id make of an answer: a wire that either of them pulls low is low."""
        if id not in self.faults.duplicate or not answer:
            return answer
        # The second one holds another position, so that its bytes differ.
        other = bytes(byte ^ 0x05 if at > 4 else byte for at, byte in enumerate(answer))
        return bytes(one & two for one, two in zip(answer, other, strict=True))
