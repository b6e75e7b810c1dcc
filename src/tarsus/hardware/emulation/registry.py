"""Emulated servos of each kind of bus, by the bus's name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from tarsus.errors import UnknownNameError
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.registry import bus_kind, bus_over
from tarsus.hardware.emulation.feetech import EmulatedFeetech
from tarsus.hardware.emulation.line import EmulatedLine
from tarsus.hardware.transport.clock import Clock
from tarsus.hardware.transport.memory import MemoryTransport

__all__ = ["EMULATIONS", "emulate", "emulated_bus"]

EMULATIONS: dict[str, Callable[..., EmulatedLine]] = {
    "feetech-sts": lambda ids, **line: EmulatedFeetech(ids, "sts", **line),
    "feetech-scs": lambda ids, **line: EmulatedFeetech(ids, "scs", **line),
}
"""What makes emulated servos, by the name of the bus."""


def emulate(name: str, ids: Iterable[int], **line: Any) -> EmulatedLine:
    """Return emulated servos.

    Parameters
    ----------
    name : str
        Kind of the bus.
    ids : iterable of int
        Their ids or channels.
    **line
        ``baud``, ``supply``, ``faults``, ``turnaround``, ``traits``.

    Raises
    ------
    UnknownNameError
        If there is no bus of that name.
    """
    if name not in EMULATIONS:
        raise UnknownNameError.of("emulated servo bus", name, EMULATIONS)
    return EMULATIONS[name](ids, **{"baud": bus_kind(name).baud, **line})


def emulated_bus(name: str, ids: Iterable[int], *, clock: Clock | None = None, **line: Any) -> tuple[Bus, EmulatedLine]:
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
    return bus_over(name, MemoryTransport(device, clock)), device
