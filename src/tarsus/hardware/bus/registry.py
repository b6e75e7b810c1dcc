"""The kinds of servo buses by name, and opening one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tarsus.errors import UnknownNameError
from tarsus.hardware.bus.boards.lines import LineBus
from tarsus.hardware.bus.boards.maestro import MaestroBus
from tarsus.hardware.bus.boards.pca9685 import Pca9685Bus
from tarsus.hardware.bus.boards.servo2040 import Servo2040Bus
from tarsus.hardware.bus.boards.ssc32 import Ssc32Bus
from tarsus.hardware.bus.lx16a import Lx16aBus
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.register_bus import RegisterBus
from tarsus.hardware.transport.i2c import SmbusTransport
from tarsus.hardware.transport.serial import SerialTransport
from tarsus.representation import represented

__all__ = ["BUSES", "BusKind", "bus_kind", "bus_over", "open_bus"]


@represented("name", "title", "baud", "transport")
@dataclass(frozen=True)
class BusKind:
    """A kind of servo bus.

    Attributes
    ----------
    name : str
        Its name in calibration files and on the command line.
    title : str
        What it is called.
    baud : int
        Bits per second: the maker's where it is fast enough; the clock [Hz] of I2C.
    make : callable
        Makes the bus on a transport, with the bus's own options.
    transport : str
        ``"serial"`` or ``"i2c"``.
    """

    name: str
    title: str
    baud: int
    make: Callable[..., Bus]
    transport: str = "serial"


def _registers(name: str, title: str, baud: int) -> BusKind:
    def make(transport: Any, **options: Any) -> Bus:
        return RegisterBus(transport, name, **options)

    return BusKind(name, title, baud, make)


_KINDS = (
    _registers("feetech-sts", "Feetech STS and SMS", 1_000_000),
    _registers("feetech-scs", "Feetech SCS", 1_000_000),
    _registers("dynamixel-x", "Dynamixel X, and MX with protocol 2.0", 57_600),
    _registers("dynamixel-mx", "Dynamixel MX with protocol 1.0", 57_600),
    _registers("dynamixel-ax", "Dynamixel AX", 1_000_000),
    BusKind("lx16a", "Hiwonder LX-16A and HTS", 115_200, Lx16aBus),
    BusKind("maestro", "Pololu Mini Maestro", 115_200, MaestroBus),
    BusKind("ssc32", "Lynxmotion SSC-32 and SSC-32U", 115_200, Ssc32Bus),
    BusKind("servo2040", "Pimoroni Servo2040", 115_200, Servo2040Bus),
    BusKind("lines", "Lines of pulse widths, for an Arduino", 115_200, LineBus),
    BusKind("pca9685", "PCA9685 boards", 400_000, Pca9685Bus, "i2c"),
)

BUSES = {kind.name: kind for kind in _KINDS}
"""All kinds of buses by name."""


def bus_kind(name: str) -> BusKind:
    """Return a kind of bus.

    Parameters
    ----------
    name : str
        Its name.

    Raises
    ------
    UnknownNameError
        If there is none of that name; the message lists all.
    """
    if name not in BUSES:
        raise UnknownNameError.of("servo bus", name, BUSES)
    return BUSES[name]


def bus_over(name: str, transport: Any, **options: Any) -> Bus:
    """Return a bus on a transport that is open.

    Parameters
    ----------
    name : str
        Kind of the bus.
    transport : Transport or I2cTransport
        The line, of the kind that the bus needs.
    **options
        Options of this kind of bus.

    Raises
    ------
    UnknownNameError
        If there is no bus of that name.
    """
    return bus_kind(name).make(transport, **options)


def open_bus(name: str, port: str, *, baud: int | None = None, **options: Any) -> Bus:
    """Open a bus on a port of this machine.

    Parameters
    ----------
    name : str
        Kind of the bus: a name in `BUSES`.
    port : str
        The port, such as ``"/dev/ttyUSB0"``, ``"COM3"`` or ``"/dev/i2c-1"``.
    baud : int, optional
        Bits per second, or clock of I2C [Hz]; by default the maker's.
    **options
        Options of this kind of bus, such as ``timeout`` [s].

    Raises
    ------
    UnknownNameError
        If there is no bus of that name.
    PortError
        If the port can't be opened.
    """
    kind = bus_kind(name)
    transport = SmbusTransport if kind.transport == "i2c" else SerialTransport
    return kind.make(transport(port, baud or kind.baud), **options)
