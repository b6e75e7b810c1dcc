"""Emulated servos of each kind of bus, by the bus's name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from tarsus.errors import UnknownNameError
from tarsus.hardware.bus.dialect import SERIES
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.registry import bus_kind, bus_over
from tarsus.hardware.emulation.boards import EmulatedLines, EmulatedMaestro, EmulatedServo2040, EmulatedSsc32
from tarsus.hardware.emulation.lx16a import EmulatedLx16a
from tarsus.hardware.emulation.pca9685 import EmulatedPca9685
from tarsus.hardware.emulation.register_line import EmulatedRegisters
from tarsus.hardware.emulation.servos import EmulatedServos
from tarsus.hardware.transport.clock import Clock
from tarsus.hardware.transport.memory import MemoryI2c, MemoryTransport

__all__ = ["EMULATIONS", "emulate", "emulated_bus"]


def _registers(name: str) -> Callable[..., EmulatedServos]:
    return lambda ids, **line: EmulatedRegisters(ids, name, **line)


EMULATIONS: dict[str, Callable[..., EmulatedServos]] = {
    **{name: _registers(name) for name in SERIES},
    "lx16a": EmulatedLx16a,
    "maestro": EmulatedMaestro,
    "ssc32": EmulatedSsc32,
    "servo2040": EmulatedServo2040,
    "lines": EmulatedLines,
    "pca9685": EmulatedPca9685,
}
"""Callables that make emulated servos, by the name of the bus."""


def emulate(name: str, ids: Iterable[int], **line: Any) -> Any:
    """Return emulated servos: an `EmulatedLine`, or for I2C the devices on it.

    Parameters
    ----------
    name : str
        Kind of the bus.
    ids : iterable of int
        Their ids or channels.
    **line
        ``supply``, ``faults``, ``traits``, and on serial lines ``baud`` and ``turnaround``.

    Raises
    ------
    UnknownNameError
        If there is no bus of that name.
    """
    if name not in EMULATIONS:
        raise UnknownNameError.of("emulated servo bus", name, EMULATIONS)
    rate = {"baud": bus_kind(name).baud} if bus_kind(name).transport == "serial" else {}
    return EMULATIONS[name](ids, **{**rate, **line})


def emulated_bus(name: str, ids: Iterable[int], *, clock: Clock | None = None, **line: Any) -> tuple[Bus, Any]:
    """Return a bus in memory and the emulated servos on it.

    Parameters
    ----------
    name : str
        Kind of the bus.
    ids : iterable of int
        Ids or channels of the servos.
    clock : Clock, optional
        By default a clock that stands still unless the bus waits.
    **line
        Passed on to `emulate`.

    Raises
    ------
    UnknownNameError
        If there is no bus of that name.
    """
    device = emulate(name, ids, **line)
    if bus_kind(name).transport == "i2c":
        return bus_over(name, MemoryI2c(device, clock, frequency=bus_kind(name).baud)), device
    return bus_over(name, MemoryTransport(device, clock)), device
