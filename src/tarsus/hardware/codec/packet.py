"""Packets ``FF FF id length code parameters checksum``: those of Dynamixel 1.0 and of Feetech.

Sources: ROBOTIS e-Manual, DYNAMIXEL Protocol 1.0; Feetech, SMS/STS communication protocol manual.
"""

from __future__ import annotations

from tarsus.hardware.codec.scan import Frame, Scanned

__all__ = ["BROADCAST", "HEADER", "checksum", "packet", "scan"]

HEADER = b"\xff\xff"
BROADCAST = 0xFE
# Header, id, length, code, checksum.
_OVERHEAD = 6
# Of ids only 0 to 253 answer; the longest length that Feetech and Dynamixel send.
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
    frames, damaged, at, noise = [], [], 0, 0
    while at < len(received):
        end = _end(received, at)
        if end > len(received) and not ended:
            break
        raw = received[at:end]
        if at < end <= len(received) and checksum(raw[2:-1]) == raw[-1]:
            damaged += [received[noise:at]] if at > noise else []
            frames.append(Frame(raw[2], raw[4], raw[5:-1], raw))
            at = noise = end
        else:
            # Where another packet follows, the length is right: bytes inside a damaged packet are no packets.
            follows = at < end and received[end:].startswith(HEADER)
            at = end if follows or end == len(received) > at else at + 1
    damaged += [received[noise:at]] if at > noise else []
    return Scanned(tuple(frames), received[at:], tuple(damaged))


def _end(received: bytes, at: int) -> int:
    """Return where a packet that begins at a place would end; the place itself if none can begin there."""
    begin = received[at : at + 4]
    if not HEADER.startswith(begin[:2]) or begin[2:3] == b"\xff":
        return at
    if len(begin) < 4:
        return at + _OVERHEAD
    return at + 4 + begin[3] if 2 <= begin[3] <= _MOST_LENGTH else at
