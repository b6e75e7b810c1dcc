"""Packets ``FF FF id length code parameters checksum``: those of Dynamixel 1.0 and of Feetech.

Sources: ROBOTIS e-Manual, DYNAMIXEL Protocol 1.0; Feetech, SMS/STS communication protocol manual.
"""

from __future__ import annotations

from tarsus.hardware.codec.scan import Frame, Framing, Scanned, scan_frames

__all__ = ["BROADCAST", "HEADER", "checksum", "packet", "scan"]

HEADER = b"\xff\xff"
BROADCAST = 0xFE
# A packet with instruction and checksum alone has a length of 2.
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


def scan(received: bytes, *, ended: bool = False) -> Scanned:
    """Return the packets in a stream of bytes.

    Parameters
    ----------
    received : bytes
        What has arrived and was not part of a packet before.
    ended : bool
        Whether nothing more comes, so that an incomplete packet is a damaged one.
    """
    return scan_frames(received, _FRAMING, ended=ended)


def _size(begin: bytes) -> int:
    # A third FF belongs to no id: the header begins one byte later.
    return 4 + begin[3] if begin[2] != 0xFF and 2 <= begin[3] <= _MOST_LENGTH else 0


def _decode(raw: bytes) -> Frame | None:
    return Frame(raw[2], raw[4], raw[5:-1], raw) if checksum(raw[2:-1]) == raw[-1] else None


_FRAMING = Framing(HEADER, 4, _size, _decode)
