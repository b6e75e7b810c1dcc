"""Emulated Feetech STS and SCS servos."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from tarsus.hardware.codec import feetech as codec
from tarsus.hardware.codec.packet import BROADCAST, packet, scan
from tarsus.hardware.codec.registers import load_registers
from tarsus.hardware.codec.scan import Frame
from tarsus.hardware.emulation.line import EmulatedLine
from tarsus.hardware.emulation.registers import ServoMemory
from tarsus.hardware.emulation.servo import EmulatedServo, ServoTraits

__all__ = ["EmulatedFeetech"]

STS_TRAITS = ServoTraits(per_turn=4096, lowest=0, highest=4095, speed=3400, play=6)
# SCS0009: 0.1 s for 60 degrees at 6 V.
SCS_TRAITS = ServoTraits(per_turn=1228.8, lowest=0, highest=1023, speed=2000, play=3, stall_current=1.0)
_OVERHEATED = 1 << 2


class EmulatedFeetech(EmulatedLine):
    """Servos of Feetech's series STS or SCS on a line.

    Parameters
    ----------
    ids : iterable of int
        Their ids.
    series : str
        ``"sts"`` or ``"scs"``.
    traits : ServoTraits, optional
        What they are like.
    **line
        Passed on to `EmulatedLine`.
    """

    def __init__(
        self, ids: Iterable[int], series: str = "sts", *, traits: ServoTraits | None = None, **line: Any
    ) -> None:
        self._sts = series == "sts"
        traits = traits or (STS_TRAITS if self._sts else SCS_TRAITS)
        super().__init__({id: EmulatedServo(traits) for id in ids}, **{"baud": 1_000_000, **line})
        registers = load_registers(f"feetech-{series}")
        self._registers = registers
        initial = {
            "model": 777 if self._sts else 1284,
            "status_level": 1,
            "lowest": int(traits.lowest),
            "highest": int(traits.highest),
            "hottest": round(traits.hottest),
            "most_torque": 1000,
            "lock": 1,
        }
        if self._sts:
            initial["torque_limit"] = 1000
        self.memory = {
            id: ServoMemory(
                servo, registers, self.supply, byteorder="little" if self._sts else "big", initial={**initial, "id": id}
            )
            for id, servo in self.servos.items()
        }

    def _answers(self) -> Iterator[tuple[int, bytes]]:
        scanned = scan(self._buffer)
        self._buffer = scanned.rest
        for request in scanned.frames:
            yield from self._carried_out(request)

    def _started_anew(self) -> None:
        for memory in self.memory.values():
            memory.restart()

    def _carried_out(self, request: Frame) -> Iterator[tuple[int, bytes]]:
        if request.code == codec.SYNC_READ and self._sts and request.id == BROADCAST:
            for id in request.data[2:]:
                yield from self._content(id, request.data[0], request.data[1])
        elif request.code == codec.SYNC_WRITE and request.id == BROADCAST:
            self._sync_write(request.data)
        elif request.id == BROADCAST and request.code == codec.WRITE:
            for id in self.servos:
                self._write(id, request.data)
        elif request.id in self.servos:
            yield from self._single(request)

    def _single(self, request: Frame) -> Iterator[tuple[int, bytes]]:
        id = request.id
        if request.code == codec.PING:
            yield id, packet(id, self._alarms(id))
        elif request.code == codec.READ and len(request.data) == 2:
            yield from self._content(id, *request.data)
        elif request.code == codec.WRITE and request.data:
            self._write(id, request.data)
            if self.memory[id].get("status_level"):
                yield id, packet(id, self._alarms(id))

    def _content(self, id: int, address: int, count: int) -> Iterator[tuple[int, bytes]]:
        if id in self.servos:
            yield id, packet(id, self._alarms(id), self.memory[id].read(address, count))

    def _sync_write(self, data: bytes) -> None:
        address, length = data[0], data[1]
        for at in range(2, len(data) - length, length + 1):
            self._write(data[at], bytes((address,)) + data[at + 1 : at + 1 + length])

    def _write(self, id: int, data: bytes) -> None:
        if id in self.servos and id not in self.faults.missing:
            self.memory[id].write(data[0], data[1:])

    def _alarms(self, id: int) -> int:
        return _OVERHEATED if self.servos[id].overheated else 0
