"""LX-16A, LX-224, HTS-35H and other bus servos of Hiwonder (LewanSoul): ``55 55 id length command data checksum``.

Source: LewanSoul, Bus Servo Communication Protocol.
"""

from __future__ import annotations

from typing import Final

from tarsus.hardware.codec.scan import Frame, Framing, Scanned, scan_frames

__all__ = [
    "BROADCAST",
    "HEADER",
    "ID_READ",
    "LIMITS_READ",
    "LIMITS_WRITE",
    "MOVE",
    "MOVE_START",
    "MOVE_WAIT",
    "POSITION_READ",
    "TEMPERATURE_READ",
    "TORQUE_READ",
    "TORQUE_WRITE",
    "VOLTAGE_READ",
    "decode_signed",
    "decode_unsigned",
    "encode_words",
    "frame",
    "scan",
]

HEADER = b"\x55\x55"
BROADCAST = 0xFE

MOVE: Final = 1
MOVE_WAIT: Final = 7
MOVE_START: Final = 11
ID_READ: Final = 14
LIMITS_WRITE: Final = 20
LIMITS_READ: Final = 21
TEMPERATURE_READ: Final = 26
VOLTAGE_READ: Final = 27
POSITION_READ: Final = 28
TORQUE_WRITE: Final = 31
TORQUE_READ: Final = 32

# A frame without data has a length of 3; no command has more than 7.
_LENGTHS = range(3, 8)


def frame(id: int, command: int, data: bytes = b"") -> bytes:
    """Return a frame.

    Parameters
    ----------
    id : int
        Id of the servo.
    command : int
        The command.
    data : bytes
        Its parameters.
    """
    body = bytes((id, len(data) + 3, command)) + data
    return HEADER + body + bytes((~sum(body) & 0xFF,))


def encode_words(*values: int) -> bytes:
    """Return numbers as pairs of bytes, the low one first.

    Parameters
    ----------
    *values : int
        Numbers, 0 to 65535.
    """
    return b"".join(value.to_bytes(2, "little") for value in values)


def decode_unsigned(data: bytes) -> int:
    """Return the number in some bytes.

    Parameters
    ----------
    data : bytes
        The bytes, the lowest first.
    """
    return int.from_bytes(data, "little")


def decode_signed(data: bytes) -> int:
    """Return the signed number in some bytes: positions can be below 0.

    Parameters
    ----------
    data : bytes
        The bytes, the lowest first.
    """
    return int.from_bytes(data, "little", signed=True)


def scan(received: bytes, *, ended: bool = False) -> Scanned:
    """Return the frames in a stream of bytes; their code is the command.

    Parameters
    ----------
    received : bytes
        Bytes to search: what the last scan left over, and what has arrived since.
    ended : bool
        Whether nothing more comes, so that an incomplete frame is a damaged one.
    """
    return scan_frames(received, _FRAMING, ended=ended)


def _size(begin: bytes) -> int:
    return 3 + begin[3] if begin[3] in _LENGTHS else 0


def _decode(raw: bytes) -> Frame | None:
    return Frame(raw[2], raw[4], raw[5:-1], raw) if ~sum(raw[2:-1]) & 0xFF == raw[-1] else None


_FRAMING = Framing(HEADER, 4, _size, _decode)
