"""Requests and answers over a line of bytes: who answered, who did not, and which answers are rejected."""

from __future__ import annotations

from collections.abc import Callable, Collection

from tarsus.errors import BusError, CorruptAnswerError, NoAnswerError, ServoStatusError
from tarsus.hardware.bus.answers import Answers
from tarsus.hardware.bus.exchange import Exchange
from tarsus.hardware.bus.patience import Patience
from tarsus.hardware.codec.scan import Frame, Scanner
from tarsus.hardware.transport.protocol import Transport
from tarsus.hardware.transport.wire import serial_seconds

__all__ = ["Link", "hexadecimal"]

_WIRING = "Check that it has this id and baud rate, its supply, and the cable to it."
_NOISE = "Look for two servos with one id, a loose cable or a wrong baud rate; a lower baud rate helps against noise."
_TWICE = "Look for two servos with this id: connect them one at a time, and give one another id."
_REFUSED = "Check that it is a servo of this kind, and its firmware: it has no such registers, or not now."
# Most reads while waiting for silence; longest answer line of a board, most sent bytes whose echo is expected [bytes].
_MOST_SETTLING = 8
_LONGEST_LINE = 64
_MOST_ECHO = 2048


def hexadecimal(data: bytes, most: int = 24) -> str:
    """Return bytes as text, for messages.

    Parameters
    ----------
    data : bytes
        The bytes.
    most : int
        How many are shown.
    """
    return data[:most].hex(" ").upper() + (" ..." if len(data) > most else "")


class Link:
    """A line on which one side asks and the other answers.

    After a damaged answer, and before servos whose answer is missing are asked again, the link waits until the line has
    been silent for as long as an answer may be late; what arrives until then is discarded.

    Parameters
    ----------
    transport : Transport
        The line.
    bus : str
        Name of the bus, for messages.
    scan : callable
        The codec's function that finds frames in bytes.
    timeout : float
        Longest time until an answer begins, beyond its time on the wire [s].
    header : bytes
        Bytes with which frames begin, before the id.
    delay : float
        Time that each servo takes before it answers, with its factory settings [s].
    errors_in : callable, optional
        Returns the errors that the code of an answer reports; left out where codes report none.
    patience : Patience, optional
        Adapts the wait to the servos' measured times, for protocols whose answers show which request they answer;
        if left out, every wait is `timeout`.
    """

    def __init__(
        self,
        transport: Transport,
        bus: str,
        scan: Scanner,
        *,
        timeout: float,
        header: bytes = b"",
        delay: float = 0.0,
        errors_in: Callable[[int], tuple[str, ...]] | None = None,
        patience: Patience | None = None,
    ) -> None:
        self.transport, self.bus, self.timeout, self._delay = transport, bus, timeout, delay
        self._scan, self._header, self._errors_in = scan, header, errors_in
        self._patience = patience
        self._doubtful = False
        # When the wait for an answer that did not come ended, by id; None stands for a board [s].
        self._awaited: dict[int | None, float] = {}
        self._sent = b""

    def send(self, frame: bytes) -> None:
        """Send a frame that nobody answers.

        Parameters
        ----------
        frame : bytes
            The frame.
        """
        self.transport.write(frame)
        self._sent = (self._sent + frame)[-_MOST_ECHO:]

    def ask(
        self, frame: bytes, ids: Collection[int], count: int, *, belongs: Callable[[Frame], bool] | None = None
    ) -> Answers[Frame]:
        """Send a frame, and return the answers of servos.

        Parameters
        ----------
        frame : bytes
            The frame.
        ids : collection of int
            Ids of the servos that answer.
        count : int
            How many bytes of data each answer has.
        belongs : callable
            Returns whether a frame answers this request, as far as the protocol shows.
        """
        self._settle(ids)
        self.transport.write(frame)
        sent, self._sent = self._sent, b""
        most = serial_seconds(len(frame) + len(ids) * (count + 12), self.transport.baud)
        begun = self.transport.now()
        timeout = self.timeout if self._patience is None else self._patience.now(ids)
        deadline = begun + most + len(ids) * self._delay + timeout
        exchange = Exchange(frame, ids, count, sent=sent, belongs=belongs)
        received = rest = b""
        late = 0.0
        while not exchange.complete:
            data = self.transport.read(deadline - self.transport.now())
            scanned = self._scan(rest + data, ended=not data)
            received, rest = received + data, scanned.rest
            exchange.take(scanned)
            if not data:
                late = max(self.transport.now() - deadline, 0.0)
                break
        now = self.transport.now()
        self._awaited.update(dict.fromkeys(set(ids) - exchange.found.keys(), now))
        self._doubtful = bool(exchange.noise or exchange.foreign or exchange.twice or rest)
        if exchange.noise or rest:
            exchange.withdraw(self._scan(received + self.transport.discard(), ended=True).suspect)
        if self._patience is not None:
            self._learn(self._patience, ids, exchange, now - begun - serial_seconds(len(received), self.transport.baud))
        errors = tuple(self._error(id, count, received, exchange, late, timeout) for id in exchange.refused)
        return Answers({id: exchange.found[id] for id in ids if id not in exchange.refused}, errors)

    def ask_board(self, frame: bytes, *, size: int | None = None, end: bytes = b"") -> bytes:
        """Send a frame, and return the answer of a board, which has no frame of its own.

        Parameters
        ----------
        frame : bytes
            The frame.
        size : int, optional
            How many bytes the answer has.
        end : bytes
            Bytes with which the answer ends, if its size is not known.

        Raises
        ------
        NoAnswerError
            If the answer does not come, or not completely.
        CorruptAnswerError
            If more comes than the answer.
        """
        self._settle()
        self.transport.write(frame)
        self._sent = b""
        most = serial_seconds(len(frame) + (size or _LONGEST_LINE), self.transport.baud)
        deadline = self.transport.now() + most + self.timeout
        received = b""
        while not _complete(received, frame, size, end):
            data = self.transport.read(deadline - self.transport.now())
            received += data
            if data:
                continue
            if len(received) == size:
                # The answer begins like the request; no echo came before it.
                return received
            self._doubtful = bool(received)
            self._awaited[None] = self.transport.now()
            raise self._silent(size, received, echo=received == frame)
        answer = received.removeprefix(frame)
        self._doubtful = size is not None and len(answer) > size
        if self._doubtful:
            raise CorruptAnswerError(
                self.bus,
                self.transport.port,
                expected=f"{size} byte{'s' * (size != 1)}",
                received=hexadecimal(answer),
                remedy=_NOISE,
            )
        return answer

    @staticmethod
    def _learn(patience: Patience, ids: Collection[int], exchange: Exchange, seconds: float) -> None:
        for id in ids:
            if id in exchange.found:
                patience.answered(id, max(seconds, 0.0))
            else:
                patience.missed(id)

    def _silent(self, size: int | None, received: bytes, *, echo: bool) -> BusError:
        got = "only the echo of the request" if echo else hexadecimal(received) or "nothing"
        return NoAnswerError(
            self.bus,
            self.transport.port,
            expected="a line" if size is None else f"{size} byte{'s' * (size != 1)}",
            received=f"{got} within {self.timeout * 1e3:.0f} ms",
            remedy="Check that this is the board's port and baud rate, and that the board has its supply.",
        )

    def _error(self, id: int, count: int, received: bytes, exchange: Exchange, late: float, timeout: float) -> BusError:
        """Return the error that tells why a servo has no accepted answer."""
        expected = f"an answer with {count} byte{'s' * (count != 1)} of data"
        kind: type[BusError] = CorruptAnswerError
        refusal = exchange.other.get(id)
        reported = () if refusal is None or self._errors_in is None else self._errors_in(refusal.code)
        if id in exchange.twice:
            expected, text, remedy = "one answer", f"two: {hexadecimal(received)}", _TWICE
        elif reported and refusal is not None and not refusal.data:
            kind, text, remedy = ServoStatusError, f"a refusal with the error {' and '.join(reported)}", _REFUSED
        elif exchange.damaged(id, self._header):
            text, remedy = f"{hexadecimal(exchange.noise)}, which is no such answer", _NOISE
        else:
            kind, remedy = NoAnswerError, _WIRING
            came = "only the echo of the request" if exchange.echo else "nothing"
            came = f"{hexadecimal(exchange.foreign)}, which answers something else," if exchange.foreign else came
            text = f"{came} within {timeout * 1e3:.0f} ms"
        return kind(self.bus, self.transport.port, id=id, expected=expected, received=text, remedy=remedy, late=late)

    def _settle(self, ids: Collection[int] | None = None) -> None:
        """Empty the input; wait for silence if the line is in doubt, or if answers of the same servos may be late."""
        came, now = self.transport.discard(), self.transport.now()
        late = [since for id, since in self._awaited.items() if ids is None or id is None or id in ids]
        if not self._doubtful and not late:
            return
        # Silence counts from the end of the last wait in vain, unless something has come or the line is in doubt.
        quiet = 0.0 if came or self._doubtful else now - max(late)
        needed = self.timeout if self._patience is None or ids is None else self._patience.usual(ids)
        for _ in range(_MOST_SETTLING):
            if quiet >= needed or not self.transport.read(needed - quiet):
                break
            quiet = 0.0
        self._awaited.clear()
        self._doubtful = False


def _complete(received: bytes, frame: bytes, size: int | None, end: bytes) -> bool:
    """Return whether the answer of a board is complete, after an echo of the request if there is one."""
    answer = received.removeprefix(frame)
    return len(answer) >= size if size is not None else answer.endswith(end) and bool(answer)
