"""Dynamixel protocol 2.0: packets with a 16-bit CRC and byte stuffing, and the instructions of X and MX servos.

A packet is ``FF FF FD 00 id length(2) instruction parameters CRC(2)``. Source: ROBOTIS e-Manual, DYNAMIXEL Protocol
2.0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tarsus.hardware.codec.scan import Frame, Framing, Scanned, scan_frames

__all__ = [
    "ALERT",
    "BROADCAST",
    "BULK_READ",
    "ERRORS",
    "FAST_SYNC_READ",
    "HEADER",
    "PING",
    "READ",
    "STATUS",
    "SYNC_READ",
    "SYNC_WRITE",
    "WRITE",
    "bulk_read",
    "crc",
    "errors_in",
    "packet",
    "ping",
    "read",
    "scan",
    "status",
    "sync_read",
    "sync_write",
    "write",
]

HEADER = b"\xff\xff\xfd\x00"
BROADCAST = 0xFE
PING: Final = 0x01
READ: Final = 0x02
WRITE: Final = 0x03
STATUS: Final = 0x55
SYNC_READ: Final = 0x82
SYNC_WRITE: Final = 0x83
FAST_SYNC_READ: Final = 0x8A
BULK_READ: Final = 0x92

ERRORS = {
    1: "instruction could not be carried out",
    2: "unknown instruction",
    3: "CRC of the request",
    4: "value out of range",
    5: "wrong length of the request",
    6: "value outside the limits",
    7: "register can't be written now",
}
"""What the number in the lower 7 bits of an answer's error byte means."""

ALERT: Final = 0x80
_MOST_LENGTH = 4096


def _table() -> tuple[int, ...]:
    values = []
    for byte in range(256):
        value = byte << 8
        for _ in range(8):
            value = (value << 1 ^ (0x8005 if value & 0x8000 else 0)) & 0xFFFF
        values.append(value)
    return tuple(values)


_CRC = _table()


def crc(data: bytes, begin: int = 0) -> int:
    """Return the CRC-16 of bytes: polynomial 8005, most significant bit first, beginning with 0.

    Parameters
    ----------
    data : bytes
        The bytes.
    begin : int
        CRC of the bytes before them.
    """
    for byte in data:
        begin = (begin << 8 ^ _CRC[(begin >> 8 ^ byte) & 0xFF]) & 0xFFFF
    return begin


def errors_in(code: int) -> tuple[str, ...]:
    """Return what a servo reports in the error byte of an answer.

    Parameters
    ----------
    code : int
        The error byte.
    """
    number = code & ~ALERT
    return (("hardware",) if code & ALERT else ()) + ((ERRORS.get(number, f"error {number}"),) if number else ())


def _framed(id: int, body: bytes) -> bytes:
    """Return a packet with an instruction and parameters, stuffed so that they contain no header."""
    stuffed = body.replace(b"\xff\xff\xfd", b"\xff\xff\xfd\xfd")
    frame = HEADER + bytes((id,)) + (len(stuffed) + 2).to_bytes(2, "little") + stuffed
    return frame + crc(frame).to_bytes(2, "little")


def packet(id: int, instruction: int, data: bytes = b"") -> bytes:
    """Return a packet with an instruction.

    Parameters
    ----------
    id : int
        Id of the servo.
    instruction : int
        The instruction.
    data : bytes
        Parameters.
    """
    return _framed(id, bytes((instruction,)) + data)


def status(id: int, error: int, data: bytes = b"") -> bytes:
    """Return the packet with which a servo answers.

    Parameters
    ----------
    id : int
        Id of the servo.
    error : int
        The error byte.
    data : bytes
        Parameters.
    """
    return _framed(id, bytes((STATUS, error)) + data)


def scan(received: bytes, *, ended: bool = False) -> Scanned:
    """Return the packets in a stream of bytes.

    The code of a frame is the error byte of an answer, or the instruction of any other packet.

    Parameters
    ----------
    received : bytes
        Bytes to search: what the last scan left over, and what has arrived since.
    ended : bool
        Whether nothing more comes, so that an incomplete packet is a damaged one.
    """
    return scan_frames(received, _FRAMING, ended=ended)


def _size(begin: bytes) -> int:
    length = int.from_bytes(begin[5:7], "little")
    return 7 + length if 3 <= length <= _MOST_LENGTH else 0


def _decode(raw: bytes) -> Frame | None:
    if crc(raw[:-2]) != int.from_bytes(raw[-2:], "little"):
        return None
    # The shared answer of several servos is not stuffed.
    body = raw[7:-2] if raw[4] == BROADCAST else raw[7:-2].replace(b"\xff\xff\xfd\xfd", b"\xff\xff\xfd")
    if body[0] == STATUS and len(body) > 1:
        return Frame(raw[4], body[1], body[2:], raw)
    return Frame(raw[4], body[0], body[1:], raw)


_FRAMING = Framing(HEADER, 7, _size, _decode)


def ping(id: int) -> bytes:
    """Return the packet that asks a servo for an answer.

    Parameters
    ----------
    id : int
        Id of the servo.
    """
    return packet(id, PING)


def _words(*values: int) -> bytes:
    return b"".join(value.to_bytes(2, "little") for value in values)


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
    return packet(id, READ, _words(address, count))


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
    return packet(id, WRITE, _words(address) + data)


def sync_read(ids: Sequence[int], address: int, count: int, *, fast: bool = False) -> bytes:
    """Return the packet that asks several servos for the same registers; they answer in the order of the ids.

    Parameters
    ----------
    ids : sequence of int
        Ids of the servos.
    address : int
        The first register.
    count : int
        How many bytes.
    fast : bool
        Whether they answer in one packet.
    """
    return packet(BROADCAST, FAST_SYNC_READ if fast else SYNC_READ, _words(address, count) + bytes(ids))


def bulk_read(ids: Sequence[int], address: int, count: int) -> bytes:
    """Return the packet that asks several servos for registers, each with an address and a count of its own.

    Parameters
    ----------
    ids : sequence of int
        Ids of the servos.
    address : int
        The first register.
    count : int
        How many bytes.
    """
    return packet(BROADCAST, BULK_READ, b"".join(bytes((id,)) + _words(address, count) for id in ids))


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
    return packet(BROADCAST, SYNC_WRITE, _words(address, length) + data)
