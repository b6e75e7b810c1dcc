"""What differs between servos that are read and written by registers: packets, registers, features, factory delays."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from tarsus.hardware.bus.capabilities import Capabilities
from tarsus.hardware.codec import dynamixel1, dynamixel2, feetech, packet
from tarsus.hardware.codec.scan import Scanner

__all__ = ["SERIES", "Dialect", "Series"]


@dataclass(frozen=True, kw_only=True)
class Dialect:
    """The packets of a protocol.

    Attributes
    ----------
    scan : callable
        Returns the packets found in bytes.
    header : bytes
        Bytes with which packets begin, before the id.
    read, write, sync_write : callable
        Return the packet that reads registers of a servo, writes them, or writes registers of several servos.
    errors_in : callable
        Returns what the error byte of an answer means.
    answer : int
        How many bytes an answer has in addition to its data.
    byteorder : str
        ``"little"`` or ``"big"``.
    """

    scan: Scanner
    header: bytes
    read: Callable[[int, int, int], bytes]
    write: Callable[[int, int, bytes], bytes]
    sync_write: Callable[[int, Mapping[int, bytes]], bytes]
    errors_in: Callable[[int], tuple[str, ...]]
    answer: int
    byteorder: str = "little"


_FEETECH = Dialect(
    scan=packet.scan,
    header=packet.HEADER,
    read=feetech.read,
    write=feetech.write,
    sync_write=feetech.sync_write,
    errors_in=feetech.errors_in,
    answer=6,
)
_FEETECH_BIG = Dialect(**{**vars(_FEETECH), "byteorder": "big"})
_DYNAMIXEL_1 = Dialect(
    scan=packet.scan,
    header=packet.HEADER,
    read=dynamixel1.read,
    write=dynamixel1.write,
    sync_write=dynamixel1.sync_write,
    errors_in=dynamixel1.errors_in,
    answer=6,
)
_DYNAMIXEL_2 = Dialect(
    scan=dynamixel2.scan,
    header=dynamixel2.HEADER,
    read=dynamixel2.read,
    write=dynamixel2.write,
    sync_write=dynamixel2.sync_write,
    errors_in=dynamixel2.errors_in,
    answer=11,
)


@dataclass(frozen=True, kw_only=True)
class Series:
    """A series of servos.

    Attributes
    ----------
    dialect : Dialect
        Its packets.
    capabilities : Capabilities
        What it can do.
    goal : tuple of str
        Names of the consecutive registers, from the goal on, that are written with each goal; all but the goal and the
        speed are written as 0.
    telemetry : tuple of str
        First and last of the consecutive registers that are read for telemetry.
    read_many : callable or None
        Returns the packet that asks several servos at once; None where there is none.
    read_fast : callable or None
        Returns the packet that several servos answer in one shared packet; None where there is none.
    turnaround : float
        Time from a request to the answer with the servos' factory settings [s].
    alarms : mapping of int to str
        What the bits of the register ``hardware_error`` mean, if there is one.
    fastest : int
        Greatest value of the speed register.
    """

    dialect: Dialect
    capabilities: Capabilities
    goal: tuple[str, ...] = ("goal",)
    telemetry: tuple[str, str]
    read_many: Callable[[Sequence[int], int, int], bytes] | None = None
    read_fast: Callable[[Sequence[int], int, int], bytes] | None = None
    turnaround: float
    alarms: Mapping[int, str] | None = None
    fastest: int = 32767


def _smart(
    highest: int, per_turn: float, telemetry: str, *, watchdog: bool = False, torque_limit: bool = True
) -> Capabilities:
    return Capabilities(
        unit="tick",
        lowest=0,
        highest=highest,
        per_turn=per_turn,
        ids=range(253 if watchdog else 254),
        ping="servo",
        positions=True,
        telemetry=frozenset(("alarms", *telemetry.split())),
        torque_off="torque",
        limits=True,
        speed_limit=True,
        torque_limit=torque_limit,
        # The register counts in units of 20 ms, up to 127 of them.
        watchdog=(0.02, 2.54) if watchdog else None,
        watchdog_action="hold" if watchdog else "none",
    )


_MEASURED = "position speed load voltage temperature"
# Factory setting of the return delay of Dynamixel servos: 250 times 2 us [s].
_RETURN_DELAY = 500e-6

SERIES = {
    "feetech-sts": Series(
        dialect=_FEETECH,
        capabilities=_smart(4095, 4096, _MEASURED + " current"),
        goal=("goal", "goal_time", "goal_speed"),
        telemetry=("position", "current"),
        read_many=feetech.sync_read,
        turnaround=50e-6,
    ),
    "feetech-scs": Series(
        dialect=_FEETECH_BIG,
        # 1024 steps over 300 degrees.
        capabilities=_smart(1023, 1024 * 360 / 300, _MEASURED, torque_limit=False),
        goal=("goal", "goal_time", "goal_speed"),
        telemetry=("position", "status"),
        turnaround=50e-6,
    ),
    "dynamixel-ax": Series(
        dialect=_DYNAMIXEL_1,
        capabilities=_smart(1023, 1024 * 360 / 300, _MEASURED),
        telemetry=("position", "temperature"),
        turnaround=_RETURN_DELAY,
        fastest=1023,
    ),
    "dynamixel-mx": Series(
        dialect=_DYNAMIXEL_1,
        capabilities=_smart(4095, 4096, _MEASURED),
        telemetry=("position", "temperature"),
        read_many=dynamixel1.bulk_read,
        turnaround=_RETURN_DELAY,
        fastest=1023,
    ),
    "dynamixel-x": Series(
        dialect=_DYNAMIXEL_2,
        capabilities=_smart(4095, 4096, _MEASURED, watchdog=True),
        telemetry=("load", "temperature"),
        read_many=dynamixel2.sync_read,
        read_fast=lambda ids, address, count: dynamixel2.sync_read(ids, address, count, fast=True),
        turnaround=_RETURN_DELAY,
        alarms={0: "voltage", 2: "temperature", 3: "position sensor", 4: "electrical shock", 5: "overload"},
    ),
}
"""The series of servos that are read and written by registers, by the names of their buses."""
