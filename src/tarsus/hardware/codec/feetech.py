"""Feetech STS and SCS: the packets of Dynamixel 1.0, with reading and writing of many servos in one packet.

Registers of two bytes are little-endian in STS servos and big-endian in SCS servos. Source: Feetech, SMS/STS and SCS
communication protocol manuals.
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
    "ERRORS",
    "PING",
    "READ",
    "SYNC_READ",
    "SYNC_WRITE",
    "WRITE",
    "errors_in",
    "ping",
    "read",
    "sync_read",
    "sync_write",
    "write",
]

SYNC_READ: Final = 0x82

ERRORS = {0: "voltage", 1: "position sensor", 2: "temperature", 3: "current", 5: "overload"}
"""What the bits of an answer's error byte mean."""


def errors_in(code: int) -> tuple[str, ...]:
    """Return what a servo reports in the error byte of an answer.

    Parameters
    ----------
    code : int
        The error byte.
    """
    return bits_set(code, ERRORS)


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
