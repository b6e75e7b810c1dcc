"""Emulated servos that are read and written by registers: Feetech and Dynamixel."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from tarsus.hardware.codec import dynamixel2
from tarsus.hardware.codec import packet as packets
from tarsus.hardware.codec.dynamixel2_fast import fast_status
from tarsus.hardware.codec.registers import load_registers
from tarsus.hardware.codec.scan import Frame
from tarsus.hardware.emulation.line import EmulatedLine
from tarsus.hardware.emulation.registers import ServoMemory
from tarsus.hardware.emulation.servo import EmulatedServo, ServoTraits
from tarsus.hardware.emulation.supply import Supply
from tarsus.hardware.emulation.traits import INITIAL, TRAITS

__all__ = ["EmulatedRegisters"]

_PING, _READ, _WRITE = 1, 2, 3
_SYNC_READ, _SYNC_WRITE, _FAST_SYNC_READ, _BULK_READ = 0x82, 0x83, 0x8A, 0x92
_BROADCAST = packets.BROADCAST
# Instructions that each kind of servo knows in addition to ping, read, write and sync write.
_INSTRUCTIONS = {
    "feetech-sts": {_SYNC_READ},
    "feetech-scs": set[int](),
    "dynamixel-ax": set[int](),
    "dynamixel-mx": {_BULK_READ},
    "dynamixel-x": {_SYNC_READ, _FAST_SYNC_READ, _BULK_READ},
}
# Overheating bit, in an answer's error byte or the register for hardware errors; error of a write that is refused.
_OVERHEATED = 1 << 2
_NOT_WRITABLE = 7
# What X servos refuse after their watchdog has stopped them.
_GOALS = ("goal", "torque_limit")


class EmulatedRegisters(EmulatedLine):
    """Servos of Feetech or Dynamixel on a line.

    Parameters
    ----------
    ids : iterable of int
        Their ids.
    name : str
        Name of their bus.
    traits : ServoTraits, optional
        What they are like.
    return_delay : float, optional
        Time until Dynamixel servos answer [s]; by default with their factory settings.
    **line
        Passed on to `EmulatedLine`.

    Attributes
    ----------
    memory : dict of int to ServoMemory
        The servos' registers.
    """

    def __init__(
        self,
        ids: Iterable[int],
        name: str,
        *,
        traits: ServoTraits | None = None,
        return_delay: float | None = None,
        **line: Any,
    ) -> None:
        traits = traits or TRAITS[name]
        if name.startswith("dynamixel") and line.get("supply") is None:
            line["supply"] = Supply(12.0, least=6.5)
        super().__init__({id: EmulatedServo(traits) for id in ids}, **line)
        self._two = name == "dynamixel-x"
        self._known = _INSTRUCTIONS[name]
        registers = load_registers(name)
        initial = {
            **INITIAL[name],
            "lowest": int(traits.lowest),
            "highest": int(traits.highest),
            "hottest": round(traits.hottest),
        }
        if return_delay is not None:
            initial["return_delay"] = round(return_delay / 2e-6)
        byteorder = "big" if name == "feetech-scs" else "little"
        self.memory = {
            id: ServoMemory(servo, registers, self.supply, byteorder=byteorder, initial={**initial, "id": id})
            for id, servo in self.servos.items()
        }

    def _delay(self, id: int) -> float:
        memory = self.memory[id]
        return max(self.turnaround, memory.get("return_delay") * 2e-6 if memory.has("return_delay") else 0.0)

    def _answers(self) -> Iterator[tuple[int, bytes]]:
        scanned = dynamixel2.scan(self._buffer) if self._two else packets.scan(self._buffer)
        self._buffer = scanned.rest
        for request in scanned.frames:
            if self._two and request.raw[7] == dynamixel2.STATUS:
                continue
            yield from self._carried_out(request)

    def _watch(self, silent: float) -> None:
        for id, memory in self.memory.items():
            if not memory.has("watchdog") or not self.servos[id].torque:
                continue
            limit = memory.get("watchdog")
            if limit > 0 and silent > limit * 0.02:
                memory.set("watchdog", -1)
                self.servos[id].halt()

    def _started_anew(self) -> None:
        for memory in self.memory.values():
            memory.restart()

    def _carried_out(self, request: Frame) -> Iterator[tuple[int, bytes]]:
        code, data = request.code, request.data
        if request.id != _BROADCAST:
            if request.id in self.servos:
                yield from self._single(request)
        elif code == _SYNC_WRITE:
            self._sync_write(data)
        elif code == _WRITE:
            for id in self.servos:
                self._write(id, data)
        elif code == _PING:
            for id in sorted(self.servos):
                yield self._pong(id)
        elif code in self._known:
            yield from self._several(code, data)

    def _several(self, code: int, data: bytes) -> Iterator[tuple[int, bytes]]:
        word = 2 if self._two else 1
        if code == _BULK_READ:
            for id, address, count in self._bulk(data, word):
                yield from self._content(id, address, count)
            return
        address, count = self._number(data, 0, word), self._number(data, word, word)
        ids = data[2 * word :]
        if code == _SYNC_READ:
            for id in ids:
                yield from self._content(id, address, count)
        elif not self.faults.missing.intersection(ids) and set(ids) <= self.servos.keys():
            # Each servo sends its part of one packet when the part before it is complete.
            parts = [(id, self._error(id), self.memory[id].read(address, count)) for id in ids]
            yield from zip(ids, fast_status(parts), strict=True)

    def _bulk(self, data: bytes, word: int) -> Iterator[tuple[int, int, int]]:
        if self._two:
            for at in range(0, len(data) - 4, 5):
                yield data[at], self._number(data, at + 1, word), self._number(data, at + 3, word)
        else:
            for at in range(1, len(data) - 2, 3):
                yield data[at + 1], data[at + 2], data[at]

    def _single(self, request: Frame) -> Iterator[tuple[int, bytes]]:
        id, word = request.id, 2 if self._two else 1
        if request.code == _PING:
            yield self._pong(id)
        elif request.code == _READ and len(request.data) == 2 * word:
            yield from self._content(id, self._number(request.data, 0, word), self._number(request.data, word, word))
        elif request.code == _WRITE and len(request.data) > word:
            refused = self._write(id, request.data)
            if self.memory[id].get("status_level") > int(self._has_delay(id)):
                yield id, self._status(id, b"", refused)

    def _has_delay(self, id: int) -> bool:
        # True for Dynamixel, whose status level 1 answers to ping and read only, as Feetech's level 0 does.
        return self.memory[id].has("return_delay") and not self.memory[id].has("lock")

    def _pong(self, id: int) -> tuple[int, bytes]:
        if not self._two:
            return id, self._status(id, b"")
        memory = self.memory[id]
        return id, self._status(id, memory.read(0, 2) + memory.read(6, 1))

    def _content(self, id: int, address: int, count: int) -> Iterator[tuple[int, bytes]]:
        if id in self.servos:
            yield id, self._status(id, self.memory[id].read(address, count))

    def _sync_write(self, data: bytes) -> None:
        word = 2 if self._two else 1
        begin, length = data[:word], self._number(data, word, word)
        for at in range(2 * word, len(data) - length, length + 1):
            self._write(data[at], begin + data[at + 1 : at + 1 + length])

    def _write(self, id: int, data: bytes) -> int:
        """Write registers of a servo, and return the error with which it answers."""
        if id not in self.servos or id in self.faults.missing:
            return 0
        word, memory = 2 if self._two else 1, self.memory[id]
        address = self._number(data, 0, word)
        stopped = memory.has("watchdog") and memory.get("watchdog") == -1
        # X servos refuse writes to EEPROM while their torque is on.
        locked = self._two and self.servos[id].torque and address < memory.address("torque")
        if locked or (stopped and any(memory.touches(goal, address, len(data) - word) for goal in _GOALS)):
            return _NOT_WRITABLE
        memory.write(address, data[word:])
        return 0

    def _status(self, id: int, data: bytes, refused: int = 0) -> bytes:
        if self._two:
            return dynamixel2.status(id, self._error(id) | refused, data)
        return packets.packet(id, self._error(id), data)

    def _error(self, id: int) -> int:
        hot = self.servos[id].overheated
        if not self._two:
            return _OVERHEATED if hot else 0
        self.memory[id].set("hardware_error", _OVERHEATED if hot else 0)
        return dynamixel2.ALERT if hot else 0

    @staticmethod
    def _number(data: bytes, at: int, size: int) -> int:
        return int.from_bytes(data[at : at + size], "little")
