"""Dynamixel protocol 1.0: instructions of AX and MX servos, in the packets of `packet`.

Source: ROBOTIS e-Manual, DYNAMIXEL Protocol 1.0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tarsus.hardware.codec.packet import (
    BROADCAST,
    PING,
    READ,
    SYNC_WRITE,
    WRITE,
    bits_set,
    packet,
    ping,
    read,
    sync_write,
    write,
)

__all__ = [
    "BULK_READ",
    "ERRORS",
    "PING",
    "READ",
    "SYNC_WRITE",
    "WRITE",
    "bulk_read",
    "errors_in",
    "ping",
    "read",
    "sync_write",
    "write",
]

BULK_READ: Final = 0x92

ERRORS = {
    0: "voltage",
    1: "goal outside the limits",
    2: "temperature",
    3: "value out of range",
    4: "checksum of the request",
    5: "overload",
    6: "unknown instruction",
}
"""What the bits of an answer's error byte mean."""


def errors_in(code: int) -> tuple[str, ...]:
    """Return what a servo reports in the error byte of an answer.

    Parameters
    ----------
    code : int
        The error byte.
    """
    return bits_set(code, ERRORS)


def bulk_read(ids: Sequence[int], address: int, count: int) -> bytes:
    """Return the packet that asks several MX servos for registers; AX servos do not know it.

    Parameters
    ----------
    ids : sequence of int
        Ids of the servos.
    address : int
        The first register.
    count : int
        How many bytes.
    """
    wanted = b"".join(bytes((count, id, address)) for id in ids)
    return packet(BROADCAST, BULK_READ, b"\x00" + wanted)
