"""Servos that are read and written by registers: Feetech and Dynamixel."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tarsus.errors import CorruptAnswerError
from tarsus.hardware.bus.answers import Answers, BusServo, BusTiming, Telemetry
from tarsus.hardware.bus.checks import (
    checked_goals,
    checked_ids,
)
from tarsus.hardware.bus.dialect import SERIES
from tarsus.hardware.bus.link import Link
from tarsus.hardware.bus.register_reader import RegisterReader
from tarsus.hardware.bus.register_settings import RegisterSettings
from tarsus.hardware.bus.scanning import scanned
from tarsus.hardware.codec.packet import BROADCAST
from tarsus.hardware.codec.registers import RegisterTable, load_models
from tarsus.hardware.codec.scan import Frame
from tarsus.hardware.transport.protocol import Transport
from tarsus.hardware.transport.wire import serial_seconds
from tarsus.representation import represented

__all__ = ["RegisterBus"]


@represented("name", "port")
class RegisterBus(RegisterSettings):
    """Servos that are read and written by registers, on a serial line.

    Parameters
    ----------
    transport : Transport
        The line.
    name : str
        Name of the bus, one of `SERIES`.
    timeout : float
        Longest time until an answer begins, beyond its time on the wire [s].
    fast : bool
        Whether servos answer in one packet (Dynamixel's Fast Sync Read, for which their firmware must be new enough).
    turnaround : float, optional
        Time from a request to the answer, for computed times [s]; by default as the servos are delivered.

    Attributes
    ----------
    name : str
        Name of the bus.
    port : str
        Name of the port.
    capabilities : Capabilities
        What it can do.
    """

    def __init__(
        self,
        transport: Transport,
        name: str,
        *,
        timeout: float = 0.02,
        fast: bool = False,
        turnaround: float | None = None,
    ) -> None:
        self.name, self.port = name, transport.port
        self._series = SERIES[name]
        self._dialect = self._series.dialect
        self.capabilities = self._series.capabilities
        self._table = RegisterTable(name, byteorder=self._dialect.byteorder)
        self._transport = transport
        # The answering delay counts as part of the answer's time.
        self._link = Link(
            transport,
            name,
            self._dialect.scan,
            timeout=timeout,
            header=self._dialect.header,
            delay=self._series.turnaround,
            errors_in=self._dialect.errors_in,
        )
        self._reader = RegisterReader(self._link, self._series, fast=fast, turnaround=turnaround)
        self._speed: dict[int, int] = {}

    def ping(self, id: int) -> BusServo | None:
        """Return a servo that answers, or None.

        Parameters
        ----------
        id : int
            Its id.

        Raises
        ------
        CorruptAnswerError
            If what comes back is damaged.
        """
        checked_ids(self.name, self.capabilities, (id,))
        # In protocol 1.0 an answer to a ping may look like the ping's echo; one with data never does.
        block = self._table.block("firmware", "model")
        answer = self._reader.read((id,), block)
        for error in answer.errors:
            if isinstance(error, CorruptAnswerError):
                raise error
            return None
        model = self._table.decode("model", answer.values[id].data, block[0])
        one = self._table["firmware"]
        firmware = answer.values[id].data[one.address - block[0] :][: one.size]
        name = load_models(self.name).get(model, "")
        return BusServo(id, model, name, ".".join(str(byte) for byte in firmware))

    def scan(self, ids: Iterable[int] | None = None) -> Answers[BusServo]:
        """Return the servos that answer, and an error for each id whose answer is damaged.

        Parameters
        ----------
        ids : iterable of int, optional
            Ids to ask; all if left out.
        """
        return scanned(self, ids)

    def read_positions(self, ids: Sequence[int]) -> Answers[float]:
        """Return measured positions [tick], with what the servos report in the error bytes of their answers.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """
        ids = checked_ids(self.name, self.capabilities, ids)
        block = self._table.block("position", "position")
        answers = self._reader.read(ids, block)
        values = {
            id: float(self._table.decode("position", frame.data, block[0])) for id, frame in answers.values.items()
        }
        codes = {id: self._dialect.errors_in(frame.code) for id, frame in answers.values.items() if frame.code}
        return Answers(values, answers.errors, codes)

    def read_telemetry(self, ids: Sequence[int]) -> Answers[Telemetry]:
        """Return what servos measure.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """
        ids = checked_ids(self.name, self.capabilities, ids)
        block = self._table.block(*self._series.telemetry)
        answers = self._reader.read(ids, block)
        return Answers({id: self._telemetry(frame, block[0]) for id, frame in answers.values.items()}, answers.errors)

    def write_goals(self, goals: Mapping[int, float]) -> None:
        """Send goals [tick] in one packet.

        Parameters
        ----------
        goals : mapping of int to float
            Goals by id.
        """
        checked = checked_goals(self.name, self.capabilities, goals)
        if checked:
            content = {id: self._goal(id, round(goal)) for id, goal in checked.items()}
            self._link.send(self._dialect.sync_write(self._table["goal"].address, content))

    def set_torque(self, ids: Sequence[int] | None, on: bool) -> bool:
        """Switch the torque of servos on or off; all of them at once with a broadcast.

        Parameters
        ----------
        ids : sequence of int, or None
            The servos; None for all on the bus.
        on : bool
            Whether they hold.
        """
        if ids is None:
            content = self._table.encode("torque", int(on))
            self._link.send(self._dialect.write(BROADCAST, self._table["torque"].address, content))
        else:
            self._write_all("torque", dict.fromkeys(checked_ids(self.name, self.capabilities, ids), int(on)))
        return True

    def timing(self, ids: Sequence[int]) -> BusTiming:
        """Return how long the bytes of a tick take on the wire.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """
        if not ids:
            return BusTiming(0.0, 0.0, 0.0)
        goals = self._dialect.sync_write(self._table["goal"].address, {id: self._goal(id, 0) for id in ids})
        positions, telemetry = (
            self._reader.seconds(ids, self._table.block(*names))
            for names in (("position", "position"), self._series.telemetry)
        )
        return BusTiming(serial_seconds(len(goals), self._transport.baud), positions, telemetry)

    def close(self) -> None:
        """Close the port; torque stays as it is."""
        self._transport.close()

    def _goal(self, id: int, goal: int) -> bytes:
        # Feetech's servos keep the speed that was last written, so each packet with a goal sets it anew.
        values = {"goal": goal, "goal_speed": self._speed.get(id, 0)}
        return b"".join(self._table.encode(name, values.get(name, 0)) for name in self._series.goal)

    def _telemetry(self, frame: Frame, first: int) -> Telemetry:
        names = self.capabilities.telemetry - {"alarms"}
        values: dict[str, Any] = {
            name: self._table.decode(name, frame.data, first) * self._unit(name) for name in names
        }
        return Telemetry(**values, alarms=self._alarms(frame))

    def _alarms(self, frame: Frame) -> tuple[str, ...]:
        found = self._dialect.errors_in(frame.code)
        if "hardware" not in found or self._series.alarms is None:
            return found
        # The answer only tells that there is an alarm; a register tells which.
        answer = self._reader.read((frame.id,), self._table.block("hardware_error", "hardware_error"))
        bits = [one.data[0] for one in answer.values.values()]
        named = tuple(text for bit, text in self._series.alarms.items() if any(one >> bit & 1 for one in bits))
        return named or found
