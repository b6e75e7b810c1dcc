"""Feetech STS and SCS servos on a serial line."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tarsus.errors import BusError, CorruptAnswerError
from tarsus.hardware.bus.checks import checked_goals, checked_ids, checked_range, checked_share, checked_speed
from tarsus.hardware.bus.link import Link
from tarsus.hardware.bus.protocol import Answers, BusServo, BusTiming, Capabilities, Telemetry
from tarsus.hardware.codec import feetech as codec
from tarsus.hardware.codec.packet import BROADCAST, scan
from tarsus.hardware.codec.registers import Register, load_registers
from tarsus.hardware.codec.scan import Frame
from tarsus.hardware.transport.protocol import Transport
from tarsus.hardware.transport.wire import serial_seconds
from tarsus.representation import represented

__all__ = ["MODELS", "SCS", "STS", "FeetechBus"]

MODELS = {777: "STS3215", 2825: "STS3250", 1284: "SCS0009"}
"""Names of models by their numbers; source: LeRobot's table of model numbers, read from the servos."""

_IDS = range(254)
_TELEMETRY = ("position", "speed", "load", "voltage", "temperature")

STS = Capabilities(
    unit="tick",
    lowest=0,
    highest=4095,
    per_turn=4096,
    ids=_IDS,
    ping="servo",
    positions=True,
    telemetry=frozenset((*_TELEMETRY, "current", "alarms")),
    torque_off="torque",
    limits=True,
    speed_limit=True,
    torque_limit=True,
)

# A turn of an SCS servo has 1024 steps over 300 degrees.
SCS = Capabilities(
    unit="tick",
    lowest=0,
    highest=1023,
    per_turn=1024 * 360 / 300,
    ids=_IDS,
    ping="servo",
    positions=True,
    telemetry=frozenset((*_TELEMETRY, "alarms")),
    torque_off="torque",
    limits=True,
    speed_limit=True,
)

# From the end of a request to the beginning of the answer: return delay of 0, and the servo's own time.
_TURNAROUND = 50e-6
_UNLOCKED, _LOCKED = b"\x00", b"\x01"


@represented("name", "port")
class FeetechBus:
    """Servos of Feetech's series STS (also SMS) or SCS.

    Parameters
    ----------
    transport : Transport
        The line.
    series : str
        ``"sts"`` or ``"scs"``.
    timeout : float
        Longest time until an answer begins, beyond its time on the wire [s].

    Attributes
    ----------
    name : str
        ``"feetech-sts"`` or ``"feetech-scs"``.
    port : str
        Name of the port.
    capabilities : Capabilities
        What it can do.
    """

    def __init__(self, transport: Transport, series: str = "sts", *, timeout: float = 0.02) -> None:
        self.name, self.port = f"feetech-{series}", transport.port
        self.capabilities = STS if series == "sts" else SCS
        self._sts = series == "sts"
        self._byteorder = "little" if self._sts else "big"
        self._registers = load_registers(self.name)
        self._transport = transport
        self._link = Link(transport, self.name, scan, timeout=timeout)
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
        # An answer to a ping may look like the ping's echo; one with data never does.
        answer = self._read((id,), self._block("firmware", "model"))
        for error in answer.errors:
            if isinstance(error, CorruptAnswerError):
                raise error
            return None
        data = answer.values[id].data
        model = self._registers["model"].decode(data[3:5], byteorder=self._byteorder)
        return BusServo(id, model, MODELS.get(model, ""), f"{data[0]}.{data[1]}")

    def scan(self, ids: Iterable[int] | None = None) -> Answers[BusServo]:
        """Return the servos that answer, and an error for each id whose answer is damaged.

        Parameters
        ----------
        ids : iterable of int, optional
            Ids to ask; all if left out.
        """
        found, errors = {}, []
        for id in checked_ids(self.name, self.capabilities, self.capabilities.ids if ids is None else ids):
            try:
                servo = self.ping(id)
            except CorruptAnswerError as error:
                errors.append(error)
                continue
            if servo is not None:
                found[id] = servo
        return Answers(found, tuple(errors))

    def read_positions(self, ids: Sequence[int]) -> Answers[float]:
        """Return measured positions [tick].

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """
        ids = checked_ids(self.name, self.capabilities, ids)
        answers = self._read(ids, self._block("position", "position"))
        decode = self._registers["position"].decode
        return Answers(
            {id: float(decode(frame.data, byteorder=self._byteorder)) for id, frame in answers.values.items()},
            answers.errors,
        )

    def read_telemetry(self, ids: Sequence[int]) -> Answers[Telemetry]:
        """Return what servos measure.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """
        ids = checked_ids(self.name, self.capabilities, ids)
        first, count = self._telemetry_block
        answers = self._read(ids, (first, count))
        return Answers({id: self._decoded(frame, first) for id, frame in answers.values.items()}, answers.errors)

    def write_goals(self, goals: Mapping[int, float]) -> None:
        """Send goals [tick] in one packet.

        Parameters
        ----------
        goals : mapping of int to float
            Goals by id.
        """
        checked = checked_goals(self.name, self.capabilities, goals)
        if not checked:
            return
        # Without the speed in the same packet, SCS servos move at the speed of the last one.
        speeds = {id: self._speed.get(id, 0) for id in checked}
        self._sync_write(
            self._registers["goal"],
            {
                id: self._encoded("goal", round(goal))
                + self._encoded("goal_time", 0)
                + self._encoded("goal_speed", speeds[id])
                for id, goal in checked.items()
            },
        )

    def set_torque(self, ids: Sequence[int] | None, on: bool) -> bool:
        """Switch the torque of servos on or off; all of them at once with a broadcast.

        Parameters
        ----------
        ids : sequence of int, or None
            The servos; None for all on the bus.
        on : bool
            Whether they hold.
        """
        register, value = self._registers["torque"], bytes((int(on),))
        if ids is None:
            self._link.send(codec.write(BROADCAST, register.address, value))
        elif chosen := checked_ids(self.name, self.capabilities, ids):
            self._sync_write(register, dict.fromkeys(chosen, value))
        return True

    def set_limits(self, id: int, lowest: float, highest: float) -> bool:
        """Set the range of goals that a servo accepts; it keeps them without supply.

        Parameters
        ----------
        id : int
            The servo.
        lowest, highest : float
            Range [tick].

        Raises
        ------
        NoAnswerError, CorruptAnswerError
            If the servo does not confirm.
        """
        low, high = checked_range(self.name, self.capabilities, id, lowest, highest)
        register, lock = self._registers["lowest"], self._registers["lock"].address
        limits = self._encoded("lowest", low) + self._encoded("highest", high)
        for address, content in ((lock, _UNLOCKED), (register.address, limits), (lock, _LOCKED)):
            # Whether servos answer to this depends on their status level: what counts is what can be read back.
            self._link.ask(codec.write(id, address, content), (id,), 0)
        self._confirm(id, ("lowest", "highest"), (low, high))
        return True

    def set_speed_limit(self, ids: Sequence[int], speed: float | None) -> bool:
        """Set the highest speed of servos, with which their next goals are sent.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        speed : float or None
            Speed [tick/s]; None for the servo's own.
        """
        limit = checked_speed(self.name, self.capabilities, speed)
        value = 0 if limit is None else min(max(round(limit), 1), 32767)
        self._speed.update(dict.fromkeys(checked_ids(self.name, self.capabilities, ids), value))
        return True

    def set_torque_limit(self, ids: Sequence[int], share: float) -> bool:
        """Set the highest torque of STS servos; SCS servos have none that can be set at run time.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        share : float
            Share of the highest torque, 0 to 1.
        """
        value = round(checked_share(self.name, share) / 0.001)
        chosen = checked_ids(self.name, self.capabilities, ids)
        if not self._sts:
            return False
        if chosen:
            self._sync_write(
                self._registers["torque_limit"], dict.fromkeys(chosen, self._encoded("torque_limit", value))
            )
        return True

    def set_watchdog(self, ids: Sequence[int], seconds: float | None) -> bool:
        """Do nothing: these servos have no watchdog.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        seconds : float or None
            The time [s].
        """
        del ids, seconds
        return False

    def timing(self, ids: Sequence[int]) -> BusTiming:
        """Return how long the bytes of a tick take on the wire.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """
        goals = dict.fromkeys(ids, b"\x00" * 6)
        return BusTiming(
            serial_seconds(len(codec.sync_write(self._registers["goal"].address, goals)), self._transport.baud),
            self._read_seconds(ids, self._registers["position"].size),
            self._read_seconds(ids, self._telemetry_block[1]),
        )

    def close(self) -> None:
        """Close the port; torque stays as it is."""
        self._transport.close()

    @property
    def _telemetry_block(self) -> tuple[int, int]:
        return self._block("position", "current" if self._sts else "status")

    def _block(self, first: str, last: str) -> tuple[int, int]:
        """Return the first address and the number of bytes of consecutive registers."""
        begin, end = self._registers[first], self._registers[last]
        return begin.address, end.address + end.size - begin.address

    def _encoded(self, register: str, value: int) -> bytes:
        return self._registers[register].encode(value, byteorder=self._byteorder)

    def _sync_write(self, register: Register, contents: Mapping[int, bytes]) -> None:
        self._link.send(codec.sync_write(register.address, contents))

    def _read(self, ids: Sequence[int], block: tuple[int, int]) -> Answers[Frame]:
        address, count = block
        if self._sts and len(ids) > 1:
            return self._link.ask(codec.sync_read(ids, address, count), ids, count)
        answers: dict[int, Frame] = {}
        errors: list[BusError] = []
        for id in ids:
            answer = self._link.ask(codec.read(id, address, count), (id,), count)
            answers.update(answer.values)
            errors += answer.errors
        return Answers(answers, tuple(errors))

    def _read_seconds(self, ids: Sequence[int], count: int) -> float:
        baud = self._transport.baud
        answers = len(ids) * (serial_seconds(codec.answer_size(count), baud) + _TURNAROUND)
        if self._sts and len(ids) > 1:
            return answers + serial_seconds(len(codec.sync_read(ids, 0, count)), baud)
        return answers + len(ids) * serial_seconds(len(codec.read(1, 0, count)), baud)

    def _decoded(self, frame: Frame, first: int) -> Telemetry:
        values: dict[str, Any] = {}
        for name in self.capabilities.telemetry - {"alarms"}:
            register = self._registers[name]
            at = register.address - first
            raw = register.decode(frame.data[at : at + register.size], byteorder=self._byteorder)
            values[name] = raw * register.scale
        return Telemetry(**values, alarms=codec.errors_in(frame.code))

    def _confirm(self, id: int, names: tuple[str, str], wanted: tuple[int, int]) -> None:
        """Read two registers back, and refuse if they do not hold what was written."""
        data = self._read((id,), self._block(*names)).require()[id].data
        read = tuple(
            self._registers[name].decode(data[2 * at : 2 * at + 2], byteorder=self._byteorder)
            for at, name in enumerate(names)
        )
        if read != wanted:
            raise CorruptAnswerError(
                self.name,
                self.port,
                id=id,
                expected=f"{names[0]} and {names[1]} to be {wanted[0]} and {wanted[1]}",
                received=f"{read[0]} and {read[1]}",
                remedy="Write them again; if that fails the servo's memory is locked or worn out.",
            )
