"""Emulated LX-16A servos."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from tarsus.hardware.codec import lx16a as codec
from tarsus.hardware.emulation.line import EmulatedLine
from tarsus.hardware.emulation.servo import EmulatedServo, ServoTraits

__all__ = ["EmulatedLx16a"]

# LX-16A at 7.4 V: 0.16 s for 60 degrees; 1000 steps over 240 degrees; 0.5 degrees of play.
_TRAITS = ServoTraits(per_turn=1500, lowest=0, highest=1000, speed=1560, play=2, stall_current=1.5)


# Settings that are kept and read back, but have no effect here. The command that reads each is the key; the values are
# the command that writes it, and its content at first. In order: offset, limits of voltage, limit of temperature, mode
# and speed, LED, and alarms that make the LED blink.
_SETTINGS = {
    19: (17, b"\x00"),
    23: (22, codec.encode_words(4500, 12000)),
    25: (24, b"\x55"),
    30: (29, b"\x00\x00\x00\x00"),
    34: (33, b"\x00"),
    36: (35, b"\x07"),
}
_WRITES = {write: read for read, (write, _) in _SETTINGS.items()}


class EmulatedLx16a(EmulatedLine):
    """LX-16A servos on a line.

    Parameters
    ----------
    ids : iterable of int
        Their ids.
    traits : ServoTraits, optional
        What they are like.
    **line
        Passed on to `EmulatedLine`.
    """

    def __init__(self, ids: Iterable[int], *, traits: ServoTraits | None = None, **line: Any) -> None:
        traits = traits or _TRAITS
        super().__init__({id: EmulatedServo(traits) for id in ids}, **{"turnaround": 300e-6, **line})
        self._limits = dict.fromkeys(self.servos, (0, 1000))
        self._waiting: dict[int, tuple[int, int]] = {}
        self._settings = {id: {read: initial for read, (_, initial) in _SETTINGS.items()} for id in self.servos}

    def _answers(self) -> Iterator[tuple[int, bytes]]:
        scanned = codec.scan(self._buffer)
        self._buffer = scanned.rest
        for request in scanned.frames:
            ids = self.servos if request.id == codec.BROADCAST else {request.id} & self.servos.keys()
            for id in tuple(ids):
                answer = b"" if id in self.faults.missing else self._carried_out(id, request.code, request.data)
                if answer and request.id != codec.BROADCAST:
                    yield id, codec.frame(id, request.code, answer)

    def _started_anew(self) -> None:
        self._waiting.clear()

    def _carried_out(self, id: int, command: int, data: bytes) -> bytes:
        if command in (codec.MOVE, codec.MOVE_WAIT, codec.MOVE_START):
            self._move(id, command, data)
        elif command == codec.TORQUE_WRITE and data:
            self.servos[id].torque = bool(data[0])
            self.servos[id].halt()
        elif command == codec.LIMITS_WRITE and len(data) == 4:
            low, high = codec.decode_unsigned(data[:2]), codec.decode_unsigned(data[2:])
            if low < high <= 1000:
                self._limits[id] = (low, high)
        elif command in _WRITES:
            self._settings[id][_WRITES[command]] = data
        return self._settings[id].get(command, b"") or self._read(id, command)

    def _read(self, id: int, command: int) -> bytes:
        servo = self.servos[id]
        if command == codec.POSITION_READ:
            return round(servo.position).to_bytes(2, "little", signed=True)
        numbers = {
            codec.ID_READ: (id, 1),
            codec.VOLTAGE_READ: (round(self.supply.voltage * 1e3), 2),
            codec.TEMPERATURE_READ: (round(servo.temperature), 1),
            codec.TORQUE_READ: (int(servo.torque), 1),
        }
        if command == codec.LIMITS_READ:
            return codec.encode_words(*self._limits[id])
        value, size = numbers.get(command, (0, 0))
        return value.to_bytes(size, "little")

    def _move(self, id: int, command: int, data: bytes) -> None:
        if command == codec.MOVE_START:
            order = self._waiting.pop(id, None)
        elif len(data) == 4:
            order = codec.decode_unsigned(data[:2]), codec.decode_unsigned(data[2:])
        else:
            return
        if order is None:
            return
        if command == codec.MOVE_WAIT:
            self._waiting[id] = order
            return
        servo, (low, high) = self.servos[id], self._limits[id]
        # A move command switches the torque on, unless the servo is overheated.
        servo.torque = not servo.overheated
        servo.goal = float(min(max(order[0], low), high))
        way, milliseconds = abs(servo.goal - servo.position), order[1]
        servo.speed_limit = way / (milliseconds / 1e3) if milliseconds and way else float("inf")
