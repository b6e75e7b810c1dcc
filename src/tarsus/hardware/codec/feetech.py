"""Feetech STS and SCS: the packets of Dynamixel 1.0, with reading and writing of many servos in one packet.

Two bytes of a register are little-endian in STS servos and big-endian in SCS servos. Source: Feetech, SMS/STS and SCS
communication protocol manuals.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tarsus.hardware.codec.packet import BROADCAST, packet

__all__ = [
    "BAUDS",
    "ERRORS",
    "PING",
    "READ",
    "SYNC_READ",
    "SYNC_WRITE",
    "WRITE",
    "answer_size",
    "errors_in",
    "ping",
    "read",
    "sync_read",
    "sync_write",
    "write",
]

PING: Final = 0x01
READ: Final = 0x02
WRITE: Final = 0x03
SYNC_READ: Final = 0x82
SYNC_WRITE: Final = 0x83

BAUDS = (1_000_000, 500_000, 250_000, 128_000, 115_200, 76_800, 57_600, 38_400)

ERRORS = {0: "voltage", 1: "position sensor", 2: "temperature", 3: "current", 5: "overload"}
"""What the bits of an answer's error byte mean."""


def errors_in(code: int) -> tuple[str, ...]:
    """Return what a servo reports in the error byte of an answer.

    Parameters
    ----------
    code : int
        The error byte.
    """
    return tuple(ERRORS.get(bit, f"bit {bit}") for bit in range(8) if code >> bit & 1)


def answer_size(count: int) -> int:
    """Return how many bytes an answer with so many parameters has.

    Parameters
    ----------
    count : int
        Number of parameters.
    """
    return 6 + count


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


def sync_read(ids: Sequence[int], address: int, count: int) -> bytes:
    """Return the packet that asks several servos for the same registers; they answer in the order of the ids.

    Parameters
    ----------
    ids : sequence of int
        Ids of the servos.
    address : int
        The first register.
    count : int
        How many bytes.
    """
    return packet(BROADCAST, SYNC_READ, bytes((address, count, *ids)))


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
