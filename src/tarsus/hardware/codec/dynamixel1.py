"""Dynamixel protocol 1.0: instructions of AX and MX servos, in the packets of `packet`.

Source: ROBOTIS e-Manual, DYNAMIXEL Protocol 1.0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tarsus.hardware.codec.packet import BROADCAST, packet

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

PING: Final = 0x01
READ: Final = 0x02
WRITE: Final = 0x03
SYNC_WRITE: Final = 0x83
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
    return tuple(ERRORS.get(bit, f"bit {bit}") for bit in range(8) if code >> bit & 1)


def ping(id: int) -> bytes:
    """Return the packet that asks a servo for an answer.

    Parameters
    ----------
    id : int
        Id of the servo.
    """
    return packet(id, PING)


def read(id: int, address: int, count: int) -> bytes:
    """Return the packet that asks a servo for registers.

    Parameters
    ----------
    id : int
        Id of the servo.
    address : int
        The first register.
    count : int
        How many bytes.
    """
    return packet(id, READ, bytes((address, count)))


def write(id: int, address: int, data: bytes) -> bytes:
    """Return the packet that writes registers of a servo; of all servos with the broadcast id.

    Parameters
    ----------
    id : int
        Id of the servo.
    address : int
        The first register.
    data : bytes
        Their content.
    """
    return packet(id, WRITE, bytes((address,)) + data)


def sync_write(address: int, contents: Mapping[int, bytes]) -> bytes:
    """Return the packet that writes the same registers of several servos; none of them answers.

    Parameters
    ----------
    address : int
        The first register.
    contents : mapping of int to bytes
        Their content, by the servos' ids, of equal length.
    """
    length = len(next(iter(contents.values())))
    data = b"".join(bytes((id,)) + content for id, content in contents.items())
    return packet(BROADCAST, SYNC_WRITE, bytes((address, length)) + data)


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
