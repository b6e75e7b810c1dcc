"""The answer to fast reading of Dynamixel protocol 2.0: one packet, to which each servo adds its part."""

from __future__ import annotations

from collections.abc import Sequence

from tarsus.hardware.codec.dynamixel2 import BROADCAST, HEADER, STATUS, crc
from tarsus.hardware.codec.scan import Frame

__all__ = ["fast_status", "split_fast"]


def fast_status(parts: Sequence[tuple[int, int, bytes]]) -> tuple[bytes, ...]:
    """Return what each servo sends of the one packet in which several answer.

    Each CRC covers everything before it in the packet.

    Parameters
    ----------
    parts : sequence of (int, int, bytes)
        Id, error byte and data of each servo, all data of equal length.
    """
    count = len(parts[0][2])
    begin = HEADER + bytes((BROADCAST,)) + (len(parts) * (count + 4) + 1).to_bytes(2, "little") + bytes((STATUS,))
    sent, before = [], 0
    for at, (id, error, data) in enumerate(parts):
        part = (begin if at == 0 else b"") + bytes((error, id)) + data
        check = crc(part, before).to_bytes(2, "little")
        before = crc(check, crc(part, before))
        sent.append(part + check)
    return tuple(sent)


def split_fast(frame: Frame, count: int) -> tuple[Frame, ...]:
    """Return the answers in the one packet in which several servos answer.

    Parameters
    ----------
    frame : Frame
        The packet.
    count : int
        How many bytes of data each answer has.
    """
    # The first error byte is the frame's code; the last CRC is that of the packet.
    body, size = bytes((frame.code,)) + frame.data + b"\x00\x00", count + 4
    if len(body) % size:
        return ()
    parts = (body[at : at + size] for at in range(0, len(body), size))
    return tuple(Frame(part[1], part[0], part[2 : 2 + count], part) for part in parts)
