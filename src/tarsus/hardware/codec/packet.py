"""Packets ``FF FF id length code parameters checksum`` and the instructions that Dynamixel 1.0 and Feetech share.

Sources: ROBOTIS e-Manual, DYNAMIXEL Protocol 1.0; Feetech, SMS/STS communication protocol manual.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tarsus.hardware.codec.scan import Frame, Framing, Scanned, scan_frames

__all__ = [
    "BROADCAST",
    "HEADER",
    "PING",
    "READ",
    "SYNC_WRITE",
    "WRITE",
    "bits_set",
    "checksum",
    "packet",
    "ping",
    "read",
    "scan",
    "sync_write",
    "write",
]

HEADER = b"\xff\xff"
BROADCAST = 0xFE
PING: Final = 0x01
READ: Final = 0x02
WRITE: Final = 0x03
SYNC_WRITE: Final = 0x83
# Greatest length that counts as one; the least is 2, of a packet with only its instruction and checksum.
_MOST_LENGTH = 250


def checksum(body: bytes) -> int:
    """Return the complement of the sum of the bytes from the id on.

    Parameters
    ----------
    body : bytes
        From the id to the last parameter.
    """
    return ~sum(body) & 0xFF


def packet(id: int, code: int, data: bytes = b"") -> bytes:
    """Return a packet.

    Parameters
    ----------
    id : int
        Id of the servo.
    code : int
        Instruction, or in an answer the error.
    data : bytes
        Parameters.
    """
    body = bytes((id, len(data) + 2, code)) + data
    return HEADER + body + bytes((checksum(body),))


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


def bits_set(code: int, meanings: Mapping[int, str]) -> tuple[str, ...]:
    """Return the meanings of the bits that are set in an error byte.

    Parameters
    ----------
    code : int
        The error byte.
    meanings : mapping of int to str
        What the bits mean; others are named by their number.
    """
    return tuple(meanings.get(bit, f"bit {bit}") for bit in range(8) if code >> bit & 1)


def scan(received: bytes, *, ended: bool = False) -> Scanned:
    """Return the packets in a stream of bytes.

    Parameters
    ----------
    received : bytes
        Bytes to search: what the last scan left over, and what has arrived since.
    ended : bool
        Whether nothing more comes, so that an incomplete packet is a damaged one.
    """
    return scan_frames(received, _FRAMING, ended=ended)


def _size(begin: bytes) -> int:
    # No servo has the id FF: after a third FF, the header begins one byte later.
    return 4 + begin[3] if begin[2] != 0xFF and 2 <= begin[3] <= _MOST_LENGTH else 0


def _decode(raw: bytes) -> Frame | None:
    return Frame(raw[2], raw[4], raw[5:-1], raw) if checksum(raw[2:-1]) == raw[-1] else None


_FRAMING = Framing(HEADER, 4, _size, _decode)
