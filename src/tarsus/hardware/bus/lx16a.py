"""LX-16A, HTS and other bus servos of Hiwonder (LewanSoul)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tarsus.errors import BusError, CorruptAnswerError, ServoStatusError, UnknownNameError
from tarsus.hardware.bus.answers import Answers, BusServo, BusTiming, Telemetry
from tarsus.hardware.bus.capabilities import Capabilities
from tarsus.hardware.bus.checks import checked_goals, checked_ids, checked_range
from tarsus.hardware.bus.link import Link
from tarsus.hardware.bus.one_by_one import one_by_one
from tarsus.hardware.bus.patience import Patience
from tarsus.hardware.bus.scanning import scanned
from tarsus.hardware.bus.without_servo_settings import WithoutServoSettings
from tarsus.hardware.codec import lx16a as codec
from tarsus.hardware.codec.scan import Frame
from tarsus.hardware.transport.protocol import Transport
from tarsus.hardware.transport.wire import serial_seconds
from tarsus.representation import represented

__all__ = ["Lx16aBus"]

_CAPABILITIES = Capabilities(
    unit="tick",
    lowest=0,
    highest=1000,
    # 1000 steps over 240 degrees.
    per_turn=1500,
    ids=range(254),
    ping="servo",
    positions=True,
    telemetry=frozenset(("position", "temperature", "voltage")),
    torque_off="torque",
    limits=True,
)
# What servos measure: the command that reads it, bytes of data, and what 1 means in the unit of `Telemetry`.
_TELEMETRY = {
    "position": (codec.POSITION_READ, 2, 1.0),
    "voltage": (codec.VOLTAGE_READ, 2, 1e-3),
    "temperature": (codec.TEMPERATURE_READ, 1, 1.0),
}
# Time from a request to the answer [s].
_TURNAROUND = 300e-6


@represented("name", "port")
class Lx16aBus(WithoutServoSettings):
    """Servos of the kinds LX-16A, LX-224, LX-15D, HTS-35H and alike, through Hiwonder's half-duplex adapter.

    Servos are asked one at a time: reading all of 18 takes longer than a tick of 10 ms.

    Parameters
    ----------
    transport : Transport
        The line.
    timeout : float
        Longest time until an answer begins, beyond its time on the wire [s].

    Attributes
    ----------
    name : str
        Name of the bus.
    port : str
        Name of the port.
    capabilities : Capabilities
        What it can do.
    """

    def __init__(self, transport: Transport, *, timeout: float = 0.02) -> None:
        self.name, self.port, self.capabilities = "lx16a", transport.port, _CAPABILITIES
        self._transport = transport
        self._link = Link(
            transport, self.name, codec.scan, timeout=timeout, header=codec.HEADER, patience=Patience(timeout)
        )

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
        answers = self._read((id,), codec.ID_READ, 1)
        for error in answers.errors:
            if isinstance(error, CorruptAnswerError):
                raise error
        return BusServo(id) if answers.values else None

    def scan(self, ids: Iterable[int] | None = None) -> Answers[BusServo]:
        """Return the servos that answer, and an error for each id whose answer is damaged.

        Parameters
        ----------
        ids : iterable of int, optional
            Ids to ask; all if left out.
        """
        return scanned(self, ids)

    def read_positions(self, ids: Sequence[int]) -> Answers[float]:
        """Return measured positions [tick].

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """
        return self._measured("position", checked_ids(self.name, self.capabilities, ids))

    def read_telemetry(self, ids: Sequence[int]) -> Answers[Telemetry]:
        """Return what servos measure, with a request for each value.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """
        values: dict[int, Telemetry] = {}
        errors: list[BusError] = []
        for id in checked_ids(self.name, self.capabilities, ids):
            parts: dict[str, Any] = {}
            for value in _TELEMETRY:
                answer = self._measured(value, (id,))
                if answer.errors:
                    errors += answer.errors
                    break
                parts[value] = answer.values[id]
            else:
                values[id] = Telemetry(**parts)
        return Answers(values, tuple(errors))

    def read_one(self, value: str, ids: Sequence[int]) -> Answers[Telemetry]:
        """Return one value of what servos measure; the others are None.

        Parameters
        ----------
        value : str
            ``"position"``, ``"temperature"`` or ``"voltage"``.
        ids : sequence of int
            The servos.

        Raises
        ------
        UnknownNameError
            If servos measure nothing of this name.
        """
        if value not in _TELEMETRY:
            raise UnknownNameError.of("measured value", value, _TELEMETRY)
        answers = self._measured(value, checked_ids(self.name, self.capabilities, ids))
        found: dict[int, dict[str, Any]] = {id: {value: measured} for id, measured in answers.values.items()}
        return Answers({id: Telemetry(**one) for id, one in found.items()}, answers.errors)

    def write_goals(self, goals: Mapping[int, float]) -> None:
        """Send goals [tick], one frame for each servo, and let all servos begin together.

        Parameters
        ----------
        goals : mapping of int to float
            Goals by id.
        """
        checked = checked_goals(self.name, self.capabilities, goals)
        if checked:
            self._link.send(self._frames(checked))

    def set_torque(self, ids: Sequence[int] | None, on: bool) -> bool:
        """Switch the torque of servos on or off; all of them at once with a broadcast.

        Parameters
        ----------
        ids : sequence of int, or None
            The servos; None for all on the bus.
        on : bool
            Whether they hold.
        """
        chosen = (codec.BROADCAST,) if ids is None else checked_ids(self.name, self.capabilities, ids)
        for id in chosen:
            self._link.send(codec.frame(id, codec.TORQUE_WRITE, bytes((int(on),))))
        return True

    def set_limits(self, id: int, lowest: float, highest: float) -> bool:
        """Set the range of goals that a servo accepts, and keeps without supply.

        Parameters
        ----------
        id : int
            The servo.
        lowest, highest : float
            Range [tick].

        Raises
        ------
        NoAnswerError, CorruptAnswerError
            If its answer does not come, or is damaged.
        ServoStatusError
            If the servo does not take the limits.
        """
        limits = checked_range(self.name, self.capabilities, id, lowest, highest)
        wanted = codec.encode_words(*limits)
        self._link.send(codec.frame(id, codec.LIMITS_WRITE, wanted))
        read = self._read((id,), codec.LIMITS_READ, 4).require()[id]
        if read != wanted:
            raise ServoStatusError(
                self.name,
                self.port,
                id=id,
                expected=f"limits of {limits[0]} and {limits[1]}",
                received=f"{codec.decode_unsigned(read[:2])} and {codec.decode_unsigned(read[2:])}",
                remedy="Write them again; the lower limit must be below the upper one.",
            )
        return True

    def timing(self, ids: Sequence[int]) -> BusTiming:
        """Return how long the bytes of a tick take on the wire.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """
        baud, servos = self._transport.baud, len(ids)
        goals = serial_seconds(len(self._frames(dict.fromkeys(ids, 0.0))), baud)
        # A request has 6 bytes, and an answer 6 bytes in addition to its data.
        position, voltage, temperature = (serial_seconds(12 + data, baud) + _TURNAROUND for data in (2, 2, 1))
        return BusTiming(goals, servos * position, servos * (position + voltage + temperature))

    def close(self) -> None:
        """Close the port; torque stays as it is."""
        self._transport.close()

    def _frames(self, goals: Mapping[int, float]) -> bytes:
        # A move time of 0: as fast as the servo can.
        waiting = (codec.frame(id, codec.MOVE_WAIT, codec.encode_words(round(goal), 0)) for id, goal in goals.items())
        return b"".join(waiting) + codec.frame(codec.BROADCAST, codec.MOVE_START)

    def _measured(self, value: str, ids: Sequence[int]) -> Answers[float]:
        command, count, unit = _TELEMETRY[value]
        answers = self._read(ids, command, count)
        decode = codec.decode_signed if value == "position" else codec.decode_unsigned
        return Answers({id: decode(data) * unit for id, data in answers.values.items()}, answers.errors)

    def _read(self, ids: Sequence[int], command: int, count: int) -> Answers[bytes]:
        def asked(id: int) -> Answers[Frame]:
            return self._link.ask(codec.frame(id, command), (id,), count, belongs=lambda frame: frame.code == command)

        answers = one_by_one(ids, asked)
        return Answers({id: frame.data for id, frame in answers.values.items()}, answers.errors)
